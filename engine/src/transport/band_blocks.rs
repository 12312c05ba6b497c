//! Blocks of bands that are evaluated at a time.

use std::ops::Range;

/// Bands that are computed at a time: few enough that their sums stay in registers and in the first-level
/// cache, however many bands a scene has.
pub(in crate::transport) const BLOCK: usize = 64;

/// Values in up to [`BLOCK`] bands.
pub(in crate::transport) type Block = [f64; BLOCK];

/// Ranges of at most [`BLOCK`] bands that cover `bands`.
pub(in crate::transport) fn blocks(bands: Range<usize>) -> impl Iterator<Item = Range<usize>> {
    let end = bands.end;
    bands.step_by(BLOCK).map(move |start| start..(start + BLOCK).min(end))
}
