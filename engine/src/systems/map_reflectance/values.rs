use crate::components::CellLayout;
use crate::geometry::place_text;
use crate::systems::Resources;
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
    of_bands: &[u32],
    resources: &Resources,
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
        return Err(wrong.problem(layout, of_bands, resources));
    }
    if missing > 0 && elsewhere.is_none() {
        return Err(ValueProblem {
            message: format!("{missing} of its {cells} cells on the terrain have no data"),
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

impl WrongValues {
    fn problem(&self, layout: CellLayout, of_bands: &[u32], resources: &Resources) -> ValueProblem {
        let Self { cell, layer, value, count, most } = *self;
        let CellLayout { columns, rows, corner, size } = layout;
        let grid = Cells { columns, rows, values: Vec::<()>::new(), corner, size };
        let mut names = resources.bands.iter().zip(of_bands);
        let name = names.find(|(_, of)| **of as usize == layer).map_or("", |(band, _)| &band.name);
        let others = match count - 1 {
            0 => String::new(),
            1 => ", and 1 more cell has such a value".to_owned(),
            more => format!(", and {more} more cells have such values"),
        };
        let message = format!(
            "the cell at {} m (column {}, row {} of those on the terrain) has a reflectance of {value} in \
             band `{name}`{others}: expected 0 to 1",
            place_text(grid.center(cell)),
            cell % columns + 1,
            cell / columns + 1
        );
        let help = if most > 100.0 {
            "write `scale: 0.0001` if the values are reflectances times 10000"
        } else if most > 2.0 {
            "write `scale: 0.01` if the values are percent"
        } else {
            "correct them in the file (`gdal_calc.py --calc=\"clip(A,0,10000)\"`), or name them as cells \
             without data there and write `elsewhere`"
        };
        ValueProblem { message, help: help.to_owned() }
    }
}
