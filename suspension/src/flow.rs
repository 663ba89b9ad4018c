//! The flow of many bodies at any points.

use std::ops::Range;

use nalgebra::{Matrix3, Point3, Vector3};
use rayon::prelude::*;
use stokes_fmm::{Output, Points, Singularities, Strengths, Stresslets};

use super::SuspensionError;
use super::sums::{Operators, Sums};
use bodies_of_revolution::Frame;
use stokes_body::discretization::Discretization;
use stokes_body::flow::{Flow, FlowError, Side, first_not_finite};
use stokes_body::kernel::{FlowAt, FlowGradientAt};
use stokes_body::layers::Layers;
use stokes_body::linear_flow::{self, LinearFlow};
use stokes_body::progress::{Progress, Silent};
use stokes_body::surface::SurfaceModes;

/// One body's part in a flow, in its own frame and for viscosity 1.
#[derive(Clone, Debug)]
pub struct BodyLayers {
    /// Where the body is.
    pub frame: Frame,
    /// Panels and nodes.
    pub discretization: Discretization,
    /// The densities, in the body's frame.
    pub layers: Layers,
}

/// The flow that was solved for, in the laboratory and for viscosity 1: the undisturbed flow and the layers of all bodies.
#[derive(Clone, Debug)]
pub struct SuspensionFlow {
    /// Every body's part.
    pub bodies: Vec<BodyLayers>,
    /// The undisturbed flow.
    pub background: LinearFlow,
}

/// What a fast sum is asked for beyond the tolerance of the flow: its own is relative to the whole, and terms may cancel.
const MARGIN: f64 = 1e-2;
/// Targets that are evaluated between two reports of progress.
const CHUNK: usize = 1 << 16;
/// Bodies whose tractions are found together.
const BODIES: usize = 64;
/// Half steps between the points of a ring and those at which the others' tractions are sampled: as far from them as can be.
const HALVES: usize = 1;

impl SuspensionFlow {
    /// Velocity and pressure at every target, to about `tolerance` relative to the densities; on a surface, the limits from outside. Targets inside
    /// a body are not refused, and mean nothing.
    ///
    /// # Errors
    /// [`FlowError::NotFinite`] for a target that is not a point.
    pub fn at(
        &self,
        targets: &[Point3<f64>],
        tolerance: f64,
    ) -> Result<Vec<FlowAt>, SuspensionError> {
        self.evaluate(targets, tolerance, &Silent)
    }

