//! Scenes through all of sunfleck: whatever a scene says, `check` and `run` refuse it with a message, or its
//! results are numbers.

use std::fs;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use sunfleck::output;
use sunfleck::products::{Forecast, Product, Report};
use sunfleck::run::{Options, Progress, SensorProgress, check_file, run_file};

use super::project;
use super::readers::Said;

/// Memory that a scene, its films and its results may take, bytes.
const MEMORY: u64 = 32 << 20;

/// Files that scenes name, beside them.
const FILES: [(&str, &str); 6] = [
    ("dem.asc", "ascii/corner.asc"),
    ("tree.obj", "obj/tree.obj"),
    ("crown.csv", "discs/crown.csv"),
    ("stand.csv", "instances/stand.csv"),
    ("leaf.csv", "spectrum/leaf.csv"),
    ("plot.geojson", "geojson/polygon.geojson"),
];

/// Folder that has the files that scenes name.
static FURNISHED: Mutex<Option<PathBuf>> = Mutex::new(None);

/// Fewest samples: what is looked for does not depend on their number.
fn options() -> Options {
    Options { threads: Some(1), quality: 1e-9, memory: Some(MEMORY), ..Options::default() }
}

/// Longest forecast of a run that is waited for, s.
const PATIENCE: f64 = 5.0;

/// Ends a run that says that it will take longer than [`PATIENCE`].
struct Impatient;

/// Payload of the panic that ends it.
struct LongRun;

impl Progress for Impatient {
    fn stage(&self, _: &str) {}
    fn sensor(&self, _: &SensorProgress<'_>) {}
    fn forecast(&self, _: &str, forecast: &Forecast) {
        if forecast.seconds > PATIENCE {
            resume_unwind(Box::new(LongRun));
        }
    }
}

/// Checks and runs a scene, and asserts what both promise. A scene that is said to be slow is not run to its end.
pub(super) fn pipeline(path: &Path) -> Said {
    let folder = path.parent().unwrap_or(Path::new("."));
    furnish(folder);
    let checked = check_file(path, &options()).map_err(|failure| failure.to_string());
    if let Ok(warnings) = &checked
        && warnings.iter().any(|warning| warning.contains("this is slow"))
    {
        return ("a slow scene".to_owned(), warnings.clone());
    }
    let run = catch_unwind(AssertUnwindSafe(|| run_file(path, &options(), &Impatient)));
    let run = match run {
        Ok(run) => run.map_err(|failure| failure.to_string()),
        Err(payload) if payload.is::<LongRun>() => return ("a long run".to_owned(), Vec::new()),
        Err(payload) => resume_unwind(payload),
    };
    match (checked, run) {
        (Ok(warnings), Ok(report)) => {
            sound(&report);
            if fs::read(path).is_ok_and(|bytes| is_written(&bytes)) {
                let out = folder.join("out");
                output::write(&report, &out).expect("measured results can be written");
                fs::remove_dir_all(&out).expect("written results can be removed");
            }
            let kinds = report.sensors.iter().flat_map(|sensor| &sensor.products);
            let kinds = kinds.map(|product| format!("product {}", product.name));
            (format!("{} sensors", report.sensors.len()), kinds.chain(warnings).collect())
        }
        (Err(checked), Err(run)) => {
            assert!(!checked.contains("bug of sunfleck"), "{checked}");
            assert!(checked.lines().count() < 2000, "{} lines of errors", checked.lines().count());
            // Lines without a scene's text; each is a kind of its own.
            let lines = run.lines().filter(|line| line.starts_with("error: "));
            let kinds = lines.map(str::to_owned).collect();
            (run, kinds)
        }
        (Ok(_), Err(run)) => panic!("check accepts what run refuses: {run}"),
        (Err(checked), Ok(_)) => panic!("check refuses what run accepts: {checked}"),
    }
}

/// Returns whether the results of a scene are written: one scene in eight, as writing takes longer than tracing.
fn is_written(scene: &[u8]) -> bool {
    let mut hasher = DefaultHasher::new();
    scene.hash(&mut hasher);
    hasher.finish().is_multiple_of(8)
}

/// Puts the files that scenes name into a folder, once.
fn furnish(folder: &Path) {
    let mut furnished = FURNISHED.lock().unwrap_or_else(PoisonError::into_inner);
    if furnished.as_deref() == Some(folder) {
        return;
    }
    for (name, from) in FILES {
        let from = project().join("tests/corpus").join(from);
        fs::copy(&from, folder.join(name)).expect("a file of the corpus");
    }
    *furnished = Some(folder.to_owned());
}

/// Asserts that results are numbers, or no data where a scene has none.
fn sound(report: &Report) {
    for warning in &report.warnings {
        assert!(!warning.contains("bug of sunfleck"), "{warning}");
    }
    let has_light = !report.warnings.iter().any(|warning| warning.contains("no light falls"));
    for sensor in &report.sensors {
        for product in &sensor.products {
            numbers(&sensor.name, product, has_light);
        }
    }
}

fn numbers(sensor: &str, product: &Product, has_light: bool) {
    let Product { name, values, standard_error, image, unit, .. } = product;
    let at = |index: usize| format!("{sensor}.{name}[{index}]");
    for (index, value) in values.iter().chain(standard_error).enumerate() {
        assert!(!value.is_infinite(), "{} is infinite", at(index));
    }
    if let Some(image) = image {
        let image = image.load().expect("pixels can be read");
        let bands = image.values.len() / image.coverage.len().max(1);
        for (index, value) in image.values.iter().enumerate() {
            assert!(!value.is_infinite(), "pixel {} is infinite", at(index));
            let is_covered = image.coverage[index / bands.max(1)] > 0.0;
            // No component is dominant where a pixel sees none.
            let may_lack = !is_covered || !has_light || unit == "K" || name == "dominant_component";
            assert!(!value.is_nan() || may_lack, "covered pixel {} is NaN", at(index));
        }
        return;
    }
    // Without light there is no reflectance, and without radiance no temperature.
    if has_light && unit != "K" {
        for (index, value) in values.iter().enumerate() {
            assert!(!value.is_nan(), "{} is NaN", at(index));
        }
    }
}
