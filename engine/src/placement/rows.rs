use std::ops::RangeInclusive;

use glam::DVec2;
use rayon::prelude::*;

use super::{MOST_STEMS, PlacementError, Region};
use crate::sampling::Key;

/// Stems in rows.
pub(super) struct StemRows {
    /// Across and along the rows, m.
    pub(super) spacing: DVec2,
    /// Azimuth along the rows, rad.
    pub(super) azimuth: f64,
    /// Largest offset of a stem from its place in x and in y, m.
    pub(super) jitter: f64,
}

impl StemRows {
    /// Returns the places in a region; the first lies half a spacing from the corner.
    pub(super) fn places(
        &self,
        region: &Region,
        corner: DVec2,
        stream: Key,
    ) -> Result<Vec<DVec2>, PlacementError> {
        let (sin, cos) = self.azimuth.sin_cos();
        let (across, along) = (DVec2::new(cos, -sin), DVec2::new(sin, cos));
        let bounds = region.bounds();
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
        let corners = corners.map(|(u, v)| bounds.at(u, v) - corner);
        let numbers = |axis: DVec2, spacing: f64| {
            let at = corners.map(|corner| corner.dot(axis));
            let low = at.into_iter().fold(f64::INFINITY, f64::min) - 2.0 * self.jitter;
            let high = at.into_iter().fold(f64::NEG_INFINITY, f64::max) + 2.0 * self.jitter;
            ((low / spacing - 0.5).floor(), (high / spacing - 0.5).ceil())
        };
        let (rows, stems) = (numbers(across, self.spacing.x), numbers(along, self.spacing.y));
        let candidates = (rows.1 - rows.0 + 1.0) * (stems.1 - stems.0 + 1.0);
        // A turned square may cover half of the square around it.
        if candidates.is_nan() || candidates > 4.0 * MOST_STEMS as f64 {
            return Err(PlacementError::TooManyStems { stems: candidates, most: MOST_STEMS });
        }
        let whole = |(low, high): (f64, f64)| -> RangeInclusive<i64> { low as i64..=high as i64 };
        let (rows, stems) = (whole(rows), whole(stems));
        let place = |row: i64, stem: i64| {
            let number = DVec2::new(row as f64 + 0.5, stem as f64 + 0.5) * self.spacing;
            let own = stream.index(row as u64).index(stem as u64);
            let off = DVec2::new(own.uniform(0), own.uniform(1)) * 2.0 - 1.0;
            corner + across * number.x + along * number.y + off * self.jitter
        };
        let places = rows
            .into_par_iter()
            .flat_map_iter(|row| stems.clone().map(move |stem| place(row, stem)))
            .filter(|&place| region.contains(place))
            .collect();
        Ok(places)
    }
}
