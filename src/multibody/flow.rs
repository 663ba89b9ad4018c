//! The flow of many bodies at any points.

use nalgebra::{Matrix3, Point3, Vector3};
use rayon::prelude::*;
use stokes_fmm::{Output, Points, Singularities, Strengths, Stresslets};

use super::SuspensionError;
use super::sums::{Operators, Sums};
use crate::body::discretization::Discretization;
use crate::body::flow::{Flow, FlowError, first_not_finite};
use crate::body::frame::Frame;
use crate::body::layers::Layers;
use crate::body::linear_flow::LinearFlow;
use crate::kernel::{FlowAt, FlowGradientAt};
use crate::progress::{Progress, Silent};

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
    pub(crate) fn evaluate(
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
        let flows: Vec<Flow<'_>> = (self.bodies.iter())
            .map(|body| Flow::new(&body.discretization, body.layers.clone()))
            .collect();
        let sources = Sources::new(self, &flows)?;
        let mut all = Vec::with_capacity(targets.len());
        for some in targets.chunks(CHUNK) {
            if progress.is_cancelled() {
                return Err(SuspensionError::Interrupted);
            }
            let mut found = sources.at::<GRADIENT>(some, tolerance)?;
            self.correct::<GRADIENT>(&flows, some, tolerance, &mut found)?;
            for (at, target) in found.iter_mut().zip(some) {
                at.velocity += self.background.at(target.coords);
                at.gradient += self.background.gradient;
            }
            all.extend(found);
            progress.advance(some.len());
        }
        Ok(all)
    }

    /// Puts right what points near a body get wrong.
    fn correct<const GRADIENT: bool>(
        &self,
        flows: &[Flow<'_>],
        targets: &[Point3<f64>],
        tolerance: f64,
        found: &mut [FlowGradientAt],
    ) -> Result<(), SuspensionError> {
        let corrections = self.bodies.par_iter().zip(flows).map(|(body, flow)| {
            let frame = &body.frame;
            let reach = flow.correction_reach(tolerance)?;
            let near = targets.iter().enumerate().filter_map(|(index, &target)| {
                let at = frame.point_to_body(target);
                (at.coords.norm() <= reach).then_some((index, at))
            });
            let (indices, near): (Vec<usize>, Vec<Point3<f64>>) = near.unzip();
            let corrections = flow.corrections::<GRADIENT>(&near, tolerance)?;
            let in_lab = corrections.into_iter().map(|(place, at)| {
                let in_lab = FlowGradientAt {
                    velocity: frame.vector_to_lab(at.velocity),
                    pressure: at.pressure / frame.scale(),
                    gradient: frame.tensor_to_lab(&at.gradient) / frame.scale(),
                };
                (indices[place], in_lab)
            });
            Ok(in_lab.collect::<Vec<_>>())
        });
        for of_body in corrections.collect::<Result<Vec<_>, FlowError>>()? {
            for (index, correction) in of_body {
                found[index] += correction;
            }
        }
        Ok(())
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
