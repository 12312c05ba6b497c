//! The command line: commands and their arguments.

use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use clap::{Args, Parser, Subcommand};
use sunfleck::document::{self, System, nearest};
use sunfleck::output::{OutputError, Results, folder_name};
use sunfleck::run::{self, Partition};

use crate::verify::CHECKS;

/// Simulates light in forest scenes that are written as text: images, BRF, albedo, absorbed light.
#[derive(Debug, Parser)]
#[command(
    name = "sunfleck",
    version,
    arg_required_else_help = true,
    after_help = "First steps:\n  \
        sunfleck run scenes/birch_stand.ron                      results in out/birch_stand\n  \
        sunfleck run scenes/birch_stand.ron --set sza=60         with another value of a parameter\n  \
        sunfleck check scenes/birch_stand.ron                    errors and warnings only\n  \
        sunfleck keys Orthographic                               keys of a sensor, with units and defaults"
)]
pub(crate) enum Command {
    /// Run a scene and write the results of its sensors
    Run(Trace),
    /// Run a scene at every point of its `sweep` and write one table; continues an interrupted sweep
    Sweep(Run),
    /// Run a scene with several transport systems and show their differences in standard errors, and
    /// their cost
    Compare(Compare),
    /// Combine the checkpoints of `run --part` and write the results
    Merge(Merge),
    /// Report what a scene consists of, its errors and its warnings, without running it
    Check(Check),
    /// Measure run time and error of each product with each transport system, for several numbers of
    /// samples
    Bench(Bench),
    /// Test this program on this machine against known solutions; takes about a minute
    Verify(Verify),
    /// Print a scene with its includes, variant and parameters applied, and the origin of each value
    Expand(Scene),
    /// Format scene files; values and comments stay as they are
    Fmt(Fmt),
    /// Print a JSON schema of the scene language, for editors
    Schema,
    /// Print every key of the scene language with values, units, defaults and examples, as Markdown
    Keys(Keys),
    /// Convert a project folder of LESS 1.8.8 to a scene and report how each setting was converted
    ImportLess(ImportLess),
}

#[derive(Args, Debug)]
pub(crate) struct Check {
    #[command(flatten)]
    pub(crate) scene: Scene,

    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args, Debug)]
pub(crate) struct Verify {
    /// Run only this check; may be repeated
    #[arg(long, value_name = "NAME", value_parser = CHECKS.map(|check| check.name))]
    pub(crate) only: Vec<String>,

    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args, Debug)]
pub(crate) struct Keys {
    /// Type, variant or key to print alone, such as `Orthographic` or `size_px`
    #[arg(value_name = "NAME")]
    pub(crate) name: Option<String>,
}

#[derive(Args, Debug)]
pub(crate) struct ImportLess {
    /// Folder of the project; it contains `Parameters/input.conf`
    #[arg(value_name = "FOLDER")]
    pub(crate) folder: PathBuf,

    /// Folder for the scene and its files [default: imported/<name of the project>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

impl ImportLess {
    /// Folder for the scene.
    pub(crate) fn out(&self) -> PathBuf {
        self.out.clone().unwrap_or_else(|| {
            // `.` has no name of its own.
            let folder = std::path::absolute(&self.folder).unwrap_or_else(|_| self.folder.clone());
            Path::new("imported").join(folder.file_name().unwrap_or("project".as_ref()))
        })
    }
}

#[derive(Args, Debug)]
pub(crate) struct Fmt {
    /// Scene files
    #[arg(value_name = "SCENE", required = true)]
    pub(crate) files: Vec<PathBuf>,

    /// Change no file; fail if one is not formatted
    #[arg(long)]
    pub(crate) check: bool,
}

#[derive(Args, Debug)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(crate) struct Bench {
    #[command(subcommand)]
    pub(crate) other: Option<OtherBench>,

    #[command(flatten)]
    pub(crate) error: Option<ErrorBench>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum OtherBench {
    /// Measure rays per second, build time and memory of the ray engine
    Rays(Rays),
}

// A scene is enough to mean this, and no other command.
#[derive(Args, Debug)]
#[group(args = ["file"])]
pub(crate) struct ErrorBench {
    #[command(flatten)]
    pub(crate) measured: Measured,

