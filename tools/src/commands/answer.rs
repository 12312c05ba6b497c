//! Answers to questions about a scene, as files and as a table.

use std::fmt::Write as _;
use std::num::NonZeroUsize;

use clap::Args;
use sunfleck::output::{self, Results};
use sunfleck::products::Report;
use sunfleck::run::{Failure, Options};

use super::{NOTE, print, told, warn};
use crate::arguments::{Formats, Out, Scene};
use crate::progress::Bars;

/// Arguments of all questions.
#[derive(Args, Debug)]
pub(crate) struct Question {
    /// Number of threads [default: all]; results do not depend on it
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,

    #[command(flatten)]
    formats: Formats,

    #[command(flatten)]
    out: Out,
}

impl Question {
    /// Asks a question about a scene, writes the files of the report that answers it, and prints its table.
    ///
    /// - `name`: of the command
    pub(super) fn answer(
        &self,
        scene: &Scene,
        name: &'static str,
        ask: impl FnOnce(&Options, &Bars) -> Result<Report, Failure>,
    ) -> anyhow::Result<()> {
        let folder = self.out.folder(scene, &format!("_{name}"));
        let results = Results::open(&folder, name, &scene.file, self.out.force)?;
        let options = Options {
            document: self.formats.options(scene),
            threads: self.threads.map(Into::into),
            ..Options::default()
        };
        let bars = Bars::new();
        let report = ask(&options, &bars);
        bars.clear();
        write_answer(&results, &report?)
    }
}

/// Writes the files of a report that answers a question, and prints its table.
pub(super) fn write_answer(results: &Results, report: &Report) -> anyhow::Result<()> {
    warn(&report.warnings);
    let written = results.write(report)?;
    let mut text = output::table(report);
    report.notes.iter().try_for_each(|note| writeln!(text, "{NOTE}{note}"))?;
    writeln!(text, "\n{}: {:.1} s", told(&written), report.seconds)?;
    print(&text)
}
