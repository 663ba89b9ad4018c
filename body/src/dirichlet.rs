//! Dirichlet problems on one body: equations, factors, densities.
//!
//! | problem | equation | flow |
//! |---|---|---|
//! | exterior, combined field | $(\frac12 + D + \eta S)\sigma = f$ | $u = D\sigma + \eta S\sigma$ |
//! | exterior, single layer | $(S + N)\sigma = f$ | $u = S\sigma$ |
//! | interior, completed double layer | $(-\frac12 + D + N)\sigma = f$ | $u = D\sigma$ |
//!
//! with $N \sigma = \nu \langle\nu, \sigma\rangle$, where $\langle\nu, \sigma\rangle$ is the mean
//! of the normal component over the surface. The normal spans the null space of $S$ and the
//! complement of the range of $-\frac12 + D$, so $N$ makes the equations uniquely solvable.
//! $N \sigma$ vanishes when $f$ has no net flux, as it must have none for the single layer and in
//! the interior.

use panel_quadrature::QuadratureError;

use super::discretization::Discretization;
use super::factors::{ModalFactors, Seconds};
use super::flow::{Flow, Side};
use super::layers::{LayerWeights, Layers};
use super::matrix::ModalMatrices;
use super::surface::SurfaceModes;
use crate::kernel::{CombinedField, DoubleLayer, SingleLayer};
use crate::progress::Progress;
use crate::special::toroidal;
use bodies_of_revolution::{RigidMotion, Wrench};

/// The equation that is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Formulation {
    /// Exterior problem, second kind, well conditioned for every body.
    CombinedField,
    /// Exterior problem, first kind: ill conditioned, and only for data without net flux.
    SingleLayer,
    /// Interior problem, second kind, only for data without net flux.
    InteriorDoubleLayer,
}

impl Formulation {
    fn weights(self, discretization: &Discretization) -> LayerWeights {
        match self {
            Self::CombinedField => LayerWeights {
                double: 1.0,
                single: natural_weight(discretization),
            },
            Self::SingleLayer => LayerWeights::SINGLE,
            Self::InteriorDoubleLayer => LayerWeights::DOUBLE,
        }
    }

    /// The matrices of the equation for modes up to `n_max`.
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn matrices(
        self,
        discretization: &Discretization,
        n_max: usize,
    ) -> Result<ModalMatrices, QuadratureError> {
        assemble(
            discretization,
            self,
            self.weights(discretization),
            n_max,
            &|| (),
        )
    }
}

/// The factored equation of one shape: solves for any number of right-hand sides.
#[derive(Debug)]
pub struct DirichletSolver {
    discretization: Discretization,
    formulation: Formulation,
    weights: LayerWeights,
    factors: ModalFactors,
    seconds: Seconds,
}

impl DirichletSolver {
    /// Assembles and factors the equation for modes up to `n_max`.
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn new(
        discretization: Discretization,
        formulation: Formulation,
        n_max: usize,
        progress: &dyn Progress,
    ) -> Result<Self, QuadratureError> {
        let weights = formulation.weights(&discretization);
        let (factors, seconds) = ModalFactors::assembled(&discretization, progress, |done| {
            assemble(&discretization, formulation, weights, n_max, done)
        })?;
        Ok(Self {
            discretization,
            formulation,
            weights,
            factors,
            seconds,
        })
    }

    /// The nodes.
    pub fn discretization(&self) -> &Discretization {
        &self.discretization
    }

    /// The factors.
    pub fn factors(&self) -> &ModalFactors {
        &self.factors
    }

    /// Modes, counting the zeroth.
    pub fn modes(&self) -> usize {
        self.factors.count()
    }

    /// Unknowns of all modes: three components at each node for two families, one for mode 0.
    pub fn unknowns(&self) -> usize {
        self.factors.unknowns()
    }

    /// The equation.
    pub fn formulation(&self) -> Formulation {
        self.formulation
    }

