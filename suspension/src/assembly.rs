//! Bodies in their places at given resolutions: all that their equations take, whatever is asked of them.

use std::sync::Arc;
use std::time::Instant;

use super::SuspensionError;
use super::check::{Checker, Miss};
use super::class::{Class, Classes, Kind};
use super::interactions::{InteractionError, Interactions, Use};
use super::memory::VECTORS;
use super::rounds::LEAST;
use super::solution::{
    Care, Imposed, Iterated, Seconds, Solution, copy_modes, iterate, start_from,
};
use super::sums::Operators;
use super::suspension::{Body, Motion, Options, Suspension};
use super::system::System;
use super::tables::{Member, Tables};
use bodies_of_revolution::RigidMotion;
use inexact_krylov::Method;
use stokes_body::layers::{LayerWeights, Layers};
use stokes_body::progress::Progress;
use stokes_body::surface::SurfaceModes;

/// How many questions are asked of an assembly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Questions {
    /// One: what is no longer needed is let go of at once.
    One,
    /// Many: what is made for one is kept for the next.
    Many,
}

/// The equations of all bodies, and what checks their solutions.
pub(crate) struct Assembly {
    classes: Classes,
    system: System,
    /// The single layers of free bodies on the same points, if any were wanted.
    singles: Option<Interactions>,
    checker: Checker,
    /// The equations on the surfaces of the check, if they were wanted and will be again.
    finer: Option<Box<Assembly>>,
    questions: Questions,
    care: Care,
    operators: Operators,
    /// What it took to make, counted with the first question.
    seconds: Seconds,
}

impl Assembly {
    /// The equations of the suspension's bodies at the resolutions of `kinds`; classes that are in `known` are not made again.
    pub fn new(
        suspension: &Suspension<'_>,
        kinds: &[Kind],
        care: Care,
        questions: Questions,
        known: &Classes,
        operators: Operators,
        progress: &dyn Progress,
    ) -> Result<Self, SuspensionError> {
        let start = Instant::now();
        let classes = Classes::new(kinds, known, progress)?;
        let spent = start.elapsed().as_secs_f64();
        let factor = spent * classes.share_of_factoring();
        let start = Instant::now();
        let bodies = &suspension.bodies;
        progress.begin("near points", bodies.len());
        let members = members(bodies, |body| classes.of(body).tables.clone());
        let done = |steps: usize| progress.advance(steps);
        // With the rows of the check, which has more points, where they are kept.
        let memory = match questions {
            Questions::One => care.memory,
            Questions::Many => care.memory / 4,
        };
        let uses = Use::Often { memory };
        let interactions =
            Interactions::new(members, care.product, uses, operators.clone(), &done)?;
        let kept = (questions == Questions::Many).then_some(care.memory - memory);
        let checker = Checker::new(bodies, &classes, kept)?;
        let system = System::new(classes.clone(), interactions, suspension.options.two_level);
        Ok(Self {
            seconds: Seconds {
                assemble: spent - factor,
                factor,
                near: start.elapsed().as_secs_f64(),
                ..Seconds::default()
            },
            classes,
            system,
            singles: None,
            checker,
            finer: None,
            questions,
            care,
            operators,
        })
    }

    /// The bodies on the surfaces of the check.
    pub fn finer_kinds(&self) -> Vec<Kind> {
        let finer: Vec<Kind> = self.checker.kinds().collect();
        let bodies = 0..self.system.interactions.members().len();
        bodies
            .map(|body| finer[self.classes.index_of(body)].clone())
            .collect()
    }

    /// The equations for them, if they were made before.
    pub fn take_finer(&mut self) -> Option<Self> {
        self.finer.take().map(|finer| *finer)
    }

    /// Keeps the equations for them for the next question, if there may be one.
    pub fn keep_finer(&mut self, finer: Self) {
        if self.questions == Questions::Many {
            self.finer = Some(Box::new(finer));
        }
    }

    /// Operators of sums, which serve all tolerances and places.
    pub fn operators(&self) -> &Operators {
        &self.operators
    }

