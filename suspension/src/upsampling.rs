//! A surface with more points, for targets that are near but not close: there a sum over a few
//! thousand points costs less than exact integrals, and less than to read numbers that were kept.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, MatRef, Par};
use panel_quadrature::QuadratureError;

use stokes_body::discretization::Discretization;
use stokes_body::far::Separation;
use stokes_body::surface_grid::{PointVectors, SurfaceGrid, azimuths};

/// How many surfaces with more points there are.
pub(crate) const LEVELS: usize = 2;

/// By how much nodes of a panel and azimuths are multiplied on each level.
const FACTORS: [usize; LEVELS] = [2, 4];

/// From where on the points of a level resolve what the panels do to `tolerance`, for densities
/// that the surface's own nodes and modes resolve.
pub(crate) fn separation(
    discretization: &Discretization,
    n_max: usize,
    level: usize,
    tolerance: f64,
) -> Separation {
    let factor = FACTORS[level];
    let points = [factor * discretization.order(), azimuths(factor * n_max)];
    Separation::of_resolved(discretization, n_max, points, tolerance)
}

/// The same panels with more nodes, each on more azimuths.
#[derive(Debug)]
pub(crate) struct Upsampling {
    pub grid: SurfaceGrid,
    /// From a panel's nodes to its many.
    interpolation: Mat<f64>,
    /// Square roots of the weights of nodes, and of the many nodes.
    roots: Vec<f64>,
    many_roots: Vec<f64>,
}

impl Upsampling {
    /// The surface of a level.
    pub fn new(
        discretization: &Discretization,
        n_max: usize,
        level: usize,
    ) -> Result<Self, QuadratureError> {
        let (factor, order) = (FACTORS[level], discretization.order());
        let many = discretization.with_order(factor * order)?;
        let roots = |of: &Discretization| -> Vec<f64> {
            of.nodes().iter().map(|node| node.weight.sqrt()).collect()
        };
        Ok(Self {
            grid: SurfaceGrid::with_azimuths(&many, n_max, azimuths(factor * n_max)),
            interpolation: discretization
                .basis()
                .interpolation_matrix(many.basis().nodes())?,
            roots: roots(discretization),
            many_roots: roots(&many),
        })
    }

    /// A scaled field on the surface's own nodes at the many points, times their shares of the
    /// surface.
    pub fn to_points(
        &self,
        field: &[f64],
        room: &mut (Vec<f64>, Vec<f64>, Vec<f64>),
        out: &mut PointVectors,
    ) {
        let (unscaled, many, scratch) = room;
        let (few, nodes) = (self.roots.len(), self.many_roots.len());
        let (p, q) = (self.interpolation.ncols(), self.interpolation.nrows());
        let columns = field.len() / few;
        unscaled.clear();
        for column in field.chunks(few) {
            unscaled.extend(column.iter().zip(&self.roots).map(|(x, root)| x / root));
        }
        many.resize(columns * nodes, 0.0);
        for panel in 0..few / p {
            matmul(
                MatMut::from_column_major_slice_with_stride_mut(
                    &mut many[panel * q..],
                    q,
                    columns,
                    nodes,
                ),
                Accum::Replace,
                self.interpolation.as_ref(),
                MatRef::from_column_major_slice_with_stride(
                    &unscaled[panel * p..],
                    p,
                    columns,
                    few,
                ),
                1.0,
                Par::Seq,
            );
        }
        for column in many.chunks_mut(nodes) {
            for (x, root) in column.iter_mut().zip(&self.many_roots) {
                *x *= root;
            }
        }
        self.grid.to_points(many, scratch, out);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use nalgebra::{Point3, Vector3};

    use super::*;
    use bodies_of_revolution::{Panels, Spheroid};
    use stokes_body::flow::Flow;
    use stokes_body::layers::{LayerWeights, Layers};
    use stokes_body::surface::SurfaceModes;

    #[test]
    fn more_points_do_for_nearer_targets() {
        let curve = Arc::new(Spheroid::new(1.0, 0.6).unwrap());
        let panels = Panels::equal_arcs(&*curve, 4).unwrap();
        let discretization = Discretization::new(curve, panels, 16).unwrap();
        let n_max = 20;
        let density = SurfaceModes::sample(&discretization, n_max, |x| {
            Vector3::new(x.y * x.z, (1.0 + x.x).exp(), x.x * x.y * x.z - 0.3)
        })
        .modes;
        let weights = LayerWeights {
            double: 1.0,
            single: 0.7,
        };
        let flow = Flow::new(&discretization, Layers::weighted(&density, weights));
        let field = density.scaled_by_roots(&discretization);
        for (level, distance) in [0.35, 0.2].into_iter().enumerate() {
            let upsampling = Upsampling::new(&discretization, n_max, level).unwrap();
            let separation = separation(&discretization, n_max, level, 1e-9);
            let mut strengths = upsampling.grid.vectors();
            let mut room = Default::default();
            upsampling.to_points(&field, &mut room, &mut strengths);
            for point in [
                Point3::new(0.0, 0.0, 1.0 + distance),
                Point3::new(0.0, 0.6 + distance, 0.1),
            ] {
                let seen = bodies_of_revolution::Meridian::of(&point);
                let mut sum = Vector3::zeros();
                for panel in 0..4 {
                    assert!(separation.is_kept(&discretization, seen, panel));
                    sum += upsampling
                        .grid
                        .panel_velocity(panel, weights, &strengths, point);
                }
                let exact = flow.at(&[point], 1e-15).unwrap()[0].velocity;
                assert!((sum - exact).norm() < 1e-9, "{:e}", (sum - exact).norm());
            }
        }
    }
}
