//! Spectra of Eradiate: numbers, `uniform` and `interpolated` ones.

use anyhow::{Context as _, Result, bail};
use serde_json::Value;

use super::super::model::Curve;
use super::{Object, needed, numbers, shown};

/// Reads a spectrum at a place of the scenario.
pub(super) fn curve(value: &Value, at: &str) -> Result<Curve> {
    if let Some(number) = value.as_f64() {
        return Ok(Curve::Constant(number));
    }
    let spectrum = super::object(value, at)?;
    let kind = spectrum.get("type").and_then(Value::as_str).unwrap_or("interpolated");
    match kind {
        "uniform" => {
            let value = needed(spectrum, "value", at)?;
            let value = value.get("value").unwrap_or(value);
            let number = value.as_f64();
            Ok(Curve::Constant(number.with_context(|| format!("{at}.value: expected a number"))?))
        }
        "interpolated" => {
            let (wavelengths, unit) = list(spectrum, "wavelengths", at)?;
            let factor = nanometres(unit.as_deref(), at)?;
            let (values, unit) = list(spectrum, "values", at)?;
            let fraction = match unit.as_deref() {
                None | Some("" | "dimensionless") => 1.0,
                Some("percent" | "%") => 0.01,
                Some(other) => bail!("{at}.values: the unit {other:?} is none of a fraction"),
            };
            let wavelengths: Vec<f64> = wavelengths.iter().map(|value| value * factor).collect();
            let values: Vec<f64> = values.iter().map(|value| value * fraction).collect();
            Curve::from_lists(&wavelengths, &values).with_context(|| at.to_owned())
        }
        other => bail!(
            "{at}: a spectrum of the type {other:?} has no counterpart; `uniform` and `interpolated` have"
        ),
    }
}

/// A list with its unit, which stands beside it or, with it, in an object of its own.
fn list(spectrum: &Object, key: &str, at: &str) -> Result<(Vec<f64>, Option<String>)> {
    let value = needed(spectrum, key, at)?;
    let at = format!("{at}.{key}");
    let text = |unit: Option<&Value>| unit.and_then(Value::as_str).map(str::to_owned);
    Ok(match value.as_object() {
        Some(own) => {
            let values = own.get("values").or_else(|| own.get("value")).unwrap_or(value);
            (numbers(values, &at)?, text(own.get("units")))
        }
        None if value.is_array() => {
            (numbers(value, &at)?, text(spectrum.get(&format!("{key}_units"))))
        }
        None => bail!("{at}: expected a list of numbers, found {}", shown(value)),
    })
}

/// Nanometres of a unit of wavelengths; Eradiate's default unit is the nanometre.
fn nanometres(unit: Option<&str>, at: &str) -> Result<f64> {
    Ok(match unit {
        None | Some("nm" | "nanometer" | "nanometre" | "nanometers" | "nanometres") => 1.0,
        Some("um" | "µm" | "micrometer" | "micrometre" | "micron" | "micrometers" | "microns") => {
            1e3
        }
        Some("m" | "meter" | "metre") => 1e9,
        Some(other) => bail!("{at}.wavelengths: {other:?} is no unit of wavelengths that is known"),
    })
}
