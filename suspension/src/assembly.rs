//! The linear system for fixed positions and resolutions, independent of the right-hand side.

use std::sync::Arc;
use std::time::Instant;

use bodies_of_revolution::{Frame, RigidMotion, Wrench};
use inexact_krylov::{Method, Stop};
use stokes_body::layers::Layers;
use stokes_body::progress::Progress;
use stokes_body::surface::SurfaceModes;

use super::check::{Checker, Keep, Miss};
use super::class::{Class, Classes, Kind};
use super::constraint::Constraint;
use super::error::SuspensionError;
use super::imposed::Imposed;
use super::interactions::{InteractionError, Interactions, Use};
use super::iteration::{Iterated, Iteration, iterate};
use super::layout::Layout;
use super::memory::VECTORS;
use super::motion::Motion;
use super::options::Options;
use super::solution::{Seconds, Solution, Start, copy_modes};
use super::sums::Operators;
use super::suspension::{Body, Suspension};
use super::system::System;
use super::tables::{Member, Tables};
use super::tolerances::Tolerances;

/// The linear system of all bodies, and what checks its solutions.
pub(crate) struct Assembly {
    classes: Classes,
    frames: Vec<Frame>,
    /// The directions in which each body is free.
    free: Vec<Vec<RigidMotion>>,
    keep: Keep,
    layout: Layout,
    /// What couples the bodies; none for a body alone, which is solved for directly.
    coupling: Option<Coupling>,
    constraints: Vec<Option<Constraint>>,
    tolerances: Tolerances,
    operators: Operators,
    /// Bytes for rows of near points.
    memory: usize,
    /// How often it was solved: what serves one solution only is kept from the second on.
    solved: usize,
    /// The system on the surfaces of the check, if it was wanted.
    finer: Option<Box<Assembly>>,
    /// What it took to make, counted with the first solution.
    seconds: Seconds,
}

struct Coupling {
    system: System,
    /// The single layers of free bodies on the same points, if any were wanted.
    singles: Option<Interactions>,
    checker: Checker,
}

/// What an assembly is made with.
#[derive(Clone, Copy)]
pub(crate) struct Setup<'a> {
    pub tolerances: Tolerances,
    pub options: &'a Options,
    /// Classes that exist already.
    pub known: &'a [Arc<Class>],
    pub operators: &'a Operators,
    /// Bytes for rows of near points.
    pub memory: usize,
    /// What checks keep.
    pub keep: Keep,
}

impl Assembly {
    /// The linear system of bodies of these kinds.
    pub fn new(
        bodies: &[Body],
        kinds: &[Kind],
        setup: &Setup<'_>,
        progress: &dyn Progress,
    ) -> Result<Self, SuspensionError> {
        let classes = Classes::new(kinds, setup.known, progress)?;
        let start = Instant::now();
        let layout = Layout::new((0..bodies.len()).map(|body| classes.of(body).tables.field_len()));
        let constraints = constraints(bodies, &classes);
        let coupling = match bodies {
            [_] => None,
            _ => Some(Coupling::new(
                bodies,
                &classes,
                &constraints,
                setup,
                progress,
            )?),
        };
        let spent = classes.spent();
        Ok(Self {
            seconds: Seconds {
                assemble: spent.assemble,
                factor: spent.factor,
                near: start.elapsed().as_secs_f64(),
                ..Seconds::default()
            },
            frames: bodies.iter().map(|body| body.frame).collect(),
            free: bodies
                .iter()
                .map(|body| body.motion.free_directions())
                .collect(),
            keep: setup.keep,
            classes,
            layout,
            coupling,
            constraints,
            tolerances: setup.tolerances,
            operators: setup.operators.clone(),
            memory: setup.memory,
            solved: 0,
            finer: None,
        })
    }

    /// Whether it serves bodies in these places and of these kinds, to these tolerances.
    pub fn serves(&self, bodies: &[Body], kinds: &[Kind], tolerances: &Tolerances) -> bool {
        let placed = bodies.iter().map(|body| body.frame);
        self.tolerances.target <= tolerances.target
            && self.tolerances.residual <= tolerances.residual
            && self.frames.iter().copied().eq(placed)
            && (self.free.iter().cloned())
                .eq(bodies.iter().map(|body| body.motion.free_directions()))
            && self.classes.kinds() == kinds
    }

    /// Its classes.
    pub fn classes(&self) -> &Classes {
        &self.classes
    }

    /// The system on the surfaces of the check, if it was made before.
    pub fn take_finer(&mut self) -> Option<Self> {
        self.finer.take().map(|finer| *finer)
    }

    /// Keeps the system on the surfaces of the check if there is more than one right-hand side, or
    /// one body only.
    pub fn keep_finer(&mut self, finer: Self) {
        if self.solved > 1 || self.coupling.is_none() {
            self.finer = Some(Box::new(finer));
        }
    }

