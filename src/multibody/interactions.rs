//! What the bodies do to each other: the velocity of the layers of all other bodies on each.
//!
//! All points together go through one [fast sum](stokes_fmm). What it counts of a body's own points is taken away by the shape's
//! [point sums](crate::body::matrix), and points that are [near](super::near) another body are put right.

use std::time::Instant;

use panel_quadrature::QuadratureError;
use rayon::prelude::*;
use stokes_fmm::{FmmError, Output, Points, Singularities, Strengths, Stresslets};

use super::near::{self, Near};
use super::sums::{Operators, Sums};
use super::tables::{Batches, Layout, Member, multiply};
use crate::body::surface_grid::PointVectors;

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
    /// Whoever waited has lost interest.
    #[error("interrupted")]
    Interrupted,
}

/// The interactions of some bodies.
pub(crate) struct Interactions {
    members: Vec<Member>,
    batches: Batches,
    /// Where the bodies' modes are, and their points.
    fields: Layout,
    points: Layout,
    positions: Vec<[f64; 3]>,
    normals: Vec<[f64; 3]>,
    near: Near,
    sums: Sums,
    /// Wall-clock seconds of all sums so far.
    pub seconds_of_sums: f64,
    own: Vec<f64>,
    strengths: Vec<near::Strengths>,
    stokeslets: Vec<[f64; 3]>,
    stresslets: Vec<[f64; 3]>,
}

impl Interactions {
    /// The interactions to a `tolerance` at best; rows for near points take `memory` bytes at most.
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn new(
        members: Vec<Member>,
        tolerance: f64,
        memory: usize,
        operators: Operators,
        done: &(dyn Fn(usize) + Sync),
    ) -> Result<Self, InteractionError> {
        let fields = Layout::new(members.iter().map(|m| m.tables.grid.field_len()));
        let points = Layout::new(members.iter().map(|m| m.tables.grid.len()));
        let at_points = |of: &(dyn Fn(&Member, usize) -> [f64; 3] + Sync)| -> Vec<[f64; 3]> {
            (members.par_iter())
                .flat_map_iter(|member| {
                    (member.tables.grid.places()).map(move |place| of(member, place))
                })
                .collect()
        };
        let positions = at_points(&|member, place| {
            let position = member.tables.grid.position(place);
            member.frame.point_to_lab(position).into()
        });
        let normals = at_points(&|member, place| {
            let normal = member.tables.grid.normal(place);
            member.frame.vector_to_lab(normal).into()
        });
        let single = members.iter().any(|m| m.tables.weights.single != 0.0);
        let double = members.iter().any(|m| m.tables.weights.double != 0.0);
        let singularities = match (single, double) {
            (true, true) => Singularities::Both,
            (true, false) => Singularities::Stokeslets,
            _ => Singularities::Stresslets,
        };
        let room = |used: bool| vec![[0.0; 3]; if used { points.len() } else { 0 }];
        let near = Near::new(&members, tolerance, memory, done)?;
        let strengths = members
            .iter()
            .enumerate()
            .map(|(body, member)| near::Strengths {
                points: member.tables.grid.vectors(),
                upsampled: (member.tables.upsamplings.iter().enumerate())
                    .map(|(level, upsampling)| {
                        if near.is_upsampled(body, level) {
                            upsampling.grid.vectors()
                        } else {
                            PointVectors::default()
                        }
                    })
                    .collect(),
            });
        let strengths = strengths.collect();
        Ok(Self {
            near,
            batches: Batches::new(&members),
            own: vec![0.0; fields.len()],
            strengths,
            stokeslets: room(single),
            stresslets: room(double),
            sums: Sums::new(operators, singularities, Output::Velocity, tolerance),
            seconds_of_sums: 0.0,
            members,
            fields,
            points,
            positions,
            normals,
        })
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

    /// Points of all bodies.
    pub fn points(&self) -> usize {
        self.points.len()
    }

    /// Adds to the modes in `velocities` what the `densities` of all other bodies do; both are scaled by the roots of the weights. The error is about
    /// `tolerance` relative to all velocities that the densities make, in the Euclidean norm.
    ///
    /// # Errors
    /// If a density is not finite.
    pub fn add_velocities(
        &mut self,
        densities: &[f64],
        velocities: &mut [f64],
        tolerance: f64,
    ) -> Result<(), InteractionError> {
        self.spread(densities);
        let strengths = Strengths {
            stokeslets: (!self.stokeslets.is_empty()).then_some(&self.stokeslets[..]),
            stresslets: (!self.stresslets.is_empty()).then_some(Stresslets {
                densities: &self.stresslets,
                normals: &self.normals,
            }),
            ..Strengths::default()
        };
        let start = Instant::now();
        let points = Points::same(&self.positions);
        let mut velocity = self.sums.apply(points, &strengths, tolerance)?.velocity;
        self.seconds_of_sums += start.elapsed().as_secs_f64();
        self.own.copy_from_slice(densities);
        let members = &self.members;
        self.batches
            .apply(&self.fields, &mut self.own, |body, n, columns, scratch| {
                multiply(&members[body].tables.point_sum, n, columns, scratch);
            });
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
                    for (place, velocity) in tables.grid.places().zip(at_points.iter()) {
                        let turned = frame.vector_to_body((*velocity).into());
                        for k in 0..3 {
                            in_body[k][place] = turned[k];
                        }
                    }
                    tables.grid.add_modes(in_body, scratch, modes);
                    for (mode, own) in modes.iter_mut().zip(&own[fields.of(body)]) {
                        *mode -= own;
                    }
                    Ok(())
                },
            )
    }

    /// Puts the densities on the points: in the bodies' frames, and as singularities in the laboratory.
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
        let (stokeslets, stresslets) = (split(&mut self.stokeslets), split(&mut self.stresslets));
        let singularities = stokeslets.into_par_iter().zip(stresslets);
        (self.strengths.par_iter_mut())
            .zip(singularities)
            .enumerate()
            .for_each_init(
                || (Vec::new(), Default::default()),
                |(scratch, room), (body, (strengths, (mut stokeslets, mut stresslets)))| {
                    let Member { tables, frame } = &members[body];
                    let (grid, field) = (&tables.grid, &densities[fields.of(body)]);
                    let upsampled = tables.upsamplings.iter().zip(&mut strengths.upsampled);
                    for (level, (upsampling, strengths)) in upsampled.enumerate() {
                        if near.is_upsampled(body, level) {
                            upsampling.to_points(field, room, strengths);
                        }
                    }
                    let strengths = &mut strengths.points;
                    grid.to_points(field, scratch, strengths);
                    // Of shares of the surface, the square of the scale; a single layer's density has the inverse of the scale. The
                    // sum's stresslet has the other sign.
                    let scale = frame.scale();
                    let [single, double] = [
                        tables.weights.single * scale,
                        -tables.weights.double * scale * scale,
                    ];
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
