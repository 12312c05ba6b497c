//! A page about a folder of results: self-contained HTML with figures as SVG, for people who read no JSON.
//!
//! Everything that a scene's author may have written is escaped (`maud`) and cut (`words`). The page needs neither
//! network nor script: its script adds texts at the pointer and sorts tables.

mod comparison;
mod context;
mod csv_table;
mod directions;
mod energy;
mod figure;
mod long_table;
mod origin;
mod page;
mod pictures;
mod planes;
mod products;
mod quantity;
mod scene;
mod sources;
mod summary;
mod sweep;
mod swept_scene;
mod tables;
mod words;
mod work;

use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use maud::{Markup, html};
use sunfleck::Progress;
use sunfleck::output::{self, REPORT, is_report};

use self::context::Context;
use self::csv_table::csv_table;
use self::long_table::LongTable;
use self::page::{Page, Section};
use self::quantity::{Quantity, has_ending};
use self::scene::SceneState;
use self::summary::Results;
use self::swept_scene::SweptScene;
use self::words::{duration, name, number, short, title};

/// Maximum number of figures of products, and of tables of all values.
const FIGURES: usize = 60;
const TABLES: usize = 80;

/// Page that was written.
#[derive(Debug)]
pub(crate) struct Written {
    pub(crate) file: PathBuf,
    pub(crate) bytes: usize,
}

/// Writes a page about the results in `folder`.
///
/// - `out`: file of the page; without it, `report.html` in the folder
///
/// # Errors
/// If the folder holds no results, or the page cannot be written.
pub(crate) fn report(
    folder: &Path,
    out: Option<&Path>,
    progress: &dyn Progress,
) -> anyhow::Result<Written> {
    let file = out.map_or_else(|| folder.join(REPORT), Path::to_owned);
    progress.stage("reading the results");
    let results = Results::read(folder)?;
    check_place(&file)?;
    let state = SceneState::read(&results, progress);
    progress.stage("drawing");
    let context = Context {
        results: &results,
        address: address(&results.folder, &file)?,
        sun: state.sun(),
        swept: SweptScene::new(&results),
    };
    let text = page(&context, &state)?.render();
    output::replace(&file, &text)?;
    Ok(Written { file, bytes: text.len() })
}

/// Refuses a place where something else is.
fn check_place(file: &Path) -> anyhow::Result<()> {
    let shown = file.display();
    if file.is_dir() {
        bail!("{shown} is a folder: name a file for the report, such as {shown}/{REPORT}");
    }
    if file.exists() && !is_report(file) {
        bail!(
            "{shown} is no report of sunfleck, and is not replaced: move it, or name another file with --out"
        );
    }
    Ok(())
}

/// Address of the folder of the results as seen from the page.
fn address(folder: &Path, file: &Path) -> anyhow::Result<String> {
    let failed = |path: &Path| format!("cannot find {}", path.display());
    let to = folder.canonicalize().with_context(|| failed(folder))?;
    let absolute = std::path::absolute(file).with_context(|| failed(file))?;
    let from = absolute.parent().unwrap_or(&absolute);
    // A folder that is made with the page has no links in it.
    let from = from.canonicalize().unwrap_or_else(|_not_there| from.to_owned());
    Ok(context::address(&from, &to))
}

fn page(context: &Context<'_>, state: &SceneState) -> anyhow::Result<Page> {
    let results = context.results;
    let section = |id, title, body| Section { id, title, body };
    let optional = |id, title, body: Option<Markup>| body.map(|body| Section { id, title, body });
    let mut sections = Vec::new();
    sections.extend(messages(results));
    sections.extend(of_points(context)?);
    sections.extend(optional("results", "Results", tables::key_values(&results.quantities)));
    sections.extend(optional("figures", "Figures", figures(context)));
    sections.extend(optional("pictures", "Pictures", pictures::section(context)));
    sections.extend(optional("energy", "Energy balance", energy::section(context)));
    sections.push(section("scene", "Scene", scene::section(results, state)));
    sections.extend(optional("values", "All values", values(context)));
    sections.extend(optional("work", "Time and rays", work::section(context)));
    sections.push(section("origin", "Repeat and cite", origin::section(results, state)));
    Ok(Page { title: heading(results), head: head(context), sections })
}

/// Sections of results that are of several points or systems; none of those of one run.
fn of_points(context: &Context<'_>) -> anyhow::Result<Vec<Section>> {
    let summary = &context.results.summary;
    let mut sections = Vec::new();
    let mut add = |id, title, body: Option<Markup>| {
        sections.extend(body.map(|body| Section { id, title, body }));
    };
    match summary.command.as_str() {
        "sweep" => {
            add("points", "Values at the points of the sweep", Some(sweep_figures(context)?));
            let title = "Sums over the hours of each day, with bounds of their standard errors";
            add("days", "Sums over days", csv_table(context, "daily.csv", title)?);
            let title = "Central differences with their standard errors";
            add("derivatives", "Derivatives", csv_table(context, output::DERIVATIVES, title)?);
            let dark: Vec<String> =
                summary.no_data.iter().map(|(point, why)| format!("{point}: {why}")).collect();
            add("dark", "Points without light", (!dark.is_empty()).then(|| work::list(&dark)));
        }
        "compare" => {
            let title = "Statistics over all values of a product";
            add("summary", "Summary", csv_table(context, "compare_summary.csv", title)?);
            let table = LongTable::read(&context.results.folder.join("compare.csv"), true)?;
            add("systems", "Values of each system", comparison::figures(context, &table));
        }
        "run" | "respectrum" => {}
        _ => {
            let tables = summary.files.iter().filter(|file| has_ending(file, "csv")).take(6);
            let tables: Vec<Markup> = tables
                .filter_map(|file| csv_table(context, file, &short(file)).transpose())
                .collect::<anyhow::Result<_>>()?;
            add(
                "tables",
                "Tables",
                (!tables.is_empty()).then(|| html! { @for one in &tables { (one) } }),
            );
        }
    }
    Ok(sections)
}

