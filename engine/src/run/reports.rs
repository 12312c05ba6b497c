//! Reports of scenes that were measured on the same paths.

use std::ops::Range;
use std::sync::Arc;

use hecs::World;
use rayon::prelude::*;

use super::provenance::joint_hashes;
use super::settled::SettledScene;
use super::{enclosed, footprint, params, projection, sensors, uncovered};
use crate::document::Sun;
use crate::extract::Stage;
use crate::products::{Context, Product, Recipe, Report, SensorReport};

/// Data that all scenes of a run share.
pub(super) struct CommonResults<'a> {
    pub(super) world: &'a World,
    pub(super) stage: &'a Stage,
    pub(super) context: &'a Context,
    pub(super) sensors: Vec<SharedReports>,
    pub(super) notes: Vec<String>,
    pub(super) warnings: Vec<String>,
    /// File of coefficients.
    pub(super) coefficients: Option<Arc<Vec<u8>>>,
    /// Factor on the numbers of samples.
    pub(super) quality: f64,
    /// True if rays were traced, so that a run repeats the results.
    pub(super) is_traced: bool,
    pub(super) stages: Vec<(String, f64)>,
    pub(super) seconds: f64,
}

/// Reports of sensors that some of the scenes share.
pub(super) struct SharedReports {
    /// Places of these scenes.
    scenes: Range<usize>,
    /// Bands of these scenes.
    context: Context,
    sensors: Vec<SensorReport>,
}

impl SharedReports {
    /// Moves the reports out of the world.
    pub(super) fn take(world: &mut World, scenes: Range<usize>, context: Context) -> Self {
        Self { scenes, context, sensors: sensors::take_reports(world) }
    }
}

/// Number of scenes on the same paths above which their files hold no recipes: they are one table.
const MOST_RECIPES: usize = 64;

/// A report for each scene. Time is shared evenly among them; rays and samples are those that each result is made
/// of, and so those of all.
pub(super) fn reports(scenes: &[SettledScene], mut common: CommonResults<'_>) -> Vec<Report> {
    let count = scenes.len();
    let share = 1.0 / count as f64;
    let mut warnings = warnings_by_scene(&common, count).into_iter();
    let sensors = std::mem::take(&mut common.sensors);
    let sensors = sensors_by_scene(sensors, scenes, common.world);
    let own: Vec<&str> = scenes.iter().map(|settled| settled.hash.as_str()).collect();
    let hashes = if let [only] = own[..] { vec![only.to_owned()] } else { joint_hashes(&own) };
    let recipe = |settled: &SettledScene| {
        (common.is_traced && count <= MOST_RECIPES).then(|| {
            Arc::new(Recipe {
                scene: settled.scene.resolved().to_ron_line(),
                folder: settled.folder.clone(),
                files: settled.inputs.clone(),
                quality: common.quality,
                keeps_coefficients: common.stage.keeps_coefficients,
                is_joint: count > 1,
            })
        })
    };
    let report = |((settled, hash), sensors): ((&SettledScene, String), Vec<SensorReport>)| {
        let warnings = warnings.next().expect("warnings of each scene");
        let SettledScene { scene, context, .. } = settled;
        Report {
            projection: projection(common.world),
            scene: scene.title.clone(),
            formats: scene.output.clone(),
            hash,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            seed: scene.transport.seed,
            seconds: common.seconds * share,
            rays: sensors.iter().map(|report| report.rays).sum(),
            bands: context.bands.clone(),
            wavelengths: context.sources.iter().map(|source| source.center_nm).collect(),
            bandwidths: context.sources.iter().map(|source| source.response.width()).collect(),
            irradiance: context.irradiance.clone(),
            responses: context.sources.iter().map(|source| source.response.clone()).collect(),
            stages: common.stages.iter().map(|(name, s)| (name.clone(), s * share)).collect(),
            skipped: settled.skipped.clone(),
            notes: [&*settled.notes, &*common.notes].concat(),
            warnings: [&*settled.warnings, &*warnings].concat(),
            sensors,
            params: params(scene),
            sun_azimuth_deg: scene.sun.as_ref().and_then(Sun::known_azimuth_deg),
            sun_zenith_deg: scene.sun.as_ref().and_then(Sun::angles_deg).map(|angles| angles.0),
            source: None,
            coefficients: common.coefficients.clone(),
            recipe: recipe(settled),
        }
    };
    scenes.iter().zip(hashes).zip(sensors).map(report).collect()
}

