//! Answers to questions about a scene, as files and as a table.

use std::fmt::Write as _;

use sunfleck::output::{self, Results};
use sunfleck::products::Report;

use super::{NOTE, print, told, warn};

/// Writes the files of a report that answers a question, and prints its table.
pub(super) fn write_answer(results: &Results, report: &Report) -> anyhow::Result<()> {
    warn(&report.warnings);
    let written = results.write(report)?;
    let mut text = output::table(report);
    report.notes.iter().try_for_each(|note| writeln!(text, "{NOTE}{note}"))?;
    writeln!(text, "\n{}: {:.1} s", told(&written), report.seconds)?;
    print(&text)
}
