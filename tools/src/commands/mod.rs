//! Execution of the commands: one file a command, or a few that share most of their code.

mod answer;
mod chm;
mod export;
mod lai;
mod new;
mod preview;
mod radiance;
mod report;
mod rerun;
mod run;
mod scenes;
mod shell;
mod stats;
mod sunpos;
mod sweep;
mod text;

use std::io::{self, Write as _};
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context as _, bail};
use sunfleck::counts::counted;
use sunfleck::document;
use sunfleck::output::Written;

use crate::arguments::{Bench, Command, Keys, OtherBench, Verify};
use crate::import::{self, ImportOptions, SourceProgram};
use crate::{bench, compare, verify};

pub(crate) use chm::Chm;
pub(crate) use export::Export;
pub(crate) use lai::Lai;
pub(crate) use new::New;
pub(crate) use preview::Preview;
pub(crate) use radiance::{Brf, Bt};
pub(crate) use report::Report;
pub(crate) use shell::{Completions, Man};
pub(crate) use stats::Stats;
pub(crate) use sunpos::Sunpos;

/// Heading of what a scene defines and does not use.
const SKIPPED: &str = "skipped: ";

/// Heading of a value that was assumed without a key in the scene.
const NOTE: &str = "note: ";

/// Runs a command.
pub(crate) fn execute(command: &Command) -> anyhow::Result<()> {
    match command {
        Command::Run(arguments) => run::trace(arguments),
        Command::Respectrum(arguments) => run::respectrum(arguments),
        Command::Rerun(arguments) => rerun::rerun(arguments),
        Command::Merge(arguments) => run::merge(arguments),
        Command::Sweep(arguments) => sweep::sweep(arguments),
        Command::Compare(arguments) => print(&compare::compare(arguments)?),
        Command::Report(arguments) => arguments.execute(),
        Command::Check(arguments) => text::check(arguments),
        Command::Preview(arguments) => preview::preview(arguments),
        Command::Chm(arguments) => chm::chm(arguments),
        Command::Sunpos(arguments) => sunpos::sunpos(arguments),
        Command::Brf(arguments) => radiance::brf(arguments),
        Command::Bt(arguments) => radiance::bt(arguments),
        Command::Stats(arguments) => stats::stats(arguments),
        Command::Lai(arguments) => lai::lai(arguments),
        Command::Export(arguments) => export::write(arguments),
        Command::Expand(scene) => text::expand(scene),
        Command::Fmt(arguments) => text::fmt(arguments),
        Command::Schema => print(&document::json_schema()),
        Command::Keys(Keys { name: None }) => print(&document::keys_page()),
        Command::Keys(Keys { name: Some(name) }) => match document::keys_about(name) {
            Ok(text) => print(&text),
            Err(error) => bail!(error),
        },
        Command::Import(arguments) => {
            let options = ImportOptions { from: arguments.from, size_m: arguments.size_m };
            print(&import::import(&arguments.path, &arguments.out(), options)?)
        }
        Command::ImportLess(arguments) => {
            let options = ImportOptions { from: Some(SourceProgram::Less), size_m: None };
            print(&import::import(&arguments.path, &arguments.out(), options)?)
        }
        Command::New(arguments) => new::new(arguments),
        Command::Completions(arguments) => shell::completions(arguments),
        Command::Man(arguments) => shell::man(arguments),
        Command::Verify(arguments) => verify(arguments),
        Command::Bench(Bench { other: Some(OtherBench::Rays(arguments)), .. }) => {
            print(&bench::rays(arguments)?)
        }
        Command::Bench(Bench { error, .. }) => match error {
            Some(arguments) => print(&bench::error(arguments)?),
            None => bail!("name a scene: sunfleck bench SCENE"),
        },
    }
}

/// Shows what is wrong with the command line; where a scene is missing, with the scenes here.
pub(crate) fn refuse(error: &clap::Error) -> ExitCode {
    // Whoever has gone away has seen enough.
    drop(error.print());
    if scenes::is_missing(error) {
        drop(io::stderr().write_all(scenes::listing(Path::new("")).as_bytes()));
    }
    ExitCode::from(error.exit_code() as u8)
}

/// Message of a command that failed.
pub(crate) fn message(error: &anyhow::Error) -> String {
    let mut text = error.to_string();
    for cause in error.chain().skip(1) {
        // Some errors name their cause themselves.
        let cause = cause.to_string();
        if !text.ends_with(cause.strip_prefix("error: ").unwrap_or(&cause)) {
            text = format!("{text}: {cause}");
        }
    }
    // The engine shows each diagnostic with its own heading and excerpt.
    let headed = ["error: ", "warning: "].iter().any(|heading| text.starts_with(heading));
    if headed { text.trim_end().to_owned() } else { format!("error: {text}") }
}

/// Text about files that were written: their number, their folder, and the results that they replace.
pub(crate) fn told(written: &Written) -> String {
    let replaced = written.replaced.as_ref().map_or_else(String::new, |old| format!(" ({old})"));
    format!("{} in {}{replaced}", counted(written.files.len(), "file"), written.folder.display())
}

fn verify(arguments: &Verify) -> anyhow::Result<()> {
    if !verify::verify(&arguments.only, arguments.json, print)? {
        bail!("this program gives wrong results on this machine: see the checks that failed");
    }
    Ok(())
}

/// Argument as a shell reads it.
pub(crate) fn quoted(argument: &str) -> String {
    let is_plain = |letter: char| letter.is_alphanumeric() || "-_./=+,:@%".contains(letter);
    if !argument.is_empty() && argument.chars().all(is_plain) {
        argument.to_owned()
    } else {
        format!("'{}'", argument.replace('\'', r"'\''"))
    }
}

pub(crate) fn warn(warnings: &[String]) {
    let mut stderr = io::stderr().lock();
    for warning in warnings {
        let headed = ["warning: ", SKIPPED].iter().any(|heading| warning.starts_with(heading));
        let heading = if headed { "" } else { "warning: " };
        // A warning that cannot be shown is no reason to lose the results.
        drop(writeln!(stderr, "{heading}{}", warning.trim_end()));
    }
}

/// Prints `text`; a reader that has gone away (`| head`) has seen enough.
pub(crate) fn print(text: &str) -> anyhow::Result<()> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(error).context("cannot print the results")
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;

    #[test]
    fn files_are_counted_with_their_noun() {
        let told = |count: usize| {
            let files = vec![PathBuf::from("out/a.csv"); count];
            told(&Written { folder: PathBuf::from("out"), files, replaced: None })
        };
        assert_eq!([told(1), told(2)], ["1 file in out", "2 files in out"]);
    }
}
