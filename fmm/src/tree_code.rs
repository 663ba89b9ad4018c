//! The Barnes-Hut tree code: sources far from a leaf are replaced by proxies, and near ones are
//! summed directly.
//!
//! A cluster of sources in a box is replaced by strengths on the $p^3$ Chebyshev nodes of the box.
//! Their sum is the same for polynomials of degree below $p$ along each axis:
//! $\sum_j s_j\,G(x - y_j) \approx \sum_k \hat s_k\,G(x - \eta_k)$ with
//! $\hat s_k = \sum_j \ell_k(y_j) s_j$, for every smooth $G$ (L. Wang, R. Krasny, S. Tlupova, A
//! kernel-independent treecode based on barycentric Lagrange interpolation, Commun. Comput. Phys.
//! 28, 2020).

use std::f64::consts::PI;
use std::ops::Range;

use rayon::prelude::*;

use crate::direct;
use crate::error::FmmError;
use crate::fast::Points;
use crate::flow::{Flow, Output, Singularities, Strengths, Stresslets, check_positions};
use crate::tree::{Costs, SortedPoints, Tree};

#[cfg(test)]
mod tests;

/// Sums by the Barnes-Hut tree code, for comparison. Their time grows like $N \log N$.
///
/// It takes the same strengths as [`StokesSum`](crate::StokesSum) and has no operators to make, but
/// it is slower except for small sums to few digits. Results are the same bits on any number of
/// threads.
///
/// # Examples
///
/// ```
/// use stokes_fmm::{Output, Points, Singularities, Strengths, TreeCode};
///
/// let sources = [[0.0; 3]];
/// let targets = [[2.0, 0.0, 0.0]];
/// let points = Points::apart(&sources, &targets);
/// let sum = TreeCode::new(points, Singularities::Stokeslets, Output::Velocity, 1e-6)?;
/// let strengths = Strengths { stokeslets: Some(&[[1.0, 0.0, 0.0]]), ..Default::default() };
/// let flow = sum.apply(&strengths)?;
/// assert!((flow.velocity[0][0] * 8.0 * std::f64::consts::PI - 1.0).abs() < 1e-6);
/// # Ok::<(), stokes_fmm::FmmError>(())
/// ```
pub struct TreeCode {
    singularities: Singularities,
    output: Output,
    tolerance: f64,
    opening: Opening,
    sources: SortedPoints,
    targets: Option<SortedPoints>,
    /// Children before their parents.
    clusters: Vec<Cluster>,
    /// Where generations of clusters end: no cluster has children in its own.
    generations: Vec<usize>,
    views: Vec<View>,
}

/// When a cluster is seen through its proxies.
#[derive(Clone, Copy, Debug)]
struct Opening {
    /// Proxies along each axis.
    proxies: usize,
    /// Largest sum of the radii of cluster and leaf, relative to the distance of their centres.
    angle: f64,
}

impl Opening {
    /// Parameters for a relative error of `tolerance`, as measured for random strengths. Every
    /// proxy along an axis adds a digit, and large sums need one proxy more than small ones.
    fn for_tolerance(tolerance: f64, singularities: Singularities, output: Output) -> Self {
        let derivatives = usize::from(singularities != Singularities::Stokeslets)
            + usize::from(output != Output::Velocity);
        let digits = -tolerance.log10();
        Self {
            proxies: digits.ceil() as usize + 1 + derivatives,
            angle: 0.6,
        }
    }
}

/// A box of the smallest size around some points.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    center: [f64; 3],
    half: [f64; 3],
}

impl Bounds {
    fn around(points: &SortedPoints, range: &Range<u32>) -> Self {
        let range = range.start as usize..range.end as usize;
        let ends = points.positions.each_ref().map(|x| {
            let x = &x[range.clone()];
            let ends = (f64::INFINITY, f64::NEG_INFINITY);
            x.iter()
                .fold(ends, |(low, high), &x| (low.min(x), high.max(x)))
        });
        Self {
            center: ends.map(|(low, high)| 0.5 * (low + high)),
            half: ends.map(|(low, high)| 0.5 * (high - low)),
        }
    }

    fn radius(&self) -> f64 {
        self.half.iter().map(|h| h * h).sum::<f64>().sqrt()
    }

    fn distance(&self, other: &Self) -> f64 {
        let along = |axis: usize| self.center[axis] - other.center[axis];
        (0..3).map(|axis| along(axis).powi(2)).sum::<f64>().sqrt()
    }

