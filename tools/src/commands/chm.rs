//! `chm`: height of the canopy of a scene, and of its surface.

use std::num::NonZeroUsize;

use clap::Args;
use sunfleck::output::Results;
use sunfleck::queries::CellCount;
use sunfleck::run;

use super::answer::write_answer;
use crate::arguments::{Formats, Out, Scene, length};
use crate::progress::Bars;

#[derive(Args, Debug)]
pub(crate) struct Chm {
    #[command(flatten)]
    scene: Scene,

    /// Side of a cell, m; the nearest that divides the terrain is taken
    #[arg(long, value_name = "M", default_value_t = 1.0, value_parser = length)]
    cell: f64,

    /// Number of threads [default: all]; results do not depend on it
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,

    #[command(flatten)]
    formats: Formats,

    #[command(flatten)]
    out: Out,
}

pub(super) fn chm(arguments: &Chm) -> anyhow::Result<()> {
    let file = &arguments.scene.file;
    let folder = arguments.out.folder(&arguments.scene, "_chm");
    let results = Results::open(&folder, "chm", file, arguments.out.force)?;
    let options = run::Options {
        document: arguments.formats.options(&arguments.scene),
        threads: arguments.threads.map(Into::into),
        ..run::Options::default()
    };
    let bars = Bars::new();
    let report = run::height_model_file(file, &options, CellCount::Side(arguments.cell), &bars);
    bars.clear();
    write_answer(&results, &report?)
}
