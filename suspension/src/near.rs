//! Points of one body that are near another: where the sum over points does not resolve what some
//! panels do.
//!
//! There a sum over [more points](super::upsampling) takes the place of the panels' points or,
//! nearer still, the panels' exact action. That is a linear map of the density: its rows are kept
//! where memory allows, and made anew each time where it does not.

use std::sync::Arc;

use bodies_of_revolution::{Ball, Meridian, Neighbours};
use nalgebra::{Point3, Vector3};
use panel_quadrature::QuadratureError;
use rayon::prelude::*;

use super::tables::{Member, Tables};
use super::upsampling::{self, Upsampling};
use stokes_body::far::Separation;
use stokes_body::influence::Buffers;
use stokes_body::surface_grid::PointVectors;

/// The points of one body that are near one other body.
#[derive(Debug)]
pub(crate) struct Visit {
    /// The other body.
    source: usize,
    /// Ring after ring about the other body's axis, the points on it: their numbers among those of
    /// their own body, and where they are in the frame of the other body.
    points: Vec<(usize, Point3<f64>)>,
    rings: Vec<NearRing>,
    /// The panels of all rings that are done exactly.
    panels: Vec<u32>,
    /// The panels of all rings that are done with more points, and with which of the upsamplings.
    finer: Vec<(u32, usize)>,
}

/// Points at one radius and height about the other body's axis: they have the same rows. Bodies on
/// one axis have hardly anything else.
#[derive(Clone, Copy, Debug)]
struct NearRing {
    /// How many of the points are on it, and how many of the panels of both kinds are its own.
    points: usize,
    panels: usize,
    finer: usize,
}

/// Difference of radius and height, in units of the body's size, of points on one ring.
const GRAIN: f64 = 1e-14;

/// All that is near, body by body. It is a matter of places and points: all layers on them share
/// it.
#[derive(Debug)]
struct Places {
    visits: Vec<Vec<Visit>>,
    /// Those upsamplings of each body that are used.
    upsampled: Vec<[Option<Arc<Upsampling>>; upsampling::LEVELS]>,
}

/// All that is near, and what layers of one kind do there.
#[derive(Debug)]
pub(crate) struct Near {
    places: Arc<Places>,
    /// The rows of each visit, or none if they are made each time.
    rows: Vec<Vec<Option<Vec<f64>>>>,
    /// Bytes of the rows that are kept.
    pub stored: usize,
}

/// A body's density at its points, and at more of them.
#[derive(Debug)]
pub(crate) struct Strengths {
    pub points: PointVectors,
    pub upsampled: Vec<PointVectors>,
}

/// A thread's buffers.
#[derive(Debug, Default)]
struct Room {
    buffers: Buffers,
    rows: Vec<f64>,
}

impl Near {
    /// Finds what the points do not resolve to `tolerance`, and makes the rows as far as they fit
    /// into `memory` bytes.
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn new(
        members: &[Member],
        tolerance: f64,
        memory: usize,
        done: &(dyn Fn(usize) + Sync),
    ) -> Result<Self, QuadratureError> {
        let places = Arc::new(Places::new(members, tolerance)?);
        Self::at(places, members, memory, done)
    }

    /// The same for other layers on the same points.
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn of_layers(&self, members: &[Member], memory: usize) -> Result<Self, QuadratureError> {
        Self::at(self.places.clone(), members, memory, &|_| ())
    }

