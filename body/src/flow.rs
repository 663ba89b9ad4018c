//! Velocity, pressure, velocity gradient and stress at any point of space.
//!
//! Points are sorted by what each panel needs: far ones are summed directly (`far`), for close ones
//! the panels that the sum does not resolve are done mode by mode (`close`), at a cost that grows
//! with the logarithm of the distance. On the surface the flow is the limit from one side, taken
//! 1e-14 body sizes away, where the flow differs from it by rounding. A point is on the surface if
//! it is nearer than [`ON_SURFACE`].

use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};

use nalgebra::{Matrix3, Point3, Rotation3, Vector3};
use panel_quadrature::QuadratureError;
use rayon::prelude::*;

use super::close::{self, CloseFlow};
use super::densities::Densities;
use super::discretization::{Discretization, Node};
use super::far::{FarFlow, Separation};
use super::layers::Layers;
use super::near::Sight;
use super::surface::SurfaceModes;
use crate::kernel::{
    FlowAt, FlowGradientAt, SurfacePoint, VelocityPressure, VelocityPressureGradient,
};
use bodies_of_revolution::Meridian;
use bodies_of_revolution::curve::ON_SURFACE;

/// The flow of densities on a body, for viscosity 1, in the body's frame.
///
/// What an evaluation needs of the densities is made at the first one and kept: later ones cost the
/// evaluation alone.
#[derive(Debug)]
pub struct Flow {
    discretization: Arc<Discretization>,
    layers: Layers,
    side: Side,
    densities: OnceLock<Densities>,
    far: OnceLock<FarFlow>,
    close: OnceLock<CloseFlow>,
}

/// The stress of a flow on the surface, for viscosity 1.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceStress {
    /// The traction, a force per area.
    pub traction: SurfaceModes,
    /// The vector field $p\, e_z$: its axial component is the pressure, whose modes behave like
    /// those of an axial component.
    pub pressure_along_axis: SurfaceModes,
}

/// The component of a surface field along the axis.
pub const AXIAL: usize = 2;

/// A side of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Outside of the body, where the normal points.
    Exterior,
    /// Inside of the body.
    Interior,
}

/// What goes with the close panels of a target.
#[derive(Clone, Copy, Debug)]
enum Rest {
    /// The other panels are added.
    Panels,
    /// What the panels' points make of them is taken away.
    Points,
}

/// Why a flow cannot be evaluated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FlowError {
    /// A target has a coordinate that is not finite, or overflows when it is turned.
    #[error(
        "target {index} has a coordinate {value:e}: expected a number of at most 1e300 in magnitude"
    )]
    Target {
        /// Its place among the targets.
        index: usize,
        /// The coordinate.
        value: f64,
    },
    /// A quadrature rule is missing.
    #[error(transparent)]
    Quadrature(#[from] QuadratureError),
}

/// The largest coordinate of a target.
const FARTHEST: f64 = 1e300;
/// How near a point is beside another, in widths of the latter's share of the surface: there a
/// gradient's kernel still leaves ten digits.
const BESIDE: f64 = 0.03;
/// Distance from the surface, in body sizes, at which the limits are taken.
const LIMIT: f64 = 1e-14;

impl Flow {
    /// The flow of densities on the nodes of `discretization`; on the surface, the limit from
    /// outside.
    pub fn new(discretization: impl Into<Arc<Discretization>>, layers: Layers) -> Self {
        Self {
            discretization: discretization.into(),
            layers,
            side: Side::Exterior,
            densities: OnceLock::new(),
            far: OnceLock::new(),
            close: OnceLock::new(),
        }
    }

    /// The same flow, with the limit from another side on the surface.
    pub fn limit_from(self, side: Side) -> Self {
        Self { side, ..self }
    }

    /// Velocity and pressure at every target, inside, outside or on the surface, with an error of
    /// the quadrature below `tolerance` relative to the densities.
    ///
    /// # Errors
    /// [`FlowError::Target`] for a target that is not a point.
    pub fn at(&self, targets: &[Point3<f64>], tolerance: f64) -> Result<Vec<FlowAt>, FlowError> {
        let found = self.evaluate::<false>(targets, tolerance)?;
        Ok(found.into_iter().map(FlowAt::from).collect())
    }

    /// The same with the velocity gradient, and so the stress.
    ///
    /// # Errors
    /// [`FlowError::Target`] for a target that is not a point.
    pub fn gradient_at(
        &self,
        targets: &[Point3<f64>],
        tolerance: f64,
    ) -> Result<Vec<FlowGradientAt>, FlowError> {
        self.evaluate::<true>(targets, tolerance)
    }