    /// Its classes, and those on the surfaces of the check if they are kept.
    pub fn all_classes(&self) -> Vec<Arc<Class>> {
        let mut all = self.classes.all().to_vec();
        if let Some(finer) = &self.finer {
            all.extend(finer.classes.all().iter().cloned());
        }
        all
    }

    /// How well it is solved.
    pub fn tolerances(&self) -> &Tolerances {
        &self.tolerances
    }

    /// By how much every body's boundary velocity is off; none for a body alone.
    pub fn misses(
        &mut self,
        suspension: &Suspension,
        solution: &Solution,
        progress: &dyn Progress,
    ) -> Result<Option<Vec<Miss>>, SuspensionError> {
        let Some(coupling) = &mut self.coupling else {
            return Ok(None);
        };
        let (tolerances, operators) = (&self.tolerances, &self.operators);
        let checker = &mut coupling.checker;
        let misses = checker.misses(suspension, solution, tolerances, operators, progress)?;
        Ok(Some(misses))
    }

    /// Solves, from an earlier solution if there is one; the bodies must be in the places that this
    /// was made for.
    ///
    /// `further` looks at what was found. It says by what factor the residual has to fall for the
    /// iteration to go on from there, or that the solution does.
    pub fn solve(
        &mut self,
        suspension: &Suspension,
        before: Option<&Start>,
        options: &Options,
        progress: &dyn Progress,
        mut further: impl FnMut(&Solution) -> Option<f64>,
    ) -> Result<Solution, SuspensionError> {
        self.solved += 1;
        let bodies = &suspension.bodies;
        let mut seconds = std::mem::take(&mut self.seconds);
        let start = Instant::now();
        if self.solved > 1 {
            // Loads may differ from those that the constraints were made for.
            self.constraints = constraints(bodies, &self.classes);
            self.keep_places();
        }
        let imposed = self.imposed(suspension)?;
        let (imposed_fields, data) = self.right_hand_side(bodies, &imposed, &mut seconds)?;
        let mut first = match before {
            Some(before) if self.coupling.is_some() => {
                before.unknowns(bodies, &self.classes, &self.layout)?
            }
            _ => None,
        };
        let mut earlier: Option<Iteration> = None;
        let mut solution = loop {
            let mut found = self.iterated(&data, first, options, progress, &mut seconds)?;
            if let Some(earlier) = earlier {
                found.iteration = found.iteration.after(earlier);
            }
            let solution = self.solution(bodies, &imposed, &imposed_fields, &found)?;
            match further(&solution) {
                Some(factor) if found.iteration.stop == Stop::Converged => {
                    self.tolerances.tighten(factor);
                    earlier = Some(found.iteration);
                    first = Some(found.unknown);
                }
                _ => break solution,
            }
        };
        seconds.iterate += start.elapsed().as_secs_f64();
        solution.seconds = seconds;
        if let Some(coupling) = &mut self.coupling {
            coupling.system.free_buffers();
        }
        Ok(solution)
    }

    /// What an unknown means for the bodies.
    fn solution(
        &mut self,
        bodies: &[Body],
        imposed: &[Imposed],
        imposed_fields: &[f64],
        found: &Iterated,
    ) -> Result<Solution, SuspensionError> {
        let densities = self.densities(&found.unknown);
        let of_others = self.felt_by_constrained(&found.unknown)?;
        let near = (self.coupling.as_ref()).map(|coupling| coupling.system.interactions.near());
        let mut solution = Solution {
            unknown: Vec::new(),
            layers: Vec::new(),
            slips: Vec::new(),
            motions: Vec::new(),
            wrenches: Vec::new(),
            residual_speeds: Vec::new(),
            largest_imposed: imposed.iter().fold(0.0f64, |most, i| most.max(i.largest)),
            iteration: found.iteration.clone(),
            seconds: Seconds::default(),
            unknowns: (0..bodies.len())
                .map(|body| self.classes.of(body).factors().unknowns())
                .sum(),
            points: (0..bodies.len())
                .map(|body| self.classes.of(body).kind.points())
                .sum(),
            near_points: near.map_or(0, |near| near.points()),
            near_bytes: near.map_or(0, |near| near.stored),
            classes: self.classes.clone(),
        };
        for (i, (body, imposed)) in bodies.iter().zip(imposed).enumerate() {
            let class = self.classes.of(i);
            let on = &class.tables.discretization;
            let mine = self.layout.of(i);
            let of = |field: &[f64]| SurfaceModes::from_scaled(on, &field[mine.clone()]);
            solution.unknown.push(of(&found.unknown));
            let left = of(&found.residual);
            let azimuths = 2 * left.modes() + 1;
            let speeds = (0..on.nodes().len()).map(|k| left.length_at(k, azimuths));
            solution.residual_speeds.push(speeds.fold(0.0, f64::max));
            let motion = self.constraints[i].as_ref().map(|constraint| {
                let alone = &imposed_fields[mine.clone()][..constraint.len()];
                let others = &of_others[mine.clone()][..constraint.len()];
                let felt: Vec<f64> = alone.iter().zip(others).map(|(a, b)| a - b).collect();
                constraint.motion(&felt)
            });
            solution.slips.push(imposed.slip.clone());
            let single = imposed.single.clone();
            solution.push(class, body, of(&densities), single, motion);
        }
        Ok(solution)
    }