    /// From -1 to 1 inside.
    fn relative(&self, point: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| {
            if self.half[axis] > 0.0 {
                (point[axis] - self.center[axis]) / self.half[axis]
            } else {
                0.0
            }
        })
    }
}

#[derive(Clone, Debug)]
struct Cluster {
    bounds: Bounds,
    sources: Range<u32>,
    children: Vec<u32>,
}

/// What a leaf's targets see.
#[derive(Clone, Debug)]
struct View {
    targets: Range<u32>,
    /// Sources seen directly.
    near: Vec<Range<u32>>,
    /// Clusters seen through their proxies.
    far: Vec<u32>,
}

impl TreeCode {
    /// Plans sums of `singularities` to about the `tolerance`, relative in the Euclidean norm over
    /// all targets.
    ///
    /// # Errors
    ///
    /// Coordinates that are not finite or beyond 1e100, and tolerances outside of 1e-12 to 1e-1.
    pub fn new(
        points: Points<'_>,
        singularities: Singularities,
        output: Output,
        tolerance: f64,
    ) -> Result<Self, FmmError> {
        direct::precision(Some(tolerance))?;
        check_positions("source position", points.sources)?;
        check_positions("target position", points.targets.unwrap_or(&[]))?;
        let opening = Opening::for_tolerance(tolerance, singularities, output);
        Ok(Self::with_opening(
            points,
            singularities,
            output,
            tolerance,
            opening,
        ))
    }

    fn with_opening(
        points: Points<'_>,
        singularities: Singularities,
        output: Output,
        tolerance: f64,
        opening: Opening,
    ) -> Self {
        let proxies = opening.proxies.pow(3) * records_per_proxy(singularities);
        // What splits boxes of more points: of so many, and some times as many in colleagues.
        let split = f64::max(500.0, 4.0 * proxies as f64);
        let costs = Costs {
            pair: 1.0,
            grid: 3.7 * split * split,
            point: 0.0,
        };
        let tree = Tree::new(points.sources, points.targets, &costs);
        let (clusters, generations) = clusters(&tree);
        let mut code = Self {
            singularities,
            output,
            tolerance,
            opening,
            clusters,
            generations,
            views: Vec::new(),
            sources: tree.sources,
            targets: tree.targets,
        };
        let leaves = tree.leaves.par_iter();
        code.views = leaves
            .filter(|leaf| !leaf.targets.is_empty())
            .map(|leaf| code.view(leaf.targets.clone()))
            .collect();
        code
    }

    /// The flow of sources of these strengths at the targets.
    ///
    /// # Errors
    ///
    /// Strengths that are not finite, whose number differs from that of the sources, or of a kind
    /// that was not planned for.
    pub fn apply(&self, strengths: &Strengths<'_>) -> Result<Flow, FmmError> {
        strengths.validate(self.sources.order.len())?;
        self.singularities.admits(strengths)?;
        let sources = Sources::new(self, strengths);
        let proxies = self.all_proxies(&sources);
        let flows: Vec<Flow> = self
            .views
            .par_iter()
            .map(|view| self.flow(view, &sources, &proxies))
            .collect::<Result<_, _>>()?;
        Ok(self.in_order(&flows))
    }

    fn target_points(&self) -> &SortedPoints {
        self.targets.as_ref().unwrap_or(&self.sources)
    }

    /// Whether a cluster has so many sources that proxies are fewer.
    fn has_proxies(&self, cluster: &Cluster) -> bool {
        let records = self.opening.proxies.pow(3) * records_per_proxy(self.singularities);
        cluster.sources.len() > records
    }

    fn view(&self, targets: Range<u32>) -> View {
        let here = Bounds::around(self.target_points(), &targets);
        let mut view = View {
            targets,
            near: Vec::new(),
            far: Vec::new(),
        };
        let mut open = vec![self.clusters.len() as u32 - 1];
        while let Some(index) = open.pop() {
            let cluster = &self.clusters[index as usize];
            let radii = here.radius() + cluster.bounds.radius();
            let apart = radii < self.opening.angle * here.distance(&cluster.bounds);
            if apart && self.has_proxies(cluster) {
                view.far.push(index);
            } else if apart || cluster.children.is_empty() {
                view.near.push(cluster.sources.clone());
            } else {
                open.extend(&cluster.children);
            }
        }
        view
    }

