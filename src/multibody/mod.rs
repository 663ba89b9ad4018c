//! Several bodies: where they are in relation to each other.
//!
//! | module | what |
//! |---|---|
//! | [`contact`] | gaps between bodies, contact and overlap |

pub mod contact;
mod descent;
mod meridian;