    fn at(
        places: Arc<Places>,
        members: &[Member],
        memory: usize,
        done: &(dyn Fn(usize) + Sync),
    ) -> Result<Self, QuadratureError> {
        let mut stored = 0;
        let mut rows = Vec::with_capacity(places.visits.len());
        for visits in &places.visits {
            let mut of_body = Vec::with_capacity(visits.len());
            for visit in visits {
                let bytes = 8 * visit.len(members)?;
                let is_kept = stored + bytes <= memory;
                stored += if is_kept { bytes } else { 0 };
                of_body.push(is_kept.then(Vec::new));
            }
            rows.push(of_body);
        }
        let fill = |room: &mut Room, (visits, rows): (&Vec<Visit>, &mut Vec<Option<Vec<f64>>>)| {
            for (visit, rows) in visits.iter().zip(rows) {
                if let Some(rows) = rows {
                    visit.fill(members, room, rows)?;
                }
            }
            done(1);
            Ok(())
        };
        (places.visits.par_iter().zip(&mut rows)).try_for_each_init(Room::default, fill)?;
        Ok(Self {
            places,
            rows,
            stored,
        })
    }

    /// The upsamplings of a body that are used.
    pub fn upsamplings(&self, body: usize) -> impl Iterator<Item = Option<&Upsampling>> {
        self.places.upsampled[body].iter().map(Option::as_deref)
    }

    /// Room for a body's density at its points, and at those of the upsamplings that are used.
    pub fn strengths(&self, members: &[Member], body: usize) -> Strengths {
        let upsampled = self.upsamplings(body).map(|upsampling| {
            upsampling.map_or_else(PointVectors::default, |it| it.grid.vectors())
        });
        Strengths {
            points: members[body].tables.grid().vectors(),
            upsampled: upsampled.collect(),
        }
    }

    /// Adds, to the velocities of a body's points in the laboratory (`velocity(point)`), what is
    /// exact less what the points of the panels do: `field` and `strengths` are the densities of
    /// all bodies, as modes and at their points.
    pub fn correct<'f>(
        &self,
        members: &[Member],
        body: usize,
        field: impl Fn(usize) -> &'f [f64],
        strengths: &[Strengths],
        velocity: &mut [[f64; 3]],
    ) -> Result<(), QuadratureError> {
        let mut room = Room::default();
        let places = &self.places;
        for (visit, rows) in places.visits[body].iter().zip(&self.rows[body]) {
            visit.correct(
                members,
                rows.as_deref(),
                field(visit.source),
                &strengths[visit.source],
                &places.upsampled[visit.source],
                velocity,
                &mut room,
            )?;
        }
        Ok(())
    }

    /// Points that are near another body, counted once for each.
    pub fn points(&self) -> usize {
        let visits = self.places.visits.iter().flatten();
        visits.map(|visit| visit.points.len()).sum()
    }
}

impl Places {
    fn new(members: &[Member], tolerance: f64) -> Result<Self, QuadratureError> {
        // Made once for all bodies that are alike.
        let mut alike: Vec<(&Arc<Tables>, Arc<Separations>)> = Vec::new();
        let mut surroundings: Vec<Surrounding> = Vec::with_capacity(members.len());
        for Member { tables, frame } in members {
            let known = alike.iter().find(|(other, _)| Arc::ptr_eq(other, tables));
            let separations = match known {
                Some((_, known)) => known.clone(),
                None => {
                    let made = Arc::new(Separations::new(tables, tolerance));
                    alike.push((tables, made.clone()));
                    made
                }
            };
            surroundings.push(Surrounding::new(separations, frame.scale()));
        }
        let neighbours = Neighbours::new((members.iter().zip(&surroundings)).map(
            |(member, around)| Ball {
                center: member.frame.center(),
                radius: around.radius + around.reach,
            },
        ));
        let visits: Vec<Vec<Visit>> = (0..members.len())
            .into_par_iter()
            .map(|body| visits(members, &surroundings, &neighbours, body))
            .collect();
        let mut upsampled = vec![[const { None }; upsampling::LEVELS]; members.len()];
        for visit in visits.iter().flatten() {
            for &(_, level) in &visit.finer {
                let used = &mut upsampled[visit.source][level];
                if used.is_none() {
                    *used = Some(members[visit.source].tables.upsampling(level)?);
                }
            }
        }
        Ok(Self { visits, upsampled })
    }
}

