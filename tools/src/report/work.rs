//! What a run did: time, rays, memory, and what it skipped.

use maud::{Markup, html};

use super::context::Context;
use super::figure::{Bar, Figure, Segment, stack};
use super::tables::{Cell, table};
use super::words::{duration, number, prose, short};
use crate::describe::{bytes, grouped};

/// Maximum number of lines of a list.
const LINES: usize = 40;

/// Stages, sensors, and what was skipped; `None` of results that do not tell.
pub(super) fn section(context: &Context<'_>) -> Option<Markup> {
    let summary = &context.results.summary;
    let seconds = summary.seconds?;
    let rays = summary.rays.unwrap_or(0);
    let rate = rays as f64 / summary.stages.get("trace").copied().unwrap_or(seconds).max(1e-9);
    Some(html! {
        p {
            (duration(seconds)) " in all, " (grouped(rays)) " rays"
            @if rays > 0 { ", " (number(rate / 1e6, 3)) " million rays per second of tracing" }
            "."
        }
        @if summary.stages.len() > 1 { (stages(context).markup()) }
        @if !summary.runs.is_empty() { (sensors(context)) }
        @if !summary.skipped.is_empty() {
            h3 { "Not needed, and skipped" }
            (list(&summary.skipped))
        }
    })
}

/// Texts as a list, the first of very many.
pub(super) fn list(texts: &[String]) -> Markup {
    html! {
        ul {
            @for text in texts.iter().take(LINES) { li { bdi { (prose(text, 600)) } } }
            @if texts.len() > LINES { li { (texts.len() - LINES) " more are in summary.json." } }
        }
    }
}

fn stages(context: &Context<'_>) -> Figure {
    let stages = &context.results.summary.stages;
    let segment = |(colour, (name, seconds)): (usize, (&String, &f64))| Segment {
        colour,
        size: *seconds,
        label: duration(*seconds),
        tooltip: format!("{}: {}", short(name), duration(*seconds)),
    };
    let bar =
        Bar { name: "time".to_owned(), segments: stages.iter().enumerate().map(segment).collect() };
    Figure {
        panels: vec![stack(&[bar], "Wall time of the stages of the run")],
        legend: stages
            .iter()
            .map(|(name, seconds)| format!("{} {}", short(name), duration(*seconds)))
            .collect(),
        bar: None,
        title: "Wall time by stage".to_owned(),
        caption: Vec::new(),
        data: None,
    }
}

fn sensors(context: &Context<'_>) -> Markup {
    let runs = &context.results.summary.runs;
    let has_memory = runs.values().any(|run| run.forecast.is_some());
    let mut header: Vec<String> =
        ["sensor", "time", "rays", "million rays/s", "samples", "ended by"]
            .map(str::to_owned)
            .to_vec();
    if has_memory {
        header.extend(["memory", "files"].map(str::to_owned));
    }
    let row = |(name, run): (&String, &super::summary::SensorRun)| {
        let rate = run.rays as f64 / run.seconds.max(1e-9) / 1e6;
        let mut row = vec![
            Cell::Text(name.clone()),
            Cell::Number(duration(run.seconds), run.seconds),
            Cell::Number(grouped(run.rays), run.rays as f64),
            Cell::Number(number(rate, 3), rate),
            Cell::Number(grouped(run.samples), run.samples as f64),
            Cell::Text(run.ended_by.clone()),
        ];
        if has_memory {
            let size = |count: Option<u64>| match count {
                Some(count) => Cell::Number(bytes(count), count as f64),
                None => Cell::Text(String::new()),
            };
            row.push(size(run.forecast.as_ref().map(|forecast| forecast.memory_bytes)));
            row.push(size(run.file_bytes));
        }
        row
    };
    let rows: Vec<Vec<Cell>> = runs.iter().take(4 * LINES).map(row).collect();
    let caption = html! {
        "Work of each sensor"
        @if has_memory { "; memory and files of those that took longer" }
        "."
    };
    table(&caption, &header, &rows)
}