    /// The same, telling where it is.
    pub fn evaluate(
        &self,
        targets: &[Point3<f64>],
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Vec<FlowAt>, SuspensionError> {
        let found = self.sum::<false>(targets, tolerance, progress)?;
        Ok(found.into_iter().map(FlowAt::from).collect())
    }

    /// The same with the velocity gradient, and so the stress.
    ///
    /// # Errors
    /// [`FlowError::NotFinite`] for a target that is not a point.
    pub fn gradient_at(
        &self,
        targets: &[Point3<f64>],
        tolerance: f64,
    ) -> Result<Vec<FlowGradientAt>, SuspensionError> {
        self.sum::<true>(targets, tolerance, &Silent)
    }

    /// The traction $\\sigma\\nu$ of the fluid on the surfaces of some bodies, background included, with the normal $\\nu$ out of the body: forces per area of the
    /// laboratory, as vectors in the body's frame.
    ///
    /// A body's own layers are taken mode by mode, what the others do on rings of points.
    ///
    /// # Errors
    /// If a quadrature rule is missing, or whoever waits has lost interest.
    pub fn tractions(
        &self,
        bodies: &[usize],
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Vec<SurfaceModes>, SuspensionError> {
        progress.begin("tractions", bodies.len());
        let flows = self.flows();
        let sources = Sources::new(self, &flows)?;
        let mut tractions = Vec::with_capacity(bodies.len());
        for some in bodies.chunks(BODIES) {
            if progress.is_cancelled() {
                return Err(SuspensionError::Interrupted);
            }
            tractions.extend(self.some_tractions(some, &flows, &sources, tolerance)?);
            progress.advance(some.len());
        }
        Ok(tractions)
    }

    fn some_tractions(
        &self,
        bodies: &[usize],
        flows: &[Flow<'_>],
        sources: &Sources,
        tolerance: f64,
    ) -> Result<Vec<SurfaceModes>, SuspensionError> {
        let mut targets = Vec::new();
        let mut own = Vec::with_capacity(bodies.len());
        let mut left_out = vec![0..0; flows.len()];
        for &body in bodies {
            let BodyLayers {
                frame,
                discretization,
                ..
            } = &self.bodies[body];
            let points = ring_points(discretization, flows[body].azimuths()?);
            let first = targets.len();
            targets.extend(points.iter().map(|&x| frame.point_to_lab(x)));
            left_out[body] = first..targets.len();
            own.push(points);
        }
        let mut found = Vec::with_capacity(targets.len());
        for some in targets.chunks(CHUNK) {
            found.extend(sources.at::<true>(some, tolerance)?);
        }
        self.correct::<true>(flows, &targets, tolerance, &left_out, &mut found)?;
        let tractions = bodies.iter().zip(own).map(|(&body, points)| {
            let BodyLayers {
                frame,
                discretization,
                ..
            } = &self.bodies[body];
            let flow = &flows[body];
            let mut of_own = flow.of_points(&points)?.into_iter();
            let mut found = found[left_out[body].clone()].iter();
            let of_others = |k: usize, [cos, sin]: [f64; 2]| {
                let [across, along] = discretization.nodes()[k].normal;
                let normal = Vector3::new(across * cos, across * sin, along);
                let mut at = found.next().copied().unwrap_or_default();
                at -= in_lab(frame, of_own.next().unwrap_or_default());
                at.gradient += self.background.gradient;
                frame.vector_to_body(at.stress() * frame.vector_to_lab(normal))
            };
            let samples = [flow.azimuths()?, HALVES];
            let n_max = (flow.modes() - 1).max(linear_flow::LAST_MODE);
            let nodes = discretization.nodes().len();
            let of_others = SurfaceModes::of_samples(nodes, n_max, samples, of_others);
            Ok(of_others.plus(1.0 / frame.scale(), &flow.traction(Side::Exterior)?))
        });
        tractions.collect()
    }

    fn flows(&self) -> Vec<Flow<'_>> {
        let flows = self.bodies.iter();
        flows
            .map(|body| Flow::new(&body.discretization, body.layers.clone()))
            .collect()
    }

    fn sum<const GRADIENT: bool>(
        &self,
        targets: &[Point3<f64>],
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Vec<FlowGradientAt>, SuspensionError> {
        if let Some(index) = first_not_finite(targets) {
            return Err(FlowError::NotFinite { index }.into());
        }
        progress.begin("evaluating", targets.len());
        let flows = self.flows();
        let sources = Sources::new(self, &flows)?;
        let mut evaluated = Vec::with_capacity(targets.len());
        let all = vec![0..0; flows.len()];
        for some in targets.chunks(CHUNK) {
            if progress.is_cancelled() {
                return Err(SuspensionError::Interrupted);
            }
            let beside = self.beside_points(&flows, some)?;
            let apart = (0..some.len()).filter(|place| beside.binary_search(place).is_err());
            let apart: Vec<usize> = apart.collect();
            let of = |places: &[usize]| -> Vec<Point3<f64>> {
                places.iter().map(|&place| some[place]).collect()
            };
            let mut at_apart = sources.at::<GRADIENT>(&of(&apart), tolerance)?;
            self.correct::<GRADIENT>(&flows, &of(&apart), tolerance, &all, &mut at_apart)?;
            let at_beside = self.one_by_one::<GRADIENT>(&flows, &of(&beside), tolerance)?;
            let mut found = vec![FlowGradientAt::default(); some.len()];
            let all_found = apart
                .iter()
                .zip(at_apart)
                .chain(beside.iter().zip(at_beside));
            for (&place, at) in all_found {
                found[place] = at;
            }
            for (at, target) in found.iter_mut().zip(some) {
                at.velocity += self.background.at(target.coords);
                at.gradient += self.background.gradient;
            }
            evaluated.extend(found);
            progress.advance(some.len());
        }
        Ok(evaluated)
    }

    /// The targets, by their places, that are beside a point of any body.
    fn beside_points(
        &self,
        flows: &[Flow<'_>],
        targets: &[Point3<f64>],
    ) -> Result<Vec<usize>, FlowError> {
        let beside = |target: &Point3<f64>| -> Result<bool, FlowError> {
            for (body, flow) in self.bodies.iter().zip(flows) {
                let at = body.frame.point_to_body(*target);
                let size = body.discretization.size();
                if at.coords.norm() <= 1.1 * size && flow.is_beside_a_point(at)? {
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
        flows: &[Flow<'_>],
        targets: &[Point3<f64>],
        tolerance: f64,
    ) -> Result<Vec<FlowGradientAt>, FlowError> {
        let mut sum = vec![FlowGradientAt::default(); targets.len()];
        if targets.is_empty() {
            return Ok(sum);
        }
        for (body, flow) in self.bodies.iter().zip(flows) {
            let targets = targets
                .iter()
                .map(|&target| body.frame.point_to_body(target));
            let found = flow.evaluate::<GRADIENT>(&targets.collect::<Vec<_>>(), tolerance)?;
            for (sum, at) in sum.iter_mut().zip(found) {
                *sum += in_lab(&body.frame, at);
            }
        }
        Ok(sum)
    }

    /// Puts right what points near a body get wrong, but for the targets that each body leaves out.
    fn correct<const GRADIENT: bool>(
        &self,
        flows: &[Flow<'_>],
        targets: &[Point3<f64>],
        tolerance: f64,
        left_out: &[Range<usize>],
        found: &mut [FlowGradientAt],
    ) -> Result<(), SuspensionError> {
        let corrections = (0..flows.len()).into_par_iter().map(|body| {
            let (frame, flow) = (&self.bodies[body].frame, &flows[body]);
            let reach = flow.correction_reach(tolerance)?;
            let near = targets.iter().enumerate().filter_map(|(index, &target)| {
                let at = frame.point_to_body(target);
                let is_near = at.coords.norm() <= reach && !left_out[body].contains(&index);
                is_near.then_some((index, at))
            });
            let (indices, near): (Vec<usize>, Vec<Point3<f64>>) = near.unzip();
            let corrections = flow.corrections::<GRADIENT>(&near, tolerance)?;
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
}

/// Points on rings of so many, ring after ring, between those of the densities; in the body's frame.
fn ring_points(discretization: &Discretization, azimuths: usize) -> Vec<Point3<f64>> {
    let nodes = discretization.nodes();
    let mut points = Vec::with_capacity(nodes.len() * azimuths);
    SurfaceModes::of_samples(nodes.len(), 0, [azimuths, HALVES], |k, [cos, sin]| {
        points.push(Point3::new(nodes[k].r * cos, nodes[k].r * sin, nodes[k].z));
        Vector3::zeros()
    });
    points
}

/// A flow at a point of the body's frame, in the laboratory.
fn in_lab(frame: &Frame, at: FlowGradientAt) -> FlowGradientAt {
    FlowGradientAt {
        velocity: frame.vector_to_lab(at.velocity),
        pressure: at.pressure / frame.scale(),
        gradient: frame.tensor_to_lab(&at.gradient) / frame.scale(),
    }
}

/// The layers of all bodies as singularities in the laboratory.
struct Sources {
    positions: Vec<[f64; 3]>,
    stokeslets: Vec<[f64; 3]>,
    densities: Vec<[f64; 3]>,
    normals: Vec<[f64; 3]>,
}

impl Sources {
    fn new(flow: &SuspensionFlow, flows: &[Flow<'_>]) -> Result<Self, FlowError> {
        let mut sources = Self {
            positions: Vec::new(),
            stokeslets: Vec::new(),
            densities: Vec::new(),
            normals: Vec::new(),
        };
        for (body, flow) in flow.bodies.iter().zip(flows) {
            let frame = &body.frame;
            let scale = frame.scale();
            flow.for_each_point(|point| {
                let vector = |v: Vector3<f64>| -> [f64; 3] { frame.vector_to_lab(v).into() };
                let position = frame.point_to_lab(point.position.into());
                sources.positions.push(position.into());
                sources.stokeslets.push(vector(scale * point.single));
                // The sum's stresslet has the other sign.
                sources
                    .densities
                    .push(vector(-scale * scale * point.double));
                sources.normals.push(vector(point.normal));
            })?;
        }
        Ok(sources)
    }

    fn at<const GRADIENT: bool>(
        &self,
        targets: &[Point3<f64>],
        tolerance: f64,
    ) -> Result<Vec<FlowGradientAt>, SuspensionError> {
        let targets: Vec<[f64; 3]> = targets.iter().map(|&x| x.into()).collect();
        let output = if GRADIENT {
            Output::Gradient
        } else {
            Output::Pressure
        };
        let strengths = Strengths {
            stokeslets: Some(&self.stokeslets),
            stresslets: Some(Stresslets {
                densities: &self.densities,
                normals: &self.normals,
            }),
            ..Strengths::default()
        };
        let points = Points::apart(&self.positions, &targets);
        let tolerance = MARGIN * tolerance;
        let mut sums = Sums::new(Operators::default(), Singularities::Both, output, tolerance);
        let flow = sums.apply(points, &strengths, tolerance)?;
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
}