    /// Number of times that the number of samples is doubled, up to that of --quality
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(2..=20))]
    pub(crate) doublings: u32,

    /// Number of independent measurements with each number of samples
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) repeats: u32,
}

#[derive(Args, Debug)]
pub(crate) struct Rays {
    #[command(flatten)]
    pub(crate) scene: Scene,

    /// Number of threads [default: all]
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,

    /// Number of paths whose rays are traced
    #[arg(long, value_name = "N", default_value_t = 100_000)]
    pub(crate) paths: u64,

    /// Number of repetitions of each measurement
    #[arg(long, value_name = "N", default_value_t = 7)]
    pub(crate) rounds: usize,
}

#[derive(Args, Debug)]
pub(crate) struct Trace {
    #[command(flatten)]
    pub(crate) run: Run,

    /// Run only the first samples, and print the time, memory and file sizes of the whole run
    #[arg(long, conflicts_with = "checkpoint")]
    pub(crate) forecast: bool,

    /// File that the run saves its state to and resumes from
    #[arg(long, value_name = "FILE")]
    pub(crate) checkpoint: Option<PathBuf>,

    /// Seconds between two saves of the checkpoint
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0, requires = "checkpoint", value_parser = seconds)]
    pub(crate) every: f64,

    /// Run only one part, such as 2/4, the second of four, and save it to the checkpoint; `merge` combines
    /// all parts
    #[arg(long, value_name = "I/N", requires = "checkpoint", value_parser = part)]
    pub(crate) part: Option<Partition>,
}

#[derive(Args, Debug)]
pub(crate) struct Merge {
    #[command(flatten)]
    pub(crate) scene: Scene,

    /// Checkpoint files of all parts
    #[arg(value_name = "FILE", required = true)]
    pub(crate) files: Vec<PathBuf>,

    #[command(flatten)]
    pub(crate) out: Out,

    /// Factor for the number of samples; the same as for the parts
    #[arg(long, value_name = "F", default_value_t = 1.0, value_parser = quality)]
    pub(crate) quality: f64,
}

impl Merge {
    /// Folder for the results.
    pub(crate) fn folder(&self) -> PathBuf {
        self.out.folder(&self.scene, "")
    }
}

#[derive(Args, Debug)]
pub(crate) struct Run {
    #[command(flatten)]
    pub(crate) scene: Scene,

    /// Measure with this sensor alone; may be repeated [default: all]
    #[arg(long = "sensor", value_name = "NAME")]
    pub(crate) sensors: Vec<String>,

    #[command(flatten)]
    pub(crate) out: Out,

    /// Number of threads [default: all]; results do not depend on it
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,

    /// Factor for the number of samples: 0.05 for a quick look
    #[arg(long, value_name = "F", default_value_t = 1.0, value_parser = quality)]
    pub(crate) quality: f64,

    /// Largest memory for films and results, such as 4GiB; larger runs are refused [default: free memory]
    #[arg(long, value_name = "SIZE", value_parser = memory)]
    pub(crate) memory: Option<u64>,
}

impl Run {
    /// Folder for the results of a command whose default folders end in `ending`.
    pub(crate) fn folder(&self, ending: &str) -> PathBuf {
        self.out.folder(&self.scene, ending)
    }
}

/// A scene, its sensors and transport systems.
#[derive(Args, Debug)]
pub(crate) struct Measured {
    #[command(flatten)]
    pub(crate) scene: Scene,

    /// Transport systems to run
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', default_values_t = default_systems(), value_parser = system)]
    systems: Vec<SystemName>,

    /// Run only this sensor; may be repeated [default: all]
    #[arg(long = "sensor", value_name = "NAME")]
    pub(crate) sensors: Vec<String>,

    /// Factor for the number of samples: 0.05 for a quick look
    #[arg(long, value_name = "F", default_value_t = 1.0, value_parser = quality)]
    pub(crate) quality: f64,

    /// Number of threads [default: all]; results do not depend on it
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,

    #[command(flatten)]
    out: Out,
}

impl Measured {
    /// Place for the results of a command.
    pub(crate) fn results(&self, command: &'static str) -> Result<Results, OutputError> {
        let folder = self.out.folder(&self.scene, &format!("_{command}"));
        Results::open(&folder, command, &self.scene.file, self.out.force)
    }

