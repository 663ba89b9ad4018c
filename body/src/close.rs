//! The fields of both layers at a ring close to the surface, all modes at once.
//!
//! The azimuth is done exactly, by the modal kernels; along the curve the panels are cut towards
//! the ring ([near rules](super::near)) and the densities interpolated there. Pressure and gradient
//! come from derivatives of the double layer's density, so that nothing worse than $1/|\bar x|^2$
//! is integrated and no digits are lost however close the ring is (`kernel::close`).
//!
//! The integration by parts leaves boundary terms, the density itself on the circles where panels
//! end. On circles close to the target that lie between two panels they are left out: those of the
//! two panels cancel, since the density is continuous, and the small jump of its approximation
//! would be magnified by the closeness. On all other circles they are kept, as sources on rings: a
//! panel's field then depends on its density and not on the derivatives, which are less accurate,
//! and the other panels may be summed directly.

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use panel_quadrature::{PanelBasis, QuadratureError};

use super::densities::Densities;
use super::discretization::{Discretization, Node};
use super::near::{NearNodes, NearRules, Sight, Stretch, offsets, reference};
use crate::kernel::{
    Columns, DENSITIES, Modes, Potential, RingDensities, RingFields, SourceRings, TargetRing,
    Workspace,
};
use bodies_of_revolution::{Meridian, Topology};

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
    /// The ends of panels whose boundary term is kept.
    rings: Vec<(usize, End)>,
    gathered: Vec<f64>,
    /// Densities at the few nodes of a stretch.
    table: Vec<f64>,
    densities: RingDensities,
    workspace: Workspace,
    fields: RingFields,
}

/// Sources done at a time: their densities fit a core's cache.
const BLOCK: usize = 64;

impl CloseFlow {
    /// Rules for panels of `order` nodes and so many modes, counting the zeroth.
    pub fn new(order: usize, modes: usize) -> Result<Self, QuadratureError> {
        Ok(Self {
            rules: NearRules::new(order, modes - 1)?,
            engine: Modes::new(modes - 1),
        })
    }

    /// All modes of the fields of the densities on `panels`: field `i` of family `f` of mode `n` is
    /// number `(2 n + f) FIELDS + i`.
    pub fn fields<const K: usize, const FIELDS: usize>(
        &self,
        discretization: &Discretization,
        densities: &Densities,
        potential: &impl Potential<K, FIELDS>,
        sight: &Sight,
        panels: &[usize],
        buffers: &mut Buffers,
    ) -> Result<Vec<f64>, QuadratureError> {
        let point = sight.point();
        let target = TargetRing {
            r: point.r,
            normal: [0.0; 2],
        };
        buffers.fields.reset(2 * densities.modes() * FIELDS);
        buffers.rings.clear();
        let count = discretization.panels().len();
        // A boundary term is left out if the target is nearer than this to the panel's end.
        let order = discretization.order() as f64;
        let reach = |panel: usize| discretization.arc_length(panel) / order;
        for &panel in panels {
            let order = discretization.order();
            let on_panel = densities.on_panel(panel, order);
            if self.rules.is_far(discretization, point, panel) {
                let near = &mut buffers.near;
                near.take_own_nodes(discretization, sight, panel);
                self.add_nodes(potential, target, on_panel, buffers);
            } else {
                let mut table = std::mem::take(&mut buffers.table);
                for (stretch, is_inner) in self.rules.stretches(discretization, sight, panel) {
                    let near = &mut buffers.near;
                    self.rules
                        .fill_off_curve(discretization, sight, panel, &stretch, near)?;
                    let values = if is_inner {
                        let whole = offsets(discretization, sight, panel);
                        resample(
                            discretization.basis(),
                            whole,
                            &stretch,
                            on_panel,
                            &mut table,
                        )?
                    } else {
                        on_panel
                    };
                    self.add_nodes(potential, target, values, buffers);
                }
                buffers.table = table;
            }
            for (end, neighbour) in [
                (End::Start, (panel + count - 1) % count),
                (End::End, (panel + 1) % count),
            ] {
                let [r, z] = discretization.ends(panel)[end as usize];
                let distance = (point.r - r).hypot(point.z - z);
                let shared = panels.contains(&neighbour);
                if !shared || distance >= reach(panel).max(reach(neighbour)) {
                    buffers.rings.push((panel, end));
                }
            }
        }
        buffers.collect_rings(discretization, sight);
        self.engine
            .arrange(target, &buffers.sources, &mut buffers.workspace);
        buffers.interpolate_rings(discretization, densities)?;
        self.add(potential, target, buffers);
        Ok(buffers.fields.values().collect())
    }

    /// Adds the fields of the near nodes, whose densities are interpolated from `values` (values at
    /// some nodes, column after column).
    fn add_nodes<const K: usize, const FIELDS: usize>(
        &self,
        potential: &impl Potential<K, FIELDS>,
        target: TargetRing,
        values: MatRef<'_, f64>,
        buffers: &mut Buffers,
    ) {
        for first in (0..buffers.near.nodes.len()).step_by(BLOCK) {
            buffers.sources.clear();
            let near = &buffers.near;
            let block = near.nodes.iter().zip(&near.separation);
            for (node, &separation) in block.skip(first).take(BLOCK) {
                buffers.sources.push(node.r, separation, node.normal);
            }
            self.engine
                .arrange(target, &buffers.sources, &mut buffers.workspace);
            buffers.interpolate(values, first);
            self.add(potential, target, buffers);
        }
    }

