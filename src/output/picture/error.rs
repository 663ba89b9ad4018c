//! Why there is no picture.

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PictureError {
    /// No point of the plane lies in the fluid.
    #[error(
        "nothing to draw: the plane lies inside the body, expected one that reaches into the fluid"
    )]
    NoFluid,
    /// A value is infinite or not a number.
    #[error("cannot draw the picture: the flow is not finite everywhere in the plane")]
    NotFinite,
    /// The image of the colours cannot be encoded.
    #[error("cannot draw the picture: {0}")]
    Image(String),
    /// No font for numbers and names.
    #[cfg(feature = "png")]
    #[error(
        "cannot draw a PNG: no font was found on this machine, expected one for the numbers; SVG needs none"
    )]
    NoFont,
}
