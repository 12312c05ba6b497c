//! Polygons with a value each, as binary PLY (Turk 1994, "The PLY Polygon File Format"): what
//! `MeshLab`, Blender and `ParaView` open in colours.

use std::io::{self, Write};

use super::Source;
use super::names::Distinct;
use super::provenance::{RECIPE, RecipeForm};
use crate::products::Faces;

/// Longest part of a recipe on a line, bytes.
const LINE: usize = 500;

/// Share of the faces below the top of the colours.
const BELOW: f64 = 0.99;

/// Every tenth of viridis, sRGB. Source: N. Smith and S. van der Walt, matplotlib 1.5, CC0.
const VIRIDIS: [[u8; 3]; 10] = [
    [0x44, 0x01, 0x54],
    [0x48, 0x28, 0x78],
    [0x3e, 0x49, 0x89],
    [0x31, 0x68, 0x8e],
    [0x26, 0x82, 0x8e],
    [0x1f, 0x9e, 0x89],
    [0x35, 0xb7, 0x79],
    [0x6e, 0xce, 0x58],
    [0xb5, 0xde, 0x2b],
    [0xfd, 0xe7, 0x25],
];

/// Faces share no corners, so that corners have their face's colour too: Blender shows only these.
pub(super) fn write(source: &Source<'_>, faces: &Faces, file: &mut impl Write) -> io::Result<()> {
    let bands = faces.bands.len();
    let sums: Vec<f32> = faces.values.chunks_exact(bands).map(|face| face.iter().sum()).collect();
    let top = top(&sums);
    let corners: usize = faces.inventory.faces().map(|face| face.corners.len()).sum();
    if i32::try_from(corners).is_err() {
        return Err(io::Error::other(format!("{corners} corners are too many for a PLY file")));
    }
    writeln!(file, "ply\nformat binary_little_endian 1.0")?;
    for (key, value) in source.provenance(RecipeForm::Packed) {
        // Some readers have room for lines of a thousand letters; only the recipe, of one byte each, is longer.
        let ends = [LINE.min(value.len()), value.len()];
        let first = if key == RECIPE { ends[0] } else { ends[1] };
        writeln!(file, "comment {key}: {}", &value[..first])?;
        for more in value.as_bytes()[first..].chunks(LINE) {
            file.write_all(&[b"comment recipe+ ", more, b"\n"].concat())?;
        }
    }
    let (east, north) = faces.origin;
    writeln!(file, "comment origin_m: {east:?} {north:?} is what x and y count from")?;
    writeln!(file, "comment colours: viridis of the sum over the bands, from 0 to {top:?}")?;
    writeln!(file, "element vertex {corners}")?;
    for property in ["float x", "float y", "float z", "uchar red", "uchar green", "uchar blue"] {
        writeln!(file, "property {property}")?;
    }
    writeln!(file, "element face {}\nproperty list uchar int vertex_indices", sums.len())?;
    for property in ["red", "green", "blue"] {
        writeln!(file, "property uchar {property}")?;
    }
    let mut names = Distinct::default();
    for band in &faces.bands {
        // Readers split the header at blanks.
        let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        let band = names.take(&band.chars().map(plain).collect::<String>());
        writeln!(file, "property float absorbed_{band}\nproperty float se_{band}")?;
    }
    writeln!(file, "end_header")?;
    for (face, sum) in faces.inventory.faces().zip(&sums) {
        for corner in &face.corners {
            let place = corner.as_vec3().to_array().map(f32::to_le_bytes);
            file.write_all(place.as_flattened())?;
            file.write_all(&colour(sum / top))?;
        }
    }
    let mut next = 0_i32;
    let values = faces.values.chunks_exact(bands).zip(faces.standard_error.chunks_exact(bands));
    for ((face, sum), (values, errors)) in faces.inventory.faces().zip(&sums).zip(values) {
        let count = face.corners.len() as u8;
        file.write_all(&[count])?;
        for corner in next..next + i32::from(count) {
            file.write_all(&corner.to_le_bytes())?;
        }
        next += i32::from(count);
        file.write_all(&colour(sum / top))?;
        for (value, error) in values.iter().zip(errors) {
            file.write_all([value.to_le_bytes(), error.to_le_bytes()].as_flattened())?;
        }
    }
    Ok(())
}

/// Upper end of the colours, above nearly all values that are not 0.
fn top(sums: &[f32]) -> f32 {
    let mut lit: Vec<f32> = sums.iter().copied().filter(|sum| *sum > 0.0).collect();
    if lit.is_empty() {
        return 1.0;
    }
    let index = (BELOW * (lit.len() - 1) as f64).ceil() as usize;
    *lit.select_nth_unstable_by(index, f32::total_cmp).1
}

/// Colour of a share of the top.
fn colour(share: f32) -> [u8; 3] {
    let place = 9.0 * share.clamp(0.0, 1.0);
    let low = (place as usize).min(8);
    let part = place - low as f32;
    std::array::from_fn(|channel| {
        let [below, above] = [low, low + 1].map(|stop| f32::from(VIRIDIS[stop][channel]));
        (below + part * (above - below)).round() as u8
    })
}
