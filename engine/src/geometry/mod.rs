//! Small geometry that several modules share: frames, bounds, outward rounding, places in messages.

mod bounds;
mod frame;
mod millimetres;
mod pixels;
mod polygon;
mod rounding;

pub use bounds::Bounds;
pub use frame::basis;
pub use millimetres::{millimetres, place_text};
pub use pixels::PixelGrid;
pub use polygon::{Polygon, Rectangle};
pub use rounding::{round_down, round_up};
