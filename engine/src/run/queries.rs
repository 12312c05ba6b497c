//! Reports that answer questions about a scene without light.

use std::path::Path;
use std::time::Instant;

use super::pool::in_pool;
use super::provenance::{self, FileHashes};
use super::{Failure, LoadedScene, Options, Progress, params, projection, scene_source};
use crate::counts::counted;
use crate::document::{Boundary, Sun};
use crate::products::{
    Forecast, Product, Report, SensorReport, height_products, leaf_area_products,
};
use crate::queries::{
    CellCount, CountedSurfaces, HeightModel, HeightReference, LayerCount, LeafAreaGrid,
    LeafAreaRequest, height_model, leaf_area,
};

/// What to count of the leaf area of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeafAreaSettings {
    /// Number of columns and rows.
    pub cells: CellCount,
    /// Number or height of layers.
    pub layers: LayerCount,
    /// Heights that layers are counted by.
    pub heights: HeightReference,
    /// Surfaces that are counted.
    pub surfaces: CountedSurfaces,
    /// True if each material has columns of its own.
    pub by_material: bool,
    /// True for the density of every cell of every layer.
    pub with_cells: bool,
}

/// Answer to a question, before it is a report.
struct Answer {
    /// Name that takes the place of a sensor's.
    name: &'static str,
    products: Vec<Product>,
    notes: Vec<String>,
    warnings: Vec<String>,
}

/// Counts the leaf area of a scene file by cells and layers.
///
/// # Errors
/// All errors of the scene, and if nothing could be counted.
pub fn leaf_area_file(
    path: &Path,
    options: &Options,
    settings: &LeafAreaSettings,
    progress: &dyn Progress,
) -> Result<Report, Failure> {
    answered(path, options, progress, |loaded| {
        let request = LeafAreaRequest {
            cells: settings.cells,
            layers: settings.layers,
            heights: settings.heights,
            surfaces: settings.surfaces,
            by_material: settings.by_material,
            is_periodic: loaded.scene().boundary == Boundary::Periodic,
            memory: options.free_memory(),
        };
        progress.stage("counting leaf area");
        let counted =
            leaf_area(&loaded.world.world, &request, &|done| progress.fraction("lai", done))?;
        let (x, y, _) = loaded.scene().frame.origin_m;
        Ok(Answer {
            name: "lai",
            products: leaf_area_products(&counted, (x, y), settings.with_cells),
            notes: leaf_area_notes(&counted),
            warnings: leaf_area_warnings(&counted),
        })
    })
}

/// Maps the height of the canopy of a scene file and that of its surface.
///
/// # Errors
/// All errors of the scene, and if the cells take more memory than there is.
pub fn height_model_file(
    path: &Path,
    options: &Options,
    cells: CellCount,
    progress: &dyn Progress,
) -> Result<Report, Failure> {
    answered(path, options, progress, |loaded| {
        progress.stage("mapping heights");
        let is_periodic = loaded.scene().boundary == Boundary::Periodic;
        let done = |done| progress.fraction("chm", done);
        let model =
            height_model(&loaded.world.world, cells, is_periodic, options.free_memory(), &done)?;
        Ok(Answer {
            name: "chm",
            products: height_products(&model, loaded.scene().frame.origin_m),
            notes: height_notes(&model),
            warnings: Vec::new(),
        })
    })
}

/// Text about the cells and heights of a height model.
fn height_notes(HeightModel { grid, .. }: &HeightModel) -> Vec<String> {
    let mut notes = vec![format!(
        "{} x {} of {:.4} m x {:.4} m; the highest point of each triangle and disc above a cell, exactly",
        counted(grid.columns, "column"),
        counted(grid.rows, "row"),
        grid.size.x / grid.columns as f64,
        grid.size.y / grid.rows as f64
    )];
    notes.push(
        "canopy height: of plants above the ground below them, 0 without plants; surface height: of plants and ground, \
         the frame's height included"
            .to_owned(),
    );
    notes
}

