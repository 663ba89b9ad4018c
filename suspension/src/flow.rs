//! The flow that was solved for, at any points, and its stress on the surfaces.
//!
//! The layers of all bodies are laid on points and summed, and what the points get wrong near a
//! body is put right. For few points, and for a body alone, every body's flow is evaluated by
//! itself instead: that loses no digits.

use std::ops::Range;
use std::sync::{Arc, OnceLock};

use bodies_of_revolution::{Ball, Frame, Insides, Neighbours, RigidMotion, Shape, Wrench};
use nalgebra::{Matrix3, Point3, Vector3};
use rayon::prelude::*;
use stokes_body::discretization::Discretization;
use stokes_body::flow::{Flow as FlowOfBody, FlowError, SurfaceStress, check_targets};
use stokes_body::kernel::{FlowAt, FlowGradientAt};
use stokes_body::linear_flow::LinearFlow;
use stokes_body::progress::{Progress, Silent};
use stokes_body::surface::SurfaceModes;
use stokes_fmm::{Output, Points, Singularities};

use super::error::SuspensionError;
use super::points::{LayerPoints, factors_of_layers};
use super::sums::{Operators, Sums, are_few};

/// One body's part in a flow.
#[derive(Debug)]
pub struct BodyFlow {
    /// Where the body is. The axis of a sphere without slip may be another one than was given.
    pub frame: Frame,
    /// What the body adds to the undisturbed flow, in its frame and for viscosity 1.
    pub disturbance: FlowOfBody,
    /// Its rigid motion, in its frame.
    pub motion: RigidMotion,
    /// Its slip at the nodes, in its frame, if it has one.
    pub slip: Option<SurfaceModes>,
    /// Force and torque on the fluid, in its frame and for viscosity 1.
    pub wrench: Wrench,
}

impl BodyFlow {
    /// Panels and nodes.
    pub(crate) fn on(&self) -> &Discretization {
        self.disturbance.discretization()
    }

    /// The velocity of the surface: rigid motion and slip; in the body's frame.
    pub fn surface_velocity(&self) -> SurfaceModes {
        let motion = SurfaceModes::of_motion(self.on(), &self.motion);
        match &self.slip {
            Some(slip) => motion.plus(1.0, slip),
            None => motion,
        }
    }

    /// Half the body's largest extent, in the laboratory.
    pub fn size(&self) -> f64 {
        self.frame.scale() * self.on().size()
    }

    /// The body's shape.
    pub fn shape(&self) -> &Shape {
        self.on().curve()
    }
}

/// Velocity, pressure, velocity gradient and stress at a point, in the laboratory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StressAt {
    /// Velocity.
    pub velocity: Vector3<f64>,
    /// Pressure, vanishing at infinity.
    pub pressure: f64,
    /// Velocity gradient, $\partial u_i / \partial x_j$ in row $i$, column $j$.
    pub gradient: Matrix3<f64>,
    /// Stress $-p I + \mu (\nabla u + (\nabla u)^\mathsf{T})$.
    pub stress: Matrix3<f64>,
}

/// The whole flow in the laboratory: the undisturbed flow, and what the layers of all bodies add to
/// it.
///
/// A clone shares everything with its original, also what was made at an earlier evaluation.
#[derive(Clone, Debug)]
pub struct Flow(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    bodies: Vec<BodyFlow>,
    background: LinearFlow,
    viscosity: f64,
    largest_speed: f64,
    tolerance: f64,
    operators: Operators,
    insides: OnceLock<Insides>,
    points: OnceLock<LayerPoints>,
    density: OnceLock<f64>,
    stresses: Vec<OnceLock<SurfaceStress>>,
}

/// What a fast sum is asked for beyond the tolerance of the flow: its own is relative to the whole,
/// and terms may cancel.
const MARGIN: f64 = 1e-2;
/// The tolerance of tractions over that of velocities at points: densities are not known so well
/// that more would show.
const STRESSES: f64 = 30.0;
/// The best tolerance of a fast sum.
const FINEST_SUM: f64 = 1e-12;
/// The best tolerance of a flow.
const FINEST: f64 = 1e-15;
/// Targets that are evaluated between two reports of progress.
const CHUNK: usize = 1 << 16;