    /// Panels and nodes.
    pub fn discretization(&self) -> &Arc<Discretization> {
        &self.discretization
    }

    /// The densities.
    pub fn layers(&self) -> &Layers {
        &self.layers
    }

    /// The modes of the traction $(-p I + \nabla u + (\nabla u)^\mathsf{T}) \nu$ on one side of the
    /// surface, with the normal $\nu$ out of the body.
    ///
    /// The traction of a double layer is hypersingular: its finite part is the limit of what
    /// integration by parts leaves of it off the surface, where only integrable kernels of the
    /// density's tangential derivatives stand (`kernel::close`).
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn traction(&self, side: Side) -> Result<SurfaceModes, QuadratureError> {
        Ok(self.surface_stress(side)?.traction)
    }

    /// Traction and pressure on one side of the surface.
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn surface_stress(&self, side: Side) -> Result<SurfaceStress, QuadratureError> {
        let discretization = &*self.discretization;
        let (close, densities) = (self.close()?, self.densities());
        let nodes = discretization.nodes();
        let panels: Vec<usize> = (0..discretization.panels().len()).collect();
        let rings: Vec<Vec<f64>> = nodes
            .par_iter()
            .map_init(close::Buffers::default, |buffers, node| {
                let sight = limit(discretization, Sight::on(node), node.normal, side);
                close.fields(
                    discretization,
                    densities,
                    &VelocityPressureGradient,
                    &sight,
                    &panels,
                    buffers,
                )
            })
            .collect::<Result<_, QuadratureError>>()?;
        let zero = || SurfaceModes::zero(densities.modes() - 1, nodes.len());
        let (mut traction, mut pressures) = (zero(), zero());
        for (k, (node, fields)) in nodes.iter().zip(&rings).enumerate() {
            for (place, fields) in fields.chunks(FIELDS).enumerate() {
                let (pressure, gradient) = (fields[3], Matrix3::from_row_slice(&fields[4..]));
                let normal = Vector3::new(node.normal[0], 0.0, node.normal[1]);
                let of_mode = (gradient + gradient.transpose()) * normal - pressure * normal;
                for j in 0..3 {
                    traction.component_mut(place / 2, place % 2, j)[k] = of_mode[j];
                }
                pressures.component_mut(place / 2, place % 2, AXIAL)[k] = pressure;
            }
        }
        Ok(SurfaceStress {
            traction,
            pressure_along_axis: pressures,
        })
    }

    /// What the points of [`for_each_point`](Self::for_each_point) get wrong near the surface: for
    /// every target for which that is more than `tolerance` relative to the densities, its place
    /// and what is to be added.
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn corrections<const GRADIENT: bool>(
        &self,
        targets: &[Point3<f64>],
        tolerance: f64,
    ) -> Result<Vec<(usize, FlowGradientAt)>, FlowError> {
        let far = self.far()?;
        let separation = far.separation(&self.discretization, tolerance);
        let is_far = self.are_far(targets, &separation);
        self.evaluate_close::<GRADIENT>(targets, &is_far, far, &separation, Rest::Points)
    }

    /// Whether a point is so near one of the points that both the sum and what
    /// [`corrections`](Self::corrections) takes away of it are too large for their difference.
    pub fn is_beside_a_point(&self, at: Point3<f64>) -> Result<bool, FlowError> {
        let seen = Meridian::of(&at);
        let spacing = 2.0 * PI / self.azimuths()? as f64;
        let turns = at.y.atan2(at.x) / spacing;
        let aside = seen.r * spacing * (turns - turns.round());
        let nodes = self.discretization.nodes().iter();
        Ok(nodes.into_iter().any(|node| {
            let away = (node.r - seen.r).hypot(node.z - seen.z).hypot(aside);
            away * away < BESIDE * BESIDE * node.weight * spacing
        }))
    }

    /// The largest distance from the origin at which [`corrections`](Self::corrections) may find
    /// anything.
    pub fn correction_reach(&self, tolerance: f64) -> Result<f64, FlowError> {
        let size = self.discretization.size();
        let separation = self.far()?.separation(&self.discretization, tolerance);
        Ok(size + separation.reach(size))
    }

    /// The densities as points, times their shares of the surface.
    pub fn for_each_point(&self, each: impl FnMut(SurfacePoint)) -> Result<(), FlowError> {
        self.far()?.points.for_each(each);
        Ok(())
    }

    /// Modes of the densities.
    pub fn modes(&self) -> usize {
        self.layers.modes()
    }