    /// Strengths of the proxies of every cluster, empty where there are none.
    fn all_proxies(&self, sources: &Sources) -> Vec<Vec<f64>> {
        let basis = Basis::new(self.opening.proxies);
        let mut all: Vec<Vec<f64>> = Vec::with_capacity(self.clusters.len());
        for &end in &self.generations {
            let next: Vec<Vec<f64>> = self.clusters[all.len()..end]
                .par_iter()
                .map(|cluster| self.proxies(cluster, sources, &basis, &all))
                .collect();
            all.extend(next);
        }
        all
    }

    fn proxies(
        &self,
        cluster: &Cluster,
        sources: &Sources,
        basis: &Basis,
        below: &[Vec<f64>],
    ) -> Vec<f64> {
        if !self.has_proxies(cluster) {
            return Vec::new();
        }
        let fields = sources.fields.len();
        let mut laid = Laid::new(basis, cluster.bounds, fields);
        let add_sources = |laid: &mut Laid, range: &Range<u32>| {
            for source in range.start as usize..range.end as usize {
                laid.add(self.place(source), |field| sources.fields[field][source]);
            }
        };
        if cluster.children.is_empty() {
            add_sources(&mut laid, &cluster.sources);
        }
        for &child in &cluster.children {
            let part = &self.clusters[child as usize];
            let proxies = &below[child as usize];
            if proxies.is_empty() {
                add_sources(&mut laid, &part.sources);
                continue;
            }
            let count = basis.count();
            for node in 0..count {
                let place = basis.place(&part.bounds, node);
                laid.add(place, |field| proxies[field * count + node]);
            }
        }
        laid.strengths
    }

    fn place(&self, source: usize) -> [f64; 3] {
        self.sources.positions.each_ref().map(|x| x[source])
    }

    /// The flow in the order of the tree, at the targets of one leaf.
    fn flow(&self, view: &View, sources: &Sources, proxies: &[Vec<f64>]) -> Result<Flow, FmmError> {
        let basis = Basis::new(self.opening.proxies);
        let mut seen = Records::default();
        for range in &view.near {
            for source in range.start as usize..range.end as usize {
                seen.push_source(self.place(source), &sources.records, source);
            }
        }
        for &index in &view.far {
            let bounds = &self.clusters[index as usize].bounds;
            let strengths = &proxies[index as usize];
            for node in 0..basis.count() {
                let field = |field: usize| strengths[field * basis.count() + node];
                seen.push_proxy(basis.place(bounds, node), self.singularities, field);
            }
        }
        let positions = &self.target_points().positions;
        let targets: Vec<[f64; 3]> = (view.targets.start as usize..view.targets.end as usize)
            .map(|target| positions.each_ref().map(|x| x[target]))
            .collect();
        direct::sum(
            &seen.positions,
            &seen.strengths(self.singularities),
            &targets,
            self.output,
            Some(self.tolerance),
        )
    }

    /// The flows of the leaves in the user's order.
    fn in_order(&self, flows: &[Flow]) -> Flow {
        let order = &self.target_points().order;
        let count = order.len();
        let mut flow = Flow {
            velocity: vec![[0.0; 3]; count],
            ..Flow::default()
        };
        if self.output != Output::Velocity {
            flow.pressure = vec![0.0; count];
        }
        if self.output == Output::Gradient {
            flow.gradient = vec![[[0.0; 3]; 3]; count];
        }
        for (view, part) in self.views.iter().zip(flows) {
            let numbers = &order[view.targets.start as usize..view.targets.end as usize];
            for (place, &number) in numbers.iter().enumerate() {
                let number = number as usize;
                flow.velocity[number] = part.velocity[place];
                if let Some(&pressure) = part.pressure.get(place) {
                    flow.pressure[number] = pressure;
                }
                if let Some(&gradient) = part.gradient.get(place) {
                    flow.gradient[number] = gradient;
                }
            }
        }
        flow
    }
}

