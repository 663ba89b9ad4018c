//! The fields of both layers at a ring close to the surface, all modes at once.
//!
//! The azimuth is done exactly, by the modal kernels; along the curve the panels are cut towards the ring
//! ([near rules](super::near)) and the densities interpolated there. Pressure and gradient come from derivatives of the double layer's
//! density, so that nothing worse than $1/|\bar x|^2$ is integrated and no digits are lost however close the ring is
//! (`kernel::close`).

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use panel_quadrature::QuadratureError;

use super::densities::Densities;
use super::discretization::{Discretization, Node};
use super::near::{NearNodes, NearRules, Sight};
use crate::curve::{Meridian, Topology};
use crate::kernel::{Modes, Potential, RingDensities, SourceRings, TargetRing, Workspace};

/// Rules for close rings.
#[derive(Debug)]
pub(super) struct CloseFlow {
    rules: NearRules,
    engine: Modes,
}

/// A thread's buffers.
#[derive(Debug, Default)]
pub(super) struct Buffers {
    near: NearNodes,
    sources: SourceRings,
    /// Where each source's density comes from, and its quadrature weight.
    origins: Vec<Origin>,
    weights: Vec<f64>,
    interpolation: Vec<f64>,
    gathered: Vec<f64>,
    densities: RingDensities,
    workspace: Workspace,
    /// The fields found.
    pub fields: Vec<f64>,
}

/// Where a source's density comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Origin {
    /// It is this node of the discretization.
    Node(usize),
    /// It is interpolated from this panel, with row so-and-so of the interpolation.
    Panel { panel: usize, row: usize },
}

impl CloseFlow {
    /// Rules for panels of `order` nodes and so many modes, counting the zeroth.
    pub fn new(order: usize, modes: usize) -> Result<Self, QuadratureError> {
        Ok(Self {
            rules: NearRules::new(order, modes - 1)?,
            engine: Modes::new(modes - 1),
        })
    }

    /// Fills `buffers.fields` with all modes of the fields of the densities on `panels`: field `i` of family `f` of mode `n` is number
    /// `(2 n + f) FIELDS + i`.
    pub fn fields<const K: usize, const FIELDS: usize>(
        &self,
        discretization: &Discretization,
        densities: &Densities,
        potential: &impl Potential<K, FIELDS>,
        sight: &Sight,
        panels: impl Iterator<Item = usize>,
        buffers: &mut Buffers,
    ) -> Result<(), QuadratureError> {
        buffers.collect(discretization, &self.rules, sight, panels)?;
        let target = TargetRing {
            r: sight.point().r,
            normal: [0.0; 2],
        };
        self.engine
            .arrange(target, &buffers.sources, &mut buffers.workspace);
        buffers.interpolate(discretization, densities);
        self.engine.fields(
            potential,
            target,
            &buffers.sources,
            &buffers.densities,
            &mut buffers.workspace,
            &mut buffers.fields,
        );
        Ok(())
    }
}

impl Buffers {
    /// The sources on the panels that resolve their action on the point.
    fn collect(
        &mut self,
        discretization: &Discretization,
        rules: &NearRules,
        sight: &Sight,
        panels: impl Iterator<Item = usize>,
    ) -> Result<(), QuadratureError> {
        let order = discretization.order();
        let point = sight.point();
        self.sources.clear();
        self.origins.clear();
        self.weights.clear();
        self.interpolation.clear();
        for panel in panels {
            if rules.is_far(discretization, point, panel) {
                for (k, node) in discretization.nodes_of(panel).iter().enumerate() {
                    let separation = [point.r - node.r, point.z - node.z];
                    self.sources.push(node.r, separation, node.normal);
                    self.origins.push(Origin::Node(panel * order + k));
                    self.weights.push(node.weight);
                }
            } else {
                rules.fill_off_curve(discretization, sight, panel, &mut self.near)?;
                for (node, &separation) in self.near.nodes.iter().zip(&self.near.separation) {
                    self.sources.push(node.r, separation, node.normal);
                    self.weights.push(node.weight);
                }
                let first = self.interpolation.len() / order;
                let rows = first..first + self.near.nodes.len();
                self.origins
                    .extend(rows.map(|row| Origin::Panel { panel, row }));
                self.interpolation.extend(&self.near.interpolation);
            }
        }
        Ok(())
    }

