//! Names of files that belong together: values and header.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

/// Endings of files with raw values; what else follows a dot belongs to the name (`dem_1.5m`).
pub(super) const VALUES: [&str; 12] =
    ["img", "dat", "raw", "bsq", "bil", "bip", "bin", "flt", "envi", "sli", "rst", "grd"];

/// Files of a folder with this name, whatever the case of its letters; the exact name comes first.
pub(super) fn named(folder: &Path, name: &str) -> Vec<PathBuf> {
    let exact = folder.join(name);
    let mut found: Vec<PathBuf> = exact.is_file().then_some(exact.clone()).into_iter().collect();
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let Ok(entries) = fs::read_dir(folder) else { return found };
    let mut others: Vec<OsString> = entries
        .filter_map(|entry| Some(entry.ok()?.file_name()))
        .filter(|other| other.to_string_lossy().eq_ignore_ascii_case(name) && other != name)
        .collect();
    others.sort();
    let parent = exact.parent().unwrap_or(Path::new(""));
    found.extend(others.into_iter().map(|name| parent.join(name)).filter(|path| path.is_file()));
    found
}

/// Folder and name of a file.
pub(super) fn split(path: &Path) -> (&Path, String) {
    let folder = path.parent().unwrap_or(Path::new(""));
    let name =
        path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    (folder, name)
}

/// A name without the ending that is named, whatever the case of its letters.
pub(super) fn without<'a>(name: &'a str, ending: &str) -> Option<&'a str> {
    let (stem, found) = name.rsplit_once('.')?;
    (found.eq_ignore_ascii_case(ending) && !stem.is_empty()).then_some(stem)
}

/// Headers that may belong to a file with values: `dem.img.hdr`, then `dem.hdr`.
pub(super) fn headers(values: &Path) -> Vec<PathBuf> {
    let (folder, name) = split(values);
    let mut found = named(folder, &format!("{name}.hdr"));
    if let Some(stem) = VALUES.iter().find_map(|ending| without(&name, ending)) {
        found.extend(named(folder, &format!("{stem}.hdr")));
    }
    found
}

/// Files with values that may belong to a header: `dem` and `dem.img` for `dem.hdr`, and the names
/// that were tried.
pub(super) fn values(header: &Path) -> (Vec<PathBuf>, Vec<String>) {
    let (folder, name) = split(header);
    let Some(stem) = without(&name, "hdr") else { return (Vec::new(), Vec::new()) };
    let mut tried = vec![stem.to_owned()];
    // The header of `dem.img` may be `dem.img.hdr`: no ending follows then.
    let has_ending = VALUES.iter().any(|ending| without(stem, ending).is_some());
    if !has_ending || named(folder, stem).is_empty() {
        tried.extend(VALUES.iter().map(|ending| format!("{stem}.{ending}")));
    }
    let mut found: Vec<PathBuf> = Vec::new();
    for path in tried.iter().flat_map(|name| named(folder, name)) {
        if path != header && !found.contains(&path) {
            found.push(path);
        }
    }
    (found, tried)
}