/// Figures of a sweep, or text that it has not ended.
fn sweep_figures(context: &Context<'_>) -> anyhow::Result<Markup> {
    let results = context.results;
    let file = results.folder.join("sweep.csv");
    if !file.is_file() {
        if results.summary.files.iter().any(|name| name == "sweep.csv") {
            bail!(
                "{} is missing: run the sweep again, which keeps the points that are there",
                file.display()
            );
        }
        return Ok(
            html! { p.warn { "The sweep has not ended: " code { "sunfleck sweep" } " goes on with it." } },
        );
    }
    let table = LongTable::read(&file, false)?;
    let figures = sweep::figures(context, &table);
    Ok(figures
        .unwrap_or_else(|| html! { p { "No point of the sweep has a value: see sweep.csv." } }))
}

/// Title of the page.
fn heading(results: &Results) -> String {
    let summary = &results.summary;
    if summary.scene.trim().is_empty() {
        let folder =
            results.folder.canonicalize().unwrap_or_else(|_not_there| results.folder.clone());
        return short(&folder.file_name().unwrap_or_default().to_string_lossy());
    }
    short(&summary.scene)
}

/// Where the results come from, in a few lines.
fn head(context: &Context<'_>) -> Markup {
    let summary = &context.results.summary;
    let what = match summary.command.as_str() {
        "run" => "Run",
        "sweep" => "Sweep",
        "compare" => "Comparison of transport systems",
        "respectrum" => "Other spectra on the paths of a run",
        other => other,
    };
    html! {
        p.lead {
            (short(what))
            @if let Some(file) = &summary.scene_file { " of " (name(file.rsplit('/').next().unwrap_or(file))) }
            @if let Some(variant) = &summary.variant { ", variant " (name(variant)) }
            @if let Some(written) = context.results.written { ", " (origin::date(written)) }
            "."
            @if let Some(seconds) = summary.seconds { " " (origin::rays(summary.rays.unwrap_or(0))) " in " (duration(seconds)) "." }
        }
        @if !summary.set.is_empty() {
            p { "With " @for (at, (param, value)) in summary.set.iter().take(20).enumerate() { @if at > 0 { ", " } (name(param)) " = " (name(value.as_str().unwrap_or(&value.to_string()))) } "." }
        }
        @if let Some(quality) = summary.quality { @if (quality - 1.0).abs() > 1e-12 { p { "Numbers of samples times " (number(quality, 3)) " (" code { "--quality" } ")." } } }
        p.origin { "sunfleck " (name(&summary.version)) ", seed " (summary.seed) ", scene hash " code title=(short(&summary.hash)) { (name(summary.hash.get(..12).unwrap_or(&summary.hash))) } }
    }
}

/// Warnings and notes of the run.
fn messages(results: &Results) -> Option<Section> {
    let summary = &results.summary;
    if summary.warnings.is_empty() && summary.notes.is_empty() {
        return None;
    }
    let body = html! {
        @if !summary.warnings.is_empty() { div.warn { (work::list(&summary.warnings)) } }
        @if !summary.notes.is_empty() { div.note { (work::list(&summary.notes)) } }
    };
    let title = if summary.warnings.is_empty() { "Notes" } else { "Warnings" };
    Some(Section { id: "messages", title, body })
}

/// Figures of all products, by sensor.
fn figures(context: &Context<'_>) -> Option<Markup> {
    let mut room = FIGURES;
    let mut shown = Vec::new();
    let mut left_out = 0;
    let all = &context.results.quantities;
    let images = products::joint_images(all);
    let others = all.iter().filter(|quantity| !products::is_joint(quantity));
    for quantity in others.chain(&images) {
        for figure in products::figures(context, quantity) {
            if room == 0 {
                left_out += 1;
                continue;
            }
            room -= 1;
            shown.push(figure.markup());
        }
    }
    (!shown.is_empty()).then(|| {
        html! {
            div.figures { @for figure in &shown { (figure) } }
            @if left_out > 0 { p.note { (left_out) " more figures are not shown: see the files." } }
        }
    })
}

/// Tables of the values of all products that have several for each band.
fn values(context: &Context<'_>) -> Option<Markup> {
    let is_table =
        |quantity: &&Quantity| !tables::is_balance(quantity) && !tables::is_told(quantity);
    let all: Vec<&Quantity> = context.results.quantities.iter().filter(is_table).collect();
    if all.is_empty() {
        return None;
    }
    Some(html! {
        @for quantity in all.iter().take(TABLES) { (tables::all_values(context, quantity)) }
        @if all.len() > TABLES {
            p.note { (all.len() - TABLES) " more products are not shown, the first of them " (title(&all[TABLES].name)) ": see summary.json." }
        }
    })
}