    /// How well the equations are solved.
    pub fn care(&self) -> &Care {
        &self.care
    }

    /// Asks for a residual that much smaller.
    pub fn tighten(&mut self, factor: f64) {
        self.care.residual = (factor * self.care.residual).max(LEAST);
    }

    /// What every body's boundary velocity is off by.
    pub fn misses(
        &mut self,
        suspension: &Suspension<'_>,
        solution: &Solution,
        progress: &dyn Progress,
    ) -> Result<Vec<Miss>, SuspensionError> {
        let (tolerance, operators) = (self.care.product, &self.operators);
        self.checker
            .misses(suspension, solution, tolerance, operators, progress)
    }

    /// Solves, from what an earlier solution says; the bodies must be those in the places that this was made for.
    pub fn solve(
        &mut self,
        suspension: &Suspension<'_>,
        before: Option<&Solution>,
        progress: &dyn Progress,
    ) -> Result<Solution, SuspensionError> {
        let mut seconds = std::mem::take(&mut self.seconds);
        let start = Instant::now();
        let imposed = self.imposed(suspension)?;
        let data = self.right_hand_side(&suspension.bodies, &imposed)?;
        seconds.near += start.elapsed().as_secs_f64();
        let start = Instant::now();
        let layout = self.system.interactions.layout();
        let first = match before {
            Some(before) => Some(start_from(before, &self.classes, layout)?),
            None => None,
        };
        let summed = self.system.interactions.seconds_of_sums;
        let options = self.within_memory(suspension.options);
        let Iterated {
            unknown,
            left,
            iteration,
        } = iterate(
            &mut self.system,
            &data,
            first,
            self.care,
            &options,
            progress,
        )?;
        let densities = self.system.solve_alone_of(&unknown);
        seconds.iterate = start.elapsed().as_secs_f64();
        seconds.sum = self.system.interactions.seconds_of_sums - summed;
        self.system.rest();
        let (classes, interactions) = (&self.classes, &self.system.interactions);
        let mut solution = Solution {
            unknown: Vec::new(),
            layers: Vec::new(),
            motions: Vec::new(),
            wrenches: Vec::new(),
            left: Vec::new(),
            largest_imposed: imposed.iter().fold(0.0f64, |most, i| most.max(i.largest)),
            iteration,
            seconds,
            unknowns: (0..suspension.bodies.len())
                .map(|body| classes.of(body).factors().unknowns())
                .sum(),
            points: interactions.points(),
            near_points: interactions.near().points(),
            near_bytes: interactions.near().stored,
            classes: classes.clone(),
        };
        let layout = interactions.layout();
        for (i, (body, imposed)) in suspension.bodies.iter().zip(imposed).enumerate() {
            let class = classes.of(i);
            let discretization = &class.tables.discretization;
            let of =
                |field: &[f64]| SurfaceModes::from_scaled(discretization, &field[layout.of(i)]);
            solution.unknown.push(of(&unknown));
            let left = of(&left);
            let azimuths = 2 * left.modes() + 1;
            let speeds = (0..discretization.nodes().len()).map(|k| left.length_at(k, azimuths));
            solution.left.push(speeds.fold(0.0, f64::max));
            solution.push(class, body, of(&densities), imposed.single);
        }
        Ok(solution)
    }

    /// A long iteration keeps as many vectors as there is room for.
    fn within_memory(&self, options: Options) -> Options {
        let Method::Gmres { restart } = options.method else {
            return options;
        };
        let interactions = &self.system.interactions;
        let rest = self.care.memory.saturating_sub(interactions.near().stored);
        let most = VECTORS + rest / (8 * interactions.layout().len());
        Options {
            method: Method::Gmres {
                restart: restart.min(most),
            },
            ..options
        }
    }