    fn add<const K: usize, const FIELDS: usize>(
        &self,
        potential: &impl Potential<K, FIELDS>,
        target: TargetRing,
        buffers: &mut Buffers,
    ) {
        buffers.fields.add(
            &self.engine,
            potential,
            target,
            &buffers.sources,
            &buffers.densities,
            &mut buffers.workspace,
        );
    }
}

/// The densities on a stretch, from those at the panel's nodes.
fn resample<'t>(
    basis: &PanelBasis,
    whole: [f64; 2],
    stretch: &Stretch<'_>,
    on_panel: MatRef<'_, f64>,
    table: &'t mut Vec<f64>,
) -> Result<MatRef<'t, f64>, QuadratureError> {
    let [start, end] = stretch.domain;
    let places: Vec<f64> = (stretch.basis.nodes().iter())
        .map(|x| reference(start + 0.5 * (end - start) * (1.0 + x), whole))
        .collect();
    let rows = basis.interpolation_matrix(&places)?;
    let (count, columns) = (places.len(), on_panel.ncols());
    table.resize(count * columns, 0.0);
    matmul(
        MatMut::from_column_major_slice_mut(table, count, columns),
        Accum::Replace,
        rows.as_ref(),
        on_panel,
        1.0,
        Par::Seq,
    );
    Ok(MatRef::from_column_major_slice(table, count, columns))
}

/// An end of a panel.
#[derive(Clone, Copy, Debug)]
enum End {
    Start,
    End,
}

impl Buffers {
    /// The densities at the sources, which begin with near node `first`, in the order of the
    /// workspace.
    fn interpolate(&mut self, values: MatRef<'_, f64>, first: usize) {
        let (order, rows) = (values.nrows(), values.ncols());
        let sources = &self.workspace.order;
        let columns = Columns::of(&self.workspace);
        self.densities.resize(rows, columns);
        let stride = self.densities.stride;
        // Near and far columns stand apart.
        let near = columns.near;
        for run in [0..near, near..sources.len()] {
            if run.is_empty() {
                continue;
            }
            let (place, length) = (columns.place(run.start), run.len());
            self.gathered.clear();
            for &source in &sources[run] {
                let weight = self.near.nodes[first + source].weight;
                let row = &self.near.interpolation[(first + source) * order..][..order];
                self.gathered.extend(row.iter().map(|l| l * weight));
            }
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
                values,
                1.0,
                Par::Seq,
            );
        }
    }

    /// The circles at the ends of panels as sources; none on the axis.
    fn collect_rings(&mut self, discretization: &Discretization, sight: &Sight) {
        self.sources.clear();
        let curve = discretization.curve();
        let poles = discretization.panels().topology() == Topology::PoleToPole;
        let last = discretization.panels().len() - 1;
        self.rings.retain(|&(panel, end)| match end {
            End::Start => !(poles && panel == 0),
            End::End => !(poles && panel == last),
        });
        for &(panel, end) in &self.rings {
            let [start, stop] = offsets(discretization, sight, panel);
            let ds = match end {
                End::Start => start,
                End::End => stop,
            };
            let chord = curve.chord(sight.s, ds);
            let separation = [sight.gap.r - chord.r, sight.gap.z - chord.z];
            // The kernels of the boundary terms do not depend on the normal.
            self.sources
                .push(sight.foot.r + chord.r, separation, [0.0; 2]);
        }
    }

    /// The boundary terms on the circles: $y^\theta = \partial_\ell\sigma$ of a density that jumps
    /// to zero there.
    fn interpolate_rings(
        &mut self,
        discretization: &Discretization,
        densities: &Densities,
    ) -> Result<(), QuadratureError> {
        let order = discretization.order();
        let columns = Columns::of(&self.workspace);
        self.densities.resize(densities.rows(), columns);
        self.densities.values.fill(0.0);
        self.gathered.resize(order, 0.0);
        for (place, &source) in self.workspace.order.iter().enumerate() {
            let column = columns.place(place);
            let (panel, end) = self.rings[source];
            let (t, sign) = match end {
                End::Start => (-1.0, 1.0),
                End::End => (1.0, -1.0),
            };
            let weight = sign * self.sources.r[source];
            discretization
                .basis()
                .interpolation_row(t, &mut self.gathered)?;
            for row in (0..densities.rows()).filter(|row| row % DENSITIES < 3) {
                let sigma = &densities.row(row)[panel * order..][..order];
                let at_end: f64 = sigma.iter().zip(&self.gathered).map(|(x, l)| x * l).sum();
                // y^theta comes six rows after sigma.
                self.densities.values[(row + 6) * self.densities.stride + column] = weight * at_end;
            }
        }
        Ok(())
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
        let s = if closed {
            s - (last - first) * ((s - first) / (last - first)).floor()
        } else {
            s
        };
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
    let mut s = start;
    let mut found = seen(s);
    // Gauss and Newton: the error shrinks by the distance over the radius of curvature each time.
    for _ in 0..STEPS {
        let tangent = curve.tangent(found.s);
        let square = tangent.r * tangent.r + tangent.z * tangent.z;
        let step = (found.gap.r * tangent.r + found.gap.z * tangent.z) / square;
        // Across the seam of a closed curve: only what is seen is put back into the period.
        s = (s + step).clamp(start - reach, start + reach);
        if !closed {
            s = s.clamp(first, last);
        }
        found = seen(s);
    }
    found
}

/// Steps towards the nearest curve point.
const STEPS: usize = 12;
