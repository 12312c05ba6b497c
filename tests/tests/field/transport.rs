//! What sensors measure of isolated scenes, slopes and heights above the scene.

use sunfleck_tests::field::{Case, Right, hold};

/// Downwelling at every height above the scene is that at its top, from sun, sky and emission, by
/// packets and photons, in periodic and isolated scenes.
#[test]
fn light_above_the_scene_is_that_of_its_sources() {
    let at = |heights: &[&'static str], truth| -> Vec<Right> {
        heights.iter().map(|level| Right::value("p", level, 0, truth)).collect()
    };
    let above = ["downwelling_2.5m", "downwelling_5m", "downwelling_50m", "downwelling_top"];
    let isolated = at(&above, 0.5);
    let sun = at(&above, 0.866_025);
    let sky = at(&above, 0.4);
    let around_top = ["downwelling_2m", "downwelling_1.999m", "downwelling_2.001m"];
    // The plate of 4 m² at 2 m shades what is below it, of the 100 m² that are lit.
    let at_top = [
        Right::value("p", around_top[0], 0, 0.866_025),
        Right::value("p", around_top[1], 0, 0.866_025 * 0.96),
        Right::value("p", around_top[2], 0, 0.866_025),
    ];
    let turbid: Vec<Right> = [("4m", 0.553), ("3m", 0.399), ("2m", 0.288), ("0.5m", 0.208)]
        .map(|(height, value)| Right::Value {
            sensor: "alb",
            product: match height {
                "4m" => "downwelling_4m",
                "3m" => "downwelling_3m",
                "2m" => "downwelling_2m",
                _ => "downwelling_0.5m",
            },
            index: 0,
            value,
            within: 0.0015,
        })
        .into();
    hold(&[
        Case { scene: "31-irradiance-at-heights/above_top.ron", right: &sun },
        Case { scene: "31-irradiance-at-heights/near_isolated.ron", right: &isolated },
        Case { scene: "31-irradiance-at-heights/near_analog_sky.ron", right: &sun },
        Case { scene: "31-irradiance-at-heights/near_sky_only.ron", right: &sky },
        Case { scene: "31-irradiance-at-heights/at_top.ron", right: &at_top },
        Case { scene: "31-irradiance-at-heights/turbid.ron", right: &turbid },
    ]);
}

/// The BRF of bare ground is its reflectance whatever stands on it, by every sensor.
#[test]
fn what_stands_on_the_ground_hides_none_of_an_isolated_scene() {
    let ground = |sensor, product, index| Right::value(sensor, product, index, 0.3);
    let near = |sensor, product, index, within| Right::Value {
        sensor,
        product,
        index,
        value: 0.3,
        within,
    };
    // The pole's own light: 2 m² of 2500 m², seen and lit at most some times as well as the ground.
    let pole: Vec<Right> = (0..7).map(|view| near("d", "brf", view, 0.003)).collect();
    let pole = [pole, vec![near("ph", "albedo", 0, 0.003), near("o60", "brf", 0, 0.02)]].concat();
    let aloft: Vec<Right> = ["back", "forth"]
        .into_iter()
        .flat_map(|sensor| (0..3).map(move |view| (sensor, view)))
        .map(|(sensor, view)| near(sensor, "brf", view, 0.001))
        .collect();
    let aloft = [aloft, vec![near("photons", "albedo", 0, 0.001)]].concat();
    let low_sun = [
        ground("back", "brf", 0),
        ground("photons", "albedo", 0),
        ground("photons", "brf_views", 0),
        Right::Quiet,
    ];
    hold(&[
        Case { scene: "60-isolated-oblique/iso2.ron", right: &pole },
        Case { scene: "60-isolated-oblique/near_plate_aloft.ron", right: &aloft },
        Case { scene: "60-isolated-oblique/near_low_sun.ron", right: &low_sun },
        Case {
            scene: "60-isolated-oblique/near_crown_over_edge.ron",
            right: &[
                Right::WarnsInRun(&["scatters upwards", "beside the rectangle of its ground"]),
                Right::WarnsInRun(&["intercepts", "beside the rectangle of its ground"]),
            ],
        },
    ]);
}

/// Fluxes on the ground are given per m² of horizontal area and per m² of the inclined ground.
#[test]
fn fluxes_on_slopes_are_given_for_both_areas() {
    // cos i of a slope of 30° that faces away from a sun at 45° is cos 75°.
    let away = 75_f64.to_radians().cos();
    let cos = 30_f64.to_radians().cos();
    hold(&[
        Case {
            scene: "61-flux-on-slope/tilt.ron",
            right: &[
                Right::value("p", "downwelling_terrain", 0, 2.0_f64.sqrt()),
                Right::value("p", "downwelling_terrain_surface", 0, 1.0),
                Right::value("p", "upwelling_terrain_surface", 0, 0.3),
            ],
        },
        Case {
            scene: "61-flux-on-slope/near_away_30.ron",
            right: &[
                Right::value("p", "downwelling_terrain", 0, away / cos),
                Right::value("p", "downwelling_terrain_surface", 0, away),
            ],
        },
        Case {
            scene: "61-flux-on-slope/near_level.ron",
            right: &[Right::value("p", "downwelling_terrain", 0, 0.5)],
        },
    ]);
}

/// *Scene*: a slope of 6 m in 20 m, repeated, with the wall that this makes at the seam: from a raster, from a mesh
/// and from a mesh that has the wall. *Expected*: BRF and albedo of the cavity's cross-section by radiosity, 600
/// strips with form factors by crossed strings; with the sun over the wall, BRF of the partly shaded slope.
#[test]
fn a_slope_that_is_repeated_is_a_cavity_with_its_wall() {
    // Nadir, 30° towards the wall and 30° from behind it, each in two bands.
    let cavity = [
        Right::value("v", "brf", 0, 0.314_059),
        Right::value("v", "brf", 2, 0.331_475),
        Right::value("v", "brf", 4, 0.303_514),
        Right::value("alb", "albedo", 0, 0.321_594),
    ];
    // Alone, the slope is lit by the sun only: ρ cos i / cos θ.
    let tan = 40_f64.to_radians().tan();
    let alone = 0.4 * (1.0 - 0.3 * tan) / 1.09_f64.sqrt();
    hold(&[
        Case { scene: "32-dem-periodic/periodic.ron", right: &cavity },
        Case { scene: "32-dem-periodic/mesh_slope.ron", right: &cavity },
        Case { scene: "32-dem-periodic/mesh_wall.ron", right: &cavity },
        Case {
            scene: "32-dem-periodic/isolated.ron",
            right: &[Right::value("v", "brf", 0, alone)],
        },
        Case { scene: "32-dem-periodic/img.ron", right: &[Right::value("i", "brf", 0, 0.386_202)] },
        // Sides that meet need no wall.
        Case { scene: "32-dem-periodic/near_ridge.ron", right: &[Right::Quiet] },
    ]);
}

/// Means of images leave out what lies beside the scene, forward as backward.
#[test]
fn means_of_forward_images_leave_out_empty_pixels() {
    let half = |sensor| Right::value(sensor, "brf", 0, 0.5);
    hold(&[
        Case { scene: "63-forward-image-empty/forward_image_empty.ron", right: &[half("im")] },
        Case { scene: "63-forward-image-empty/near_nadir_forward.ron", right: &[half("im")] },
        Case {
            scene: "63-forward-image-empty/near_oblique.ron",
            right: &[half("back"), half("forth")],
        },
        Case {
            scene: "63-forward-image-empty/near_plane_of_periodic.ron",
            right: &[half("back"), half("forth")],
        },
    ]);
}
