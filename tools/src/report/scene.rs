//! What the scene consists of.

use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, html};
use sunfleck::Progress;
use sunfleck::document::{Param, ReadOptions};
use sunfleck::preview::{MAP_SIZE, SceneMap};
use sunfleck::run::{self, LoadedScene, SceneFacts};

use super::sources::sources;
use super::summary::Results;
use super::tables::{Cell, table};
use super::words::{cut, name, short};
use crate::describe;

/// Facts of a scene whose file is still there, and whether it is still the one that was run.
pub(super) struct SceneState {
    pub(super) facts: Option<SceneFacts>,
    pub(super) is: Agreement,
    /// Sources of the published data that the scene uses.
    pub(super) sources: Vec<&'static str>,
    /// The map of the scene, if there is one.
    pub(super) map: Option<Map>,
}

/// Map of a scene.
pub(super) struct Map {
    /// Address that holds the picture.
    data: String,
    /// What it shows.
    text: String,
}

/// Agreement of the scene file with the results.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Agreement {
    /// The hashes are equal.
    Same,
    /// The hash of such results is not that of a single scene.
    Unknown,
    Changed,
    /// The file is not there, or has errors.
    Missing(String),
}

impl SceneState {
    /// Reads the scene of some results again, with their variant and parameters.
    pub(super) fn read(results: &Results, progress: &dyn Progress) -> Self {
        let missing = |why: &str| Self {
            facts: None,
            is: Agreement::Missing(why.to_owned()),
            sources: Vec::new(),
            map: None,
        };
        let Some(file) = results.scene_file() else {
            return missing("The scene file is not where it was at the time of the run");
        };
        let summary = &results.summary;
        let document = read_options(results);
        let is_run = summary.command == "run" || summary.command == "respectrum";
        // A run may have been one of some sensors alone, which is another scene.
        let sensors = if is_run { summary.runs.keys().cloned().collect() } else { Vec::new() };
        let sources = sunfleck::read_file(&file, &document)
            .map(|reading| sources(&reading.scene))
            .unwrap_or_default();
        let options = run::Options { document, sensors, ..run::Options::default() };
        match run::describe_file(&file, &options, progress) {
            Ok(checked) => {
                let is_same =
                    checked.facts.as_ref().is_some_and(|facts| facts.hash == summary.hash);
                let is = match (is_run, is_same) {
                    (_, true) => Agreement::Same,
                    (true, false) => Agreement::Changed,
                    (false, false) => Agreement::Unknown,
                };
                let map = map(&file, &options, progress);
                Self { facts: checked.facts, is, sources, map }
            }
            Err(_) => missing("The scene file has changed since the run, and cannot be described"),
        }
    }

    /// Zenith angle and azimuth of the sun, degrees, if they are those of the results.
    pub(super) fn sun(&self) -> Option<[f64; 2]> {
        let sun = self.facts.as_ref().filter(|_| self.is != Agreement::Changed)?.sun.as_ref()?;
        Some([sun.zenith_deg, sun.azimuth_deg])
    }
}

/// Options that the scene of some results was read with.
pub(super) fn read_options(results: &Results) -> ReadOptions {
    let set = |(name, value): (&String, &serde_json::Value)| {
        let value = match value {
            serde_json::Value::Number(number) => Param::Number(number.as_f64()?),
            serde_json::Value::String(text) => Param::Text(text.clone()),
            _ => return None,
        };
        Some((name.clone(), value))
    };
    ReadOptions {
        set: results.summary.set.iter().filter_map(set).collect(),
        variant: results.summary.variant.clone(),
        ..ReadOptions::default()
    }
}

/// Largest map that is a part of the page, bytes.
const LARGEST_MAP: usize = 1_500_000;

