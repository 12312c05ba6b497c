//! The scene of a sweep, for axes of its parameters and for the sun at its points.

use sunfleck::document::{Param, ParsedScene, ReadOptions, ScenePath, Step};
use sunfleck::output::axis_title;

use super::scene::read_options;
use super::summary::Results;
use super::words::short;

/// Keys of the scene that say nothing of the meaning of a parameter.
const NO_USE: [&str; 4] = ["title", "params", "variants", "sweep"];

/// Scene file of a sweep, if it is still there and has the parameters of the results.
pub(super) struct SweptScene {
    parsed: Option<ParsedScene>,
    options: ReadOptions,
}

impl SweptScene {
    pub(super) fn new(results: &Results) -> Self {
        let file = results.scene_file().filter(|_| results.summary.command == "sweep");
        let parsed = file.and_then(|file| ParsedScene::from_file(&file).ok());
        Self { parsed, options: read_options(results) }
    }

    /// Title of the axis of a parameter, with the unit of what it sets: `sza: sun zenith (°)`.
    pub(super) fn param_title(&self, name: &str) -> String {
        let plain = axis_title(&short(name));
        let mut uses = self.parsed.iter().flat_map(|parsed| parsed.uses_of_param(name));
        let meaning = uses.find_map(|path| meaning(&path));
        match meaning {
            Some(meaning) if meaning != plain => format!("{}: {meaning}", short(name)),
            _ => plain,
        }
    }

    /// Zenith angle and azimuth of the sun at a point, degrees, if it is above the horizon there.
    pub(super) fn sun(&self, params: &[String], values: &[String]) -> Option<[f64; 2]> {
        let point = params.iter().zip(values).map(|(name, value)| {
            let number = value.parse::<f64>().ok().filter(|number| number.is_finite());
            (name.clone(), number.map_or_else(|| Param::Text(value.clone()), Param::Number))
        });
        let options = ReadOptions { point: point.collect(), ..self.options.clone() };
        let (zenith, azimuth) = self.parsed.as_ref()?.read(&options).scene.sun?.angles_deg()?;
        Some([zenith, azimuth])
    }
}

/// Quantity and unit of a value of the scene by the keys above it: `sun zenith (°)`, `reflectance (–)`.
fn meaning(path: &ScenePath) -> Option<String> {
    let keys: Vec<&str> = path
        .steps()
        .iter()
        .filter_map(|step| if let Step::Key(key) = step { Some(key.as_ref()) } else { None })
        .collect();
    let (first, last) = (keys.first()?, keys.last()?);
    if NO_USE.contains(first) {
        return None;
    }
    let title = match (*last, path.steps().last()?) {
        ("reflectance" | "transmittance" | "back_reflectance", _) => {
            format!("{} (–)", last.replace('_', " "))
        }
        ("time", Step::Index(0)) => "time (h)".to_owned(),
        _ => axis_title(last),
    };
    Some(if *first == "sun" { format!("sun {title}") } else { title })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests {
    use super::*;

    /// *Expected*: names with the quantity and unit of the first use; what no value is alone keeps its name.
    #[test]
    fn parameters_have_the_quantity_and_unit_of_what_they_set() {
        let text = r#"Scene(
            format: 1, title: "=sza",
            params: { "sza": 20.0, "soil": 0.1, "half": 1.0, "height_m": 3.0, "hour": 9.0 },
            sun: (zenith_deg: "=sza", azimuth_deg: "=2 * half"),
            meshes: { "leaf": Crown(base_m: "=height_m") },
            materials: { "soil": Lambertian(reflectance: Bands([0.2, "=soil"])) },
            note: (time: ("=hour", 0, 0)),
        )"#;
        let parsed = Some(ParsedScene::new("a.ron", text).unwrap());
        let swept = SweptScene { parsed, options: ReadOptions::default() };
        let titles =
            ["sza", "soil", "half", "height_m", "hour"].map(|name| swept.param_title(name));
        let expected = [
            "sza: sun zenith (°)",
            "soil: reflectance (–)",
            "half",
            "height_m: base (m)",
            "hour: time (h)",
        ];
        assert_eq!(titles, expected);
    }

    #[test]
    fn the_sun_of_a_point_is_that_of_its_parameters() {
        let text = r#"Scene(format: 1, params: { "sza": 20.0 }, sun: (zenith_deg: "=sza", azimuth_deg: 70.0))"#;
        let parsed = Some(ParsedScene::new("a.ron", text).unwrap());
        let swept = SweptScene { parsed, options: ReadOptions::default() };
        assert_eq!(swept.sun(&["sza".to_owned()], &["55".to_owned()]), Some([55.0, 70.0]));
        let lost = SweptScene { parsed: None, options: ReadOptions::default() };
        assert_eq!(lost.sun(&["sza".to_owned()], &["55".to_owned()]), None);
        assert_eq!(lost.param_title("sza_deg"), "sza (°)");
    }
}