/// Loads a scene, asks it, and makes a report of the answer.
fn answered(
    path: &Path,
    options: &Options,
    progress: &dyn Progress,
    ask: impl FnOnce(&mut LoadedScene) -> Result<Answer, Failure> + Send,
) -> Result<Report, Failure> {
    let start = Instant::now();
    in_pool(options, || {
        let mut loaded = LoadedScene::from_file(path, options, progress)?;
        let answer = ask(&mut loaded)?;
        report(path, options, &loaded, answer, start.elapsed().as_secs_f64())
    })
}

fn report(
    path: &Path,
    options: &Options,
    loaded: &LoadedScene,
    answer: Answer,
    seconds: f64,
) -> Result<Report, Failure> {
    let scene = loaded.scene();
    let messages = &loaded.world.resources.messages;
    let files = messages.files();
    let sensor = SensorReport {
        name: answer.name.to_owned(),
        products: answer.products,
        seconds,
        rays: 0,
        samples: 0,
        ended_by: "exact".to_owned(),
        energy_imbalance: None,
        forecast: Forecast { seconds, memory: 0, files: 0 },
    };
    Ok(Report {
        projection: projection(&loaded.world.world),
        scene: scene.title.clone(),
        formats: scene.output.clone(),
        hash: provenance::hash(scene, &files, &FileHashes::default())?,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: scene.transport.seed,
        seconds,
        rays: 0,
        bands: Vec::new(),
        wavelengths: Vec::new(),
        bandwidths: Vec::new(),
        irradiance: Vec::new(),
        responses: Vec::new(),
        stages: vec![(answer.name.to_owned(), seconds)],
        skipped: Vec::new(),
        notes: answer.notes,
        warnings: [loaded.warnings(), answer.warnings].concat(),
        sensors: vec![sensor],
        params: params(scene),
        sun_azimuth_deg: scene.sun.as_ref().and_then(Sun::known_azimuth_deg),
        sun_zenith_deg: scene.sun.as_ref().and_then(Sun::angles_deg).map(|angles| angles.0),
        source: Some(scene_source(path, options)),
        coefficients: None,
        recipe: None,
    })
}

/// Text about the cells, and about what was counted.
fn leaf_area_notes(areas: &LeafAreaGrid) -> Vec<String> {
    let grid = &areas.grid;
    let surfaces = areas.classes.join(", ");
    let heights = match grid.heights {
        HeightReference::Ground => "above the ground below the middle of each triangle or disc",
        HeightReference::Absolute => "of the local frame",
    };
    vec![
        format!("one-sided area of {surfaces}, per m² of the terrain's rectangle"),
        format!(
            "{} x {} of {:.4} m x {:.4} m, {} of {:.4} m from {:.4} m; heights {heights}",
            counted(grid.columns, "column"),
            counted(grid.rows, "row"),
            grid.size.x / grid.columns as f64,
            grid.size.y / grid.rows as f64,
            counted(grid.layers, "layer"),
            grid.thickness,
            grid.bottom
        ),
    ]
}

/// Warnings about area that no cell holds.
fn leaf_area_warnings(counted: &LeafAreaGrid) -> Vec<String> {
    let all: f64 = (0..counted.classes.len()).map(|class| counted.total(class)).sum();
    let warning = |areas: &[f64], place: &str| {
        let area = areas.iter().sum::<f64>();
        // Rounding at a side is no area.
        (area > 1e-9 * all).then(|| {
            format!(
                "{area:.4} m² of the counted surfaces lie {place}: they are in no cell and no index"
            )
        })
    };
    [
        warning(&counted.outside, "outside the terrain's rectangle, as the scene is isolated"),
        warning(&counted.below, "below the lowest layer, at the ground"),
        warning(&counted.over_holes, "over holes in the ground, where they have no height"),
    ]
    .into_iter()
    .flatten()
    .collect()
}