    /// There is more than one right-hand side: keeps what depends on places.
    fn keep_places(&mut self) {
        if let (Some(coupling), 2) = (&mut self.coupling, self.solved) {
            let stored = coupling.system.interactions.near().stored;
            let rest = self.memory.saturating_sub(stored);
            coupling.checker.keep_places(rest);
        }
    }

    /// The unknown, by iteration; of a body alone it is what is imposed.
    fn iterated(
        &mut self,
        data: &[f64],
        first: Option<Vec<f64>>,
        options: &Options,
        progress: &dyn Progress,
        seconds: &mut Seconds,
    ) -> Result<Iterated, SuspensionError> {
        let Some(coupling) = &mut self.coupling else {
            return Ok(Iterated {
                unknown: data.to_vec(),
                residual: vec![0.0; data.len()],
                iteration: Iteration::direct(),
            });
        };
        let interactions = &coupling.system.interactions;
        let summed = interactions.seconds_of_sums;
        let rest = self.memory.saturating_sub(interactions.near().stored);
        let options = within_memory(options, rest, self.layout.len());
        let system = &mut coupling.system;
        let found = iterate(system, data, first, self.tolerances, &options, progress)?;
        seconds.sum += system.interactions.seconds_of_sums - summed;
        Ok(found)
    }

    /// The densities that make these velocities on their own bodies.
    fn densities(&self, unknown: &[f64]) -> Vec<f64> {
        match &self.coupling {
            Some(coupling) => coupling.system.densities(unknown),
            None => {
                let class = self.classes.of(0);
                let on = &class.tables.discretization;
                let density = class
                    .factors()
                    .solve(&SurfaceModes::from_scaled(on, unknown));
                let mut scaled = density.scaled_by_roots(on);
                scaled.resize(unknown.len(), 0.0);
                scaled
            }
        }
    }

    /// What all other bodies do to those that have a constraint.
    fn felt_by_constrained(&mut self, unknown: &[f64]) -> Result<Vec<f64>, InteractionError> {
        let constrained = self.constraints.iter().any(Option::is_some);
        match &mut self.coupling {
            Some(coupling) if constrained => {
                let tolerance = self.tolerances.product;
                coupling.system.velocities_of_others(unknown, tolerance)
            }
            _ => Ok(vec![0.0; unknown.len()]),
        }
    }

    fn imposed(&self, suspension: &Suspension) -> Result<Vec<Imposed>, SuspensionError> {
        let imposed = suspension.bodies.iter().enumerate().map(|(i, body)| {
            let class = self.classes.of(i);
            let Tables {
                discretization,
                n_max,
                ..
            } = &*class.tables;
            let shell = class.free().map(|solver| solver.shell());
            let oversampling = self.tolerances.oversampling;
            let background = &suspension.background;
            Imposed::new(
                body,
                background,
                discretization,
                *n_max,
                oversampling,
                shell,
            )
        });
        let imposed: Vec<Imposed> = imposed.collect();
        match imposed.iter().position(|i| !i.largest.is_finite()) {
            Some(body) => Err(SuspensionError::Velocity { body }),
            None => Ok(imposed),
        }
    }

    /// What is imposed, less what the single layers of free bodies do; and the same as far as
    /// constraints let it act, with what their loads add.
    fn right_hand_side(
        &mut self,
        bodies: &[Body],
        imposed: &[Imposed],
        seconds: &mut Seconds,
    ) -> Result<(Vec<f64>, Vec<f64>), SuspensionError> {
        let mut data = vec![0.0; self.layout.len()];
        let mut forced = vec![0.0; self.layout.len()];
        for (i, imposed) in imposed.iter().enumerate() {
            let class = self.classes.of(i);
            let discretization = &class.tables.discretization;
            let mut velocity = imposed.velocity.clone();
            if let (Some(single), Some(solver)) = (&imposed.single, class.free()) {
                velocity = velocity.plus(-1.0, &solver.single_layer(single));
                let single = single.scaled_by_roots(discretization);
                copy_modes(&mut forced[self.layout.of(i)], &single);
            }
            let velocity = velocity.scaled_by_roots(discretization);
            copy_modes(&mut data[self.layout.of(i)], &velocity);
        }
        if forced.iter().any(|&x| x != 0.0) && self.coupling.is_some() {
            let velocities = self.velocities_of_singles(bodies, &forced, seconds)?;
            for (data, velocity) in data.iter_mut().zip(&velocities) {
                *data -= velocity;
            }
        }
        let imposed = data.clone();
        for (body, constraint) in self.constraints.iter().enumerate() {
            if let Some(constraint) = constraint {
                let mine = &mut data[self.layout.of(body)][..constraint.len()];
                constraint.project(mine);
                constraint.add_pushed(mine);
            }
        }
        Ok((imposed, data))
    }

