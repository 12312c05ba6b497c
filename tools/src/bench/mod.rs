//! Speed of this machine on a scene: rays per second, and run time against error.

mod curve;
mod error;
mod picture;
mod rays;

pub(crate) use error::error;
pub(crate) use rays::rays;