/// Clusters of the leaves, then of the boxes level by level from the finest; and the end of each of
/// these generations.
fn clusters(tree: &Tree) -> (Vec<Cluster>, Vec<usize>) {
    let cluster = |sources: &Range<u32>, children| Cluster {
        bounds: Bounds::around(&tree.sources, sources),
        sources: sources.clone(),
        children,
    };
    let leaves = tree.leaves.iter();
    let mut clusters: Vec<Cluster> = leaves
        .map(|leaf| cluster(&leaf.sources, Vec::new()))
        .collect();
    let mut generations = vec![clusters.len()];
    let mut below = clusters.len() as u32;
    for level in tree.levels.iter().rev() {
        let first = clusters.len() as u32;
        for one in &level.boxes {
            let boxes = one.children.start + below..one.children.end + below;
            let children = one.leaves.clone().chain(boxes);
            let populated = |child: &u32| !clusters[*child as usize].sources.is_empty();
            let children = children.filter(populated).collect();
            clusters.push(cluster(&one.sources, children));
        }
        generations.push(clusters.len());
        below = first;
    }
    (clusters, generations)
}

/// Number of records per proxy. A stresslet of density $q$ and normal $n$ is $q \otimes n$; a sum
/// of these is three stresslets with the axes as normals.
fn records_per_proxy(singularities: Singularities) -> usize {
    if singularities == Singularities::Stokeslets {
        1
    } else {
        3
    }
}

/// Numbers that a source is to proxies: force 3, $q_j n_k$ 9, torque 3, flux 1.
const FIELDS: usize = 16;
const DYADS: usize = 3;
const TORQUES: usize = 12;
const FLUX: usize = 15;

/// Which fields singularities have.
fn fields(singularities: Singularities) -> Range<usize> {
    match singularities {
        Singularities::Stokeslets => 0..DYADS,
        Singularities::Stresslets => DYADS..TORQUES,
        Singularities::Both => 0..TORQUES,
        Singularities::All => 0..FIELDS,
    }
}

/// Strengths of all sources in the order of the tree.
struct Sources {
    records: Records,
    /// One column for each field that there is.
    fields: Vec<Vec<f64>>,
}

impl Sources {
    fn new(code: &TreeCode, strengths: &Strengths<'_>) -> Self {
        let mut records = Records::default();
        let mut columns = vec![Vec::new(); fields(code.singularities).len()];
        for &number in &code.sources.order {
            let all = strengths.of(number as usize, Singularities::All);
            let vector = |first: usize| [all[first], all[first + 1], all[first + 2]];
            records.push(
                [0.0; 3],
                vector(0),
                [vector(3), vector(6)],
                vector(9),
                all[12],
            );
            let mut record = [0.0; FIELDS];
            record[..DYADS].copy_from_slice(&all[..3]);
            for j in 0..3 {
                for k in 0..3 {
                    record[DYADS + 3 * j + k] = all[3 + j] * all[6 + k];
                }
            }
            record[TORQUES..].copy_from_slice(&all[9..]);
            let present = &record[fields(code.singularities)];
            for (column, &value) in columns.iter_mut().zip(present) {
                column.push(value);
            }
        }
        Self {
            records,
            fields: columns,
        }
    }
}

/// Sources of the direct sum.
#[derive(Default)]
struct Records {
    positions: Vec<[f64; 3]>,
    forces: Vec<[f64; 3]>,
    densities: Vec<[f64; 3]>,
    normals: Vec<[f64; 3]>,
    torques: Vec<[f64; 3]>,
    fluxes: Vec<f64>,
}

impl Records {
    fn push(
        &mut self,
        position: [f64; 3],
        force: [f64; 3],
        [density, normal]: [[f64; 3]; 2],
        torque: [f64; 3],
        flux: f64,
    ) {
        self.positions.push(position);
        self.forces.push(force);
        self.densities.push(density);
        self.normals.push(normal);
        self.torques.push(torque);
        self.fluxes.push(flux);
    }

    fn push_source(&mut self, position: [f64; 3], all: &Self, index: usize) {
        let stresslet = [all.densities[index], all.normals[index]];
        let (force, torque) = (all.forces[index], all.torques[index]);
        self.push(position, force, stresslet, torque, all.fluxes[index]);
    }

    fn push_proxy(
        &mut self,
        position: [f64; 3],
        singularities: Singularities,
        field: impl Fn(usize) -> f64,
    ) {
        let present = fields(singularities);
        let at = |wanted: usize| {
            if present.contains(&wanted) {
                field(wanted - present.start)
            } else {
                0.0
            }
        };
        let vector = |first: usize| [first, first + 1, first + 2].map(at);
        let dyad = |k: usize| {
            let mut normal = [0.0; 3];
            normal[k] = 1.0;
            [[0, 1, 2].map(|j| at(DYADS + 3 * j + k)), normal]
        };
        self.push(position, vector(0), dyad(0), vector(TORQUES), at(FLUX));
        for k in 1..records_per_proxy(singularities) {
            self.push(position, [0.0; 3], dyad(k), [0.0; 3], 0.0);
        }
    }

