//! Which bodies are near each other, and how the bodies of a pair lie.
//!
//! Pairs that may be near are found by their bounding spheres. Of a pair the nearest points are
//! searched. If the search ends at a point of one body inside the other, the depth is determined.
//! Bodies with disjoint surfaces are one inside the other or not: one point tells.

use rayon::prelude::*;

use super::deepest::{deepest, is_inside};
use super::depth::penetration;
use super::descent::Pair;
use super::gap::{ContactError, Depth, Gap, Relation, TOUCHING};
use super::meridian::{Foot, Located, Shape};
use super::patches::{Nearest, nearest};
use super::placed::Placed;
use crate::neighbours::{Ball, Neighbours};

/// The pairs of bodies whose gap is within reach, those that touch or overlap among them; in the
/// order of their indices.
///
/// Distances, and depths that are exact, are good to about 1e-13 of the bodies' sizes, and of their
/// coordinates. Bodies with the same curve in memory share what is prepared.
///
/// # Errors
/// Curves with a point or tangent that is not finite or a tangent that vanishes; places that are
/// not finite, scales that are not positive, reaches that are negative.
pub fn gaps(bodies: &[Placed<'_>]) -> Result<Vec<Gap>, ContactError> {
    let mut shapes: Vec<Shape<'_>> = Vec::new();
    let mut known = std::collections::HashMap::new();
    let mut which = Vec::with_capacity(bodies.len());
    for (body, placed) in bodies.iter().enumerate() {
        placed.validate(body)?;
        // The type's table belongs to the key: curves without fields may share an address.
        let shape = match known.get(&std::ptr::from_ref(placed.curve)) {
            Some(&shape) => shape,
            None => {
                let shape = Shape::new(placed.curve)
                    .map_err(|source| ContactError::Curve { body, source })?;
                shapes.push(shape);
                known.insert(std::ptr::from_ref(placed.curve), shapes.len() - 1);
                shapes.len() - 1
            }
        };
        which.push(shape);
    }
    let located: Vec<_> = bodies
        .iter()
        .zip(&which)
        .map(|(placed, &shape)| Located {
            shape: &shapes[shape],
            frame: placed.frame.scaled(1.0),
            scale: placed.frame.scale(),
        })
        .collect();
    let reach = |i: usize, j: usize| bodies[i].reach.max(bodies[j].reach);
    let near = candidates(&located, |i| bodies[i].reach);
    let found = near
        .par_iter()
        .filter_map(|&[i, j]| gap(&located, [i, j], reach(i, j)));
    Ok(found.collect())
}

/// Pairs whose bounding spheres are within reach, in order.
fn candidates(bodies: &[Located<'_>], reach: impl Fn(usize) -> f64) -> Vec<[usize; 2]> {
    let balls = bodies.iter().map(|body| Ball {
        center: body.center(),
        radius: body.radius(),
    });
    let neighbours = Neighbours::new(balls);
    let near = neighbours.balls().iter().enumerate().flat_map(|(i, ball)| {
        let touching = neighbours.touching(ball.grown(reach(i))).into_iter();
        touching
            .filter(move |&j| j != i)
            .map(move |j| [i.min(j), i.max(j)])
    });
    let mut pairs: Vec<[usize; 2]> = near.collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// Two bodies of different roles: the surface of the smaller one is searched.
struct Roles<'a> {
    bodies: [usize; 2],
    /// Whether the smaller one has the larger index.
    swapped: bool,
    smaller: &'a Located<'a>,
    larger: &'a Located<'a>,
}

/// The gap of two bodies, if it is within reach.
fn gap(bodies: &[Located<'_>], pair: [usize; 2], reach: f64) -> Option<Gap> {
    let swapped = bodies[pair[0]].radius() > bodies[pair[1]].radius();
    let [i, j] = if swapped { [pair[1], pair[0]] } else { pair };
    let roles = Roles {
        bodies: pair,
        swapped,
        smaller: &bodies[i],
        larger: &bodies[j],
    };
    let (smaller, larger) = (roles.smaller, roles.larger);
    let coordinates = [smaller, larger].map(|body| body.center().coords.amax());
    let rounding = 4.0 * f64::EPSILON * coordinates[0].max(coordinates[1]);
    let touching = TOUCHING * larger.radius() + rounding;

    let deep = |known: Pair| {
        let relation = if is_inside(smaller, larger) {
            Relation::Inside(i)
        } else if is_inside(larger, smaller) {
            Relation::Inside(j)
        } else {
            Relation::Overlapping
        };
        roles.deep(known, relation)
    };
    let found = match nearest(smaller, larger, reach.max(touching)) {
        Nearest::Crossing(point) => return Some(deep(Pair::at(smaller, larger, point))),
        Nearest::Points(pair) if pair.distance() < -touching => return Some(deep(pair)),
        // Surfaces that touch from the same side: one body is inside the other.
        Nearest::Points(pair) if pair.distance() <= touching && pair.same_side() => {
            return Some(deep(pair));
        }
        Nearest::Points(pair) => Some(pair),
        Nearest::Nothing => None,
    };
    let shallow = |pair: Pair, relation| {
        roles.gap(
            pair.distance(),
            None,
            [pair.on_first, pair.on_second],
            relation,
        )
    };
    if let Some(pair) = found.filter(|pair| pair.distance() <= touching) {
        return Some(shallow(pair, Relation::Touching));
    }
    let on_larger = larger.at(0.0, 0.0).0;
    let in_sphere = (on_larger - smaller.center()).norm() <= smaller.radius();
    if in_sphere && smaller.foot(on_larger).distance <= 0.0 {
        let known = Pair::at(larger, smaller, on_larger).reversed();
        return Some(roles.deep(known, Relation::Inside(j)));
    }
    found.map(|pair| shallow(pair, Relation::Apart))
}

impl Roles<'_> {
    /// The gap of bodies with common inner points, of which `known` is one.
    fn deep(&self, known: Pair, relation: Relation) -> Gap {
        let (smaller, larger) = (self.smaller, self.larger);
        if smaller.is_convex() && larger.is_convex() {
            let contact = penetration(smaller, larger);
            let depth = Depth::Exact(contact.depth);
            let feet = [contact.on_first, contact.on_second];
            return self.gap(-contact.depth, Some(depth), feet, relation);
        }
        let (depth, feet) = deepest(smaller, larger, known);
        self.gap(-depth, Some(Depth::AtLeast(depth)), feet, relation)
    }

    fn gap(
        &self,
        distance: f64,
        depth: Option<Depth>,
        mut feet: [Foot; 2],
        relation: Relation,
    ) -> Gap {
        if self.swapped {
            feet.reverse();
        }
        Gap {
            bodies: self.bodies,
            distance,
            depth,
            points: feet.map(|foot| foot.point),
            normals: feet.map(|foot| foot.normal),
            relation,
        }
    }
}
