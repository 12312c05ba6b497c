//! Lawful ranges of quantities: one table for all keys.

use super::super::leaves::{LeafValue, visit_leaves};
use super::super::path::{ScenePath, Step};
use super::super::scene::Scene;
use super::Report;

/// Lawful values of a quantity; the ends are lawful.
#[derive(Debug, PartialEq)]
pub(crate) struct LawfulRange {
    /// Name of the quantity with an article.
    quantity: &'static str,
    /// Unit behind a number; empty for none.
    unit: &'static str,
    least: f64,
    most: f64,
    /// Advice on what to write instead.
    help: &'static str,
}

/// Coordinates and lengths. Eastings that start with the number of their zone reach 3.3e7 m.
pub(crate) const LENGTH: LawfulRange = LawfulRange {
    quantity: "a coordinate or a length",
    unit: "m",
    least: -1e8,
    most: 1e8,
    help: "lengths are in metres; coordinates of a map may be moved by `frame.origin_m`",
};

/// Heights, and heights of sensors: satellites among them.
pub(crate) const HEIGHT: LawfulRange = LawfulRange {
    quantity: "a height",
    unit: "m",
    least: -1e8,
    most: 1e8,
    help: "heights are in metres",
};

const AREA: LawfulRange = LawfulRange {
    quantity: "an area, or a number per area",
    unit: "",
    least: 0.0,
    most: 1e12,
    help: "areas are in m², densities per m²",
};

const ANGLE: LawfulRange = LawfulRange {
    quantity: "an angle",
    unit: "°",
    least: -1e6,
    most: 1e6,
    help: "angles are in degrees",
};

const WAVELENGTH: LawfulRange = LawfulRange {
    quantity: "a wavelength",
    unit: "nm",
    least: 0.0,
    most: 1e9,
    help: "wavelengths are in nanometres: 10 µm is 10000.0",
};

/// Temperatures. Flames and lamps are below 4000 K.
pub(super) const TEMPERATURE: LawfulRange = LawfulRange {
    quantity: "a temperature",
    unit: "K",
    least: 0.0,
    most: 1e4,
    help: "temperatures are in kelvins: 20 °C is 293.15",
};

const TEMPERATURE_DIFFERENCE: LawfulRange = LawfulRange {
    quantity: "a difference of temperatures",
    unit: "K",
    least: -1e4,
    most: 1e4,
    help: "it is the sunlit temperature less the shaded one",
};

/// Irradiance, and radiance of the thermal sky. The surface of the sun has some 1e5 W m⁻² nm⁻¹.
pub(crate) const IRRADIANCE: LawfulRange = LawfulRange {
    quantity: "an irradiance or a radiance",
    unit: "W m⁻² nm⁻¹",
    least: 0.0,
    most: 1e12,
    help: "the sun has some 1 to 2 W m⁻² nm⁻¹ in the visible",
};

/// Sizes of instances over that of their mesh.
pub(crate) const SCALE: LawfulRange = LawfulRange {
    quantity: "a scale",
    unit: "",
    least: 0.0,
    most: 1e6,
    help: "a scale of 1 leaves the mesh as it is",
};

const SECONDS: LawfulRange = LawfulRange {
    quantity: "a time",
    unit: "s",
    least: 0.0,
    most: 1e9,
    help: "the time of a measurement is in seconds",
};

impl LawfulRange {
    /// Fault of a value, with advice; `None` if it is lawful.
    pub(crate) fn problem(&self, value: f64) -> Option<(String, &'static str)> {
        let Self { quantity, unit, least, most, help } = self;
        if (*least..=*most).contains(&value) {
            return None;
        }
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        let [least, most, value] = [*least, *most, value].map(shown);
        let message = format!("expected {quantity} from {least} to {most}{unit}, found {value}");
        Some((message, help))
    }
}

/// A number with at most six digits before the point.
fn shown(value: f64) -> String {
    let is_short = value == 0.0 || (1e-3..1e6).contains(&value.abs());
    if is_short { value.to_string() } else { format!("{value:e}") }
}

