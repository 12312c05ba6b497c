//! Stems with the density of a raster.

use std::ops::Range;

use glam::DVec2;
use rayon::prelude::*;

use super::buckets::Buckets;
use super::{MOST_STEMS, PlacementError, Region};
use crate::geometry::Rectangle;
use crate::sampling::Key;
use crate::terrain::Cells;

/// Most trials for one stem before its block counts as full.
const MOST_DARTS: u64 = 1000;

/// Width of a block, as a multiple of the distance between stems: wide enough for the number of stems that its
/// density asks for.
const WIDTH: f64 = 8.0;

/// Returns places with a density, m⁻², at least `distance` from each other.
///
/// The ground is cut into square blocks of one or more cells, which are wide against the distance. A block of n
/// expected stems gets ⌊n⌋ or ⌈n⌉ with mean n, so that the density is met with less than the error of counting.
/// Each stem draws a place by the density within its block, repeatedly while it is too close to another stem; a
/// stem whose first place is outside the region is left out.
///
/// # Errors
/// More stems than a scatter may have; a block without room.
pub(super) fn map(
    density: &Cells<f64>,
    region: &Region,
    tile: Option<Rectangle>,
    distance: f64,
    stream: Key,
) -> Result<Vec<DVec2>, PlacementError> {
    let blocks = Blocks::new(density, region.bounds(), distance);
    let expected = blocks.cumulative.last().copied().unwrap_or(0.0);
    if expected > MOST_STEMS as f64 {
        return Err(PlacementError::TooManyStems { stems: expected, most: MOST_STEMS });
    }
    if let Some(tile) = tile {
        let side = tile.size().min_element();
        if side < distance && expected > 0.0 {
            return Err(PlacementError::TooCloseToItself { distance, side });
        }
    }
    // In no order of place, so that no block has the first choice of its neighbours' borders.
    let mut stems: Vec<(u64, Key, u32)> = (0..blocks.of.len())
        .into_par_iter()
        .flat_map_iter(|block| {
            let own = stream.index(blocks.of[block].0);
            let count = (blocks.stems(block) + own.path("count").uniform(0)).floor() as u64;
            (0..count).map(move |stem| (own.index(stem).bits(0), own.index(stem), block as u32))
        })
        .collect();
    stems.par_sort_unstable_by_key(|&(order, _, block)| (order, block));
    let bounds = tile.unwrap_or_else(|| region.bounds());
    let mut buckets = Buckets::new(bounds, tile.is_some(), distance, stems.len());
    'stems: for (_, own, block) in stems {
        for dart in 0..MOST_DARTS {
            let numbers = own.index(dart);
            let place = blocks.sample(block as usize, [1, 2, 3].map(|n| numbers.uniform(n)));
            if !region.contains(place) {
                if dart == 0 {
                    continue 'stems;
                }
            } else if distance == 0.0 || !buckets.is_taken(place) {
                buckets.push(place);
                continue 'stems;
            }
        }
        let at = blocks.sample(block as usize, [0.5; 3]);
        let wanted = blocks.stems(block as usize).round() as usize;
        return Err(PlacementError::NoRoomInMap { wanted, at, distance });
    }
    Ok(buckets.points)
}

/// Cells that hold any stems, block by block.
struct Blocks<'a> {
    density: &'a Cells<f64>,
    cells: Vec<u32>,
    /// Stems up to and with each cell.
    cumulative: Vec<f64>,
    /// Number of each block on the whole raster, and its cells.
    of: Vec<(u64, Range<usize>)>,
}

impl<'a> Blocks<'a> {
    /// Creates the blocks of the cells that overlap some bounds.
    fn new(density: &'a Cells<f64>, bounds: Rectangle, distance: f64) -> Self {
        let cell = density.cell();
        let side = (WIDTH * distance / cell).ceil().max(DVec2::ONE).min(DVec2::splat(1e9));
        let (width, height) = (side.x as usize, side.y as usize);
        let across = density.columns.div_ceil(width);
        let block = |index: usize| {
            let (column, row) = (index % density.columns, index / density.columns);
            row / height * across + column / width
        };
        let reaches = |index: usize| {
            let Rectangle { min, max } = density.rectangle(index);
            min.cmplt(bounds.max).all() && max.cmpgt(bounds.min).all()
        };
        let mut cells: Vec<u32> = (0..density.values.len())
            .into_par_iter()
            .filter(|&index| density.values[index] > 0.0 && reaches(index))
            .map(|index| index as u32)
            .collect();
        cells.par_sort_by_key(|&index| block(index as usize));
        let (mut sum, mut cumulative) = (0.0, Vec::with_capacity(cells.len()));
        let mut of: Vec<(u64, Range<usize>)> = Vec::new();
        for (at, &index) in cells.iter().enumerate() {
            sum += density.values[index as usize] * cell.x * cell.y;
            cumulative.push(sum);
            let number = block(index as usize) as u64;
            match of.last_mut() {
                Some((last, range)) if *last == number => range.end = at + 1,
                _ => of.push((number, at..at + 1)),
            }
        }
        Self { density, cells, cumulative, of }
    }

