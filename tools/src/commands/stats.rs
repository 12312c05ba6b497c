//! `stats`: plants of a scene, their numbers, sizes and leaf area.

use clap::Args;
use sunfleck::run;

use super::text::described;
use super::{SKIPPED, print, warn};
use crate::arguments::Scene;
use crate::describe;

#[derive(Args, Debug)]
pub(crate) struct Stats {
    #[command(flatten)]
    scene: Scene,

    /// Print JSON: all that `check --json` prints
    #[arg(long)]
    json: bool,
}

pub(super) fn stats(arguments: &Stats) -> anyhow::Result<()> {
    let run::Checked { warnings, facts } = described(&arguments.scene)?;
    if arguments.json {
        return print(&describe::json(facts.as_ref(), &warnings)?);
    }
    let of_scene = |text: &&String| !text.starts_with(SKIPPED) && !text.starts_with(super::NOTE);
    warn(&warnings.iter().filter(of_scene).cloned().collect::<Vec<_>>());
    print(&facts.as_ref().map(describe::statistics).unwrap_or_default())
}