    /// Those points on the ring of a node.
    pub fn azimuths(&self) -> Result<usize, FlowError> {
        Ok(self.far()?.azimuths)
    }

    /// The flow of those points alone.
    pub fn of_points(&self, targets: &[Point3<f64>]) -> Result<Vec<FlowGradientAt>, FlowError> {
        let points = &self.far()?.points;
        let at = |&target: &Point3<f64>| points.sum::<true>(0..points.len(), target);
        Ok(targets.par_iter().map(at).collect())
    }

    fn densities(&self) -> &Densities {
        self.densities
            .get_or_init(|| Densities::new(&self.discretization, &self.layers))
    }

    fn close(&self) -> Result<&CloseFlow, QuadratureError> {
        if let Some(close) = self.close.get() {
            return Ok(close);
        }
        let close = CloseFlow::new(self.discretization.order(), self.layers.modes())?;
        Ok(self.close.get_or_init(|| close))
    }

    fn far(&self) -> Result<&FarFlow, QuadratureError> {
        if let Some(far) = self.far.get() {
            return Ok(far);
        }
        let far = FarFlow::new(&self.discretization, self.densities())?;
        Ok(self.far.get_or_init(|| far))
    }

    /// Velocity, pressure and, if asked for, velocity gradient at every target.
    pub fn evaluate<const GRADIENT: bool>(
        &self,
        targets: &[Point3<f64>],
        tolerance: f64,
    ) -> Result<Vec<FlowGradientAt>, FlowError> {
        check_targets(targets)?;
        let far = self.far()?;
        let separation = far.separation(&self.discretization, tolerance);
        let is_far = self.are_far(targets, &separation);
        let mut found: Vec<FlowGradientAt> = (targets.par_iter().zip(&is_far))
            .map(|(target, &is_far)| {
                if is_far {
                    far.points.sum::<GRADIENT>(0..far.points.len(), *target)
                } else {
                    FlowGradientAt::default()
                }
            })
            .collect();
        let close =
            self.evaluate_close::<GRADIENT>(targets, &is_far, far, &separation, Rest::Panels)?;
        for (index, at) in close {
            found[index] = at;
        }
        Ok(found)
    }

    /// Which targets the points of every panel do for.
    fn are_far(&self, targets: &[Point3<f64>], separation: &Separation) -> Vec<bool> {
        let panels = 0..self.discretization.panels().len();
        let is_far = |target: &Point3<f64>| {
            let target = Meridian::of(target);
            (panels.clone()).all(|panel| separation.is_kept(&self.discretization, target, panel))
        };
        targets.par_iter().map(is_far).collect()
    }

    /// The targets that are not far, each with its place.
    fn evaluate_close<const GRADIENT: bool>(
        &self,
        targets: &[Point3<f64>],
        is_far: &[bool],
        far: &FarFlow,
        separation: &Separation,
        rest: Rest,
    ) -> Result<Vec<(usize, FlowGradientAt)>, FlowError> {
        let mut indices: Vec<usize> = (0..targets.len()).filter(|&i| !is_far[i]).collect();
        if indices.is_empty() {
            return Ok(Vec::new());
        }
        let close = self.close()?;
        // Targets on one ring, up to rounding, share all of the work but the last sum over the
        // modes.
        let grain = LIMIT * self.discretization.size();
        let ring = |index: usize| {
            let Meridian { r, z } = Meridian::of(&targets[index]);
            ((r / grain).round(), (z / grain).round())
        };
        let order = |i: usize, j: usize| {
            let ((r, z), (s, y)) = (ring(i), ring(j));
            r.total_cmp(&s).then(z.total_cmp(&y)).then(i.cmp(&j))
        };
        indices.sort_unstable_by(|&i, &j| order(i, j));
        let rings: Vec<&[usize]> = indices.chunk_by(|&i, &j| ring(i) == ring(j)).collect();
        let found = rings
            .into_par_iter()
            .map_init(close::Buffers::default, |buffers, ring| {
                self.ring::<GRADIENT>(targets, ring, far, close, separation, rest, buffers)
            })
            .collect::<Result<Vec<_>, FlowError>>()?;
        Ok(found.into_iter().flatten().collect())
    }

