//! Scenes that parse and were made to harm: each is refused with place and range, or measured rightly, in a
//! bounded time.

use sunfleck::run::Options;
use sunfleck::scratch::ScratchSpace;
use sunfleck_tests::field::{Case, Right, hold, hold_with};

const DARK: &str = "no light falls on the scene in band";
const HEIGHT: &str = "expected a height from -1e8 to 1e8 m";

/// The value of a product without noise, or within its own.
macro_rules! value {
    ($sensor:literal, $product:literal, $index:literal, $value:literal) => {
        Right::Value {
            sensor: $sensor,
            product: $product,
            index: $index,
            value: $value,
            within: 0.0,
        }
    };
}

/// A product that is 0 without noise.
macro_rules! zero {
    ($sensor:literal, $product:literal) => {
        value!($sensor, $product, 0, 0.0)
    };
}

#[test]
fn bands_without_light_measure_no_radiance() {
    hold(&[
        Case {
            scene: "70-hostile/irradiance_0_nan.ron",
            right: &[Right::Warns(&[DARK, "`nir`", "sun.irradiance"])],
        },
        Case {
            scene: "70-hostile/near_one_dark_band.ron",
            right: &[
                Right::Warns(&[DARK, "`red`"]),
                zero!("d", "radiance"),
                zero!("o", "radiance"),
                zero!("p", "exitance"),
                value!("d", "brf", 1, 0.2),
            ],
        },
        Case {
            scene: "70-hostile/near_dark_sky.ron",
            right: &[
                Right::Warns(&[DARK, "sky.irradiance"]),
                zero!("d", "radiance"),
                zero!("f", "radiance"),
                zero!("p", "exitance"),
                zero!("a", "exitance"),
            ],
        },
    ]);
}

#[test]
fn quantities_have_lawful_ranges() {
    hold(&[
        Case {
            scene: "70-hostile/irradiance_1e308_nan.ron",
            right: &[Right::Fails(&[
                "expected an irradiance or a radiance from 0 to 1e12",
                "found 1e308",
                "irradiance_1e308_nan.ron:11:",
            ])],
        },
        Case {
            scene: "70-hostile/near_samples_without_end.ron",
            right: &[Right::Fails(&["expected 1000000000000 samples or fewer", ":7:"])],
        },
        Case {
            scene: "70-hostile/near_name_of_many_lines.ron",
            right: &[Right::Fails(&["no material `soil`", "so\\n\\n", "characters) …"])],
        },
        Case {
            scene: "70-hostile/temperature_nan.ron",
            right: &[Right::Fails(&["expected a temperature from 0 to 10000 K, found 1e300"])],
        },
        Case {
            scene: "70-hostile/near_temperature_of_a_star.ron",
            right: &[Right::Fails(&["expected a temperature from 0 to 10000 K", "sunlit_k"])],
        },
        Case {
            scene: "70-hostile/near_absolute_zero.ron",
            right: &[zero!("d", "radiance"), zero!("p", "exitance")],
        },
        Case {
            scene: "70-hostile/deg_fishvfarDownPeriodic.ron",
            right: &[Right::Fails(&[HEIGHT, "sensors.f.position_m"])],
        },
        Case {
            scene: "70-hostile/near_target_1e20.ron",
            right: &[Right::Fails(&["from -1e8 to 1e8 m, found 1e20", "sensors.c.target_m"])],
        },
        Case {
            scene: "70-hostile/virtual_plane_1e300_wrong.ron",
            right: &[Right::Fails(&[HEIGHT, "sensors.p.virtual_plane.height_m"])],
        },
        Case {
            scene: "70-hostile/near_virtual_plane_1e20.ron",
            right: &[Right::Fails(&[HEIGHT, "sensors.o.virtual_plane.height_m"])],
        },
        Case {
            scene: "70-hostile/near_virtual_plane_10_km.ron",
            right: &[value!("p", "albedo", 0, 0.2)],
        },
        Case {
            scene: "70-hostile/deg_spm1e300.ron",
            right: &[Right::Fails(&["found 1e300", "sensors.n.samples_per_m2"])],
        },
        Case {
            scene: "70-hostile/near_samples_per_m2.ron",
            right: &[Right::Fails(&["make 4.00e9 samples in a pixel", "write at most 4.1"])],
        },
    ]);
}

