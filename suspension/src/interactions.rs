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
    densities: Vec<Density>,
    /// Where the bodies' modes are, and their points.
    fields: Layout,
    points: Layout,
    layers: LayerPoints,
    uses: Use,
    tolerance: f64,
    sums: Sums,
    /// Wall-clock seconds of all sums so far.
    pub seconds_of_sums: f64,
}

/// One density on all bodies, and the layers that it makes there. The held have one; of the free,
/// the single layer that carries force and torque has a density of its own.
struct Density {
    members: Vec<Member>,
    batches: Batches,
    near: Near,
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
        let density = Density::new(members, near);
        let on = [positions, normals];
        Ok(Self::at(on, vec![density], tolerance, uses, operators))
    }

    /// The same of two densities, the second that of `members`, on the same points and in one sum.
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn with_density(
        self,
        members: Vec<Member>,
        operators: Operators,
    ) -> Result<Self, InteractionError> {
        let near = self.near().of_layers(&members, self.uses.memory())?;
        let mut densities = self.densities;
        densities.push(Density::new(members, near));
        let on = [self.layers.positions, self.layers.normals];
        Ok(Self::at(
            on,
            densities,
            self.tolerance,
            self.uses,
            operators,
        ))
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
        let near = self.near().of_layers(&members, uses.memory())?;
        let density = Density::new(members, near);
        let on = [&self.layers.positions, &self.layers.normals].map(Clone::clone);
        Ok(Self::at(on, vec![density], self.tolerance, uses, operators))
    }

    fn at(
        [positions, normals]: [Vec<[f64; 3]>; 2],
        densities: Vec<Density>,
        tolerance: f64,
        uses: Use,
        operators: Operators,
    ) -> Self {
        let all = || densities.iter().flat_map(|density| &density.members);
        let single = all().any(|m| m.tables.weights.single != 0.0);
        let double = all().any(|m| m.tables.weights.double != 0.0);
        let singularities = match (single, double) {
            (true, true) => Singularities::Both,
            (true, false) => Singularities::Stokeslets,
            _ => Singularities::Stresslets,
        };
        let members = &densities[0].members;
        Self {
            uses,
            sums: Sums::new(operators, singularities, Output::Velocity, tolerance),
            seconds_of_sums: 0.0,
            tolerance,
            fields: Layout::new(members.iter().map(|m| m.tables.field_len())),
            points: Layout::new(members.iter().map(|m| m.tables.grid().len())),
            densities,
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

    /// How many densities there are.
    pub fn densities(&self) -> usize {
        self.densities.len()
    }

    /// The bodies, with the tables of the first density.
    pub fn members(&self) -> &[Member] {
        &self.densities[0].members
    }

    /// What is near, for the first density.
    pub fn near(&self) -> &Near {
        &self.densities[0].near
    }

    /// Adds to the modes in `velocities` what the densities of all other bodies do, the modes of
    /// each density in one of `fields`; all are scaled by the roots of the weights. The error is
    /// about `tolerance` relative to all velocities that the densities make, in the Euclidean norm.
    ///
    /// # Errors
    /// If a density is not finite.
    pub fn add_velocities(
        &mut self,
        fields: &[&[f64]],
        velocities: &mut [f64],
        tolerance: f64,
    ) -> Result<(), InteractionError> {
        self.make_room();
        for (density, field) in self.densities.iter_mut().zip(fields) {
            density.spread(field, &self.fields);
        }
        self.place_singularities();
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
        // A sum over all points counts a body's own.
        if !few {
            for (density, field) in self.densities.iter_mut().zip(fields) {
                density.own.clear();
                density.own.extend_from_slice(field);
                density.sum_own_points(&self.fields, self.uses);
            }
        }
        let (layout, densities) = (&self.fields, &self.densities);
        let points = self.points.split(&mut velocity);
        points
            .into_par_iter()
            .zip(layout.split(velocities))
            .enumerate()
            .try_for_each_init(
                || (Vec::new(), [(); 3].map(|()| Vec::new())),
                |(scratch, in_body), (body, (at_points, modes))| {
                    for (density, densities) in densities.iter().zip(fields) {
                        let field = |source: usize| &densities[layout.of(source)];
                        let Density {
                            members,
                            near,
                            strengths,
                            ..
                        } = density;
                        near.correct(members, body, field, strengths, at_points)?;
                    }
                    let Member { tables, frame } = &densities[0].members[body];
                    let grid = tables.grid();
                    let places = densities[0].strengths[body].points[0].len();
                    for component in in_body.iter_mut() {
                        component.clear();
                        component.resize(places, 0.0);
                    }
                    for (place, velocity) in grid.places().zip(at_points.iter()) {
                        let turned = frame.vector_to_body((*velocity).into());
                        for k in 0..3 {
                            in_body[k][place] = turned[k];
                        }
                    }
                    grid.add_modes(in_body, scratch, modes);
                    for density in densities.iter().filter(|_| !few) {
                        for (mode, own) in modes.iter_mut().zip(&density.own[layout.of(body)]) {
                            *mode -= own;
                        }
                    }
                    Ok(())
                },
            )
    }

    /// Frees the buffers of products: they are made anew with the next one.
    pub fn free_buffers(&mut self) {
        self.sums.forget_plan();
        for density in &mut self.densities {
            (density.own, density.strengths) = (Vec::new(), Vec::new());
        }
        (self.layers.stokeslets, self.layers.stresslets) = (Vec::new(), Vec::new());
    }

    fn make_room(&mut self) {
        let room = |used: bool| vec![[0.0; 3]; if used { self.points.len() } else { 0 }];
        if !self.densities[0].strengths.is_empty() {
            return;
        }
        let stokeslets = room(self.layers.has_stokeslets());
        self.layers.stresslets = room(self.layers.has_stresslets());
        self.layers.stokeslets = stokeslets;
        for Density {
            members,
            near,
            strengths,
            ..
        } in &mut self.densities
        {
            let bodies = 0..members.len();
            *strengths = bodies.map(|body| near.strengths(members, body)).collect();
        }
    }

    /// The velocities at all points, of the points of all other bodies. Of what neighbours on a
    /// body do to each other a sum has fewer digits the nearer they are: here it is not made at
    /// all.
    fn sum_over_others(&self) -> Result<Vec<[f64; 3]>, FmmError> {
        let mut velocity = Vec::with_capacity(self.points.len());
        for body in 0..self.members().len() {
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

    /// The singularities at the points, in the laboratory, that all densities together make.
    fn place_singularities(&mut self) {
        let layers = &mut self.layers;
        layers.stokeslets.fill([0.0; 3]);
        layers.stresslets.fill([0.0; 3]);
        for density in &self.densities {
            let split = |strengths| -> Vec<&mut [[f64; 3]]> {
                let strengths: &mut Vec<[f64; 3]> = strengths;
                if strengths.is_empty() {
                    density.members.iter().map(|_| Default::default()).collect()
                } else {
                    self.points.split(strengths)
                }
            };
            let stokeslets = split(&mut layers.stokeslets).into_par_iter();
            (stokeslets.zip(split(&mut layers.stresslets)))
                .zip(&density.members)
                .zip(&density.strengths)
                .for_each(|(((stokeslets, stresslets), member), strengths)| {
                    let Member { tables, frame } = member;
                    let [single, double] = factors_of_layers(frame);
                    let single = tables.weights.single * single;
                    let double = tables.weights.double * double;
                    for (factor, singularities) in [(single, stokeslets), (double, stresslets)] {
                        if factor == 0.0 {
                            continue;
                        }
                        for (place, strength) in tables.grid().places().zip(singularities) {
                            let in_body = strengths.points.each_ref().map(|s| s[place]);
                            let in_lab = factor * frame.vector_to_lab(in_body.into());
                            *strength = std::array::from_fn(|k| strength[k] + in_lab[k]);
                        }
                    }
                });
        }
    }
}

impl Density {
    fn new(members: Vec<Member>, near: Near) -> Self {
        Self {
            batches: Batches::new(&members),
            near,
            members,
            own: Vec::new(),
            strengths: Vec::new(),
        }
    }

    /// Puts the density on the points, in the bodies' frames.
    fn spread(&mut self, densities: &[f64], fields: &Layout) {
        let (members, near) = (&self.members, &self.near);
        (self.strengths.par_iter_mut().enumerate()).for_each_init(
            || (Vec::new(), Default::default()),
            |(scratch, room), (body, strengths)| {
                let field = &densities[fields.of(body)];
                let upsampled = near.upsamplings(body).zip(&mut strengths.upsampled);
                for (upsampling, strengths) in upsampled {
                    if let Some(upsampling) = upsampling {
                        upsampling.to_points(field, room, strengths);
                    }
                }
                let grid = members[body].tables.grid();
                grid.to_points(field, scratch, &mut strengths.points);
            },
        );
    }

    /// What the sum over all points did to each body's own, from the density in `own`.
    fn sum_own_points(&mut self, fields: &Layout, uses: Use) {
        if uses == Use::Once {
            for (tables, batches) in self.batches.by_tables() {
                let matrices = tables.new_point_sum();
                batches.apply(fields, &mut self.own, |_, n, columns, scratch| {
                    multiply(&matrices, n, columns, scratch);
                });
            }
            return;
        }
        let members = &self.members;
        self.batches
            .apply(fields, &mut self.own, |body, n, columns, scratch| {
                multiply(members[body].tables.point_sum(), n, columns, scratch);
            });
    }
}
