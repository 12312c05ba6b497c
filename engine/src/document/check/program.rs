//! Parameters, variants and sweeps.

use super::super::diagnostic::{Diagnostic, suggestion};
use super::super::scene::{Param, Scene, Sweep};
use super::{Report, ScenePath, count};

/// A sweep may have so many points.
const POINTS: usize = 100_000;

pub(super) fn check_params(scene: &Scene, report: &mut Report<'_>) {
    for (name, value) in &scene.params {
        let path = ScenePath::from("params").name(name);
        // Behind the names of included files.
        let lawful = name.split('.').all(|name| {
            let mut letters = name.chars();
            letters.next().is_some_and(|c| c == '_' || c.is_alphabetic())
                && letters.all(|c| c == '_' || c.is_alphanumeric())
        });
        if !lawful {
            let help = "start with a letter, go on with letters, digits and `_`";
            report.error(&path, format!("`{name}` cannot be a parameter's name"), help);
        }
        report.finite(path, value.number().as_slice());
    }
    for (variant, changes) in &scene.variants {
        let known: Vec<_> = scene.params.keys().map(String::as_str).collect();
        for (name, value) in changes {
            let path = ScenePath::from("variants").name(variant).name(name);
            report.finite(&path, value.number().as_slice());
            check_kind(&path, value, scene.params.get(name), report);
            if !scene.params.contains_key(name) && report.is_readable("params") {
                let help = if known.is_empty() {
                    format!("add it: `params: {{ \"{name}\": {} }}`", shown(value))
                } else {
                    suggestion(name, &known, "a variant may change")
                };
                let error = Diagnostic::error(&path, format!("no parameter `{name}` to change"));
                report.push(Diagnostic { is_of_key: true, ..error.help(help) });
            }
        }
    }
}

/// A parameter is a number or a text, whatever its value.
fn check_kind(path: &ScenePath, value: &Param, own: Option<&Param>, report: &mut Report<'_>) {
    let Some(own) = own else { return };
    // What could not be read counts as a number that is not finite.
    if value.number().is_some() != own.number().is_some() && own.is_lawful() {
        let kind = if own.number().is_some() { "a number" } else { "a text" };
        let message = format!("expected {kind}, as in `params`, found {}", shown(value));
        report.error(path, message, "a parameter is one of both at all of its values");
    }
}

/// A value as it is written in a scene.
fn shown(value: &Param) -> String {
    match value {
        Param::Number(number) => format!("{number:?}"),
        Param::Text(text) => format!("{text:?}"),
    }
}

pub(super) fn check_sweep(scene: &Scene, report: &mut Report<'_>) {
    let Some(sweep) = &scene.sweep else { return };
    let (Sweep::Grid(axes) | Sweep::Zip(axes)) = sweep;
    if axes.is_empty() && report.is_whole("sweep") {
        let help = "write, for example, `Grid({ \"sza\": [0.0, 30.0, 60.0] })`";
        report.error("sweep", "this sweep varies nothing", help);
    }
    let known: Vec<_> = scene.params.keys().map(String::as_str).collect();
    for (name, values) in axes {
        let path = ScenePath::from("sweep").name(name);
        for (index, value) in values.iter().enumerate() {
            let at = path.index(index);
            report.finite(&at, value.number().as_slice());
            check_kind(&at, value, scene.params.get(name), report);
        }
        if values.is_empty() {
            report.error(&path, "no values", "write at least one");
        }
        if !scene.params.contains_key(name) && report.is_readable("params") {
            let help = if known.is_empty() {
                let first = values.first().map_or_else(|| "1.0".to_owned(), shown);
                format!("add it: `params: {{ \"{name}\": {first} }}`")
            } else {
                suggestion(name, &known, "a sweep may vary")
            };
            report.error(path, format!("no parameter `{name}` to vary"), help);
        }
    }
    if let (Sweep::Zip(axes), Some((first, values))) = (sweep, axes.first()) {
        let other = axes.iter().find(|(_, other)| other.len() != values.len());
        if let Some((name, other)) = other {
            let message = format!(
                "`{first}` has {}, `{name}` has {}",
                count(values.len(), "value"),
                count(other.len(), "value")
            );
            let help = "`Zip` takes one value of each at every point; `Grid` combines all of them";
            report.error(ScenePath::from("sweep").name(name), message, help);
        }
    }
    match sweep.len() {
        points if points > POINTS => {
            let message = format!("this sweep has {points} points, more than {POINTS}");
            report.push(Diagnostic::error("sweep", message).help("split it, or take values out"));
        }
        _ => {}
    }
}
