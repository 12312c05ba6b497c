//! Arguments of imports.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::import::SourceProgram;

#[derive(Args, Debug)]
pub(crate) struct Import {
    /// Project folder of LESS, `scenario.json` of Eradiate or its folder, folder of RAMI's `.def` files, or XML file of
    /// Helios
    #[arg(value_name = "PATH")]
    pub(crate) path: PathBuf,

    /// Folder for the scene and its files [default: imported/<name of PATH>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Program that PATH is from, where its files may be of several
    #[arg(long, value_name = "PROGRAM")]
    pub(crate) from: Option<SourceProgram>,

    /// Extent of the ground to the east and to the north, m, which lists of RAMI do not hold
    #[arg(long, value_name = "X,Y", value_parser = size)]
    pub(crate) size_m: Option<(f64, f64)>,
}

#[derive(Args, Debug)]
pub(crate) struct ImportLess {
    /// Folder of the project; it contains `Parameters/input.conf`
    #[arg(value_name = "FOLDER")]
    pub(crate) path: PathBuf,

    /// Folder for the scene and its files [default: imported/<name of the project>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

impl Import {
    /// Folder for the scene.
    pub(crate) fn out(&self) -> PathBuf {
        self.out.clone().unwrap_or_else(|| default_out(&self.path))
    }
}

impl ImportLess {
    /// Folder for the scene.
    pub(crate) fn out(&self) -> PathBuf {
        self.out.clone().unwrap_or_else(|| default_out(&self.path))
    }
}

/// `imported/NAME` by the name of a folder, of a file, or of the folder of a scenario.
fn default_out(path: &Path) -> PathBuf {
    // `.` has no name of its own.
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let name = if !path.is_file() {
        path.file_name()
    } else if path.file_name().is_some_and(|name| name == "scenario.json") {
        path.parent().and_then(Path::file_name)
    } else {
        path.file_stem()
    };
    Path::new("imported").join(name.unwrap_or("project".as_ref()))
}

/// Two lengths above 0.
fn size(text: &str) -> Result<(f64, f64), String> {
    let lengths: Vec<f64> = text
        .split(',')
        .map_while(|word| word.trim().parse().ok())
        .filter(|length: &f64| length.is_finite() && *length > 0.0)
        .collect();
    match lengths[..] {
        [x, y] if text.split(',').count() == 2 => Ok((x, y)),
        _ => Err("expected two lengths above 0, m, such as 100,100".to_owned()),
    }
}
