//! `stats`: plants of a scene, their numbers, sizes and leaf area.

use clap::Args;
use sunfleck::run;

use super::{SKIPPED, print, warn};
use crate::arguments::Scene;
use crate::describe;
use crate::progress::Bars;

#[derive(Args, Debug)]
pub(crate) struct Stats {
    #[command(flatten)]
    scene: Scene,

    /// Print JSON: all that `check --json` prints
    #[arg(long)]
    json: bool,
}

pub(super) fn stats(arguments: &Stats) -> anyhow::Result<()> {
    let scene = &arguments.scene;
    let options = run::Options { document: scene.options(), ..run::Options::default() };
    let bars = Bars::new();
    let checked = run::describe_file(&scene.file, &options, &bars);
    bars.clear();
    let run::Checked { warnings, facts } = checked?;
    if arguments.json {
        return print(&describe::json(facts.as_ref(), &warnings)?);
    }
    let of_scene = |text: &&String| !text.starts_with(SKIPPED) && !text.starts_with(super::NOTE);
    warn(&warnings.iter().filter(of_scene).cloned().collect::<Vec<_>>());
    print(&facts.as_ref().map(describe::statistics).unwrap_or_default())
}
