//! How to repeat results, and how to cite them.

use maud::{Markup, html};

use super::scene::{Agreement, SceneState};
use super::summary::Results;
use super::words::{cut, name, number};
use crate::commands::quoted;
use sunfleck::counts::counted;

/// Commands and a citation.
pub(super) fn section(results: &Results, state: &SceneState) -> Markup {
    let summary = &results.summary;
    html! {
        p { "From the folder of the results, with sunfleck " (name(&summary.version)) ":" }
        @if summary.command == "run" {
            pre tabindex="0" { code { "sunfleck rerun . --out again" } }
            p { "repeats the run from the scene that its files hold. The scene file as it is now runs by" }
        }
        pre tabindex="0" { code { (cut(&command(results), 4000)) } }
        @if summary.command == "respectrum" { p { "where RESULTS is the folder of the run whose paths these are." } }
        p {
            "Equal hashes, versions and seeds give equal numbers, on any number of threads."
            @if state.is == Agreement::Changed { " The scene file has changed: the command gives other numbers." }
        }
        dl.facts {
            dt { "scene hash" } dd { code { (name(&summary.hash)) } }
            dt { "version" } dd { (name(&summary.version)) }
            dt { "seed" } dd { (summary.seed) }
        }
        h3 { "To cite" }
        p.cite {
            "sunfleck " (name(&summary.version)) ", Monte Carlo radiative transfer of forest scenes. Scene "
            q { (name(&summary.scene)) } ", hash " code { (name(summary.hash.get(..16).unwrap_or(&summary.hash))) }
            ", seed " (summary.seed) "."
        }
        @if !state.sources.is_empty() {
            p { "Published data that the scene uses:" }
            ul { @for source in &state.sources { li { (source) } } }
        }
    }
}

/// Command line that makes the results again.
fn command(results: &Results) -> String {
    let summary = &results.summary;
    let mut words = vec!["sunfleck".to_owned(), summary.command.clone()];
    words.push(match (summary.command.as_str(), &summary.scene_file) {
        // Their paths lie in the results of another run, and nothing here says where those are.
        ("respectrum", _) => "RESULTS".to_owned(),
        (_, Some(scene)) => quoted(scene),
        (_, None) => "SCENE.ron".to_owned(),
    });
    if let Some(variant) = &summary.variant {
        words.extend(["--variant".to_owned(), quoted(variant)]);
    }
    for (name, value) in &summary.set {
        let value = match value {
            serde_json::Value::Number(value) => {
                value.as_f64().map_or_else(|| value.to_string(), plain)
            }
            serde_json::Value::String(text) => text.clone(),
            other => other.to_string(),
        };
        words.extend(["--set".to_owned(), quoted(&format!("{name}={value}"))]);
    }
    #[expect(clippy::float_cmp, reason = "the default is this very number")]
    if let Some(quality) = summary.quality.filter(|quality| *quality != 1.0) {
        words.extend(["--quality".to_owned(), plain(quality)]);
    }
    words.extend(["--out".to_owned(), "again".to_owned()]);
    words.join(" ")
}

/// A number without a needless `.0`.
fn plain(value: f64) -> String {
    let text = sunfleck::output::number(value);
    text.strip_suffix(".0").map_or_else(|| text.clone(), str::to_owned)
}

/// Time as a page shows it: `2026-11-30 21:05 UTC`.
pub(super) fn date(time: std::time::SystemTime) -> String {
    let text = humantime::format_rfc3339_seconds(time).to_string();
    text.get(..16).map_or_else(|| text.clone(), |day| format!("{} UTC", day.replace('T', " ")))
}

/// Rays of a run in a few letters: `12.4 million rays`.
pub(super) fn rays(count: u64) -> String {
    if count < 1_000_000 {
        counted(count, "ray")
    } else {
        format!("{} million rays", number(count as f64 / 1e6, 3))
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, UNIX_EPOCH};

    use super::*;

    #[test]
    fn dates_are_short() {
        assert_eq!(date(UNIX_EPOCH + Duration::from_secs(1_796_072_767)), "2026-11-30 21:06 UTC");
    }
}
