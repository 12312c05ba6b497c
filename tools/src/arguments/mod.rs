//! The command line: commands and their arguments.

mod import;
mod shared;
mod values;

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use sunfleck::document::{Param, System};
use sunfleck::run::Partition;

use self::shared::changed_name;
use self::values::{SystemName, part, quality, seconds, setting, system};
use crate::commands::{
    Brf, Bt, Chm, Completions, Export, Lai, Man, New, Preview, Report, Stats, Sunpos,
};
use crate::console::Console;
use crate::verify::CHECKS;

pub(crate) use self::shared::{Formats, Measured, Out, Run, Scene};
pub(crate) use self::values::{length, memory};
pub(crate) use import::{Import, ImportLess};

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
    /// Evaluate the results of `run --keep-coefficients` for other spectra, irradiances or bands; no ray is traced
    Respectrum(Respectrum),
    /// Repeat the run that wrote a file, with the scene that the file holds, and write the same results again
    Rerun(Rerun),
    /// Combine the checkpoints of `run --part` and write the results
    Merge(Merge),
    /// Write a page about a folder of results, with all figures, to read in a browser
    Report(Report),
    /// Report what a scene consists of, its errors and its warnings, without running it
    Check(Check),
    /// Draw a map and a shaded view of a scene
    Preview(Preview),
    /// Count leaf area by cells and layers: maps, profiles and totals, exact for every triangle and disc
    Lai(Lai),
    /// Map the height of the canopy above the ground, and the height of the surface
    Chm(Chm),
    /// Count plants, triangles and leaf area of a scene by mesh, with a histogram of heights
    Stats(Stats),
    /// Convert radiance images to bidirectional reflectance factors
    Brf(Brf),
    /// Convert thermal radiance images to brightness temperatures
    Bt(Bt),
    /// Compute where the sun is: at a time, over a day, or sunrise and sunset over a year
    Sunpos(Sunpos),
    /// Write the geometry of a scene as glTF or PLY, or points on its leaves as LAS
    Export(Export),
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
    /// Write a small commented scene to start from
    New(New),
    /// Convert a scene of LESS, Eradiate, RAMI or Helios and report how each item was converted
    Import(Import),
    /// Convert a project folder of LESS 1.8.8: `import --from less`
    #[command(hide = true)]
    ImportLess(ImportLess),
    /// Print a script that completes commands and options in a shell
    Completions(Completions),
    /// Print the manual page, or write one for each command
    Man(Man),
}

impl Command {
    /// Manner in which the command speaks.
    pub(crate) const fn console(&self) -> Console {
        match self {
            Self::Run(arguments) => arguments.run.console,
            Self::Sweep(arguments) => arguments.console,
            Self::Merge(arguments) => arguments.console,
            Self::Respectrum(arguments) => arguments.console,
            Self::Rerun(arguments) => arguments.console,
            _ => Console::TEXT,
        }
    }
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

    /// Keep what sensors of packets measure as coefficients of products of spectra, for `respectrum`
    #[arg(long, conflicts_with_all = ["checkpoint", "forecast"])]
    pub(crate) keep_coefficients: bool,

    /// Run only one part, such as 2/4, the second of four, and save it to the checkpoint; `merge` combines
    /// all parts
    #[arg(long, value_name = "I/N", requires = "checkpoint", value_parser = part)]
    pub(crate) part: Option<Partition>,
}

#[derive(Args, Debug)]
pub(crate) struct Respectrum {
    /// Folder with the results of `run --keep-coefficients`
    #[arg(value_name = "RESULTS")]
    pub(crate) results: PathBuf,

    /// Set a parameter of the scene to a number or a text; may be repeated. Those that the run has set keep their values
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = setting)]
    pub(crate) settings: Vec<(String, Param)>,

    /// Apply this variant of the scene [default: that of the run]
    #[arg(long, value_name = "NAME")]
    pub(crate) variant: Option<String>,

    /// Folder for the results [default: that of the run, with `_<variant>` and `_<name>=<value>` of each --set]
    #[arg(long = "out", value_name = "DIR")]
    out: Option<PathBuf>,

    /// Replace results of another scene
    #[arg(long)]
    pub(crate) force: bool,

    #[command(flatten)]
    pub(crate) console: Console,
}

impl Respectrum {
    /// Folder for the results.
    pub(crate) fn out(&self) -> PathBuf {
        self.out.clone().unwrap_or_else(|| {
            // `.` has no name of its own.
            let folder = std::path::absolute(&self.results).unwrap_or(self.results.clone());
            let stem = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let name = changed_name(stem, self.variant.as_deref(), &self.settings);
            self.results.with_file_name(name)
        })
    }
}

#[derive(Args, Debug)]
pub(crate) struct Rerun {
    /// A result of `run`, or the folder of its results
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,

    /// Folder for the results [default: that of the file, with `_rerun`]
    #[arg(long = "out", value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,

    /// Folder that paths of the scene are relative to [default: the one that the file names]
    #[arg(long, value_name = "DIR")]
    pub(crate) folder: Option<PathBuf>,

    /// Number of threads [default: all]; results do not depend on it
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,

    /// Replace results of another scene
    #[arg(long)]
    pub(crate) force: bool,

    #[command(flatten)]
    pub(crate) console: Console,
}

impl Rerun {
    /// Folder for the results of a run whose results are in a folder.
    pub(crate) fn out(&self, results: &std::path::Path) -> PathBuf {
        self.out.clone().unwrap_or_else(|| {
            // `.` has no name of its own.
            let folder = results.canonicalize().unwrap_or(results.to_owned());
            let name = folder.file_name().unwrap_or_default().to_string_lossy();
            folder.with_file_name(format!("{name}_rerun"))
        })
    }
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

    #[command(flatten)]
    pub(crate) formats: Formats,

    #[command(flatten)]
    pub(crate) console: Console,
}

impl Merge {
    /// Folder for the results.
    pub(crate) fn folder(&self) -> PathBuf {
        self.out.folder(&self.scene, "")
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

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use std::path::Path;

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
}