/// What a flow is made of.
pub(crate) struct Parts {
    pub bodies: Vec<BodyFlow>,
    pub background: LinearFlow,
    pub viscosity: f64,
    /// The largest speed on the surfaces.
    pub largest_speed: f64,
    /// Tolerance where none is given, relative to that.
    pub tolerance: f64,
    pub operators: Operators,
}

impl Flow {
    pub(crate) fn new(parts: Parts) -> Self {
        Self(Arc::new(Inner {
            stresses: parts.bodies.iter().map(|_| OnceLock::new()).collect(),
            bodies: parts.bodies,
            background: parts.background,
            viscosity: parts.viscosity,
            largest_speed: parts.largest_speed,
            tolerance: parts.tolerance,
            operators: parts.operators,
            insides: OnceLock::new(),
            points: OnceLock::new(),
            density: OnceLock::new(),
        }))
    }

    /// Every body's part.
    pub fn bodies(&self) -> &[BodyFlow] {
        &self.0.bodies
    }

    /// The undisturbed flow.
    pub fn background(&self) -> &LinearFlow {
        &self.0.background
    }

    /// The viscosity.
    pub fn viscosity(&self) -> f64 {
        self.0.viscosity
    }

    /// The largest speed on the surfaces, of what is imposed and of motions that were found.
    pub fn largest_speed(&self) -> f64 {
        self.0.largest_speed
    }

    /// Velocity and pressure at any points, `None` inside a body; on a surface, the limits from
    /// outside. As well as the tolerance of the answer makes sense.
    ///
    /// # Errors
    /// If a point is not finite.
    pub fn at(&self, points: &[Point3<f64>]) -> Result<Vec<Option<FlowAt>>, SuspensionError> {
        self.at_with(points, self.0.tolerance, &Silent)
    }