    /// The layer potentials that make up the flow.
    pub fn weights(&self) -> LayerWeights {
        self.weights
    }

    /// How long the stages took.
    pub fn seconds(&self) -> Seconds {
        self.seconds
    }

    /// The density for boundary values `data`.
    pub fn solve(&self, data: &SurfaceModes) -> SurfaceModes {
        self.factors.solve(data)
    }

    /// The flow of a density, for viscosity 1.
    pub fn flow(&self, density: &SurfaceModes) -> Flow {
        let side = match self.formulation {
            Formulation::InteriorDoubleLayer => Side::Interior,
            _ => Side::Exterior,
        };
        let layers = Layers::weighted(density, self.weights);
        Flow::new(&self.discretization, layers).limit_from(side)
    }

    /// Force and torque (about the origin) that the body exerts on the fluid, for viscosity 1: of
    /// the single layer alone, since a double layer exerts none.
    pub fn wrench(&self, density: &SurfaceModes) -> Wrench {
        let Wrench { force, torque } = density.wrench(&self.discretization);
        Wrench {
            force: self.weights.single * force,
            torque: self.weights.single * torque,
        }
    }

    /// Force and torque exerted on the fluid (viscosity 1) in a rigid motion.
    pub fn resistance(&self, motion: &RigidMotion) -> Wrench {
        self.wrench(&self.solve(&SurfaceModes::of_motion(&self.discretization, motion)))
    }
}

/// The matrices of a formulation.
fn assemble(
    discretization: &Discretization,
    formulation: Formulation,
    weights: LayerWeights,
    n_max: usize,
    done: &(dyn Fn() + Sync),
) -> Result<ModalMatrices, QuadratureError> {
    let mut matrices = match formulation {
        Formulation::CombinedField => ModalMatrices::assemble(
            discretization,
            &CombinedField {
                eta: weights.single,
            },
            0.5,
            n_max,
            done,
        )?,
        Formulation::SingleLayer => {
            ModalMatrices::assemble(discretization, &SingleLayer, 0.0, n_max, done)?
        }
        Formulation::InteriorDoubleLayer => {
            ModalMatrices::assemble(discretization, &DoubleLayer, -0.5, n_max, done)?
        }
    };
    // On the normal both do nothing. What is added is about as strong as the layer.
    let strength = match formulation {
        Formulation::CombinedField => return Ok(matrices),
        Formulation::SingleLayer => discretization.size(),
        Formulation::InteriorDoubleLayer => 1.0,
    };
    matrices.add_projection(discretization, 0, strength, |node| {
        [node.normal[0], 0.0, node.normal[1]]
    });
    Ok(matrices)
}

/// The weight $\eta$ that makes the single layer as strong on translations as $\frac12$: with
/// $\lambda = \frac{1}{6\pi A} \int\\!\int \frac{d\Gamma\\, d\Gamma'}{\lvert x - x'\rvert}$,
/// where $A$ is the area, it is $1/2\lambda$ ($3/4a$ for a sphere of radius $a$). This $\lambda$ is
/// the mean of $\langle e, S e\rangle$ over directions $e$.
fn natural_weight(discretization: &Discretization) -> f64 {
    let nodes = discretization.nodes();
    let mut energy = 0.0;
    let mut area = 0.0;
    for x in nodes {
        area += x.weight;
        for y in nodes {
            // The distance of a node from itself is replaced by the mean distance within its
            // stretch of curve. That is rough, but enough for a weight.
            let rho = (x.r - y.r).hypot(x.z - y.z).max(0.2 * x.weight / x.r);
            let big_r = 2.0 * x.r * y.r;
            let (q0, _) = toroidal::start(rho * rho / big_r);
            energy += x.weight * y.weight * (8.0 / big_r).sqrt() * q0;
        }
    }
    3.0 * std::f64::consts::PI * area / energy
}
