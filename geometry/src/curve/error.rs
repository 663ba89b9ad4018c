//! What can be wrong with a curve.

use thiserror::Error;

/// Shortest length a curve is built from; below it squares and cubes underflow.
pub const SHORTEST: f64 = 1e-100;
/// Longest length a curve is built from; above it squares and cubes overflow.
pub const LONGEST: f64 = 1e100;
/// Largest ratio of two lengths of one curve; beyond it no tolerance can be met in double
/// precision.
pub const LARGEST_ASPECT: f64 = 1e6;

/// Why a curve, or panels on it, cannot be made; the message names the value and what was expected.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum CurveError {
    /// A length is zero, negative, not finite, or out of the range of sensible numbers.
    #[error(
        "{quantity} must be a positive length between {SHORTEST:e} and {LONGEST:e}, got {value}"
    )]
    Length {
        /// The name of the length.
        quantity: &'static str,
        /// What was given.
        value: f64,
    },
    /// Two lengths of one curve differ too much.
    #[error(
        "{larger} {larger_value} and {smaller} {smaller_value} differ by more than a factor {LARGEST_ASPECT:e}"
    )]
    Aspect {
        /// The name of the larger length.
        larger: &'static str,
        /// Its value.
        larger_value: f64,
        /// The name of the smaller length.
        smaller: &'static str,
        /// Its value.
        smaller_value: f64,
    },
    /// A torus whose tube reaches the axis.
    #[error(
        "the torus needs minor < major (its tube must stay off the axis), got minor {minor}, major {major}"
    )]
    TubeOnAxis {
        /// Distance of the tube's centre from the axis.
        major: f64,
        /// Radius of the tube.
        minor: f64,
    },
    /// A cosine series without any coefficient.
    #[error("coefficients must not be empty")]
    NoCoefficients,
    /// A cosine series with too many terms.
    #[error("at most {limit} coefficients are accepted, got {count}")]
    TooManyCoefficients {
        /// How many were given.
        count: usize,
        /// How many are accepted.
        limit: usize,
    },
    /// A coefficient that is not a finite number of sensible size.
    #[error("coefficient {index} must be a finite number of size at most {LONGEST:e}, got {value}")]
    Coefficient {
        /// Its position, from 0.
        index: usize,
        /// What was given.
        value: f64,
    },
    /// The distance from the centre vanishes or is negative somewhere.
    #[error(
        "the distance from the centre must exceed {least:e} everywhere, but is {distance:e} at theta = {theta}"
    )]
    DistanceNotPositive {
        /// Angle from the axis, in radians.
        theta: f64,
        /// The distance there.
        distance: f64,
        /// The least that is accepted: 1e-6 of the sum of the coefficients' sizes.
        least: f64,
    },
    /// Too few points for a profile.
    #[error("a profile needs at least {least} different points, got {count}")]
    TooFewPoints {
        /// How many were given.
        count: usize,
        /// How many are needed.
        least: usize,
    },
    /// Too many points for a profile.
    #[error("a profile has at most {limit} points, got more")]
    TooManyPoints {
        /// How many are accepted.
        limit: usize,
    },
    /// A profile file that is too large to be one.
    #[error("{name}: a profile has at most {limit} bytes, this file is larger")]
    FileTooLarge {
        /// The file.
        name: String,
        /// How many bytes are accepted.
        limit: u64,
    },
    /// A profile file that cannot be read.
    #[error("{name}: {reason}")]
    Unreadable {
        /// The file.
        name: String,
        /// What the system said.
        reason: String,
    },
    /// A line of a profile file that does not hold a point.
    #[error("{name}, line {line}: expected two numbers \"r,z\", got \"{text}\"")]
    Line {
        /// The file.
        name: String,
        /// The line, from 1.
        line: usize,
        /// What the line says, shortened.
        text: String,
    },
    /// A profile point with a NaN, an infinity or an absurd size.
    #[error(
        "point {index} must have finite coordinates of size at most {LONGEST:e}, got r = {r}, z = {z}"
    )]
    PointNotFinite {
        /// Its position, from 1.
        index: usize,
        /// Its distance from the axis.
        r: f64,
        /// Its height.
        z: f64,
    },
    /// A profile point on the wrong side of the axis.
    #[error("point {index} lies at r = {r}: r must be positive between the ends of the profile")]
    PointNotOffAxis {
        /// Its position, from 1.
        index: usize,
        /// Its distance from the axis.
        r: f64,
    },
    /// Two successive profile points that coincide.
    #[error("points {index} and {} of the profile coincide, or are less than 1e-12 of its size or than 1e-100 apart", .index + 1)]
    Duplicate {
        /// Position of the first of the two, from 1.
        index: usize,
    },
    /// Steps between neighbouring profile points that differ too much for the spline.
    #[error(
        "the step after point {index} differs from the one before by a factor {ratio:.1}; at most {limit} is accepted"
    )]
    UnevenPoints {
        /// Position of the point between the two steps, from 1.
        index: usize,
        /// The ratio of the steps.
        ratio: f64,
        /// What is accepted.
        limit: f64,
    },
    /// A curve that neither ends on the axis twice nor closes.
    #[error(
        "the curve is open: it runs from (r, z) = ({r0}, {z0}) to ({r1}, {z1}); both ends must lie on the axis (r = 0), or meet off the axis"
    )]
    Open {
        /// First end.
        r0: f64,
        /// First end.
        z0: f64,
        /// Last end.
        r1: f64,
        /// Last end.
        z1: f64,
    },
    /// A curve that crosses or touches itself.
    #[error("the curve meets itself near (r, z) = ({r}, {z})")]
    SelfIntersection {
        /// Where.
        r: f64,
        /// Where.
        z: f64,
    },
    /// A curve that leaves the half plane.
    #[error("the curve must stay at r > 0 between its ends, but r = {r} at s = {s}")]
    CrossesAxis {
        /// Parameter.
        s: f64,
        /// The distance there.
        r: f64,
    },
    /// A curve that meets the axis at an angle other than a right one, so that the body has a
    /// conical tip.
    #[error(
        "the curve must meet the axis at a right angle (a smooth pole), but does not at s = {s}"
    )]
    ConicalPole {
        /// Parameter of the pole.
        s: f64,
    },
    /// A curve traversed so that the normal points into the body.
    #[error(
        "the curve is traversed backwards: (-dz/ds, dr/ds) must point out of the body (from the upper pole down)"
    )]
    Backwards,
    /// A point or tangent that is not finite.
    #[error("the curve's {quantity} is not finite at s = {s}")]
    NotFinite {
        /// "point" or "tangent".
        quantity: &'static str,
        /// Parameter.
        s: f64,
    },
    /// A tangent that vanishes.
    #[error("the curve's tangent vanishes at s = {s}: the parametrisation must be regular")]
    Stationary {
        /// Parameter.
        s: f64,
    },
    /// A tangent that is not the derivative of the point.
    #[error("the tangent given is not the derivative of the point near s = {s}")]
    WrongTangent {
        /// Parameter.
        s: f64,
    },
    /// A parameter domain that is not an ascending list of finite numbers.
    #[error(
        "the parameter domain must be two or more finite numbers in ascending order, at least 1e-12 apart in relation to its size"
    )]
    Domain,
    /// A number of panels that cannot be placed.
    #[error(
        "the number of panels must be between {least} (one per smooth piece) and {limit}, got {count}"
    )]
    PanelCount {
        /// How many were asked for.
        count: usize,
        /// How many are needed.
        least: usize,
        /// How many are accepted.
        limit: usize,
    },
    /// A number of nodes per panel that is not supported.
    #[error("the order (nodes per panel) must be between {least} and {limit}, got {order}")]
    Order {
        /// What was asked for.
        order: usize,
        /// How many are needed.
        least: usize,
        /// How many are accepted.
        limit: usize,
    },
    /// A tolerance that is no tolerance, or below what doubles can do.
    #[error("the tolerance must be between {least:e} and {limit:e}, got {tolerance:e}")]
    Tolerance {
        /// What was asked for.
        tolerance: f64,
        /// The smallest that double precision can do.
        least: f64,
        /// The largest that says anything.
        limit: f64,
    },
    /// A curve that bisection does not resolve.
    #[error(
        "panels of order {order} do not resolve the curve to {tolerance:e} near s = {s}: is it smooth there?"
    )]
    Unresolved {
        /// Parameter.
        s: f64,
        /// Nodes per panel.
        order: usize,
        /// What was asked for.
        tolerance: f64,
    },
}

/// Checks one length of a curve.
pub(super) fn length(quantity: &'static str, value: f64) -> Result<f64, CurveError> {
    // The negated comparison also catches NaN.
    if (SHORTEST..=LONGEST).contains(&value) {
        Ok(value)
    } else {
        Err(CurveError::Length { quantity, value })
    }
}

/// Checks that two lengths of a curve are not too different.
pub(super) fn aspect(
    first: (&'static str, f64),
    second: (&'static str, f64),
) -> Result<(), CurveError> {
    let (larger, smaller) = if first.1 >= second.1 {
        (first, second)
    } else {
        (second, first)
    };
    if larger.1 <= LARGEST_ASPECT * smaller.1 {
        Ok(())
    } else {
        Err(CurveError::Aspect {
            larger: larger.0,
            larger_value: larger.1,
            smaller: smaller.0,
            smaller_value: smaller.1,
        })
    }
}
