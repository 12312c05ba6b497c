//! Clouds of discs.

use std::path::Path;

use glam::DVec3;

use super::format::{self, FileReader};
use super::import::coarse;
use super::table::{Column, ColumnContent, Table, known_columns, missing};
use super::{AssetError, Loaded};
use crate::components::{Disc, Mesh, MeshPart};
use crate::document::Origin;

/// Columns of a disc: radius and centre in metres, direction of the normal.
const COLUMNS: [&str; 7] = ["radius", "x", "y", "z", "nx", "ny", "nz"];

/// Most discs of one file.
const MOST_DISCS: usize = 100_000_000;

/// A cloud of discs, m, z up, as one part named `discs`.
///
/// Either a table with the header `radius,x,y,z,nx,ny,nz` in any order, or the text of the RAMI
/// experiments: no header, rows `r x y z nx ny nz`, or the same after the number of a layer. Normals
/// need not have unit length.
///
/// # Errors
/// A file that cannot be read, is of another format, is not text or holds no disc; a row that is not a disc.
pub fn read_discs(path: &Path) -> Result<Loaded<Mesh>, AssetError> {
    format::check(path, FileReader::Discs)?;
    let mut table = Table::open(path)?;
    let columns = columns(&mut table)?;
    let mut discs = Vec::new();
    let mut row = [0.0; COLUMNS.len()];
    while let Some(line) = table.read_row(&columns, &mut row)? {
        if discs.len() == MOST_DISCS {
            let file = path.to_owned();
            return Err(AssetError::TooMany { file, what: "discs", most: MOST_DISCS });
        }
        discs.push(disc(row, path, line)?);
    }
    if discs.is_empty() {
        return Err(AssetError::NoRows { file: path.to_owned() });
    }
    let part = MeshPart { name: "discs".to_owned(), triangles: 0..0, discs: 0..discs.len() as u32 };
    let mesh = Mesh { discs, parts: vec![part], ..Mesh::default() };
    let warnings = coarse(path, &mesh, &Origin::File).into_iter().collect();
    Ok(Loaded { value: mesh, warnings })
}

fn columns(table: &mut Table) -> Result<Vec<Column>, AssetError> {
    let (file, line, count) = (table.file(), table.first_line, table.first.len());
    if table.has_header() {
        let columns = known_columns(&table.first, &COLUMNS, file, line)?;
        if let Some(column) = COLUMNS.iter().find(|&name| !table.first.iter().any(|n| n == name)) {
            return Err(missing(column, &table.first, file, line));
        }
        table.skip_header()?;
        return Ok(columns);
    }
    let layer = || Column { name: "layer".to_owned(), content: ColumnContent::Ignored };
    let layer = (count == COLUMNS.len() + 1).then(layer);
    let named = COLUMNS.iter().enumerate();
    let named = named.map(|(slot, &name)| Column {
        name: name.to_owned(),
        content: ColumnContent::Number(slot),
    });
    Ok(layer.into_iter().chain(named).collect())
}

fn disc(row: [f64; COLUMNS.len()], path: &Path, line: usize) -> Result<Disc, AssetError> {
    let file = || path.to_owned();
    let [radius, x, y, z, nx, ny, nz] = row;
    let far = |value: &f64| value.abs() > f64::from(f32::MAX) / 4.0;
    if let Some(value) = [radius, x, y, z].into_iter().find(far) {
        return Err(AssetError::TooFar { file: file(), line, value });
    }
    // Asked of what is kept: in f32 a radius may vanish.
    if (radius as f32) <= 0.0 {
        return Err(AssetError::NotPositive {
            file: file(),
            line,
            what: "the radius".to_owned(),
            value: radius,
        });
    }
    let normal = DVec3::new(nx, ny, nz);
    let largest = normal.abs().max_element();
    // Divided by the largest first: squares of lawful numbers may overflow or vanish.
    let unit = (normal / largest).try_normalize();
    let normal = unit.ok_or_else(|| AssetError::ZeroNormal { file: file(), line })?.as_vec3();
    Ok(Disc { center: DVec3::new(x, y, z).as_vec3(), normal, radius: radius as f32 })
}
