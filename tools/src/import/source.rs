//! Programs whose scenes can be imported, and how their files are known.

use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};
use clap::ValueEnum;

/// Program that a scene is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SourceProgram {
    /// Project folder of LESS 1.8.8
    Less,
    /// Canopy scenario of Eradiate: `scenario.json` with its meshes
    Eradiate,
    /// Lists of the RAMI benchmark: `.def` files of discs and of places
    Rami,
    /// XML geometry of Helios
    Helios,
}

/// Name of the file that a scenario of Eradiate consists of.
pub(super) const SCENARIO: &str = "scenario.json";

impl SourceProgram {
    /// Name of the program.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Less => "LESS",
            Self::Eradiate => "Eradiate",
            Self::Rami => "RAMI",
            Self::Helios => "Helios",
        }
    }

    /// The program whose files these are.
    ///
    /// # Errors
    /// If nothing is there, if no program is known by it, or if several are.
    pub(super) fn of_path(path: &Path) -> Result<Self> {
        let metadata =
            path.metadata().with_context(|| format!("cannot read {}", path.display()))?;
        let found = if metadata.is_dir() { of_folder(path) } else { of_file(path)? };
        match found[..] {
            [program] => Ok(program),
            [] => bail!(
                "{} is no scene that can be imported; that is a project folder of LESS (with `Parameters/input.conf`), \
                 a `scenario.json` of Eradiate or its folder, a folder with `.def` files of RAMI, or an XML file of Helios",
                path.display()
            ),
            _ => {
                let names = found.iter().map(|program| program.name().to_lowercase());
                let names: Vec<_> = names.map(|name| format!("`--from {name}`")).collect();
                bail!("{} may be of several programs: write {}", path.display(), names.join(" or "))
            }
        }
    }
}

fn of_folder(folder: &Path) -> Vec<SourceProgram> {
    let is_less = folder.join("Parameters/input.conf").is_file();
    let is_eradiate = folder.join(SCENARIO).is_file();
    let is_rami = !files_with_ending(folder, "def").is_empty();
    let found = [
        (is_less, SourceProgram::Less),
        (is_eradiate, SourceProgram::Eradiate),
        (is_rami, SourceProgram::Rami),
    ];
    found.into_iter().filter(|(is_found, _)| *is_found).map(|(_, program)| program).collect()
}

fn of_file(file: &Path) -> Result<Vec<SourceProgram>> {
    let cannot = || format!("cannot read {}", file.display());
    if !file.is_file() {
        bail!("{} is neither a file nor a folder", file.display());
    }
    let mut head = Vec::new();
    File::open(file)
        .with_context(cannot)?
        .take(4096)
        .read_to_end(&mut head)
        .with_context(cannot)?;
    let head = String::from_utf8_lossy(&head);
    let has_ending =
        |ending: &str| file.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending));
    Ok(if head.contains("<helios") {
        vec![SourceProgram::Helios]
    } else if has_ending("json") && head.trim_start().starts_with('{') {
        vec![SourceProgram::Eradiate]
    } else if has_ending("def") {
        vec![SourceProgram::Rami]
    } else {
        Vec::new()
    })
}

/// Files of a folder with an ending, in the order of their names.
pub(super) fn files_with_ending(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let Ok(entries) = folder.read_dir() else { return Vec::new() };
    let mut files: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending)))
        .filter(|path| path.is_file())
        .collect();
    files.sort();
    files
}
