//! `chm`: height of the canopy of a scene, and of its surface.

use clap::Args;
use sunfleck::queries::CellCount;
use sunfleck::run;

use super::answer::Question;
use crate::arguments::{Scene, length};

#[derive(Args, Debug)]
pub(crate) struct Chm {
    #[command(flatten)]
    scene: Scene,

    /// Side of a cell, m; the nearest that divides the terrain is taken
    #[arg(long, value_name = "M", default_value_t = 1.0, value_parser = length)]
    cell: f64,

    #[command(flatten)]
    question: Question,
}

pub(super) fn chm(arguments: &Chm) -> anyhow::Result<()> {
    arguments.question.answer(&arguments.scene, "chm", |options, bars| {
        let cells = CellCount::Side(arguments.cell);
        run::height_model_file(&arguments.scene.file, options, cells, bars)
    })
}