    /// The densities at the sources, in the order of the workspace.
    fn interpolate(&mut self, discretization: &Discretization, densities: &Densities) {
        let (order, nodes) = (discretization.order(), discretization.nodes().len());
        let (rows, values) = (densities.rows(), densities.values());
        let columns = &self.workspace.order;
        self.densities.resize(rows, self.workspace.columns());
        let mut first = 0;
        while first < columns.len() {
            // A run of consecutive columns from one panel, all near or all far.
            let place = self.workspace.column(first);
            let panel = |k: usize| match self.origins[columns[k]] {
                Origin::Node(_) => None,
                Origin::Panel { panel, .. } => Some(panel),
            };
            let home = panel(first);
            let length = (first..columns.len())
                .take_while(|&k| panel(k) == home && self.workspace.column(k) == place + k - first)
                .count();
            self.gathered.clear();
            for &source in &columns[first..first + length] {
                let weight = self.weights[source];
                match self.origins[source] {
                    Origin::Node(node) => {
                        let column = place + self.gathered.len();
                        self.gathered.push(weight);
                        for row in 0..rows {
                            self.densities.values[row * self.densities.stride + column] =
                                weight * values[row * nodes + node];
                        }
                    }
                    Origin::Panel { row, .. } => self.gathered.extend(
                        self.interpolation[row * order..][..order]
                            .iter()
                            .map(|l| l * weight),
                    ),
                }
            }
            if let Some(panel) = home {
                let stride = self.densities.stride;
                matmul(
                    MatMut::from_column_major_slice_with_stride_mut(
                        &mut self.densities.values,
                        stride,
                        rows,
                        stride,
                    )
                    .subrows_mut(place, length),
                    Accum::Replace,
                    MatRef::from_column_major_slice(&self.gathered, order, length).transpose(),
                    MatRef::from_column_major_slice_with_stride(values, nodes, rows, nodes)
                        .subrows(panel * order, order),
                    1.0,
                    Par::Seq,
                );
            }
            first += length;
        }
    }
}

/// The point seen from the curve point nearest to it, or about so if it is not close.
pub(super) fn sight(discretization: &Discretization, point: Meridian) -> Sight {
    let curve = discretization.curve();
    let panels = discretization.panels();
    let [first, last] = [
        panels.as_slice()[0].start,
        panels.as_slice()[panels.len() - 1].end,
    ];
    let closed = panels.topology() == Topology::Loop;
    let seen = |s: f64| {
        let mut foot = curve.point(s);
        if !closed && foot.r < 0.1 * discretization.size() {
            let pole = if s - first < last - s { first } else { last };
            foot.r = curve.chord(pole, s - pole).r;
        }
        let gap = Meridian {
            r: point.r - foot.r,
            z: point.z - foot.z,
        };
        Sight { s, foot, gap }
    };
    let nodes = discretization.nodes();
    let distance = |node: &Node| (node.r - point.r).hypot(node.z - point.z);
    let nearest = (0..nodes.len())
        .min_by(|&i, &j| distance(&nodes[i]).total_cmp(&distance(&nodes[j])))
        .unwrap_or(0);
    let start = nodes[nearest].s;
    // No further than to the next node but one.
    let reach = 0.5
        * discretization
            .panel(nearest / discretization.order())
            .length();
    let mut found = seen(start);
    // Gauss and Newton: the error shrinks by the distance over the radius of curvature each time.
    for _ in 0..STEPS {
        let tangent = curve.tangent(found.s);
        let square = tangent.r * tangent.r + tangent.z * tangent.z;
        let step = (found.gap.r * tangent.r + found.gap.z * tangent.z) / square;
        let s = (found.s + step).clamp(start - reach, start + reach);
        let s = if closed {
            s - (last - first) * ((s - first) / (last - first)).floor()
        } else {
            s.clamp(first, last)
        };
        found = seen(s);
    }
    found
}

/// Steps towards the nearest curve point.
const STEPS: usize = 12;