    /// The same to a tolerance for the velocity, relative to the [largest
    /// speed](Self::largest_speed); tells `progress` where it is.
    ///
    /// # Errors
    /// If a point is not finite, the tolerance is not between 0 and 1, or the caller cancels.
    pub fn at_with(
        &self,
        points: &[Point3<f64>],
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Vec<Option<FlowAt>>, SuspensionError> {
        let viscosity = self.0.viscosity;
        let at = |at: FlowGradientAt| FlowAt {
            velocity: at.velocity,
            pressure: viscosity * at.pressure,
        };
        self.outside::<false, FlowAt>(points, tolerance, progress, at)
    }

    /// Velocity, pressure, velocity gradient and stress at any points, `None` inside a body.
    ///
    /// # Errors
    /// If a point is not finite.
    pub fn stress_at(
        &self,
        points: &[Point3<f64>],
    ) -> Result<Vec<Option<StressAt>>, SuspensionError> {
        self.stress_at_with(points, self.0.tolerance, &Silent)
    }

    /// The same to a tolerance, as [`at_with`](Self::at_with).
    ///
    /// # Errors
    /// If a point is not finite, the tolerance is not between 0 and 1, or the caller cancels.
    pub fn stress_at_with(
        &self,
        points: &[Point3<f64>],
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Vec<Option<StressAt>>, SuspensionError> {
        let viscosity = self.0.viscosity;
        let at = |at: FlowGradientAt| StressAt {
            velocity: at.velocity,
            pressure: viscosity * at.pressure,
            gradient: at.gradient,
            stress: viscosity * at.stress(),
        };
        self.outside::<true, StressAt>(points, tolerance, progress, at)
    }

    fn outside<const GRADIENT: bool, T: Clone>(
        &self,
        points: &[Point3<f64>],
        tolerance: f64,
        progress: &dyn Progress,
        convert: impl Fn(FlowGradientAt) -> T,
    ) -> Result<Vec<Option<T>>, SuspensionError> {
        check_targets(points)?;
        if !(tolerance > 0.0 && tolerance < 1.0) {
            return Err(SuspensionError::FlowTolerance(tolerance));
        }
        let insides = self.insides()?;
        let is_outside = |&place: &usize| insides.body_at(points[place]).is_none();
        let places: Vec<usize> = (0..points.len())
            .into_par_iter()
            .filter(is_outside)
            .collect();
        let targets: Vec<Point3<f64>> = places.iter().map(|&place| points[place]).collect();
        let found = self.evaluate::<GRADIENT>(&targets, tolerance, progress)?;
        let mut flow = vec![None; points.len()];
        for (place, at) in places.into_iter().zip(found) {
            flow[place] = Some(convert(at));
        }
        Ok(flow)
    }

    /// Which body a point is in, for many points.
    ///
    /// # Errors
    /// If a curve has no outline.
    pub fn insides(&self) -> Result<&Insides, SuspensionError> {
        let inner = &*self.0;
        if let Some(insides) = inner.insides.get() {
            return Ok(insides);
        }
        let bodies = inner.bodies.iter();
        let placed = bodies.map(|body| (body.on().curve(), body.frame));
        let insides =
            Insides::new(placed).map_err(|(body, error)| SuspensionError::Curve { body, error })?;
        Ok(inner.insides.get_or_init(|| insides))
    }

    /// Velocity, pressure and, if asked for, gradient at points that are all in the fluid; for
    /// viscosity 1.
    pub(crate) fn evaluate<const GRADIENT: bool>(
        &self,
        targets: &[Point3<f64>],
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Vec<FlowGradientAt>, SuspensionError> {
        check_targets(targets)?;
        progress.begin("evaluating", targets.len());
        let tolerance = self.of_densities(tolerance);
        let mut evaluated = Vec::with_capacity(targets.len());
        let mut fast = self.fast_sum::<GRADIENT>(targets.len(), tolerance)?;
        for some in targets.chunks(CHUNK) {
            if progress.is_cancelled() {
                return Err(SuspensionError::Interrupted);
            }
            let mut found = match &mut fast {
                Some(fast) => self.by_sum::<GRADIENT>(fast, some, tolerance)?,
                None => self.one_by_one::<GRADIENT>(some, tolerance)?,
            };
            for (at, target) in found.iter_mut().zip(some) {
                at.velocity += self.0.background.at(target.coords);
                at.gradient += self.0.background.gradient;
            }
            evaluated.extend(found);
            progress.advance(some.len());
        }
        Ok(evaluated)
    }

    /// A tolerance relative to the densities from one that is relative to the largest speed.
    fn of_densities(&self, tolerance: f64) -> f64 {
        let inner = &*self.0;
        let density = *inner.density.get_or_init(|| {
            let of_body = |body: &BodyFlow| {
                let layers = body.disturbance.layers();
                let most = |field: &SurfaceModes| {
                    (0..field.modes())
                        .map(|n| field.amplitude(n))
                        .fold(0.0, f64::max)
                };
                most(&layers.double).max(most(&layers.single) * body.on().size())
            };
            inner.bodies.iter().map(of_body).fold(0.0, f64::max)
        });
        if density > 0.0 && inner.largest_speed > 0.0 {
            (tolerance * inner.largest_speed / density).max(FINEST)
        } else {
            tolerance
        }
    }

    /// A fast sum, if that is how so many targets are evaluated.
    fn fast_sum<const GRADIENT: bool>(
        &self,
        targets: usize,
        tolerance: f64,
    ) -> Result<Option<Sums>, SuspensionError> {
        if self.0.bodies.len() == 1 || MARGIN * tolerance < FINEST_SUM {
            return Ok(None);
        }
        if are_few(self.points()?.positions.len(), targets) {
            return Ok(None);
        }
        let output = if GRADIENT {
            Output::Gradient
        } else {
            Output::Pressure
        };
        let operators = self.0.operators.clone();
        let tolerance = MARGIN * tolerance;
        Ok(Some(Sums::new(
            operators,
            Singularities::Both,
            output,
            tolerance,
        )))
    }

    fn by_sum<const GRADIENT: bool>(
        &self,
        fast: &mut Sums,
        targets: &[Point3<f64>],
        tolerance: f64,
    ) -> Result<Vec<FlowGradientAt>, SuspensionError> {
        let beside = self.beside_points(targets)?;
        let apart = (0..targets.len()).filter(|place| beside.binary_search(place).is_err());
        let apart: Vec<usize> = apart.collect();
        let of = |places: &[usize]| -> Vec<Point3<f64>> {
            places.iter().map(|&place| targets[place]).collect()
        };
        let mut at_apart = self.sum(fast, &of(&apart), tolerance)?;
        self.correct::<GRADIENT>(&of(&apart), tolerance, |_, _| false, &mut at_apart)?;
        let at_beside = self.one_by_one::<GRADIENT>(&of(&beside), tolerance)?;
        let mut found = vec![FlowGradientAt::default(); targets.len()];
        let all_found = apart
            .iter()
            .zip(at_apart)
            .chain(beside.iter().zip(at_beside));
        for (&place, at) in all_found {
            found[place] = at;
        }
        Ok(found)
    }

    /// The layers of all bodies at points.
    fn points(&self) -> Result<&LayerPoints, FlowError> {
        let inner = &*self.0;
        if let Some(points) = inner.points.get() {
            return Ok(points);
        }
        let mut points = LayerPoints {
            positions: Vec::new(),
            normals: Vec::new(),
            stokeslets: Vec::new(),
            stresslets: Vec::new(),
            singularities: Singularities::Both,
        };
        for body in &inner.bodies {
            let frame = &body.frame;
            let [single, double] = factors_of_layers(frame);
            body.disturbance.for_each_point(|point| {
                let stokeslet = single * frame.vector_to_lab(point.single);
                let stresslet = double * frame.vector_to_lab(point.double);
                points
                    .positions
                    .push(frame.point_to_lab(point.position.into()).into());
                points
                    .normals
                    .push(frame.vector_to_lab(point.normal).into());
                points.stokeslets.push(stokeslet.into());
                points.stresslets.push(stresslet.into());
            })?;
        }
        Ok(inner.points.get_or_init(|| points))
    }

    fn sum(
        &self,
        fast: &mut Sums,
        targets: &[Point3<f64>],
        tolerance: f64,
    ) -> Result<Vec<FlowGradientAt>, SuspensionError> {
        if targets.is_empty() {
            return Ok(Vec::new());
        }
        let points = self.points()?;
        let targets: Vec<[f64; 3]> = targets.iter().map(|&x| x.into()).collect();
        let strengths = points.strengths(0..points.positions.len());
        // The targets are others with each chunk.
        fast.forget_plan();
        let between = Points::apart(&points.positions, &targets);
        let flow = fast.apply(between, &strengths, MARGIN * tolerance)?;
        let at = |index: usize| FlowGradientAt {
            velocity: flow.velocity[index].into(),
            pressure: flow.pressure[index],
            gradient: match flow.gradient.get(index) {
                Some(rows) => Matrix3::from_fn(|i, j| rows[i][j]),
                None => Matrix3::zeros(),
            },
        };
        Ok((0..targets.len()).map(at).collect())
    }

    /// The targets, by their places, that are beside a point of any body.
    fn beside_points(&self, targets: &[Point3<f64>]) -> Result<Vec<usize>, FlowError> {
        let balls = self.0.bodies.iter().map(|body| Ball {
            center: body.frame.center(),
            radius: 1.1 * body.size(),
        });
        let neighbours = Neighbours::new(balls);
        let beside = |target: &Point3<f64>| -> Result<bool, FlowError> {
            for index in neighbours.holding(*target) {
                let body = &self.0.bodies[index];
                if body
                    .disturbance
                    .is_beside_a_point(body.frame.point_to_body(*target))?
                {
                    return Ok(true);
                }
            }
            Ok(false)
        };
        let are = targets
            .par_iter()
            .map(beside)
            .collect::<Result<Vec<bool>, FlowError>>()?;
        Ok((0..targets.len()).filter(|&place| are[place]).collect())
    }

    /// The flow of every body by itself, added up.
    fn one_by_one<const GRADIENT: bool>(
        &self,
        targets: &[Point3<f64>],
        tolerance: f64,
    ) -> Result<Vec<FlowGradientAt>, FlowError> {
        let mut sum = vec![FlowGradientAt::default(); targets.len()];
        if targets.is_empty() {
            return Ok(sum);
        }
        for body in &self.0.bodies {
            let in_body = |&target: &Point3<f64>| body.frame.point_to_body(target);
            let targets: Vec<Point3<f64>> = targets.iter().map(in_body).collect();
            let found = body.disturbance.evaluate::<GRADIENT>(&targets, tolerance)?;
            for (sum, at) in sum.iter_mut().zip(found) {
                *sum += in_lab(&body.frame, at);
            }
        }
        Ok(sum)
    }

    /// Puts right what points near a body get wrong, but for the targets that a body leaves out.
    fn correct<const GRADIENT: bool>(
        &self,
        targets: &[Point3<f64>],
        tolerance: f64,
        leaves_out: impl Fn(usize, usize) -> bool + Sync,
        found: &mut [FlowGradientAt],
    ) -> Result<(), SuspensionError> {
        let bodies = &self.0.bodies;
        let ball = |body: &BodyFlow| -> Result<Ball, FlowError> {
            let reach = body.disturbance.correction_reach(tolerance)?;
            Ok(Ball {
                center: body.frame.center(),
                radius: body.frame.scale() * reach,
            })
        };
        let balls = bodies.par_iter().map(ball);
        let neighbours = Neighbours::new(balls.collect::<Result<Vec<Ball>, FlowError>>()?);
        let near: Vec<Vec<usize>> = (targets.par_iter())
            .map(|&target| neighbours.holding(target))
            .collect();
        let mut of_body = vec![Vec::new(); bodies.len()];
        for (index, near) in near.into_iter().enumerate() {
            for body in near {
                if !leaves_out(body, index) {
                    of_body[body].push(index);
                }
            }
        }
        let corrections = bodies.par_iter().zip(&of_body).map(|(body, indices)| {
            let frame = &body.frame;
            let near = indices
                .iter()
                .map(|&index| frame.point_to_body(targets[index]));
            let near: Vec<Point3<f64>> = near.collect();
            let corrections = body.disturbance.corrections::<GRADIENT>(&near, tolerance)?;
            let corrections = corrections.into_iter();
            Ok(corrections
                .map(|(place, at)| (indices[place], in_lab(frame, at)))
                .collect())
        });
        for of_body in corrections.collect::<Result<Vec<Vec<_>>, FlowError>>()? {
            for (index, correction) in of_body {
                found[index] += correction;
            }
        }
        Ok(())
    }

    /// Room for the stress on every surface, made when it is first wanted.
    pub(crate) fn stresses(&self) -> &[OnceLock<SurfaceStress>] {
        &self.0.stresses
    }

    /// The flow of all bodies but the one whose ring of targets it is; for viscosity 1, without the
    /// undisturbed flow.
    pub(crate) fn of_others(
        &self,
        targets: &[Point3<f64>],
        rings: &[(usize, Range<usize>)],
    ) -> Result<Vec<FlowGradientAt>, SuspensionError> {
        let bodies = &self.0.bodies;
        let mut found = vec![FlowGradientAt::default(); targets.len()];
        if bodies.len() == 1 {
            return Ok(found);
        }
        let tolerance = self.of_densities(STRESSES * self.0.tolerance);
        let in_body = |body: &BodyFlow, range: Range<usize>| -> Vec<Point3<f64>> {
            let targets = targets[range].iter();
            targets.map(|&x| body.frame.point_to_body(x)).collect()
        };
        if let Some(mut fast) = self.fast_sum::<true>(targets.len(), tolerance)? {
            found.clear();
            for some in targets.chunks(CHUNK) {
                found.extend(self.sum(&mut fast, some, tolerance)?);
            }
            let mut own = vec![0..0; bodies.len()];
            for (body, ring) in rings {
                own[*body] = ring.clone();
            }
            let leaves_out = |body: usize, target: usize| own[body].contains(&target);
            self.correct::<true>(targets, tolerance, leaves_out, &mut found)?;
            for (body, ring) in rings {
                let body = &bodies[*body];
                let of_own = body.disturbance.of_points(&in_body(body, ring.clone()))?;
                for (found, at) in found[ring.clone()].iter_mut().zip(of_own) {
                    *found -= in_lab(&body.frame, at);
                }
            }
            return Ok(found);
        }
        for (index, body) in bodies.iter().enumerate() {
            for (_, ring) in rings.iter().filter(|(owner, _)| *owner != index) {
                let near = in_body(body, ring.clone());
                let of_body = body.disturbance.evaluate::<true>(&near, tolerance)?;
                for (found, at) in found[ring.clone()].iter_mut().zip(of_body) {
                    *found += in_lab(&body.frame, at);
                }
            }
        }
        Ok(found)
    }
}

/// A flow at a point of the body's frame, in the laboratory.
fn in_lab(frame: &Frame, at: FlowGradientAt) -> FlowGradientAt {
    FlowGradientAt {
        velocity: frame.vector_to_lab(at.velocity),
        pressure: at.pressure / frame.scale(),
        gradient: frame.tensor_to_lab(&at.gradient) / frame.scale(),
    }
}
