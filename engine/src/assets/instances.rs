//! Tables of instances.

use std::path::Path;

use glam::DVec3;

use super::AssetError;
use super::table::{Table, known_columns, missing};
use crate::document::INSTANCE_COLUMNS;

/// Where one instance stands, as its row says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Position, m.
    pub position: DVec3,
    /// Turn about the vertical, counter-clockwise seen from above, rad.
    pub yaw: f64,
    /// Lean from the vertical, rad.
    pub tilt: f64,
    /// Where it leans to, clockwise from north, rad.
    pub tilt_azimuth: f64,
    /// Horizontal scale.
    pub scale_horizontal: f64,
    /// Vertical scale.
    pub scale_vertical: f64,
}

/// Rows of a table of instances, in file order.
///
/// Columns `x_m`, `y_m` and perhaps `z_m`, `yaw_deg` or `yaw_rad`, `tilt_deg`, `tilt_azimuth_deg`,
/// `scale` and `scale_vertical` in any order, separated by commas, semicolons, tabs or white space.
/// A missing column is 0, a missing `scale` 1, a missing `scale_vertical` the same as `scale`.
/// `columns` names them where the file has no header.
///
/// # Errors
/// A file that cannot be read, is not text or holds no row; an unknown or missing column; a number
/// that is not finite; a scale that is not above 0.
pub fn read_instances(path: &Path, columns: Option<&[String]>) -> Result<Vec<Row>, AssetError> {
    let mut table = Table::open(path)?;
    let line = table.first_line;
    let names = match columns {
        Some(names) => names.to_vec(),
        None if table.has_header() => {
            table.skip_header()?;
            table.first.clone()
        }
        None => {
            let wanted = "`x_m,y_m` and perhaps `z_m,yaw_deg,scale` and others, or list them under \
                          `columns` in the scene";
            let (file, wanted) = (path.to_owned(), wanted.to_owned());
            return Err(AssetError::NoHeader { file, line, wanted });
        }
    };
    let known = known_columns(&names, &INSTANCE_COLUMNS, path, line)?;
    let has = |name: &str| names.iter().any(|n| n == name);
    if let Some(column) = ["x_m", "y_m"].into_iter().find(|name| !has(name)) {
        return Err(missing(column, &names, path, line));
    }
    if has("yaw_deg") && has("yaw_rad") {
        let (first, second) = ("yaw_deg".to_owned(), "yaw_rad".to_owned());
        return Err(AssetError::RepeatedColumn { file: path.to_owned(), line, first, second });
    }
    let own_vertical = has("scale_vertical");

    let mut rows = Vec::new();
    let mut row = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0];
    while let Some(line) = table.read_row(&known, &mut row)? {
        let [x, y, z, yaw_deg, yaw_rad, tilt_deg, tilt_azimuth_deg, scale, vertical] = row;
        let scale_vertical = if own_vertical { vertical } else { scale };
        for (value, name) in [(scale, "scale"), (scale_vertical, "scale_vertical")] {
            if value <= 0.0 {
                let (file, what) = (path.to_owned(), name.to_owned());
                return Err(AssetError::NotPositive { file, line, what, value });
            }
        }
        rows.push(Row {
            position: DVec3::new(x, y, z),
            yaw: yaw_deg.to_radians() + yaw_rad,
            tilt: tilt_deg.to_radians(),
            tilt_azimuth: tilt_azimuth_deg.to_radians(),
            scale_horizontal: scale,
            scale_vertical,
        });
    }
    if rows.is_empty() {
        return Err(AssetError::NoRows { file: path.to_owned() });
    }
    Ok(rows)
}