/// Map of the scene in a file; `None` of one that is too large or cannot be drawn.
fn map(file: &Path, options: &run::Options, progress: &dyn Progress) -> Option<Map> {
    let loaded = LoadedScene::from_file(file, options, progress).ok()?;
    let drawn = SceneMap::new(&loaded, MAP_SIZE);
    let (kind, bytes) = match drawn.svg().into_bytes() {
        svg if svg.len() <= LARGEST_MAP => ("svg+xml", svg),
        _ => ("png", drawn.png().filter(|png| png.len() <= LARGEST_MAP)?),
    };
    let data = format!("data:image/{kind};base64,{}", STANDARD.encode(bytes));
    Some(Map { data, text: cut(&drawn.contents.join("; "), 600) })
}

/// Facts of the scene, and its parameters.
pub(super) fn section(results: &Results, state: &SceneState) -> Markup {
    let facts = state.facts.as_ref();
    html! {
        @match &state.is {
            Agreement::Same => {},
            Agreement::Unknown => p.note { "As the scene file is now." },
            Agreement::Changed => p.note.warn { "The scene file has changed since the run: what follows is of the file as it is now, and not of these results." },
            Agreement::Missing(why) => p.note { (why) ": " (name(results.summary.scene_file.as_deref().unwrap_or("unknown"))) ". What it consists of is therefore not told here." },
        }
        @if let Some(facts) = facts {
            dl.facts {
                @for row in describe::summary(facts) {
                    @if let [title, text] = &row[..] { dt { (title) } dd { (short_fact(text)) } }
                }
            }
        }
        @if let Some(Map { data, text }) = &state.map {
            figure.map.picture id="picture-map" {
                a.open href="#picture-map" { img src=(data) alt={ "Map of the scene. " (text) } decoding="async"; }
                a.close href="#scene" { "Close" }
                figcaption { strong { "Map of the scene." } " From " code { "sunfleck preview" } "." }
            }
        }
        @if !results.summary.params.is_empty() { (parameters(results)) }
        @if let Some(facts) = facts {
            @for (title, rows) in [("Meshes", describe::meshes(facts)), ("Bands", describe::bands(facts)), ("Sensors", describe::sensors(facts))] {
                @if rows.len() > 1 { (facts_table(title, &rows)) }
            }
        }
    }
}

/// Maximum number of rows of a table of facts.
const ROWS: usize = 60;

fn short_fact(text: &str) -> String {
    cut(text, 400)
}

fn facts_table(title: &str, rows: &[Vec<String>]) -> Markup {
    let cell = |text: &String| {
        // Digits of large numbers are in groups.
        let plain: String = text.chars().filter(|letter| *letter != ' ').collect();
        match plain.parse::<f64>() {
            Ok(value) => Cell::Number(text.clone(), value),
            Err(_) => Cell::Text(text.clone()),
        }
    };
    let body: Vec<Vec<Cell>> =
        rows[1..].iter().take(ROWS).map(|row| row.iter().map(cell).collect()).collect();
    let more = rows.len() - 1 - body.len();
    let caption = html! { (title) @if more > 0 { "; " (more) " more are not shown" } };
    table(&caption, &rows[0], &body)
}

fn parameters(results: &Results) -> Markup {
    let summary = &results.summary;
    let row = |(name, value): (&String, &serde_json::Value)| {
        let value = match value {
            serde_json::Value::Number(number) => {
                Cell::Number(number.to_string(), number.as_f64().unwrap_or(f64::NAN))
            }
            serde_json::Value::String(text) => Cell::Text(text.clone()),
            other => Cell::Text(short(&other.to_string())),
        };
        let origin = if summary.set.contains_key(name) { "set for this run" } else { "scene" };
        vec![Cell::Text(name.clone()), value, Cell::Text(origin.to_owned())]
    };
    let rows: Vec<Vec<Cell>> = summary.params.iter().take(ROWS).map(row).collect();
    let header = ["parameter", "value", "from"].map(str::to_owned);
    table(&html! { "Parameters" }, &header, &rows)
}
