//! Material libraries (`.mtl`): transparency of materials, read by `tobj`.
//!
//! `tobj` is given the statements about transparency alone, in the one form that it reads: it refuses a whole
//! library for `d -halo 0.5` or text in Latin-1, and panics on `Kd 0.5`, which the format allows.

use std::path::{Path, PathBuf};

use indexmap::{IndexMap, IndexSet};

use super::super::error::excerpt;
use super::super::text::{self, TextLines, finite};
use super::words;

/// Size of the largest library that is read, bytes.
const LARGEST: u64 = 16 << 20;

/// Material of a `newmtl` without a name; no `usemtl` can name it, because `#` starts a comment.
const UNNAMED: &str = "#";

/// Returns the transparent materials, each with the statement that makes it so.
///
/// Among materials of one name the first transparent one counts. A library that cannot be read has none.
pub(super) fn transparent(obj: &Path, libraries: &IndexSet<String>) -> IndexMap<String, String> {
    let mut transparent = IndexMap::new();
    for library in libraries.iter().flat_map(|names| library_paths(obj, names)) {
        let statements = transparency_statements(&library);
        let (materials, _) = tobj::load_mtl_buf(&mut statements.as_bytes()).unwrap_or_default();
        for mut material in materials {
            let opacity = material.dissolve.map(|opacity| (opacity < 1.0, format!("d {opacity}")));
            let transparency = material.unknown_param.remove("Tr").and_then(|text| finite(&text));
            // Some programs write `Tr`, 1 minus the opacity, in place of `d`.
            let number = opacity.or(transparency.map(|value| (value > 0.0, format!("Tr {value}"))));
            let number = number.and_then(|(is_transparent, text)| is_transparent.then_some(text));
            if let Some(statement) = material.dissolve_texture.or(number) {
                transparent.entry(material.name).or_insert(statement);
            }
        }
    }
    transparent
}

/// Returns the files that follow `mtllib`: one, whose name may hold spaces, or several.
fn library_paths(obj: &Path, names: &str) -> Vec<PathBuf> {
    let folder = obj.parent().unwrap_or(Path::new(""));
    let beside = |name: &str| folder.join(name.replace('\\', "/"));
    let whole = beside(names);
    if whole.is_file() { vec![whole] } else { names.split_whitespace().map(beside).collect() }
}

/// Returns the names of a library's materials and what it says about their transparency, in the words of `tobj`.
///
/// `map_d` is followed by the whole statement, which may be that of another keyword with this meaning.
fn transparency_statements(library: &Path) -> String {
    let mut statements = String::new();
    let Ok(mut lines) = TextLines::open(library) else { return statements };
    if text::size(library).is_ok_and(|size| size > LARGEST) {
        return statements;
    }
    while let Ok(Some((_, line))) = lines.next_bytes() {
        let line = String::from_utf8_lossy(line);
        let (keyword, rest) = line.split_once(char::is_whitespace).unwrap_or((&line, ""));
        let rest = words(rest.split(" #").next().unwrap_or_default());
        // The number of `d -halo 0.5` is its last word.
        let number = rest.rsplit(' ').next().and_then(finite);
        let statement = match (keyword.to_ascii_lowercase().as_str(), number) {
            ("newmtl", _) if rest.is_empty() => format!("newmtl {UNNAMED}"),
            ("newmtl", _) => format!("newmtl {rest}"),
            ("d", Some(opacity)) => format!("d {opacity}"),
            ("tr", Some(transparency)) => format!("Tr {transparency}"),
            ("map_d" | "map_tr" | "map_opacity", _) => {
                format!("map_d {}", excerpt(&format!("{keyword} {rest}")))
            }
            _ => continue,
        };
        statements.push_str(&statement);
        statements.push('\n');
    }
    statements
}
