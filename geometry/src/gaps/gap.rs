//! What is told of two bodies: their distance or depth, where it is measured, and how they lie.

use std::fmt;

use nalgebra::{Point3, Vector3};
use thiserror::Error;

use crate::curve::CurveError;

/// Distance, in units of the larger body's size, up to which bodies touch: rounding of their
/// coordinates.
pub const TOUCHING: f64 = 1e-12;

/// How two bodies lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// They are disjoint.
    Apart,
    /// They are no farther apart than [`TOUCHING`], and no deeper in each other.
    Touching,
    /// Their surfaces cross.
    Overlapping,
    /// The body with this index is inside the other one.
    Inside(usize),
}

/// The penetration depth of two bodies with common inner points, or a bound of it.
///
/// The penetration depth is the length of the smallest translation of one body that leaves no
/// common inner point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Depth {
    /// The penetration depth, in the units of the laboratory. Pairs of convex bodies have it.
    Exact(f64),
    /// A lower bound of the penetration depth, in the units of the laboratory: the depth of one
    /// point of a body below the surface of the other. Pairs that are not both convex have it.
    // Proof: a point at depth d is the centre of a ball of radius d in the other body. A
    // translation shorter than d keeps the point in this ball, and so the bodies still overlap.
    AtLeast(f64),
}

impl Depth {
    /// A length that the penetration depth is not smaller than: the depth itself where it is known.
    pub fn lower_bound(self) -> f64 {
        let (Self::Exact(depth) | Self::AtLeast(depth)) = self;
        depth
    }
}

/// The number in scientific notation, and "or more" after a lower bound.
impl fmt::LowerExp for Depth {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::LowerExp::fmt(&self.lower_bound(), f)?;
        match self {
            Self::Exact(_) => Ok(()),
            Self::AtLeast(_) => f.write_str(" or more"),
        }
    }
}

/// Two bodies that are near each other; all lengths and vectors are in the laboratory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The bodies' indices, the smaller one first.
    pub bodies: [usize; 2],
    /// The signed distance of the bodies.
    ///
    /// It is the smallest distance of a point of one from a point of the other if the bodies are
    /// [apart](Relation::Apart). If they overlap or one is inside the other, it is minus the number
    /// in [`depth`](Self::depth): the signed distance itself for [`Depth::Exact`], an upper bound
    /// of it for [`Depth::AtLeast`].
    ///
    /// For convex bodies $A$ and $B$ this is
    /// $\max_n (\min_{x \in B} n \cdot x - \max_{x \in A} n \cdot x)$ over the unit vectors $n$, a
    /// continuous function of their places on both sides of contact.
    pub distance: f64,
    /// How deep the bodies are in each other; none if they are apart or touch.
    pub depth: Option<Depth>,
    /// A point of each body's surface, as far from each other as `distance` says.
    ///
    /// For [`Depth::Exact`] they are the points that touch last when the bodies are separated by
    /// the smallest translation, which is along the segment between the points. Each lies in the
    /// other body or on it while the overlap is shallow. Deeper that need not be: a needle that
    /// pierces a wide disc comes out along its axis, and its tip is outside the disc.
    ///
    /// For [`Depth::AtLeast`] one is a point below the surface of the other body, and the other is
    /// its nearest point of that surface.
    pub points: [Point3<f64>; 2],
    /// The outward unit normals of the two surfaces at `points`. They are opposite to about 1e-9,
    /// except for [`Depth::AtLeast`], where they need not be.
    pub normals: [Vector3<f64>; 2],
    /// How they lie.
    pub relation: Relation,
}

impl Gap {
    /// Refuses bodies that are not apart, or nearer than `needed`, a length in the laboratory.
    ///
    /// # Errors
    /// How they lie, if so.
    pub fn check(&self, needed: f64) -> Result<(), ContactError> {
        let [first, second] = self.bodies;
        match self.relation {
            Relation::Apart if self.distance >= needed => Ok(()),
            Relation::Apart => Err(ContactError::Near {
                first,
                second,
                distance: self.distance,
                needed,
            }),
            Relation::Touching => Err(ContactError::Touch { first, second }),
            Relation::Overlapping => Err(ContactError::Overlap {
                first,
                second,
                depth: self.depth.unwrap_or(Depth::AtLeast(-self.distance)),
            }),
            Relation::Inside(inner) => Err(ContactError::Inside {
                inner,
                outer: first + second - inner,
            }),
        }
    }
}

/// What is wrong with the places of bodies; they are named by their index in the slice, `bodies[0]`
/// first.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ContactError {
    /// A generating curve without a finite point and a direction everywhere.
    #[error("bodies[{body}]: {source}")]
    Curve {
        /// The first body with it.
        body: usize,
        /// What is wrong with it.
        source: CurveError,
    },
    /// A number out of range.
    #[error("bodies[{body}]: {quantity} must be {expected}, got {value}")]
    Place {
        /// The body.
        body: usize,
        /// Which number.
        quantity: &'static str,
        /// What is accepted.
        expected: &'static str,
        /// What was given.
        value: f64,
    },
    /// Bodies that touch.
    #[error("bodies[{first}] and bodies[{second}] touch, but must be apart")]
    Touch {
        /// One.
        first: usize,
        /// The other.
        second: usize,
    },
    /// Bodies that overlap.
    #[error("bodies[{first}] and bodies[{second}] overlap by {depth:.3e}, but must be apart")]
    Overlap {
        /// One.
        first: usize,
        /// The other.
        second: usize,
        /// How deep they are in each other.
        depth: Depth,
    },
    /// A body inside another.
    #[error("bodies[{inner}] is inside bodies[{outer}], but must be apart from it")]
    Inside {
        /// The one inside.
        inner: usize,
        /// The one around it.
        outer: usize,
    },
    /// Bodies that are too near each other.
    #[error(
        "bodies[{first}] and bodies[{second}] are {distance:.3e} apart, but must be {needed:.3e}"
    )]
    Near {
        /// One.
        first: usize,
        /// The other.
        second: usize,
        /// Their distance.
        distance: f64,
        /// What is needed.
        needed: f64,
    },
}