#[test]
fn paths_without_roulette_end_where_nothing_is_absorbed() {
    hold(&[
        Case { scene: "70-hostile/deg_closedboxll__0.0.ron", right: &[zero!("f", "radiance")] },
        Case { scene: "70-hostile/deg_closedboxll__0.5.ron", right: &[zero!("f", "radiance")] },
        Case { scene: "70-hostile/deg_closedboxthermal.ron", right: &[zero!("f", "radiance")] },
        Case {
            scene: "70-hostile/near_white_room.ron",
            right: &[zero!("c", "radiance"), value!("p", "albedo", 0, 1.0)],
        },
        Case {
            scene: "70-hostile/near_white_room_analog.ron",
            right: &[value!("p", "albedo", 0, 1.0)],
        },
    ]);
}

#[test]
fn rays_cross_a_bounded_number_of_tiles() {
    hold(&[
        Case {
            scene: "70-hostile/check_hang_z1e30.ron",
            right: &[Right::Fails(&[HEIGHT, "instances[0].at_m[0][2]"])],
        },
        Case {
            scene: "70-hostile/height1e6_silent.ron",
            right: &[Right::Fails(&["125000 times as high as its tile", "instances[0].at_m[0]"])],
        },
        Case {
            scene: "70-hostile/near_high_stand.ron",
            right: &[Right::Fails(&["row 3 of `near_stand.csv`", "times as high as its tile"])],
        },
        Case {
            scene: "70-hostile/near_high_isolated_stand.ron",
            right: &[value!("d", "brf", 0, 0.2)],
        },
        Case {
            scene: "70-hostile/face_1e9_slow.ron",
            right: &[Right::Fails(&["found 1e9", "meshes.sheet.faces_m[1][2]"])],
        },
        Case {
            scene: "70-hostile/low_sun_hang.ron",
            right: &[Right::Fails(&["sun.zenith_deg", "write at most 89.999999"])],
        },
        Case {
            scene: "70-hostile/near_low_sun.ron",
            right: &[Right::Fails(&["tiles of 8 x 8 m", "sun.zenith_deg", "write a zenith angle"])],
        },
        Case {
            scene: "70-hostile/near_low_view.ron",
            right: &[Right::Fails(&["tiles of 8 x 8 m", "sensors.p.measure[0][1][0]"])],
        },
        Case {
            scene: "70-hostile/near_low_sun_over_bare_ground.ron",
            right: &[
                value!("d", "brf", 0, 0.2),
                value!("d", "brf", 1, 0.2),
                value!("p", "albedo", 0, 0.2),
            ],
        },
    ]);
}

#[test]
fn what_a_scene_makes_of_memory_is_counted_before() {
    hold(&[
        Case {
            scene: "70-hostile/periodic_images_memory.ron",
            right: &[Right::Fails(&["625050001 tiles of 8 x 8 m", "instances[0].at_m[0]"])],
        },
        Case {
            scene: "70-hostile/near_sheet_of_20_km.ron",
            right: &[Right::Fails(&[
                "tiles of 8 x 8 m",
                "at most 2000 are allowed",
                "instances[0].at_m[0]",
            ])],
        },
        Case {
            scene: "70-hostile/near_stems_1e12.ron",
            right: &[Right::Fails(&["stems", "instances[0]"])],
        },
        Case {
            scene: "70-hostile/deg_million.ron",
            right: &[Right::Fails(&["2000 instances of `m` stand in one place", "instances[0]"])],
        },
        Case {
            scene: "70-hostile/near_alike.ron",
            right: &[Right::Warns(&["1 instance stands exactly where another one", "(4, 4, 0)"])],
        },
    ]);
    let little = Options { memory: Some(1 << 28), ..Options::default() };
    hold_with(
        &[
            Case {
                scene: "70-hostile/fluxes_16GiB_ulimit.ron",
                right: &[Right::Fails(&["256.0 MiB are free", "sensors.n.measure[0]", "pixel_m"])],
            },
            Case {
                scene: "70-hostile/near_layers_1e-9.ron",
                right: &[Right::Fails(&["256.0 MiB are free", "layer_m"])],
            },
        ],
        &little,
    );
    // Sums of images that take much memory are kept on a disk.
    let scratch = ScratchSpace { disk: Some(1 << 30), ..ScratchSpace::default() };
    hold_with(
        &[Case {
            scene: "70-hostile/near_image_of_65536.ron",
            right: &[Right::Fails(&["of temporary files, and 1.0 GiB are free", "sensors.o"])],
        }],
        &Options { scratch, ..little },
    );
}
