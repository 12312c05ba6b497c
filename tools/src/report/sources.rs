//! Spectra that come with sunfleck: whose they are, and under which licence, where a scene uses them.

use sunfleck::document::Scene;

/// A word of a scene that uses published data, and their source.
const SOURCES: [(&str, &str); 6] = [
    (
        "AstmG173",
        "Irradiance: ASTM G173-03 (National Renewable Energy Laboratory), as pvlib distributes it, BSD 3-Clause License.",
    ),
    ("AstmE490", "Irradiance: ASTM E490-00a, as pyspectral distributes it, Apache License 2.0."),
    (
        "Prospect(",
        "Leaves: optical constants of PROSPECT-PRO, © 2020-present Jean-Baptiste Féret, MIT License.",
    ),
    (
        "Soil(",
        "Soils: those of PROSAIL, Jacquemoud et al. (2009), Remote Sens. Environ. 113, S56, as torchrtm distributes them, © 2025 Peng Sun, MIT License.",
    ),
    (
        "Library(",
        "Litter, bark, wood: spectral library of earthlib, © 2023 Christopher Anderson, MIT License. Snow: computed, refractive index of Warren and Brandt (2008).",
    ),
    (
        "Sensor(",
        "Responses of bands: published by space agencies, as pyrsr distributes them, © 2019-2026 Daniel Scheffler, GFZ Potsdam, Apache License 2.0; EnMAP and PRISMA: hgrs, © 2025 Tristan Harmel, Apache License 2.0.",
    ),
];

/// Sources of the published data that a scene uses.
pub(super) fn sources(scene: &Scene) -> Vec<&'static str> {
    // Defaults are a part of this text, and not of the scene as it is written.
    let parts = [
        format!("{:?}", scene.bands),
        format!("{:?}", scene.spectra),
        format!("{:?}", scene.materials),
        format!("{:?}", scene.sun),
        format!("{:?}", scene.sky),
    ];
    let is_used = |word: &str| {
        let is_start = |text: &str, at: usize| {
            !text[..at].ends_with(|letter: char| letter.is_alphanumeric() || letter == '_')
        };
        parts.iter().any(|text| text.match_indices(word).any(|(at, _)| is_start(text, at)))
    };
    SOURCES.iter().filter(|(word, _)| is_used(word)).map(|(_, source)| *source).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests {
    use super::*;

    #[test]
    fn published_data_that_a_scene_uses_are_named_and_no_others() {
        let scene = |spectrum: &str, sun: &str| {
            let text = format!(
                r#"Scene(
                    format: 1,
                    bands: [(name: "red", center_nm: 660.0, width_nm: 20.0)],
                    materials: {{ "soil": Lambertian(reflectance: {spectrum}) }},
                    terrain: Plane(size_m: (1.0, 1.0), material: "soil"),
                    sun: (zenith_deg: 30.0{sun}),
                )"#
            );
            sunfleck::read_text("a.ron", &text, &sunfleck::ReadOptions::default()).unwrap().scene
        };
        let starts = |scene: &Scene| -> Vec<&str> {
            sources(scene).into_iter().map(|text| text.split(':').next().unwrap()).collect()
        };
        assert_eq!(starts(&scene("Constant(0.2)", "")), ["Irradiance"]);
        assert_eq!(starts(&scene("Soil(dryness: 0.3)", ", irradiance: Constant(1.0)")), ["Soils"]);
        let library = scene("Library(\"bark_birch\")", ", irradiance: Constant(1.0)");
        assert_eq!(starts(&library), ["Litter, bark, wood"]);
    }
}