    /// Stems up to where a block starts.
    fn before(&self, block: usize) -> f64 {
        let first = self.of[block].1.start;
        if first == 0 { 0.0 } else { self.cumulative[first - 1] }
    }

    /// Expected stems of a block.
    fn stems(&self, block: usize) -> f64 {
        self.cumulative[self.of[block].1.end - 1] - self.before(block)
    }

    /// A place in a block, as likely as it is dense there.
    fn sample(&self, block: usize, [u, v, w]: [f64; 3]) -> DVec2 {
        let Range { start, end } = self.of[block].1.clone();
        let target = self.before(block) + u * self.stems(block);
        let cell = start + self.cumulative[start..end].partition_point(|&sum| sum <= target);
        self.density.rectangle(self.cells[cell.min(end - 1)] as usize).at(v, w)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Rule;
    use crate::geometry::Polygon;
    use crate::placement::{Amount, places};

    const TERRAIN: Rectangle =
        Rectangle { min: DVec2::new(-20.0, 10.0), max: DVec2::new(40.0, 50.0) };

    /// A density over the terrain, and 12 m beyond it to the west and to the north.
    fn cells(side: f64, density: impl Fn(DVec2) -> f64) -> Cells<f64> {
        let corner = TERRAIN.min - DVec2::X * 12.0;
        let size = TERRAIN.size() + 12.0;
        let (columns, rows) = ((size.x / side) as usize, (size.y / side) as usize);
        let mut cells = Cells { columns, rows, values: vec![0.0; columns * rows], corner, size };
        cells.values = (0..columns * rows).map(|index| density(cells.center(index))).collect();
        cells
    }

    fn stems(rule: &Rule, cells: &Cells<f64>, region: &Region, seed: u64) -> Vec<DVec2> {
        let amount = Amount::Map(cells);
        places(rule, amount, region, TERRAIN, true, Key::new(seed)).expect("room")
    }

    fn whole() -> Region {
        Region::new(TERRAIN, &[], &[]).expect("a region")
    }

    /// *Scene*: cells of 4 m, alone or as blocks of 2 x 2, of densities at random, a tenth of them
    /// unknown. *Expected*: each block that lies in the region has its number of stems but for less
    /// than one, and the mean over seeds that number itself.
    #[test]
    fn each_block_holds_as_many_stems_as_its_density_says() {
        let key = Key::new(7);
        let random = cells(4.0, |place| {
            let number = ((place.x + 40.0) * 64.0 + place.y) as u64;
            let density = key.index(number).uniform(0);
            if density < 0.1 { f64::NAN } else { 0.25 * density }
        });
        let rules = [(Rule::Uniform, 1), (Rule::PoissonDisc { min_distance_m: 1.0 }, 2)];
        for (rule, width) in rules {
            let (columns, rows) = (random.columns.div_ceil(width), random.rows.div_ceil(width));
            let block = |index: usize| {
                index / random.columns / width * columns + index % random.columns / width
            };
            let mut expected = vec![0.0; columns * rows];
            for (index, density) in random.values.iter().enumerate() {
                expected[block(index)] += 16.0 * density.max(0.0);
            }
            let mut sums = vec![0.0; columns * rows];
            for seed in 0..100 {
                let mut counts = vec![0.0; columns * rows];
                for stem in stems(&rule, &random, &whole(), seed) {
                    let at = ((stem - random.corner) / 4.0).floor().as_u64vec2();
                    let index = (random.rows - 1 - at.y as usize) * random.columns + at.x as usize;
                    assert!(!random.values[index].is_nan(), "{stem} is where no data are");
                    counts[block(index)] += 1.0;
                }
                for (index, count) in counts.iter().enumerate() {
                    sums[index] += count;
                    // Three columns to the west and three rows to the north lie beside the terrain.
                    let (column, row) = (index % columns * width, index / columns * width);
                    if column >= 4 && row >= 4 {
                        let difference: f64 = count - expected[index];
                        assert!(difference.abs() < 1.0, "{rule:?}: {difference} of {index}");
                    } else if column + width <= 3 || row + width <= 3 {
                        assert!(*count == 0.0, "{count} beside the terrain");
                    }
                }
            }
            // The number is ⌊n⌋ or ⌈n⌉, whose variance is at most 1/4: z of the sum over blocks.
            let within =
                |index: &usize| index % columns * width >= 4 && index / columns * width >= 4;
            let inner: Vec<usize> = (0..sums.len()).filter(within).collect();
            let sum: f64 = inner.iter().map(|&i| sums[i] - 100.0 * expected[i]).sum();
            let variance: f64 = inner
                .iter()
                .map(|&i| 100.0 * expected[i].fract() * (1.0 - expected[i].fract()))
                .sum();
            let z = sum / variance.sqrt();
            assert!(z.abs() < 4.0, "{rule:?}: z = {z}");
        }
    }

    /// *Scene*: density growing eastwards in cells much finer than the distance of stems, in a region
    /// with a hole. *Expected*: strips within counting error, distances kept across the borders.
    #[test]
    fn fine_rasters_are_met_at_a_distance_too() {
        let gradient = cells(0.5, |place| 0.0008 * (place.x + 32.0));
        let hole: Polygon =
            Rectangle { min: DVec2::new(0.0, 20.0), max: DVec2::new(20.0, 40.0) }.into();
        let region = Region::new(TERRAIN, &[], &[hole]).expect("a region");
        for distance in [0.0, 1.5] {
            let rule = if distance > 0.0 {
                Rule::PoissonDisc { min_distance_m: distance }
            } else {
                Rule::Uniform
            };
            let mut strips = [0.0; 6];
            for seed in 0..40 {
                let stems = stems(&rule, &gradient, &region, seed);
                for (index, stem) in stems.iter().enumerate() {
                    assert!(region.contains(*stem), "{stem}");
                    strips[((stem.x + 20.0) / 10.0) as usize] += 1.0;
                    for other in &stems[..index] {
                        let offset = *stem - *other;
                        let offset = offset - TERRAIN.size() * (offset / TERRAIN.size()).round();
                        assert!(offset.length() >= distance, "{stem} {other}");
                    }
                }
            }
            for (strip, count) in strips.iter().enumerate() {
                let middle = 10.0 * strip as f64 - 15.0;
                let area = if (2..4).contains(&strip) { 200.0 } else { 400.0 };
                let expected = 40.0 * area * 0.0008 * (middle + 32.0);
                let z = (count - expected) / f64::sqrt(expected);
                assert!(z.abs() < 4.0, "distance {distance}, strip {strip}: z = {z}");
            }
        }
    }

    #[test]
    fn a_raster_that_asks_for_too_much_says_where() {
        let dense =
            cells(
                4.0,
                |place| if place.distance(DVec2::new(6.0, 32.0)) < 6.0 { 1.0 } else { 0.01 },
            );
        let find = |cells: &Cells<f64>, min_distance_m| {
            let rule = Rule::PoissonDisc { min_distance_m };
            places(&rule, Amount::Map(cells), &whole(), TERRAIN, true, Key::new(1))
        };
        let error = find(&dense, 1.2).expect_err("no room");
        let PlacementError::NoRoomInMap { at, .. } = error else { panic!("{error:?}") };
        assert!(at.distance(DVec2::new(6.0, 32.0)) < 12.0, "{at}");
        let error = find(&cells(4.0, |_| 1e9), 0.1).expect_err("too many");
        assert!(matches!(error, PlacementError::TooManyStems { .. }), "{error:?}");
        let error = find(&cells(4.0, |_| 0.1), 41.0).expect_err("too narrow");
        assert_eq!(error, PlacementError::TooCloseToItself { distance: 41.0, side: 40.0 });
        assert_eq!(find(&cells(4.0, |_| f64::NAN), 41.0), Ok(Vec::new()));
    }
}
