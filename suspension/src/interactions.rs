//! What the bodies do to each other: the velocity of the layers of all other bodies on each.
//!
//! All points together go through one [fast sum](stokes_fmm). What it counts of a body's own points
//! is taken away by the shape's point sums (`body::point_sums`), and points that are near another
//! body (`near`) are put right.

use std::time::Instant;

use panel_quadrature::QuadratureError;
use rayon::prelude::*;
use stokes_fmm::{FmmError, Output, Points, Singularities, direct};

use super::batches::{Batches, multiply};
use super::layout::Layout;
use super::near::{self, Near};
use super::points::{LayerPoints, factors_of_layers};
use super::sums::{self, Operators, Sums};
use super::tables::Member;

/// Why the interactions cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InteractionError {
    /// The fast sum refused.
    #[error(transparent)]
    Sum(#[from] FmmError),
    /// A quadrature rule is missing.
    #[error(transparent)]
    Quadrature(#[from] QuadratureError),
    /// Cancelled by the caller.
    #[error("interrupted")]
    Interrupted,
}

/// How often interactions are used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Use {
    /// Once: nothing is kept.
    Once,
    /// Many times: rows for near points are kept as far as they fit into so many bytes.
    Often {
        /// Bytes.
        memory: usize,
    },
}

impl Use {
    /// Bytes for rows.
    fn memory(self) -> usize {
        match self {
            Self::Once => 0,
            Self::Often { memory } => memory,
        }
    }
}

/// The interactions of some bodies.
pub(crate) struct Interactions {
    members: Vec<Member>,
    batches: Batches,
    /// Where the bodies' modes are, and their points.
    fields: Layout,
    points: Layout,
    layers: LayerPoints,
    near: Near,
    uses: Use,
    tolerance: f64,
    sums: Sums,
    /// Wall-clock seconds of all sums so far.
    pub seconds_of_sums: f64,
    /// Room for products; none when at rest.
    own: Vec<f64>,
    strengths: Vec<near::Strengths>,
}

impl Interactions {
    /// The interactions to a `tolerance` at best.
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn new(
        members: Vec<Member>,
        tolerance: f64,
        uses: Use,
        operators: Operators,
        done: &(dyn Fn(usize) + Sync),
    ) -> Result<Self, InteractionError> {
        let at_points = |of: &(dyn Fn(&Member, usize) -> [f64; 3] + Sync)| -> Vec<[f64; 3]> {
            (members.par_iter())
                .flat_map_iter(|member| {
                    (member.tables.grid().places()).map(move |place| of(member, place))
                })
                .collect()
        };
        let positions = at_points(&|member, place| {
            let position = member.tables.grid().position(place);
            member.frame.point_to_lab(position).into()
        });
        let normals = at_points(&|member, place| {
            let normal = member.tables.grid().normal(place);
            member.frame.vector_to_lab(normal).into()
        });
        let near = Near::new(&members, tolerance, uses.memory(), done)?;
        let on = [positions, normals];
        Ok(Self::at(on, near, members, tolerance, uses, operators))
    }

    /// The interactions of other layers, those of `members`, on the same points: what is near needs
    /// not be found again.
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn of_layers(
        &self,
        members: Vec<Member>,
        uses: Use,
        operators: Operators,
    ) -> Result<Self, InteractionError> {
        let near = self.near.of_layers(&members, uses.memory())?;
        let on = [&self.layers.positions, &self.layers.normals].map(Clone::clone);
        Ok(Self::at(on, near, members, self.tolerance, uses, operators))
    }

