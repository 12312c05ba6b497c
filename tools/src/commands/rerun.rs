//! `rerun`: the run that wrote a file, once more.

use anyhow::bail;
use sunfleck::output::Results;
use sunfleck::scratch::ScratchSpace;
use sunfleck::{output, run};

use super::run::write_report;
use crate::arguments::Rerun;

pub(super) fn rerun(arguments: &Rerun) -> anyhow::Result<()> {
    let record = output::read_record(&arguments.file)?;
    let folder = arguments.folder.clone().unwrap_or_else(|| record.scene_folder());
    if !folder.is_dir() {
        bail!(
            "the run read files in {}, which is not there: name that folder with `--folder DIR`",
            folder.display()
        );
    }
    let changed = run::changed_files(&record, &folder);
    let console = arguments.console;
    console.warn(&changed);
    console.warn(&differences(&record));
    let inputs = match (record.files.len(), changed.len()) {
        (0, _) => "it read no files".to_owned(),
        (all, 0) => format!("none of its {all} input files has changed since"),
        (all, changed) => format!("{changed} of its {all} input files changed since"),
    };
    console.say(&format!(
        "repeats the run of {} (sunfleck {}, hash {}): {inputs}\n\n",
        arguments.file.display(),
        record.version,
        record.hash.get(..12).unwrap_or(&record.hash),
    ))?;
    let out = arguments.out(&record.results);
    // The scene may be gone: its results are those of this file.
    let scene = record.scene_file().unwrap_or_else(|| arguments.file.clone());
    let results = Results::open(&out, "run", &scene, arguments.force)?;
    let options = run::Options {
        threads: arguments.threads.map(Into::into),
        scratch: ScratchSpace::within(&out),
        ..run::Options::default()
    };
    let observer = console.observer();
    let report = run::rerun(&record, &folder, &options, &observer);
    observer.clear();
    let report = report?;
    let is_same = report.hash == record.hash || record.is_joint || !changed.is_empty();
    if !is_same {
        let text =
            "this version of sunfleck takes another scene from the same text: results differ";
        console.warn(&[text.to_owned()]);
    }
    let work = format!("{:.3} million rays in {:.1} s", report.rays as f64 / 1e6, report.seconds);
    write_report(&results, &report, &work, console)
}

/// Reasons for which results may differ from those before, though files are the same.
fn differences(record: &output::RecipeRecord) -> Vec<String> {
    let own = env!("CARGO_PKG_VERSION");
    let mut all = Vec::new();
    if record.version != own {
        let version = &record.version;
        all.push(format!(
            "the results are of sunfleck {version}, and this is {own}: numbers may differ"
        ));
    }
    if record.is_joint {
        let text = "the results are of a point of a sweep that shared its paths with others: a run alone has the same values but for rounding";
        all.push(text.to_owned());
    }
    all
}
