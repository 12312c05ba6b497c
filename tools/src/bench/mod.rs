//! How fast this machine is on a scene: rays a second, and run time against error.

mod curve;
mod error;
mod picture;
mod rays;

pub(crate) use error::error;
pub(crate) use rays::rays;