/// Reports numbers beyond the range of their quantity where nothing else is wrong with them.
pub(super) fn check_ranges(scene: &Scene, report: &mut Report<'_>) {
    let known: Vec<ScenePath> = report.found.iter().map(|one| one.path.clone()).collect();
    visit_leaves(scene, &mut |path, leaf| {
        let LeafValue::Number(value) = leaf else { return };
        let problem = range_of(path).map_or_else(
            || {
                (!value.is_finite())
                    .then(|| (format!("expected a finite number, found {value}"), ""))
            },
            |range| range.problem(value),
        );
        let Some((message, help)) = problem else { return };
        if known.iter().any(|known| path.is_within(known)) {
            return;
        }
        if help.is_empty() {
            report.push(super::Diagnostic::error(path, message));
        } else {
            report.error(path, message, help);
        }
    });
}

/// The range of the quantity that a number at this path is of.
fn range_of(path: &ScenePath) -> Option<&'static LawfulRange> {
    let steps = path.steps();
    // Numbers that authors have named may be anything.
    if let Some(Step::Key(key)) = steps.first()
        && matches!(&**key, "params" | "variants" | "sweep")
    {
        return None;
    }
    let is_third = matches!(steps, [.., Step::Key(_), Step::Index(2)])
        || matches!(steps, [.., Step::Key(_), Step::Index(_), Step::Index(2)]);
    // Those of a distribution are of what the key above it is of.
    let key = steps.iter().rev().find_map(|step| match step {
        Step::Key(key) => {
            Some(&**key).filter(|key| !["mean", "sd", "median", "min", "max"].contains(key))
        }
        _ => None,
    })?;
    Some(match key {
        "scale" => &SCALE,
        "temperature" => &TEMPERATURE,
        "spectra" | "irradiance" if is_point(steps) => match steps.last() {
            Some(Step::Index(0)) => &WAVELENGTH,
            _ => &IRRADIANCE,
        },
        "spectra" | "irradiance" => &IRRADIANCE,
        "until" => &SECONDS,
        "height_m" | "heights_m" | "base_m" | "lowest_m" => &HEIGHT,
        _ if key.ends_with("_m") && is_third => &HEIGHT,
        _ if key.ends_with("_m") => &LENGTH,
        _ if key.ends_with("_m2") => &AREA,
        _ if key.ends_with("_deg") => &ANGLE,
        _ if key.ends_with("_nm") => &WAVELENGTH,
        "delta_k" => &TEMPERATURE_DIFFERENCE,
        _ if key.ends_with("_k") => &TEMPERATURE,
        _ => return None,
    })
}

/// Returns whether a number is one of a pair in a list.
fn is_point(steps: &[Step]) -> bool {
    matches!(steps, [.., Step::Index(_), Step::Index(_)])
}

#[cfg(test)]
mod tests {
    use super::super::super::path::ScenePath;
    use super::{HEIGHT, IRRADIANCE, LENGTH, SCALE, TEMPERATURE, WAVELENGTH, range_of};

    #[test]
    fn a_quantity_follows_from_the_keys_above_a_number() {
        let [instances, sensors, materials, sun, params] =
            ["instances", "sensors", "materials", "sun", "params"].map(ScenePath::from);
        let at = instances.index(0).key("at_m").index(7);
        assert_eq!(range_of(&at.index(1)), Some(&LENGTH));
        assert_eq!(range_of(&at.index(2)), Some(&HEIGHT));
        let camera = sensors.name("up").key("position_m").index(2);
        assert_eq!(range_of(&camera), Some(&HEIGHT));
        assert_eq!(range_of(&instances.index(0).key("scale").key("mean")), Some(&SCALE));
        assert_eq!(range_of(&materials.name("soil").key("temperature")), Some(&TEMPERATURE));
        let irradiance = sun.key("irradiance");
        assert_eq!(range_of(&irradiance), Some(&IRRADIANCE));
        assert_eq!(range_of(&irradiance.index(3).index(0)), Some(&WAVELENGTH));
        assert_eq!(range_of(&irradiance.index(3).index(1)), Some(&IRRADIANCE));
        assert_eq!(range_of(&params.name("height_m")), None);
    }
}
