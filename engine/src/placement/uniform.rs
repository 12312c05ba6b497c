use glam::DVec2;
use rayon::prelude::*;

use super::Region;
use crate::sampling::Key;

/// Returns `count` uniform points of a region; a larger count adds points and moves none.
pub(super) fn uniform(region: &Region, count: usize, stream: Key) -> Vec<DVec2> {
    let point = |index: usize| {
        let stem = stream.index(index as u64);
        region.sample(stem.uniform(0), stem.uniform(1))
    };
    (0..count).into_par_iter().map(point).collect()
}
