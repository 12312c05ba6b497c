use crate::assets::Scaling;
use crate::components::CellLayout;
use crate::counts::{agreeing, counted};
use crate::document::Band;
use crate::geometry::place_text;
use crate::terrain::Cells;

/// Reason for which values are no reflectances.
pub(super) struct ValueProblem {
    pub(super) message: String,
    pub(super) help: String,
}

/// Sums of several bands may leave the range of fractions by this, which is rounding.
const ROUNDING: f32 = 1e-6;

/// Fills cells without data; shape `[cells, layers]`.
///
/// # Errors
/// Cells without data if there is no value for them, and values that are no fractions.
pub(super) fn check_values(
    values: &mut [f32],
    layout: CellLayout,
    elsewhere: Option<&[f32]>,
    scaling: Option<Scaling>,
    names: &LayerNames<'_>,
) -> Result<(), ValueProblem> {
    let cells = layout.columns * layout.rows;
    let layers = values.len() / cells;
    let mut missing = 0;
    let mut wrong: Option<WrongValues> = None;
    for (index, cell) in values.chunks_mut(layers).enumerate() {
        if cell.iter().any(|value| value.is_nan()) {
            missing += 1;
            if let Some(elsewhere) = elsewhere {
                cell.copy_from_slice(elsewhere);
            }
            continue;
        }
        let is_fraction = |value: f32| (-ROUNDING..=1.0 + ROUNDING).contains(&value);
        if let Some(layer) = cell.iter().position(|&value| !is_fraction(value)) {
            let first = WrongValues { cell: index, layer, value: cell[layer], count: 0, most: 0.0 };
            let wrong = wrong.get_or_insert(first);
            wrong.count += 1;
            wrong.most = cell.iter().copied().fold(wrong.most, f32::max);
        }
        for value in cell {
            *value = value.clamp(0.0, 1.0);
        }
    }
    if let Some(wrong) = wrong {
        return Err(ValueProblem {
            message: wrong.message(layout, names),
            help: help(wrong.most.into(), scaling),
        });
    }
    if missing > 0 && elsewhere.is_none() {
        return Err(ValueProblem {
            message: format!(
                "{missing} of its {} on the terrain {} no data",
                counted(cells, "cell"),
                agreeing(missing, "has", "have")
            ),
            help: "write `elsewhere: Constant(0.2)` for their reflectance".to_owned(),
        });
    }
    Ok(())
}

/// Values that are no fractions.
struct WrongValues {
    /// The first cell that has one.
    cell: usize,
    layer: usize,
    value: f32,
    /// Number of cells with such a value.
    count: usize,
    /// Largest value of these cells.
    most: f32,
}

/// Names of layers in messages: those of the bands of the scene that have their values there.
pub(super) struct LayerNames<'a> {
    pub(super) bands: &'a [Band],
    /// Layer of each band.
    pub(super) of_bands: &'a [u32],
}

impl LayerNames<'_> {
    fn first(&self, layer: usize) -> &str {
        let mut names = self.bands.iter().zip(self.of_bands);
        names.find(|(_, of)| **of as usize == layer).map_or("", |(band, _)| &band.name)
    }
}

impl WrongValues {
    fn message(&self, layout: CellLayout, names: &LayerNames<'_>) -> String {
        let Self { cell, layer, value, count, .. } = *self;
        let CellLayout { columns, rows, corner, size } = layout;
        let grid = Cells { columns, rows, values: Vec::<()>::new(), corner, size };
        let others = match count - 1 {
            0 => String::new(),
            more => format!(
                ", and {} {}",
                counted(more, "more cell"),
                agreeing(more, "has such a value", "have such values")
            ),
        };
        format!(
            "the cell at {} m (column {}, row {} of those on the terrain) has a reflectance of {value} in \
             band `{}`{others}: expected 0 to 1",
            place_text(grid.center(cell)),
            cell % columns + 1,
            cell / columns + 1,
            names.first(layer)
        )
    }
}

/// What to write about values of which `most` is the largest.
///
/// - `scaling`: that of the scene, if it has one
fn help(most: f64, scaling: Option<Scaling>) -> String {
    const CORRECT: &str = "correct them in the file";
    const NAME: &str = "or name them as cells without data there and write `elsewhere`";
    let Some(Scaling { scale, offset }) = scaling else { return format!("{CORRECT}, {NAME}") };
    let stored = |value: f64| (value - offset) / scale;
    let (meant, what) = match stored(most) {
        number if number > 100.0 => (0.0001, "reflectances times 10000"),
        number if number > 2.0 => (0.01, "percent"),
        _ => (scale, ""),
    };
    if most > 2.0 && scale > meant {
        return format!("write `scale: {meant}` if the values are {what}");
    }
    let (low, high) = (stored(0.0).min(stored(1.0)).round(), stored(0.0).max(stored(1.0)).round());
    format!("{CORRECT} (`gdal_calc.py --calc=\"clip(A,{low},{high})\"`), {NAME}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advice_is_another_scale_or_the_range_of_the_numbers_in_the_file() {
        let help = |most, scale, offset| help(most, Some(Scaling { scale, offset }));
        assert_eq!(help(30.0, 1.0, 0.0), "write `scale: 0.01` if the values are percent");
        let reflectances = "write `scale: 0.0001` if the values are reflectances times 10000";
        assert_eq!(help(30.0, 0.01, 0.0), reflectances);
        assert_eq!(help(3000.0, 1.0, 0.0), reflectances);
        assert!(help(1.5, 1.0, 0.0).contains("clip(A,0,1)"));
        assert!(help(1.2, 0.01, 0.0).contains("clip(A,0,100)"));
        // Products of Sentinel-2 since 2022, whose dark pixels are below 0.
        assert!(help(0.4, 0.0001, -0.1).contains("clip(A,1000,11000)"));
    }
}