    /// How it is run.
    pub(crate) fn options(&self) -> run::Options {
        run::Options {
            document: self.scene.options(),
            threads: self.threads.map(Into::into),
            quality: self.quality,
            ..run::Options::default()
        }
    }

    /// Each system once, in the order in which they were named.
    pub(crate) fn systems(&self) -> Vec<System> {
        let mut systems = Vec::new();
        for SystemName(system) in &self.systems {
            if !systems.contains(system) {
                systems.push(*system);
            }
        }
        systems
    }
}

#[derive(Args, Debug)]
pub(crate) struct Compare {
    #[command(flatten)]
    pub(crate) measured: Measured,

    /// Transport system that the others are compared with [default: the first]
    #[arg(long, value_name = "NAME", value_parser = system)]
    reference: Option<SystemName>,

    /// Include every pixel of images in the table
    #[arg(long)]
    pub(crate) pixels: bool,
}

impl Compare {
    /// The system that the others are compared with.
    pub(crate) fn reference(&self) -> System {
        self.reference.as_ref().unwrap_or(&self.measured.systems[0]).0
    }
}

/// A transport system by its name.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SystemName(System);

impl std::fmt::Display for SystemName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.0.name())
    }
}

/// All systems but the slow reference integrator.
fn default_systems() -> Vec<SystemName> {
    let systems = System::ALL.into_iter().filter(|system| *system != System::Reference);
    systems.map(SystemName).collect()
}

fn system(text: &str) -> Result<SystemName, String> {
    let names = System::ALL.map(System::name);
    System::ALL.into_iter().find(|system| system.name() == text).map(SystemName).ok_or_else(|| {
        let all = names.join(", ");
        match nearest(text, names) {
            Some(near) => format!("did you mean `{near}`? There are: {all}"),
            None => format!("there are: {all}"),
        }
    })
}

#[derive(Args, Debug)]
pub(crate) struct Scene {
    /// Scene file
    #[arg(value_name = "SCENE")]
    pub(crate) file: PathBuf,

    /// Set a parameter of the scene to a number or a text; may be repeated
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = setting)]
    pub(crate) settings: Vec<(String, document::Param)>,

    /// Apply this variant of the scene
    #[arg(long, value_name = "NAME")]
    pub(crate) variant: Option<String>,
}

impl Scene {
    /// How it is read.
    pub(crate) fn options(&self) -> document::ReadOptions {
        document::ReadOptions {
            set: self.settings.clone(),
            variant: self.variant.clone(),
            ..document::ReadOptions::default()
        }
    }

    /// Name of the scene and of what is changed in it: `birch_winter_sza=60`.
    fn name(&self) -> String {
        let stem = self.file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        // Only the last value of a parameter counts.
        let settings: BTreeMap<&str, &document::Param> =
            self.settings.iter().map(|(name, value)| (name.as_str(), value)).collect();
        let settings = settings.iter().map(|(param, value)| format!("{param}={value}"));
        let parts = [stem].into_iter().chain(self.variant.clone()).chain(settings);
        let name = parts.collect::<Vec<_>>().join("_");
        folder_name(&name, &name)
    }
}

/// Where results go.
#[derive(Args, Debug)]
pub(crate) struct Out {
    /// Folder for the results; others of the same scene there are replaced, and files that are no
    /// results are kept [default: out/<name of the scene file>, with `_<variant>`, `_<name>=<value>` of each
    /// --set, and for other commands than run `_<command>`]
    #[arg(long = "out", value_name = "DIR")]
    folder: Option<PathBuf>,

    /// Replace results of another scene
    #[arg(long)]
    pub(crate) force: bool,
}

impl Out {
    fn folder(&self, scene: &Scene, ending: &str) -> PathBuf {
        let named = || Path::new("out").join(scene.name() + ending);
        self.folder.clone().unwrap_or_else(named)
    }
}

/// A number, or a text: that of digits behind a zero, `007`, is none that a formula would need.
fn param(text: &str) -> document::Param {
    let is_code = text.starts_with('0') && text[1..].starts_with(|c: char| c.is_ascii_digit());
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() && !is_code => number.into(),
        _ => text.into(),
    }
}

