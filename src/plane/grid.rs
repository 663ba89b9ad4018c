//! A plane with a grid of points, and the flow there.

use nalgebra::{Point3, Unit, Vector3};

use stokes_body::kernel::FlowAt;
use stokes_body::linear_flow::LinearFlow;
use stokes_body::progress::Progress;
use stokes_suspension::{Flow, SuspensionError};

/// Relative accuracy of what is drawn.
const TOLERANCE: f64 = 1e-5;

/// A rectangle in space with a grid of points on it, corners included; lengths in the units of the
/// case.
///
/// Coordinates in the plane are `[across, up]`, counted from its middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// The middle.
    pub center: Point3<f64>,
    /// To the right.
    pub across: Unit<Vector3<f64>>,
    /// Upwards; orthogonal to `across`.
    pub up: Unit<Vector3<f64>>,
    /// Width and height.
    pub size: [f64; 2],
    /// Grid points across and up, at least two each.
    pub points: [usize; 2],
}

impl Plane {
    /// Towards the viewer: across x up.
    pub fn normal(&self) -> Vector3<f64> {
        self.across.cross(&self.up)
    }

    /// The point of space with coordinates `[x, y]` in the plane.
    pub fn point(&self, [x, y]: [f64; 2]) -> Point3<f64> {
        self.center + x * *self.across + y * *self.up
    }

    /// The coordinates of a point's projection.
    pub fn coordinates(&self, point: Point3<f64>) -> [f64; 2] {
        self.components(point - self.center)
    }

    /// The components of a vector in the plane.
    pub fn components(&self, vector: Vector3<f64>) -> [f64; 2] {
        [vector.dot(&self.across), vector.dot(&self.up)]
    }

    /// Distance of neighbouring grid points, across and up.
    pub fn spacing(&self) -> [f64; 2] {
        [0, 1].map(|j| self.size[j] / (self.points[j] - 1) as f64)
    }

    /// The grid points, row after row from below, each from left to right.
    pub fn grid(&self) -> Vec<Point3<f64>> {
        let at = |j: usize, i: usize| self.size[j] * (i as f64 / (self.points[j] - 1) as f64 - 0.5);
        let row = |k: usize| (0..self.points[0]).map(move |i| self.point([at(0, i), at(1, k)]));
        (0..self.points[1]).flat_map(row).collect()
    }
}

/// Velocity and pressure at the grid points of a plane.
#[derive(Clone, Debug)]
pub struct PlaneFlow {
    /// The plane.
    pub plane: Plane,
    /// In the order of [`Plane::grid`]; `None` inside a body.
    pub values: Vec<Option<FlowAt>>,
}

impl PlaneFlow {
    /// The flow at the grid points of a plane, relative to the laboratory, to about six digits.
    ///
    /// # Errors
    /// If the flow cannot be evaluated, or the caller cancels.
    pub fn sample(
        flow: &Flow,
        plane: Plane,
        progress: &dyn Progress,
    ) -> Result<Self, SuspensionError> {
        let values = flow.at_with(&plane.grid(), TOLERANCE, progress)?;
        Ok(Self { plane, values })
    }

    /// The same seen by an observer who moves with this velocity.
    pub fn relative_to(mut self, velocity: Vector3<f64>) -> Self {
        for value in self.values.iter_mut().flatten() {
            value.velocity -= velocity;
        }
        self
    }

    /// What is left of the flow without another one.
    #[must_use]
    pub fn without(mut self, background: &LinearFlow) -> Self {
        for (value, point) in self.values.iter_mut().zip(self.plane.grid()) {
            if let Some(at) = value {
                at.velocity -= background.at(point.coords);
            }
        }
        self
    }

