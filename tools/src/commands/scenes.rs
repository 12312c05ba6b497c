//! Scenes in a folder, for someone who has named none.

use std::fs;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use clap::error::{ContextKind, ContextValue, ErrorKind};
use sunfleck::document;

/// Levels of folders below the one that is searched.
const DEPTH: usize = 3;

/// Number of files and folders that are looked at.
const MOST_ENTRIES: usize = 20_000;

/// Number of scenes that are listed.
const MOST_SCENES: usize = 40;

/// Bytes of a file that are searched for the start of a scene.
const HEAD: u64 = 1 << 16;

/// Returns true if a command line lacks a scene and nothing else is wrong with it.
pub(super) fn is_missing(error: &clap::Error) -> bool {
    let is_scene = |argument: &String| argument.contains("<SCENE>");
    error.kind() == ErrorKind::MissingRequiredArgument
        && match error.get(ContextKind::InvalidArg) {
            Some(ContextValue::Strings(arguments)) => arguments.iter().any(is_scene),
            Some(ContextValue::String(argument)) => is_scene(argument),
            _ => false,
        }
}

/// Text that lists the scenes in a folder and in those within it.
pub(super) fn listing(folder: &Path) -> String {
    let (mut found, mut seen) = (Vec::new(), 0);
    search(folder, DEPTH, &mut seen, &mut found);
    if found.is_empty() {
        return "\nThere is no scene here; `sunfleck new stand` writes one.\n".to_owned();
    }
    let shown = &found[..found.len().min(MOST_SCENES)];
    let names: Vec<String> = shown.iter().map(|file| file.display().to_string()).collect();
    let width = names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
    let line = |(name, file): (&String, &PathBuf)| format!("  {name:width$}  {}", title(file));
    let mut lines = vec!["\nScenes here:".to_owned()];
    lines.extend(names.iter().zip(shown).map(line));
    if found.len() > shown.len() {
        lines.push(format!("  and {} more", found.len() - shown.len()));
    }
    lines.iter().flat_map(|line| [line.trim_end(), "\n"]).collect()
}

/// Adds the scenes in a folder in the order of their names; those of folders within it follow.
fn search(folder: &Path, depth: usize, seen: &mut usize, found: &mut Vec<PathBuf>) {
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    // A folder that cannot be read shows no scene.
    let Ok(entries) = fs::read_dir(here) else { return };
    let mut entries: Vec<_> = entries.flatten().take(MOST_ENTRIES - *seen).collect();
    *seen += entries.len();
    entries.sort_by_key(fs::DirEntry::file_name);
    let mut folders = Vec::new();
    for entry in entries {
        let (name, path) = (entry.file_name(), folder.join(entry.file_name()));
        let is_hidden = name.to_string_lossy().starts_with('.');
        match entry.file_type() {
            Ok(kind) if kind.is_dir() && !is_hidden && name != "target" => folders.push(path),
            Ok(kind) if kind.is_file() && is_scene(&path) => found.push(path),
            _ => {}
        }
    }
    if depth > 0 {
        for folder in &folders {
            search(folder, depth - 1, seen, found);
        }
    }
}

/// Returns true if a file is a scene by its name and its first word; libraries start with another one.
fn is_scene(file: &Path) -> bool {
    let head = || {
        let mut bytes = Vec::new();
        fs::File::open(file)?.take(HEAD).read_to_end(&mut bytes).map(|_| bytes)
    };
    let first_word = |text: &str| -> Option<String> {
        let line = text.lines().map(str::trim_start);
        let mut line = line.filter(|line| !line.is_empty() && !line.starts_with("//"));
        Some(line.next()?.to_owned())
    };
    file.extension().is_some_and(|ending| ending == "ron")
        && head().is_ok_and(|bytes| {
            let word = first_word(String::from_utf8_lossy(&bytes).trim_start_matches('\u{feff}'));
            word.is_some_and(|word| word.starts_with("Scene"))
        })
}

/// Title of a scene, or a note that it has errors.
fn title(file: &Path) -> String {
    match document::read_file(file, &document::ReadOptions::default()) {
        Ok(reading) if reading.is_sound() => reading.scene.title,
        _ => "(has errors: `sunfleck check` shows them)".to_owned(),
    }
}
