//! Commands about the text of a scene: `check`, `expand`, `fmt`.

use std::fmt::Write as _;

use anyhow::bail;
use sunfleck::counts::counted;
use sunfleck::{document, output, run};

use super::{NOTE, SKIPPED, print, warn};
use crate::arguments::{Check, Fmt, Scene};
use crate::describe;
use crate::progress::Bars;

/// Checks a scene and describes its contents.
pub(super) fn described(scene: &Scene) -> anyhow::Result<run::Checked> {
    let options = run::Options { document: scene.options(), ..run::Options::default() };
    let bars = Bars::new();
    let checked = run::describe_file(&scene.file, &options, &bars);
    bars.clear();
    Ok(checked?)
}

pub(super) fn check(arguments: &Check) -> anyhow::Result<()> {
    let scene = &arguments.scene;
    let run::Checked { warnings, facts } = described(scene)?;
    if arguments.json {
        return print(&describe::json(facts.as_ref(), &warnings)?);
    }
    let (mut notes, warnings): (Vec<String>, Vec<String>) =
        warnings.into_iter().partition(|text| text.starts_with(NOTE));
    warn(&warnings);
    let found = match warnings.iter().filter(|text| !text.starts_with(SKIPPED)).count() {
        0 => "no errors".to_owned(),
        n => format!("no errors, {}", counted(n, "warning")),
    };
    notes.extend(facts.as_ref().and_then(describe::note_without_sky));
    let facts = facts.as_ref().map(describe::text).unwrap_or_default();
    let notes = notes.iter().flat_map(|note| [note.as_str(), "\n"]).collect::<String>();
    print(&format!("{facts}{notes}{}: {found}\n", scene.file.display()))
}

pub(super) fn expand(scene: &Scene) -> anyhow::Result<()> {
    let reading = document::read_file(&scene.file, &scene.options())?;
    if !reading.is_sound() {
        bail!(reading.render());
    }
    print(&reading.expanded())
}

pub(super) fn fmt(arguments: &Fmt) -> anyhow::Result<()> {
    let mut changed = String::new();
    for file in &arguments.files {
        let (text, formatted) = document::format_file(file)?;
        if text == formatted {
            continue;
        }
        writeln!(changed, "{}", file.display())?;
        if !arguments.check {
            output::replace(file, &formatted)?;
        }
    }
    print(&changed)?;
    if arguments.check && !changed.is_empty() {
        bail!("not formatted: run `sunfleck fmt` on these files");
    }
    Ok(())
}
