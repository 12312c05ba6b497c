//! Scenes of other programs.
//!
//! Each reader writes a folder with a scene, tables and copies of meshes, and reports what the scene does not hold just as
//! the other program does. Formats are read as they are documented.

mod draft;
mod eradiate;
mod helios;
mod less;
mod model;
mod rami;
mod report;
mod scene;
mod source;
mod text;

use std::path::Path;

use anyhow::Result;

use draft::Draft;
pub(crate) use source::SourceProgram;

/// Choices of an import.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ImportOptions {
    /// Program that the scene is from; that which its files show if absent.
    pub(crate) from: Option<SourceProgram>,
    /// Extent of the ground to the east and to the north, m, where files do not say it.
    pub(crate) size_m: Option<(f64, f64)>,
}

/// Imports what `path` is into the folder `out` and returns a report for a terminal.
pub(crate) fn import(path: &Path, out: &Path, options: ImportOptions) -> Result<String> {
    let program = match options.from {
        Some(program) => program,
        None => SourceProgram::of_path(path)?,
    };
    if program == SourceProgram::Less {
        return less::import(path, out);
    }
    let draft = Draft::create_for(out)?;
    let written = match program {
        SourceProgram::Eradiate => eradiate::import(path, draft.folder()),
        SourceProgram::Rami => rami::import(path, draft.folder(), options.size_m),
        SourceProgram::Helios => helios::import(path, draft.folder()),
        SourceProgram::Less => unreachable!("a project of LESS was imported above"),
    };
    let scene = written.map_err(|error| draft.without_its_name(&error, out))?;
    let finished = scene.finish(draft.folder(), path, program);
    let table = finished.map_err(|error| draft.without_its_name(&error, out))?;
    draft.publish(out)?;
    Ok(format!("{}: scene.ron\n{table}", out.display()))
}
