use crate::document::Diagnostic;
use crate::geometry::place_text;
use crate::systems::Resources;
use crate::terrain::Cells;

/// Slope of which a quarter of the ground is no natural ground: 75 degrees.
const STEEP: f64 = 3.73;

/// A step from a cell to the next that is lower may be a cliff, m.
const CLIFF: f64 = 50.0;

/// Slope of a step that is no cliff.
const WALL: f64 = 10.0;

/// Steps between neighbouring cells.
#[derive(Clone, Copy, Debug, Default)]
struct Steps {
    count: usize,
    /// Number of steps that are steeper than [`STEEP`].
    steep: usize,
    /// The highest step that is steeper than [`WALL`], m, and the cell where it is.
    highest: f64,
    at: usize,
}

/// Warns of heights that are in another unit or hold values for no data, by their steps.
pub(super) fn warn_steepness(heights: &Cells<f64>, resources: &mut Resources) {
    let steps = steps(heights);
    if steps.count > 0 && 4 * steps.steep > steps.count {
        let percent = 100 * steps.steep / steps.count;
        let message = format!("{percent} % of the ground is steeper than 75 degrees");
        let help = "heights may be in another unit than metres: write `height_unit_m: 0.01` for \
                        centimetres, 0.1 for decimetres, 0.3048 for feet";
        resources.report(Diagnostic::warning(["terrain", "file"], message).help(help));
    } else if steps.highest > CLIFF {
        let message = format!(
            "the ground rises or falls by {:.1} m from the cell at {} to the next",
            steps.highest,
            place_text(heights.center(steps.at))
        );
        let help = "a cell without data may hold a height that the file does not name as such: name it \
                        (`gdal_edit.py -a_nodata 0`) and write `no_data: Neighbours`";
        resources.report(Diagnostic::warning(["terrain", "file"], message).help(help));
    }
}

fn steps(heights: &Cells<f64>) -> Steps {
    let (columns, cell) = (heights.columns, heights.cell());
    let mut steps = Steps::default();
    let mut add = |from: usize, to: usize, distance: f64| {
        let step = (heights.values[from] - heights.values[to]).abs();
        if step.is_nan() {
            return;
        }
        steps.count += 1;
        steps.steep += usize::from(step > STEEP * distance);
        if step > WALL * distance && step > steps.highest {
            (steps.highest, steps.at) = (step, from);
        }
    };
    for index in 0..heights.values.len() {
        if index % columns + 1 < columns {
            add(index, index + 1, cell.x);
        }
        if index + columns < heights.values.len() {
            add(index, index + columns, cell.y);
        }
    }
    steps
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;

    #[test]
    fn steps_are_counted_by_their_slope() {
        let values = vec![0.0, 1.0, 100.0, f64::NAN, 1.0, 1.0];
        let size = DVec2::new(3.0, 2.0);
        let heights = Cells { columns: 3, rows: 2, values, corner: DVec2::ZERO, size };
        let steps = steps(&heights);
        // Five pairs have heights; those of 99 m to the west and to the south are walls.
        assert_eq!((steps.count, steps.steep, steps.at), (5, 2, 1));
        assert!((steps.highest - 99.0).abs() < 1e-12);
    }
}
