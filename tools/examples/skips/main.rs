//! What a scene does not need is not done: what each such skip saves in time and memory, on a scene
//! where it applies.
//!
//!     cargo run --release -p sunfleck-tools --example skips > engine/SKIPS.md
//!
//! Each scene runs with the skip and, changed so little that its results stay, without it; in turn, and each
//! time in a process of its own, whose peak memory is its own.

#![allow(clippy::print_stdout, reason = "an example prints what it found")]

mod cases;
mod numbers;

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use anyhow::{Context as _, bail};
use sunfleck::products::Report;
use sunfleck::{document, run};

use cases::{CASES, Case, Setting};
use numbers::Numbers;

/// Times that each scene runs; the medians are shown.
const ROUNDS: usize = 3;

fn main() -> anyhow::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => table(ROUNDS),
        ["--rounds", rounds] => table(rounds.parse::<usize>()?.max(1)),
        // What the program calls itself with.
        ["--one", case, way] => {
            let case = CASES.get(case.parse::<usize>()?).context("no such case")?;
            print!("{}", Run::of(case, way == "with")?.to_text());
            Ok(())
        }
        _ => bail!("usage: skips [--rounds N]"),
    }
}

/// What one run of a scene took, and what it found.
struct Run {
    seconds: f64,
    /// Peak memory of the process, MiB; NaN where the system does not tell.
    memory: f64,
    rays: u64,
    numbers: Numbers,
}

impl Run {
    fn of(case: &Case, skips: bool) -> anyhow::Result<Self> {
        let folder = tempfile::tempdir()?;
        let text = (case.scene)(&Setting { skips, share: 1.0, folder: folder.path() })?;
        let start = Instant::now();
        let report = measure(&text, folder.path(), 1.0)?;
        let seconds = start.elapsed().as_secs_f64();
        let numbers = Numbers::of(&report, case.products);
        Ok(Self { seconds, memory: peak_memory().unwrap_or(f64::NAN), rays: report.rays, numbers })
    }

    fn to_text(&self) -> String {
        format!("{} {} {}\n{}", self.seconds, self.memory, self.rays, self.numbers.to_text())
    }

    fn from_text(text: &str) -> anyhow::Result<Self> {
        let (head, numbers) = text.split_once('\n').context("no numbers")?;
        let mut head = head.split(' ');
        let mut next = || head.next().context("too few figures");
        Ok(Self {
            seconds: next()?.parse()?,
            memory: next()?.parse()?,
            rays: next()?.parse()?,
            numbers: Numbers::from_text(numbers)?,
        })
    }

    /// The same in a process of its own.
    fn apart(index: usize, skips: bool) -> anyhow::Result<Self> {
        let way = if skips { "with" } else { "without" };
        let output = Command::new(std::env::current_exe()?)
            .args(["--one", &index.to_string(), way])
            .output()?;
        if !output.status.success() {
            let error = String::from_utf8_lossy(&output.stderr);
            bail!("{} {way} the skip: {error}", CASES[index].name);
        }
        Self::from_text(std::str::from_utf8(&output.stdout)?)
    }
}

/// What a scene measures, with this factor on its samples.
fn measure(text: &str, folder: &Path, quality: f64) -> anyhow::Result<Report> {
    let reading = document::read_text("skips.ron", text, &document::ReadOptions::default())?;
    if !reading.is_sound() {
        bail!(reading.render());
    }
    let options = run::Options { quality, ..run::Options::default() };
    run(&reading.scene, folder, &options, &run::Unwatched)
        .map_err(|failure| failure.with_source(&reading.source).into())
}

/// The page before the table.
const HEAD: &str = "# What is not done

What a scene does not need is neither loaded nor traced. Each row is a scene where one such skip
applies, as it is, and changed so little that the skip does not apply and the results stay; how is
said below. `what_is_skipped_changes_no_result` in `tools/examples/skips` holds what the last column says.

    cargo run --release -p sunfleck-tools --example skips > engine/SKIPS.md
";

fn table(rounds: usize) -> anyhow::Result<()> {
    let threads = std::thread::available_parallelism()?;
    println!(
        "{HEAD}\nmakes this page. Rounds in turn: {rounds}; threads: {threads}. Times are \
         from the scene's text to its results: medians, with their range.\n"
    );
    println!(
        "| skipped | s | s without the skip | MiB | without | million rays | without | results |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for (index, case) in CASES.iter().enumerate() {
        let (mut with, mut without) = (Vec::new(), Vec::new());
        for _ in 0..rounds {
            with.push(Run::apart(index, true)?);
            without.push(Run::apart(index, false)?);
        }
        let results = case.same.verdict(&with[0].numbers, &without[0].numbers);
        let [s, full_s] = [&with, &without].map(|runs| seconds(runs));
        let [mib, full_mib] =
            [&with, &without].map(|runs| median(runs.iter().map(|run| run.memory)).1);
        let [rays, full_rays] = [&with, &without].map(|runs| runs[0].rays as f64 / 1e6);
        println!(
            "| {} | {s} | {full_s} | {mib:.0} | {full_mib:.0} | {rays:.2} | {full_rays:.2} | {results} |",
            case.name
        );
    }
    println!("\nHow each scene is made to do without:\n");
    for case in CASES {
        println!("- **{}**: {}.", case.name, case.how);
    }
    Ok(())
}

fn seconds(runs: &[Run]) -> String {
    let (least, middle, most) = median(runs.iter().map(|run| run.seconds));
    format!("{middle:.2} ({least:.2} to {most:.2})")
}

/// Least, median and largest value.
fn median(values: impl Iterator<Item = f64>) -> (f64, f64, f64) {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    (values[0], values[values.len() / 2], values[values.len() - 1])
}

/// The most memory that this process has held, MiB, where the system tells (Linux).
fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kibibytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kibibytes / 1024.0)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests {
    use super::*;
    use crate::numbers::Same;

    /// Each scene at a hundredth of its size and samples. *Expected*: what its row of the table says of the
    /// results, and no more rays with the skip than without, if they are the same ones.
    #[test]
    fn what_is_skipped_changes_no_result() {
        for case in CASES {
            let folder = tempfile::tempdir().unwrap();
            let run = |skips| {
                let setting = Setting { skips, share: 0.01, folder: folder.path() };
                let text = (case.scene)(&setting).unwrap();
                let report = measure(&text, folder.path(), 0.01).unwrap();
                (report.rays, Numbers::of(&report, case.products))
            };
            let ((few, with), (many, without)) = (run(true), run(false));
            assert!(case.same.holds(&with, &without), "{}", case.name);
            let fewer = few <= many || !matches!(case.same, Same::Bits);
            assert!(fewer, "{}: {few} rays instead of {many}", case.name);
            assert!(!with.values.is_empty(), "{}", case.name);
        }
    }

    #[test]
    fn runs_survive_the_way_between_processes() {
        let numbers = Numbers { values: vec![0.1, f64::NAN], errors: vec![1e-300, 0.0] };
        let run = Run { seconds: 0.25, memory: 12.5, rays: 7, numbers };
        let other = Run::from_text(&run.to_text()).unwrap();
        assert_eq!((other.seconds, other.memory, other.rays), (0.25, 12.5, 7));
        assert!(other.numbers.are_the_bits_of(&run.numbers));
    }
}