/// From where on a shape is resolved, in its frame.
struct Separations {
    points: Separation,
    /// With more points, from few to many.
    finer: Vec<Separation>,
    /// Of the sphere about the centre that the shape fits in.
    radius: f64,
    /// The distance from that sphere beyond which everything is resolved.
    reach: f64,
}

impl Separations {
    fn new(tables: &Tables, tolerance: f64) -> Self {
        let points = Separation::of_resolved(
            &tables.discretization,
            tables.n_max,
            [tables.discretization.order(), tables.grid().azimuths()],
            tolerance,
        );
        let finer = (0..upsampling::LEVELS).map(|level| {
            upsampling::separation(&tables.discretization, tables.n_max, level, tolerance)
        });
        let radius = tables.discretization.size();
        Self {
            reach: points.reach(radius),
            radius,
            finer: finer.collect(),
            points,
        }
    }
}

/// The same of a body, its lengths in the laboratory.
struct Surrounding {
    separations: Arc<Separations>,
    radius: f64,
    reach: f64,
}

impl Surrounding {
    fn new(separations: Arc<Separations>, scale: f64) -> Self {
        Self {
            radius: scale * separations.radius,
            reach: scale * separations.reach,
            separations,
        }
    }
}

/// The other bodies that points of a body are near.
fn visits(
    members: &[Member],
    surroundings: &[Surrounding],
    neighbours: &Neighbours,
    body: usize,
) -> Vec<Visit> {
    let member = &members[body];
    let near = neighbours.touching(Ball {
        center: member.frame.center(),
        radius: surroundings[body].radius,
    });
    let grid = member.tables.grid();
    let points: Vec<Point3<f64>> = (grid.places())
        .map(|place| member.frame.point_to_lab(grid.position(place)))
        .collect();
    let others = near.into_iter().filter(|&source| source != body);
    let visits =
        others.map(|source| visit(&points, source, &members[source], &surroundings[source]));
    visits.filter(|visit| !visit.points.is_empty()).collect()
}

/// Those of some points in the laboratory that are near one body.
fn visit(points: &[Point3<f64>], source: usize, other: &Member, around: &Surrounding) -> Visit {
    let discretization = &other.tables.discretization;
    let panels = 0..discretization.panels().len();
    let beyond = (around.radius + around.reach).powi(2);
    let grain = GRAIN * discretization.size();
    let mut near: Vec<([i64; 2], usize, Point3<f64>)> = Vec::new();
    for (index, point) in points.iter().enumerate() {
        if (point - other.frame.center()).norm_squared() > beyond {
            continue;
        }
        let at = other.frame.point_to_body(*point);
        let seen = Meridian::of(&at);
        let is_kept = |panel| {
            around
                .separations
                .points
                .is_kept(discretization, seen, panel)
        };
        if !panels.clone().all(is_kept) {
            let ring = [seen.r, seen.z].map(|x| (x / grain).round() as i64);
            near.push((ring, index, at));
        }
    }
    near.sort_unstable_by_key(|&(ring, index, _)| (ring, index));
    let mut visit = Visit {
        source,
        points: Vec::new(),
        rings: Vec::new(),
        panels: Vec::new(),
        finer: Vec::new(),
    };
    for ring in near.chunk_by(|a, b| a.0 == b.0) {
        let seen = Meridian::of(&ring[0].2);
        let before = [visit.panels.len(), visit.finer.len()];
        for panel in panels.clone() {
            let keeps = |separation: &Separation| separation.is_kept(discretization, seen, panel);
            if keeps(&around.separations.points) {
                continue;
            }
            match around.separations.finer.iter().position(keeps) {
                Some(level) => visit.finer.push((panel as u32, level)),
                None => visit.panels.push(panel as u32),
            }
        }
        let panels = visit.panels.len() - before[0];
        let finer = visit.finer.len() - before[1];
        if panels + finer > 0 {
            visit.rings.push(NearRing {
                points: ring.len(),
                panels,
                finer,
            });
            visit
                .points
                .extend(ring.iter().map(|&(_, index, at)| (index, at)));
        }
    }
    visit
}

