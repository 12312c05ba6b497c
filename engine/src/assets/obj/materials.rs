//! Material libraries (`.mtl`): what they say about transparency.

use std::path::{Path, PathBuf};

use indexmap::{IndexMap, IndexSet};

use super::super::error::excerpt;
use super::super::text::{self, Lines, finite};
use super::words;

/// Largest library that is looked into, bytes.
const LARGEST: u64 = 16 << 20;

/// What a library says of one material.
#[derive(Default)]
struct Transparency {
    /// Opacity (`d`), 0 to 1.
    d: Option<f64>,
    /// 1 minus the opacity (`Tr`); some programs write it in place of `d`.
    tr: Option<f64>,
    /// The line of a texture of opacities.
    map: Option<String>,
}

impl Transparency {
    /// The words of the library that make the material transparent.
    fn words(self) -> Option<String> {
        let Self { d, tr, map } = self;
        map.or_else(|| match (d, tr) {
            (Some(d), _) => (d < 1.0).then(|| format!("d {d}")),
            (None, Some(tr)) => (tr > 0.0).then(|| format!("Tr {tr}")),
            (None, None) => None,
        })
    }
}

/// Transparent materials, each with the words that make it so. Libraries that cannot be read say nothing.
pub(super) fn transparent(obj: &Path, libraries: &IndexSet<String>) -> IndexMap<String, String> {
    let mut found = IndexMap::new();
    for library in libraries.iter().flat_map(|names| files(obj, names)) {
        read(&library, &mut found);
    }
    found
}

/// The files that follow `mtllib`: one, whose name may hold spaces, or several.
fn files(obj: &Path, names: &str) -> Vec<PathBuf> {
    let folder = obj.parent().unwrap_or(Path::new(""));
    let beside = |name: &str| folder.join(name.replace('\\', "/"));
    let whole = beside(names);
    if whole.is_file() { vec![whole] } else { names.split_whitespace().map(beside).collect() }
}

fn read(library: &Path, found: &mut IndexMap<String, String>) {
    if text::size(library).is_ok_and(|size| size <= LARGEST)
        && let Ok(mut lines) = Lines::open(library)
    {
        let mut material = (String::new(), Transparency::default());
        while let Ok(Some((_, line))) = lines.next_bytes() {
            let line = String::from_utf8_lossy(line);
            let (keyword, rest) = line.split_once(char::is_whitespace).unwrap_or((&line, ""));
            let rest = words(rest.split(" #").next().unwrap_or_default());
            // `d -halo 0.5` has its number last.
            let number = rest.rsplit(' ').next().and_then(finite);
            match keyword.to_ascii_lowercase().as_str() {
                "newmtl" => {
                    note(std::mem::replace(&mut material, (rest, Transparency::default())), found);
                }
                "d" => material.1.d = number,
                "tr" => material.1.tr = number,
                "map_d" | "map_tr" | "map_opacity" => {
                    material.1.map = Some(excerpt(&format!("{keyword} {rest}")));
                }
                _ => {}
            }
        }
        note(material, found);
    }
}

fn note((name, transparency): (String, Transparency), found: &mut IndexMap<String, String>) {
    if let Some(words) = transparency.words() {
        // As viewers do, the first material of a name counts.
        found.entry(name).or_insert(words);
    }
}
