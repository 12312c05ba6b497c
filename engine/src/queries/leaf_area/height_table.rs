//! Area of a mesh below any height, without a look at most of its surfaces.

use std::f64::consts::PI;
use std::ops::Range;

use crate::queries::surfaces::{FlatPatch, SurfaceTree};

/// Surfaces of a tree by height in object space, in slices of equal height.
///
/// A plane at a height cuts the surfaces of one slice. All others lie below or above it, and the area of those below is
/// a sum that is known. Fractions of a surface's area below a height do not depend on how an upright instance is
/// scaled; areas do, and are given.
#[derive(Debug)]
pub(super) struct HeightTable {
    low: f64,
    high: f64,
    slices_per_m: f64,
    /// First entry of each slice, and the number of entries at the end.
    starts: Vec<u32>,
    entries: Vec<Entry>,
}

/// A surface that reaches into a slice.
#[derive(Clone, Copy, Debug)]
struct Entry {
    /// Place of the surface in the order of its tree.
    place: u32,
    span: SurfaceHeights,
}

/// Heights of a surface, m, object space.
#[derive(Clone, Copy, Debug)]
enum SurfaceHeights {
    /// Corners from low to high.
    Triangle([f32; 3]),
    /// Centre, and distance of the lowest and highest point from it.
    Disc(f32, f64),
}

/// Slices of a table, at most.
const MOST_SLICES: f64 = 65_536.0;

impl HeightTable {
    pub(super) fn new(tree: &SurfaceTree<'_>) -> Self {
        let spans: Vec<SurfaceHeights> =
            (0..tree.len()).map(|place| SurfaceHeights::new(&tree.patch(place))).collect();
        let ranges = || spans.iter().map(SurfaceHeights::range);
        let (low, high) = ranges().fold((f64::INFINITY, f64::NEG_INFINITY), |all, (low, high)| {
            (all.0.min(low), all.1.max(high))
        });
        let mean = ranges().map(|(low, high)| high - low).sum::<f64>() / spans.len() as f64;
        // Horizontal surfaces have no height.
        let slices = if mean > 0.0 { (high - low) / mean } else { MOST_SLICES };
        let slices = if high > low { slices.clamp(1.0, MOST_SLICES).floor() } else { 1.0 };
        let slices_per_m = if high > low { slices / (high - low) } else { 0.0 };
        let mut table = Self {
            low,
            high,
            slices_per_m,
            starts: vec![0; slices as usize + 1],
            entries: Vec::new(),
        };
        for span in &spans {
            for slice in table.slices_of(span) {
                table.starts[slice + 1] += 1;
            }
        }
        for slice in 1..table.starts.len() {
            table.starts[slice] += table.starts[slice - 1];
        }
        let mut next = table.starts.clone();
        let all = next.last().copied().unwrap_or(0) as usize;
        table.entries = vec![Entry { place: 0, span: SurfaceHeights::Disc(0.0, 0.0) }; all];
        for (place, &span) in spans.iter().enumerate() {
            for slice in table.slices_of(&span) {
                table.entries[next[slice] as usize] = Entry { place: place as u32, span };
                next[slice] += 1;
            }
        }
        table
    }

    fn slice(&self, height: f64) -> usize {
        let slice = (height - self.low) * self.slices_per_m;
        // The highest point lies in the last slice.
        (slice.max(0.0) as usize).min(self.starts.len() - 2)
    }

    fn slices_of(&self, span: &SurfaceHeights) -> Range<usize> {
        let (low, high) = span.range();
        self.slice(low)..self.slice(high) + 1
    }

    /// Area of all surfaces that end below each slice, m²; the last number is that of all.
    ///
    /// - `areas`: of each surface, m², in the order of the tree
    pub(super) fn areas_below(&self, areas: &[f64]) -> Vec<f64> {
        let mut below = vec![0.0; self.starts.len()];
        for (slice, range) in self.starts.windows(2).enumerate() {
            for entry in &self.entries[range[0] as usize..range[1] as usize] {
                if self.slice(entry.span.range().1) == slice {
                    below[slice + 1] += areas[entry.place as usize];
                }
            }
        }
        for slice in 1..below.len() {
            below[slice] += below[slice - 1];
        }
        below
    }

    /// Area below a height of object space, m².
    pub(super) fn area_below(&self, height: f64, areas: &[f64], below: &[f64]) -> f64 {
        if height <= self.low {
            return 0.0;
        }
        if height > self.high {
            return below[below.len() - 1];
        }
        let slice = self.slice(height);
        let entries = &self.entries[self.starts[slice] as usize..self.starts[slice + 1] as usize];
        let cut = entries
            .iter()
            .map(|entry| areas[entry.place as usize] * entry.span.fraction_below(height));
        below[slice] + cut.sum::<f64>()
    }
}

impl SurfaceHeights {
    fn new(patch: &FlatPatch) -> Self {
        let (z, u, v) = (patch.origin.z, patch.u.z, patch.v.z);
        if patch.is_ellipse {
            return Self::Disc(z as f32, u.hypot(v));
        }
        // The corners are f32, and the differences of two of them are exact in f64.
        let mut corners = [z, z + u, z + v].map(|height| height as f32);
        corners.sort_unstable_by(f32::total_cmp);
        Self::Triangle(corners)
    }

    fn range(&self) -> (f64, f64) {
        match *self {
            Self::Triangle([low, _, high]) => (low.into(), high.into()),
            Self::Disc(center, reach) => (f64::from(center) - reach, f64::from(center) + reach),
        }
    }

    /// Fraction of the surface's area below a height.
    fn fraction_below(&self, height: f64) -> f64 {
        let (first, last) = self.range();
        if height <= first {
            return 0.0;
        }
        if height > last {
            return 1.0;
        }
        match *self {
            Self::Triangle([_, middle, _]) => {
                let middle = f64::from(middle);
                if height < middle {
                    (height - first).powi(2) / ((middle - first) * (last - first))
                } else if last > middle {
                    1.0 - (last - height).powi(2) / ((last - middle) * (last - first))
                } else {
                    1.0
                }
            }
            Self::Disc(center, reach) => {
                let d = ((height - f64::from(center)) / reach).clamp(-1.0, 1.0);
                1.0 - (d.acos() - d * (1.0 - d * d).sqrt()) / PI
            }
        }
    }
}