    /// A quantity at every grid point, continued into the bodies: each point there gets the mean of
    /// those of its neighbours that have a value, layer by layer from outside. What is drawn is cut
    /// off at the surface; this is for interpolation beside it.
    ///
    /// None if no point has a value.
    pub fn continued<const N: usize>(
        &self,
        quantity: impl Fn(&FlowAt) -> [f64; N],
    ) -> Option<Continued<N>> {
        let [columns, rows] = self.plane.points;
        let mut values: Vec<Option<[f64; N]>> = self
            .values
            .iter()
            .map(|value| value.as_ref().map(&quantity))
            .collect();
        if values.iter().all(Option::is_none) {
            return None;
        }
        let neighbours = |index: usize| {
            let (i, k) = (index % columns, index / columns);
            let across = i.saturating_sub(1)..=(i + 1).min(columns - 1);
            let up = k.saturating_sub(1)..=(k + 1).min(rows - 1);
            up.flat_map(move |k| across.clone().map(move |i| k * columns + i))
        };
        let mut missing: Vec<usize> = (0..values.len()).filter(|&i| values[i].is_none()).collect();
        while !missing.is_empty() {
            let layer: Vec<(usize, [f64; N])> = missing
                .iter()
                .filter_map(|&index| {
                    let known: Vec<[f64; N]> =
                        neighbours(index).filter_map(|near| values[near]).collect();
                    let mean =
                        |c: usize| known.iter().map(|v| v[c]).sum::<f64>() / known.len() as f64;
                    (!known.is_empty()).then(|| (index, std::array::from_fn(mean)))
                })
                .collect();
            for (index, value) in layer {
                values[index] = Some(value);
            }
            missing.retain(|&index| values[index].is_none());
        }
        Some(Continued {
            plane: self.plane,
            values: values.into_iter().flatten().collect(),
        })
    }
}

/// A quantity of `N` components that is known at every grid point of a plane.
#[derive(Clone, Debug)]
pub struct Continued<const N: usize> {
    plane: Plane,
    values: Vec<[f64; N]>,
}

impl<const N: usize> Continued<N> {
    /// The values in the order of [`Plane::grid`].
    pub fn values(&self) -> &[[f64; N]] {
        &self.values
    }

    /// The value at coordinates in the plane, by bilinear interpolation; outside of the plane that
    /// of its nearest cell, continued.
    pub fn at(&self, point: [f64; 2]) -> [f64; N] {
        let plane = &self.plane;
        let spacing = plane.spacing();
        let place = [0, 1].map(|j| (point[j] + 0.5 * plane.size[j]) / spacing[j]);
        let corner = [0, 1].map(|j| place[j].floor().clamp(0.0, (plane.points[j] - 2) as f64));
        let [a, b] = [0, 1].map(|j| place[j] - corner[j]);
        let first = corner[0] as usize + plane.points[0] * corner[1] as usize;
        let above = first + plane.points[0];
        std::array::from_fn(|c| {
            let value = |index: usize| self.values[index][c];
            (1.0 - b) * ((1.0 - a) * value(first) + a * value(first + 1))
                + b * ((1.0 - a) * value(above) + a * value(above + 1))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane() -> Plane {
        Plane {
            center: Point3::new(1.0, 2.0, 3.0),
            across: Vector3::x_axis(),
            up: Vector3::z_axis(),
            size: [4.0, 2.0],
            points: [9, 5],
        }
    }

    #[test]
    fn the_grid_has_the_corners() {
        let grid = plane().grid();
        assert_eq!(grid.len(), 45);
        assert_eq!(grid[0], Point3::new(-1.0, 2.0, 2.0));
        assert_eq!(grid[8], Point3::new(3.0, 2.0, 2.0));
        assert_eq!(grid[44], Point3::new(3.0, 2.0, 4.0));
        assert_eq!(plane().coordinates(grid[44]), [2.0, 1.0]);
        assert_eq!(plane().normal(), -Vector3::y());
    }

    #[test]
    fn continued_from_outside_and_exact_for_linear_fields() {
        let plane = plane();
        let value = |x: Point3<f64>| FlowAt {
            velocity: Vector3::new(1.0 + 2.0 * x.x - x.z, 0.0, 3.0),
            pressure: x.x + x.z,
        };
        let mut values: Vec<_> = plane.grid().into_iter().map(|x| Some(value(x))).collect();
        let whole = PlaneFlow {
            plane,
            values: values.clone(),
        };
        let field = whole.continued(|at| [at.velocity.x, at.pressure]).unwrap();
        for point in [[0.3, 0.7], [-1.9, -0.95], [2.0, 1.0]] {
            let exact = value(plane.point(point));
            let [u, p] = field.at(point);
            assert!((u - exact.velocity.x).abs() < 1e-14 && (p - exact.pressure).abs() < 1e-14);
        }
        values[22] = None;
        let holed = PlaneFlow { plane, values };
        let field = holed.continued(|at| [at.pressure]).unwrap();
        let [p] = field.at([0.0, 0.0]);
        assert!(
            (p - 4.0).abs() < 1e-14,
            "the mean of a linear field's neighbours"
        );
        let nothing = PlaneFlow {
            plane,
            values: vec![None; 45],
        };
        assert!(nothing.continued(|at| [at.pressure]).is_none());
    }
}