impl Visit {
    /// How many numbers all rows together have.
    fn len(&self, members: &[Member]) -> Result<usize, QuadratureError> {
        let tables = &members[self.source].tables;
        let influence = tables.influence()?;
        Ok(influence.len(&tables.discretization, self.panels.len()))
    }

    /// Makes the rows.
    fn fill(
        &self,
        members: &[Member],
        room: &mut Room,
        rows: &mut Vec<f64>,
    ) -> Result<(), QuadratureError> {
        rows.resize(self.len(members)?, 0.0);
        let tables = &members[self.source].tables;
        let influence = tables.influence()?;
        let (mut points, mut panels) = (&self.points[..], &self.panels[..]);
        let mut rest = &mut rows[..];
        for ring in &self.rings {
            let (on_ring, other_points) = points.split_at(ring.points);
            let (own, others) = panels.split_at(ring.panels);
            (points, panels) = (other_points, others);
            if own.is_empty() {
                continue;
            }
            let length = influence.len(&tables.discretization, own.len());
            let (rows, others_rows) = std::mem::take(&mut rest).split_at_mut(length);
            influence.fill(
                &tables.discretization,
                tables.weights,
                on_ring[0].1,
                own,
                &mut room.buffers,
                rows,
            )?;
            rest = others_rows;
        }
        Ok(())
    }

    #[expect(clippy::too_many_arguments, reason = "one step of `Near::correct`")]
    fn correct(
        &self,
        members: &[Member],
        mut kept: Option<&[f64]>,
        field: &[f64],
        strengths: &Strengths,
        upsampled: &[Option<Arc<Upsampling>>],
        velocity: &mut [[f64; 3]],
        room: &mut Room,
    ) -> Result<(), QuadratureError> {
        let member = &members[self.source];
        let tables = &member.tables;
        let (influence, discretization) = (tables.influence()?, &tables.discretization);
        let (mut points, mut panels) = (&self.points[..], &self.panels[..]);
        let mut finer = &self.finer[..];
        for ring in &self.rings {
            let (on_ring, other_points) = points.split_at(ring.points);
            let (own, others) = panels.split_at(ring.panels);
            let (own_finer, other_finer) = finer.split_at(ring.finer);
            (points, panels, finer) = (other_points, others, other_finer);
            let length = influence.len(discretization, own.len());
            let rows = match &mut kept {
                Some(rows) => {
                    let (mine, others) = rows.split_at(length);
                    *rows = others;
                    mine
                }
                None if own.is_empty() => &[],
                None => {
                    room.rows.resize(length, 0.0);
                    influence.fill(
                        discretization,
                        tables.weights,
                        on_ring[0].1,
                        own,
                        &mut room.buffers,
                        &mut room.rows[..length],
                    )?;
                    &room.rows[..length]
                }
            };
            for &(index, at) in on_ring {
                let of_points = |panel: u32| {
                    let (panel, strengths) = (panel as usize, &strengths.points);
                    tables
                        .grid()
                        .panel_velocity(panel, tables.weights, strengths, at)
                };
                let mut better = Vector3::zeros();
                if !own.is_empty() {
                    better += influence.velocity(discretization, rows, own, field, at);
                }
                for &panel in own {
                    better -= of_points(panel);
                }
                for &(panel, level) in own_finer {
                    if let Some(upsampling) = &upsampled[level] {
                        let of_more = upsampling.grid.panel_velocity(
                            panel as usize,
                            tables.weights,
                            &strengths.upsampled[level],
                            at,
                        );
                        better += of_more - of_points(panel);
                    }
                }
                let correction = member.frame.vector_to_lab(better);
                for k in 0..3 {
                    velocity[index][k] += correction[k];
                }
            }
        }
        Ok(())
    }
}