    fn imposed(&self, suspension: &Suspension<'_>) -> Result<Vec<Imposed>, SuspensionError> {
        let imposed = suspension.bodies.iter().enumerate().map(|(i, body)| {
            let class = self.classes.of(i);
            let tables = &class.tables;
            let shell = class.free().map(|solver| solver.shell());
            let background = &suspension.background;
            Imposed::new(
                body,
                background,
                &tables.discretization,
                tables.n_max,
                shell,
            )
        });
        let imposed: Vec<Imposed> = imposed.collect();
        match imposed.iter().position(|i| !i.largest.is_finite()) {
            Some(body) => Err(SuspensionError::Velocity { body }),
            None => Ok(imposed),
        }
    }

    /// What is imposed, less what the single layers of free bodies do.
    fn right_hand_side(
        &mut self,
        bodies: &[Body<'_>],
        imposed: &[Imposed],
    ) -> Result<Vec<f64>, SuspensionError> {
        let layout = self.system.interactions.layout();
        let mut data = vec![0.0; layout.len()];
        let mut forced = vec![0.0; layout.len()];
        for (i, imposed) in imposed.iter().enumerate() {
            let class = self.classes.of(i);
            let discretization = &class.tables.discretization;
            let mut velocity = imposed.velocity.clone();
            if let (Some(single), Some(solver)) = (&imposed.single, class.free()) {
                velocity = velocity.plus(-1.0, &solver.single_layer(single));
                let single = single.scaled_by_roots(discretization);
                copy_modes(&mut forced[layout.of(i)], &single);
            }
            let velocity = velocity.scaled_by_roots(discretization);
            copy_modes(&mut data[layout.of(i)], &velocity);
        }
        if forced.iter().any(|&x| x != 0.0) {
            let mut velocities = vec![0.0; data.len()];
            let mut singles = match self.singles.take() {
                Some(singles) => singles,
                None => self.single_layers(bodies)?,
            };
            singles.add_velocities(&forced, &mut velocities, self.care.product)?;
            if self.questions == Questions::Many {
                singles.rest();
                self.singles = Some(singles);
            }
            for (data, velocity) in data.iter_mut().zip(&velocities) {
                *data -= velocity;
            }
        }
        Ok(data)
    }

    /// The interactions of single layers on the same points.
    fn single_layers(&self, bodies: &[Body<'_>]) -> Result<Interactions, InteractionError> {
        let tables = self.classes.iter().map(|class| {
            let of = &class.tables;
            let single = Tables::new(of.discretization.clone(), of.n_max, LayerWeights::SINGLE)?;
            Ok(Arc::new(single))
        });
        let tables: Vec<Arc<Tables>> = tables.collect::<Result<_, InteractionError>>()?;
        let members = members(bodies, |body| tables[self.classes.index_of(body)].clone());
        let operators = self.operators.clone();
        let uses = match self.questions {
            Questions::One => Use::Once,
            Questions::Many => Use::Often { memory: 0 },
        };
        Interactions::new(members, self.care.product, uses, operators, &|_| ())
    }
}

fn members(bodies: &[Body<'_>], tables: impl Fn(usize) -> Arc<Tables>) -> Vec<Member> {
    let members = bodies.iter().enumerate().map(|(i, body)| Member {
        tables: tables(i),
        frame: body.frame,
    });
    members.collect()
}

impl Solution {
    /// Adds a body's part: its density, and that of its force and torque if it is free.
    fn push(
        &mut self,
        class: &Class,
        body: &Body<'_>,
        density: SurfaceModes,
        single: Option<SurfaceModes>,
    ) {
        let discretization = &class.tables.discretization;
        let (motion, layers) = match (class.free(), single) {
            (Some(solver), Some(single)) => (
                -solver.shell().projection(discretization, &density),
                Layers {
                    double: density,
                    single,
                },
            ),
            _ => (
                match body.motion {
                    Motion::Given(motion) => body.frame.motion_to_body(motion),
                    Motion::Free(_) => RigidMotion::rest(),
                },
                Layers::weighted(&density, class.tables.weights),
            ),
        };
        self.motions.push(motion);
        self.wrenches.push(match body.motion {
            Motion::Given(_) => layers.single.wrench(discretization),
            Motion::Free(wrench) => body.frame.wrench_to_body(wrench),
        });
        self.layers.push(layers);
    }
}