    /// What the single layers of all free bodies do to the others.
    fn velocities_of_singles(
        &mut self,
        bodies: &[Body],
        forced: &[f64],
        seconds: &mut Seconds,
    ) -> Result<Vec<f64>, InteractionError> {
        let mut velocities = vec![0.0; forced.len()];
        let Some(coupling) = &mut self.coupling else {
            return Ok(velocities);
        };
        let mut singles = match coupling.singles.take() {
            Some(singles) => singles,
            None => {
                let tables: Vec<Arc<Tables>> = (self.classes.all().iter())
                    .map(|class| match self.keep {
                        Keep::Nothing => Arc::new(class.new_single_layer_tables()),
                        _ => class.single_layer_tables().clone(),
                    })
                    .collect();
                let members = members(bodies, |body| tables[self.classes.index_of(body)].clone());
                let uses = match self.keep {
                    Keep::Nothing => Use::Once,
                    _ => Use::Often { memory: 0 },
                };
                let doubles = &coupling.system.interactions;
                doubles.of_layers(members, uses, self.operators.clone())?
            }
        };
        let summed = singles.seconds_of_sums;
        singles.add_velocities(&[forced], &mut velocities, self.tolerances.product)?;
        seconds.sum += singles.seconds_of_sums - summed;
        if self.solved > 1 {
            singles.free_buffers();
            coupling.singles = Some(singles);
        }
        Ok(velocities)
    }
}

impl Coupling {
    fn new(
        bodies: &[Body],
        classes: &Classes,
        constraints: &[Option<Constraint>],
        setup: &Setup<'_>,
        progress: &dyn Progress,
    ) -> Result<Self, SuspensionError> {
        progress.begin("near points", bodies.len());
        let members = members(bodies, |body| classes.of(body).tables.clone());
        let done = |steps: usize| progress.advance(steps);
        let product = setup.tolerances.product;
        let uses = Use::Often {
            memory: setup.memory,
        };
        let operators = setup.operators.clone();
        let interactions = Interactions::new(members, product, uses, operators, &done)?;
        let levels = setup.options.levels;
        let constraints = constraints.to_vec();
        Ok(Self {
            checker: Checker::new(bodies, classes, setup.keep)?,
            system: System::new(classes.clone(), interactions, constraints, levels)?,
            singles: None,
        })
    }
}

/// The constraints of the bodies that are free in some directions only.
fn constraints(bodies: &[Body], classes: &Classes) -> Vec<Option<Constraint>> {
    let constraints = bodies
        .iter()
        .enumerate()
        .map(|(i, body)| match &body.motion {
            Motion::Mixed(mixed) => {
                let response = classes.of(i).response()?;
                Some(Constraint::new(response, mixed, &body.frame))
            }
            Motion::Given(_) | Motion::Free(_) => None,
        });
    constraints.collect()
}

/// A long iteration keeps as many vectors as there is room for.
fn within_memory(options: &Options, memory: usize, unknowns: usize) -> Options {
    let mut options = options.clone();
    if let Method::Gmres { restart } = &mut options.method {
        *restart = (*restart).min(VECTORS + memory / (8 * unknowns));
    }
    options
}

fn members(bodies: &[Body], tables: impl Fn(usize) -> Arc<Tables>) -> Vec<Member> {
    let members = bodies.iter().enumerate().map(|(i, body)| Member {
        tables: tables(i),
        frame: body.frame,
    });
    members.collect()
}

impl Solution {
    /// Adds a body's part: its density, that of its force and torque if it is free, and its motion
    /// if a constraint let it be found.
    fn push(
        &mut self,
        class: &Class,
        body: &Body,
        density: SurfaceModes,
        single: Option<SurfaceModes>,
        found: Option<RigidMotion>,
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
            _ => {
                let given = body.frame.motion_to_body(body.motion.given());
                let layers = Layers::weighted(&density, class.tables.weights);
                (found.unwrap_or(given), layers)
            }
        };
        self.motions.push(motion);
        let wrench: Wrench = match body.motion {
            Motion::Free(wrench) => body.frame.wrench_to_body(wrench),
            Motion::Given(_) | Motion::Mixed(_) => layers.single.wrench(discretization),
        };
        self.wrenches.push(wrench);
        self.layers.push(layers);
    }
}
