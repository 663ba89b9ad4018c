//! What a picture may show.

/// What the colours show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quantity {
    /// The magnitude of the velocity, its component across the plane included: from zero to the
    /// largest.
    #[default]
    Speed,
    /// The pressure: the same up and down from zero, and so far that only one point in a thousand
    /// lies beyond; where any do, the bar of the colours ends in a point.
    Pressure,
    /// The same as the speed, of the flow without the undisturbed one.
    Disturbance,
}