/// Reports of the sensors for each scene, in document order.
fn sensors_by_scene(
    mut shared: Vec<SharedReports>,
    scenes: &[SettledScene],
    world: &World,
) -> Vec<Vec<SensorReport>> {
    // Images are large.
    if scenes.len() == 1 {
        return shared.drain(..).map(|shared| shared.sensors).collect();
    }
    let names: Vec<String> = sensors::in_order(world).into_iter().map(|one| one.name).collect();
    let of_scene = |(index, settled): (usize, &SettledScene)| {
        let own = |name: &String| {
            let of_index = shared.iter().filter(|shared| shared.scenes.contains(&index));
            let mut reports = of_index
                .flat_map(|shared| shared.sensors.iter().map(move |report| (shared, report)));
            let (shared, report) = reports.find(|(_, report)| report.name == *name)?;
            Some(of_scene(report, index - shared.scenes.start, &shared.context, &settled.context))
        };
        names.iter().filter_map(own).collect()
    };
    scenes.par_iter().enumerate().map(of_scene).collect()
}

/// Report of one scene from that of all that share it.
fn of_scene(
    report: &SensorReport,
    scene: usize,
    shared: &Context,
    context: &Context,
) -> SensorReport {
    let scenes = shared.scenes;
    let product = |product: &Product| {
        let product = product.of_scene(scene, scenes);
        // Some scenes may have light of the sky, and others none.
        match product.name.strip_prefix(shared.factor()) {
            Some(kind) => Product { name: format!("{}{kind}", context.factor()), ..product },
            None => product,
        }
    };
    SensorReport {
        name: report.name.clone(),
        products: report.products.iter().map(product).collect(),
        seconds: report.seconds / scenes as f64,
        ended_by: report.ended_by.clone(),
        ..*report
    }
}

/// Warnings about the paths that all scenes share, each for the scenes that it is about.
fn warnings_by_scene(common: &CommonResults<'_>, scenes: usize) -> Vec<Vec<String>> {
    let CommonResults { world, stage, context, .. } = common;
    let enclosed = enclosed::warnings(&sensors::in_order(world), stage);
    let enclosed: Vec<String> = enclosed.iter().map(super::failure::one_line).collect();
    let beside = footprint::warnings(world, stage, scenes);
    let uncovered = uncovered::warning(stage, context);
    let of_scene = |(scene, beside): (usize, Vec<String>)| {
        let own = common.sensors.iter().filter(|shared| shared.scenes.contains(&scene));
        let first = enclosed.iter().cloned().chain(beside).chain(uncovered.clone());
        first.chain(unbalanced(own)).chain(common.warnings.iter().cloned()).collect()
    };
    beside.into_iter().enumerate().map(of_scene).collect()
}

/// Fraction of the incident energy that the rounding of f64 may lose.
const BALANCE: f64 = 1e-9;

/// Warnings about sensors whose energy balance does not close.
fn unbalanced<'a>(shared: impl Iterator<Item = &'a SharedReports>) -> impl Iterator<Item = String> {
    let off = |report: &&SensorReport| report.energy_imbalance.is_some_and(|off| off > BALANCE);
    shared.flat_map(|shared| &shared.sensors).filter(off).map(|report| {
        let off = report.energy_imbalance.unwrap_or(f64::NAN);
        format!(
            "sensors.{}: {off:.1e} of the energy is not accounted for: this is a bug of sunfleck",
            report.name
        )
    })
}