    fn at(
        [positions, normals]: [Vec<[f64; 3]>; 2],
        near: Near,
        members: Vec<Member>,
        tolerance: f64,
        uses: Use,
        operators: Operators,
    ) -> Self {
        let single = members.iter().any(|m| m.tables.weights.single != 0.0);
        let double = members.iter().any(|m| m.tables.weights.double != 0.0);
        let singularities = match (single, double) {
            (true, true) => Singularities::Both,
            (true, false) => Singularities::Stokeslets,
            _ => Singularities::Stresslets,
        };
        Self {
            near,
            uses,
            batches: Batches::new(&members),
            own: Vec::new(),
            strengths: Vec::new(),
            sums: Sums::new(operators, singularities, Output::Velocity, tolerance),
            seconds_of_sums: 0.0,
            tolerance,
            fields: Layout::new(members.iter().map(|m| m.tables.field_len())),
            points: Layout::new(members.iter().map(|m| m.tables.grid().len())),
            members,
            layers: LayerPoints {
                positions,
                normals,
                stokeslets: Vec::new(),
                stresslets: Vec::new(),
                singularities,
            },
        }
    }

    /// Where the bodies' modes are in a vector of all.
    pub fn layout(&self) -> &Layout {
        &self.fields
    }

    /// The bodies.
    pub fn members(&self) -> &[Member] {
        &self.members
    }

    /// What is near.
    pub fn near(&self) -> &Near {
        &self.near
    }

    /// Adds to the modes in `velocities` what the `densities` of all other bodies do; both are
    /// scaled by the roots of the weights. The error is about `tolerance` relative to all
    /// velocities that the densities make, in the Euclidean norm.
    ///
    /// # Errors
    /// If a density is not finite.
    pub fn add_velocities(
        &mut self,
        densities: &[f64],
        velocities: &mut [f64],
        tolerance: f64,
    ) -> Result<(), InteractionError> {
        self.make_room();
        self.spread(densities);
        let start = Instant::now();
        let few = sums::are_few(self.points.len(), self.points.len());
        let mut velocity = if few {
            self.sum_over_others()?
        } else {
            let points = Points::same(&self.layers.positions);
            let strengths = self.layers.strengths(0..self.points.len());
            self.sums.apply(points, &strengths, tolerance)?.velocity
        };
        self.seconds_of_sums += start.elapsed().as_secs_f64();
        self.own.clear();
        self.own.resize(self.fields.len(), 0.0);
        if !few {
            self.own.copy_from_slice(densities);
            self.sum_own_points();
        }
        let members = &self.members;
        let (fields, near) = (&self.fields, &self.near);
        let own = &self.own;
        let strengths = &self.strengths;
        let points = self.points.split(&mut velocity);
        points
            .into_par_iter()
            .zip(fields.split(velocities))
            .enumerate()
            .try_for_each_init(
                || (Vec::new(), [(); 3].map(|()| Vec::new())),
                |(scratch, in_body), (body, (at_points, modes))| {
                    let field = |source: usize| &densities[fields.of(source)];
                    near.correct(members, body, field, strengths, at_points)?;
                    let Member { tables, frame } = &members[body];
                    for component in in_body.iter_mut() {
                        component.clear();
                        component.resize(strengths[body].points[0].len(), 0.0);
                    }
                    for (place, velocity) in tables.grid().places().zip(at_points.iter()) {
                        let turned = frame.vector_to_body((*velocity).into());
                        for k in 0..3 {
                            in_body[k][place] = turned[k];
                        }
                    }
                    tables.grid().add_modes(in_body, scratch, modes);
                    for (mode, own) in modes.iter_mut().zip(&own[fields.of(body)]) {
                        *mode -= own;
                    }
                    Ok(())
                },
            )
    }

    /// What the sum over all points did to each body's own, from the densities in `own`.
    fn sum_own_points(&mut self) {
        let (members, fields) = (&self.members, &self.fields);
        if self.uses == Use::Once {
            for (tables, batches) in self.batches.by_tables() {
                let matrices = tables.new_point_sum();
                batches.apply(fields, &mut self.own, |_, n, columns, scratch| {
                    multiply(&matrices, n, columns, scratch);
                });
            }
            return;
        }
        self.batches
            .apply(fields, &mut self.own, |body, n, columns, scratch| {
                multiply(members[body].tables.point_sum(), n, columns, scratch);
            });
    }