    fn strengths(&self, singularities: Singularities) -> Strengths<'_> {
        let all = singularities == Singularities::All;
        Strengths {
            stokeslets: (singularities != Singularities::Stresslets).then_some(&self.forces),
            stresslets: (singularities != Singularities::Stokeslets).then_some(Stresslets {
                densities: &self.densities,
                normals: &self.normals,
            }),
            rotlets: all.then_some(&self.torques),
            fluxes: all.then_some(&self.fluxes),
        }
    }
}

/// Lagrange polynomials on the zeros of the Chebyshev polynomial $T_p$.
struct Basis {
    nodes: Vec<f64>,
    /// $\ell_k = \sum_m c_{km} T_m$, with $c_{km} = (2 - \delta_{m0})\,T_m(\eta_k)/p$.
    series: Vec<f64>,
}

impl Basis {
    fn new(count: usize) -> Self {
        let angle = |k: usize| PI * (k as f64 + 0.5) / count as f64;
        let coefficient = |k: usize, m: usize| {
            let twice = if m == 0 { 1.0 } else { 2.0 };
            twice * (m as f64 * angle(k)).cos() / count as f64
        };
        Self {
            nodes: (0..count).map(|k| angle(k).cos()).collect(),
            series: (0..count * count)
                .map(|i| coefficient(i / count, i % count))
                .collect(),
        }
    }

    /// Nodes in a box.
    fn count(&self) -> usize {
        self.nodes.len().pow(3)
    }

    /// Node number `node` of a box, the first axis the fastest.
    fn place(&self, bounds: &Bounds, node: usize) -> [f64; 3] {
        let p = self.nodes.len();
        let along = [node % p, node / p % p, node / (p * p)];
        [0, 1, 2].map(|axis| bounds.center[axis] + bounds.half[axis] * self.nodes[along[axis]])
    }

    /// Every polynomial at a point; `powers` is room for as many numbers.
    fn values(&self, x: f64, powers: &mut [f64], values: &mut [f64]) {
        let (mut below, mut current) = (x, 1.0);
        for power in powers.iter_mut() {
            *power = current;
            (below, current) = (current, 2.0 * x * current - below);
        }
        for (value, series) in values
            .iter_mut()
            .zip(self.series.chunks_exact(powers.len()))
        {
            *value = series.iter().zip(&*powers).map(|(c, t)| c * t).sum();
        }
    }
}

/// Strengths laid on the proxies of a cluster, field by field.
struct Laid<'a> {
    basis: &'a Basis,
    bounds: Bounds,
    strengths: Vec<f64>,
    powers: Vec<f64>,
    values: [Vec<f64>; 3],
    /// Products of the values along the first two axes.
    plane: Vec<f64>,
}

impl<'a> Laid<'a> {
    fn new(basis: &'a Basis, bounds: Bounds, fields: usize) -> Self {
        let p = basis.nodes.len();
        Self {
            basis,
            bounds,
            strengths: vec![0.0; fields * basis.count()],
            powers: vec![0.0; p],
            values: [0; 3].map(|_| vec![0.0; p]),
            plane: vec![0.0; p * p],
        }
    }

    fn add(&mut self, position: [f64; 3], field: impl Fn(usize) -> f64) {
        let relative = self.bounds.relative(position);
        for (x, values) in relative.into_iter().zip(&mut self.values) {
            self.basis.values(x, &mut self.powers, values);
        }
        let [first, second, third] = &self.values;
        for (row, y) in self.plane.chunks_exact_mut(first.len()).zip(second) {
            for (product, x) in row.iter_mut().zip(first) {
                *product = x * y;
            }
        }
        let boxes = self.strengths.chunks_exact_mut(self.basis.count());
        for (number, strengths) in boxes.enumerate() {
            let strength = field(number);
            let planes = strengths.chunks_exact_mut(self.plane.len());
            for (strengths, z) in planes.zip(third) {
                let part = strength * z;
                for (strength, product) in strengths.iter_mut().zip(&self.plane) {
                    *strength += part * product;
                }
            }
        }
    }
}
