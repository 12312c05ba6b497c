//! Parameters, variants and sweeps.

use super::super::diagnostic::{Diagnostic, suggestion};
use super::super::scene::{DerivativeSteps, Param, Scene, Sweep};
use super::{Report, ScenePath};
use crate::counts::counted;

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
    let (axes, is_zip) = match sweep {
        Sweep::Grid(axes) => (axes, false),
        Sweep::Zip(axes) => (axes, true),
        Sweep::Derivatives(steps) => return check_derivatives(steps, scene, report),
    };
    if axes.is_empty() && report.is_whole("sweep") {
        let help = "write, for example, `Grid({ \"sza\": [0.0, 30.0, 60.0] })`";
        report.error("sweep", "this sweep varies nothing", help);
    }
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
        if !scene.params.contains_key(name) {
            let first = values.first().map_or_else(|| "1.0".to_owned(), shown);
            let known: Vec<_> = scene.params.keys().map(String::as_str).collect();
            check_known(path, name, &first, &known, report);
        }
    }
    if let (true, Some((first, values))) = (is_zip, axes.first()) {
        let other = axes.iter().find(|(_, other)| other.len() != values.len());
        if let Some((name, other)) = other {
            let message = format!(
                "`{first}` has {}, `{name}` has {}",
                counted(values.len(), "value"),
                counted(other.len(), "value")
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

/// Checks that there is a parameter; `example` is a value of it, and `known` are those that it might be.
fn check_known(
    path: ScenePath,
    name: &str,
    example: &str,
    known: &[&str],
    report: &mut Report<'_>,
) {
    if report.is_readable("params") {
        let help = if known.is_empty() {
            format!("add it: `params: {{ \"{name}\": {example} }}`")
        } else {
            suggestion(name, known, "a sweep may vary")
        };
        report.error(path, format!("no parameter `{name}` to vary"), help);
    }
}

/// Smallest step as a fraction of the parameter: spectra have the digits of f32.
const SMALLEST_STEP: f64 = 1e-5;

fn check_derivatives(steps: &DerivativeSteps, scene: &Scene, report: &mut Report<'_>) {
    let names = steps.names();
    if names.is_empty() && report.is_whole("sweep") {
        let help = "write, for example, `Derivatives([\"cab\", \"lai\"])`";
        report.error("sweep", "these derivatives are with respect to nothing", help);
    }
    let numbers = scene.params.iter().filter(|(_, value)| value.number().is_some());
    let numbers: Vec<&str> = numbers.map(|(name, _)| name.as_str()).collect();
    for (index, &name) in names.iter().enumerate() {
        let path = steps.path(index);
        if names[..index].contains(&name) {
            report.error(&path, format!("`{name}` is given twice"), "take one of the two out");
        }
        match scene.params.get(name) {
            Some(Param::Number(own)) => check_step(steps, index, *own, report),
            Some(Param::Text(text)) => {
                let message = format!("`{name}` is the text {text:?}, which has no derivative");
                let help = if numbers.is_empty() {
                    "derivatives are with respect to numbers of `params`".to_owned()
                } else {
                    suggestion(name, &numbers, "there are derivatives with respect to")
                };
                report.error(path, message, help);
            }
            None => check_known(path, name, "1.0", &numbers, report),
        }
    }
}

/// Checks the step of a parameter, whose own value is given.
fn check_step(steps: &DerivativeSteps, index: usize, own: f64, report: &mut Report<'_>) {
    let (name, path, step) = (steps.names()[index], steps.path(index), steps.step(index, own));
    let least = SMALLEST_STEP * own.abs();
    match steps {
        DerivativeSteps::Relative(_) if own == 0.0 => {
            let help = format!("name a step: `Derivatives({{ \"{name}\": 0.01 }})`");
            report.error(path, format!("`{name}` is 0, of which 1 % is no step"), help);
        }
        DerivativeSteps::Absolute(_) if step > 0.0 && step < least => {
            let message = format!("expected a step of at least {least:e}, found {step:e}");
            let help = "spectra have seven digits: smaller steps measure their rounding";
            report.error(path, message, help);
        }
        DerivativeSteps::Absolute(_) => report.above_zero(path, step),
        DerivativeSteps::Relative(_) => {}
    }
}
