use crate::assets::Raster;
use crate::counts::{agreeing, counted};
use crate::document::{Diagnostic, NoData};
use crate::systems::Resources;

/// Fills cells without data, leaves them as holes, or refuses them.
pub(super) fn fill_no_data(
    raster: &mut Raster,
    no_data: &NoData,
    resources: &mut Resources,
) -> Option<()> {
    let missing = raster.missing();
    if missing == 0 {
        return Some(());
    }
    match no_data {
        NoData::Refuse => {
            let (all, help) = (
                raster.values.len(),
                "write `no_data: Neighbours` to fill them from around, `Height(0.0)` to level \
                     them, or `Hole` to leave them out",
            );
            let message = format!(
                "{missing} of its {} {} no data",
                counted(all, "cell"),
                agreeing(missing, "has", "have")
            );
            resources.report(Diagnostic::error(["terrain", "file"], message).help(help));
            return None;
        }
        NoData::Neighbours => fill_from_neighbours(raster),
        NoData::Height(height) => {
            raster.values.iter_mut().filter(|v| v.is_nan()).for_each(|v| *v = *height);
        }
        NoData::Hole => {}
    }
    Some(())
}

/// Gives cells without data the mean of their eight neighbours that have any, ring by ring.
fn fill_from_neighbours(raster: &mut Raster) {
    let (columns, rows) = (raster.columns, raster.rows);
    let around = |cell: usize| {
        let (x, y) = (cell % columns, cell / columns);
        let (xs, ys) =
            (x.saturating_sub(1)..(x + 2).min(columns), y.saturating_sub(1)..(y + 2).min(rows));
        ys.flat_map(move |y| xs.clone().map(move |x| y * columns + x))
    };
    let mut candidates: Vec<usize> =
        (0..raster.values.len()).filter(|&cell| raster.values[cell].is_nan()).collect();
    while !candidates.is_empty() {
        let mut ring = Vec::new();
        for &cell in &candidates {
            let known = around(cell).map(|c| raster.values[c]).filter(|height| !height.is_nan());
            let (sum, count) =
                known.fold((0.0, 0), |(sum, count), height| (sum + height, count + 1));
            if count > 0 {
                ring.push((cell, sum / f64::from(count)));
            }
        }
        for &(cell, height) in &ring {
            raster.values[cell] = height;
        }
        // The next ring lies around this one: to ask all cells each time would never end.
        let next = ring.iter().flat_map(|&(cell, _)| around(cell));
        candidates = next.filter(|&cell| raster.values[cell].is_nan()).collect();
        candidates.sort_unstable();
        candidates.dedup();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn raster_of(columns: usize, rows: usize, values: Vec<f64>) -> Raster {
        let (place, class_names, heights, assumed) = (None, Vec::new(), None, None);
        Raster { columns, rows, values, place, class_names, heights, assumed }
    }

    #[test]
    fn cells_without_data_are_filled_ring_by_ring() {
        let nan = f64::NAN;
        let values = vec![1.0, nan, nan, 4.0];
        let mut raster = raster_of(4, 1, values);
        fill_from_neighbours(&mut raster);
        assert_eq!(raster.values, [1.0, 1.0, 4.0, 4.0]);
        // One known cell among 2^20 takes a thousand rings.
        let mut values = vec![nan; 1 << 20];
        values[0] = 7.0;
        let mut raster = raster_of(1 << 10, 1 << 10, values);
        fill_from_neighbours(&mut raster);
        assert!(raster.values.iter().all(|&height| (height - 7.0).abs() < 1e-12));
    }
}