    /// The targets of one ring.
    #[expect(clippy::too_many_arguments, reason = "one step of `evaluate_close`")]
    fn ring<const GRADIENT: bool>(
        &self,
        targets: &[Point3<f64>],
        ring: &[usize],
        far: &FarFlow,
        close: &CloseFlow,
        separation: &Separation,
        rest: Rest,
        buffers: &mut close::Buffers,
    ) -> Result<Vec<(usize, FlowGradientAt)>, FlowError> {
        let (discretization, densities) = (&*self.discretization, self.densities());
        let point = Meridian::of(&targets[ring[0]]);
        let sight = self.sight(point);
        let count = discretization.panels().len();
        let is_kept = |&panel: &usize| separation.is_kept(discretization, point, panel);
        let near: Vec<usize> = (0..count).filter(|panel| !is_kept(panel)).collect();
        let fields = if GRADIENT {
            let potential = VelocityPressureGradient;
            close.fields(
                discretization,
                densities,
                &potential,
                &sight,
                &near,
                buffers,
            )?
        } else {
            let potential = VelocityPressure;
            close.fields(
                discretization,
                densities,
                &potential,
                &sight,
                &near,
                buffers,
            )?
        };
        let mut found = Vec::with_capacity(ring.len());
        for &index in ring {
            let mut at = at_azimuth::<GRADIENT>(&fields, &targets[index]);
            let points =
                |panel: usize| far.points.sum::<GRADIENT>(far.panel(panel), targets[index]);
            match rest {
                Rest::Panels => (0..count)
                    .filter(is_kept)
                    .for_each(|panel| at += points(panel)),
                Rest::Points => near.iter().for_each(|&panel| at -= points(panel)),
            }
            found.push((index, at));
        }
        Ok(found)
    }

    /// The point seen from the curve; if it is on the surface, a point on the side of the limit
    /// instead.
    fn sight(&self, point: Meridian) -> Sight {
        let sight = close::sight(&self.discretization, point);
        let distance = sight.gap.r.hypot(sight.gap.z);
        if distance > ON_SURFACE * self.discretization.size() {
            return sight;
        }
        let foot = Node::new(&**self.discretization.curve(), sight.s, 0.0);
        limit(&self.discretization, sight, foot.normal, self.side)
    }
}

/// A point of the surface moved off it, to one side.
fn limit(discretization: &Discretization, sight: Sight, normal: [f64; 2], side: Side) -> Sight {
    let distance = LIMIT * discretization.size();
    let signed = match side {
        Side::Exterior => distance,
        Side::Interior => -distance,
    };
    let gap = Meridian {
        // At a pole the normal is along the axis up to rounding: not across it.
        r: (signed * normal[0]).max(-sight.foot.r),
        z: signed * normal[1],
    };
    Sight { gap, ..sight }
}

/// Refuses targets that are not points, or too far away.
///
/// # Errors
/// [`FlowError::Target`] for the first of them.
pub fn check_targets(targets: &[Point3<f64>]) -> Result<(), FlowError> {
    for (index, target) in targets.iter().enumerate() {
        let bad = |x: &&f64| x.is_nan() || x.abs() > FARTHEST;
        if let Some(&value) = target.iter().find(bad) {
            return Err(FlowError::Target { index, value });
        }
    }
    Ok(())
}

/// Fields of [`VelocityPressure`] and of [`VelocityPressureGradient`].
const FLOW_FIELDS: usize = 4;
const FIELDS: usize = 13;

/// The sum over the modes at the azimuth of a point, in Cartesian components.
fn at_azimuth<const GRADIENT: bool>(fields: &[f64], point: &Point3<f64>) -> FlowGradientAt {
    // Components with an odd number of azimuthal indices go with sin in the first family.
    const IS_SIN: [bool; FIELDS] = {
        let mut is_sin = [false; FIELDS];
        is_sin[1] = true;
        is_sin[5] = true;
        is_sin[7] = true;
        is_sin[9] = true;
        is_sin[11] = true;
        is_sin
    };
    let azimuth = point.y.atan2(point.x);
    let width = if GRADIENT { FIELDS } else { FLOW_FIELDS };
    let mut sum = [0.0; FIELDS];
    for (n, families) in fields.chunks_exact(2 * width).enumerate() {
        let (sin, cos) = (n as f64 * azimuth).sin_cos();
        let (first, second) = families.split_at(width);
        for (i, (first, second)) in first.iter().zip(second).enumerate() {
            sum[i] += if IS_SIN[i] {
                first * sin - second * cos
            } else {
                first * cos + second * sin
            };
        }
    }
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), azimuth);
    let gradient = Matrix3::from_row_slice(&sum[4..]);
    FlowGradientAt {
        velocity: turn * Vector3::new(sum[0], sum[1], sum[2]),
        pressure: sum[3],
        gradient: turn * gradient * turn.inverse(),
    }
}