fn setting(text: &str) -> Result<(String, document::Param), String> {
    let (name, value) = text.split_once('=').ok_or("write NAME=VALUE, such as sza=30")?;
    let name = name.trim();
    if name.is_empty() {
        return Err("the name before `=` is missing".to_owned());
    }
    match value.trim() {
        "" => Err("there is no value behind `=`".to_owned()),
        value => Ok((name.to_owned(), param(value))),
    }
}

/// Largest number of parts of a run; each randomisation belongs to one part.
const MOST_PARTS: u32 = 32;

fn part(text: &str) -> Result<Partition, String> {
    let numbers = text.split_once('/').and_then(|(index, of)| {
        Some((index.trim().parse::<u32>().ok()?, of.trim().parse::<u32>().ok()?))
    });
    match numbers {
        Some((index, of)) if (1..=of).contains(&index) && of <= MOST_PARTS => {
            Ok(Partition { index: index - 1, count: of })
        }
        _ => Err(format!("write, for example, 2/4: the second of four, of at most {MOST_PARTS}")),
    }
}

fn memory(text: &str) -> Result<u64, String> {
    let text = text.trim();
    let end = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let power = match text[end..].trim() {
        "KiB" => 1,
        "MiB" => 2,
        "GiB" => 3,
        "TiB" => 4,
        _ => 0,
    };
    match text[..end].parse::<f64>() {
        Ok(number) if number > 0.0 && power > 0 => Ok((number * 1024_f64.powi(power)) as u64),
        _ => Err("write a number and KiB, MiB, GiB or TiB, such as 4GiB".to_owned()),
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds.is_finite() && seconds > 0.0 => Ok(seconds),
        _ => Err("write a number of seconds above 0, such as 60".to_owned()),
    }
}

fn quality(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(factor) if factor.is_finite() && factor > 0.0 => Ok(factor),
        _ => Err("write a number above 0, such as 0.05".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    #[test]
    fn the_command_line_contradicts_itself_nowhere() {
        Command::command().debug_assert();
    }

    #[test]
    fn results_go_to_a_folder_named_after_the_scene() {
        let folder = |line: &[&str]| match Command::parse_from(line) {
            Command::Run(trace) => trace.run.folder(""),
            Command::Sweep(run) => run.folder("_sweep"),
            other => panic!("{other:?}"),
        };
        assert_eq!(folder(&["sunfleck", "run", "a/birch.ron"]), Path::new("out/birch"));
        assert_eq!(folder(&["sunfleck", "run", "a.ron", "--out", "b"]), Path::new("b"));
        let changed =
            ["--set", "sza=60", "--variant", "winter", "--set", "a/b=-0.5", "--set", "sza=7"];
        let line = [&["sunfleck", "run", "a/birch.ron"], &changed[..]].concat();
        assert_eq!(folder(&line), Path::new("out/birch_winter_a_b=-0.5_sza=7"));
        let line = ["sunfleck", "sweep", "a/birch.ron", "--set", "sza=60"];
        assert_eq!(folder(&line), Path::new("out/birch_sza=60_sweep"));
        let long = format!("lai=0.{}", "1".repeat(300));
        let name = folder(&["sunfleck", "run", "a.ron", "--set", &long]);
        assert!(name.as_os_str().len() < 120, "{}", name.display());
    }

    #[test]
    fn memory_is_a_number_with_a_unit() {
        assert_eq!(memory("4GiB"), Ok(4 << 30));
        assert_eq!(memory("1.5 MiB"), Ok(3 << 19));
        for wrong in ["4", "GiB", "0MiB", "-1GiB", "4GB", "1e3KiB", "1.2.3GiB"] {
            assert!(memory(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn settings_are_names_with_values() {
        assert_eq!(setting("sza=30"), Ok(("sza".to_owned(), 30.0.into())));
        assert_eq!(setting(" lai = -1e-3 "), Ok(("lai".to_owned(), (-1e-3).into())));
        assert_eq!(setting("plot=007"), Ok(("plot".to_owned(), "007".into())));
        assert_eq!(setting("soil=a=b.csv"), Ok(("soil".to_owned(), "a=b.csv".into())));
        for wrong in ["sza", "=3", "sza=", "sza= "] {
            assert!(setting(wrong).is_err(), "{wrong}");
        }
    }
}