    /// Frees the buffers of products: they are made anew with the next one.
    pub fn free_buffers(&mut self) {
        self.sums.forget_plan();
        (self.own, self.strengths) = (Vec::new(), Vec::new());
        (self.layers.stokeslets, self.layers.stresslets) = (Vec::new(), Vec::new());
    }

    fn make_room(&mut self) {
        if !self.strengths.is_empty() {
            return;
        }
        let room = |used: bool| vec![[0.0; 3]; if used { self.points.len() } else { 0 }];
        let bodies = 0..self.members.len();
        self.strengths = bodies
            .map(|body| self.near.strengths(&self.members, body))
            .collect();
        let stokeslets = room(self.layers.has_stokeslets());
        self.layers.stresslets = room(self.layers.has_stresslets());
        self.layers.stokeslets = stokeslets;
    }

    /// The velocities at all points, of the points of all other bodies. Of what neighbours on a
    /// body do to each other a sum has fewer digits the nearer they are: here it is not made at
    /// all.
    fn sum_over_others(&self) -> Result<Vec<[f64; 3]>, FmmError> {
        let mut velocity = Vec::with_capacity(self.points.len());
        for body in 0..self.members.len() {
            let own = self.points.of(body);
            let targets = &self.layers.positions[own.clone()];
            let first = velocity.len();
            velocity.resize(first + targets.len(), [0.0; 3]);
            for others in [0..own.start, own.end..self.points.len()] {
                if others.is_empty() {
                    continue;
                }
                let sources = &self.layers.positions[others.clone()];
                let strengths = self.layers.strengths(others);
                let of_others = direct::sum(sources, &strengths, targets, Output::Velocity, None)?;
                for (sum, more) in velocity[first..].iter_mut().zip(of_others.velocity) {
                    *sum = std::array::from_fn(|k| sum[k] + more[k]);
                }
            }
        }
        Ok(velocity)
    }

    /// Puts the densities on the points: in the bodies' frames, and as singularities in the
    /// laboratory.
    fn spread(&mut self, densities: &[f64]) {
        let (members, fields, near) = (&self.members, &self.fields, &self.near);
        let count = members.len();
        let split = |strengths| -> Vec<Option<&mut [[f64; 3]]>> {
            let strengths: &mut Vec<[f64; 3]> = strengths;
            if strengths.is_empty() {
                (0..count).map(|_| None).collect()
            } else {
                self.points.split(strengths).into_iter().map(Some).collect()
            }
        };
        let layers = &mut self.layers;
        let (stokeslets, stresslets) =
            (split(&mut layers.stokeslets), split(&mut layers.stresslets));
        let singularities = stokeslets.into_par_iter().zip(stresslets);
        (self.strengths.par_iter_mut())
            .zip(singularities)
            .enumerate()
            .for_each_init(
                || (Vec::new(), Default::default()),
                |(scratch, room), (body, (strengths, (mut stokeslets, mut stresslets)))| {
                    let Member { tables, frame } = &members[body];
                    let (grid, field) = (tables.grid(), &densities[fields.of(body)]);
                    let upsampled = near.upsamplings(body).zip(&mut strengths.upsampled);
                    for (upsampling, strengths) in upsampled {
                        if let Some(upsampling) = upsampling {
                            upsampling.to_points(field, room, strengths);
                        }
                    }
                    let strengths = &mut strengths.points;
                    grid.to_points(field, scratch, strengths);
                    let [single, double] = factors_of_layers(frame);
                    let single = tables.weights.single * single;
                    let double = tables.weights.double * double;
                    for (point, place) in grid.places().enumerate() {
                        let strength = strengths.each_ref().map(|s| s[place]);
                        let in_lab = frame.vector_to_lab(strength.into());
                        if let Some(stokeslets) = &mut stokeslets {
                            stokeslets[point] = (single * in_lab).into();
                        }
                        if let Some(stresslets) = &mut stresslets {
                            stresslets[point] = (double * in_lab).into();
                        }
                    }
                },
            );
    }
}
