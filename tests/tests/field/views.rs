//! Cameras, pictures and leaf area indices.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use sunfleck::output;
use sunfleck::run::{Options, Unwatched, run_file};
use sunfleck_tests::field::{Case, Right, folder, hold, hold_with};

/// *Scene*: a fisheye below a layer of LAI 2 of leaves of three angle distributions. *Expected*: 2 within what
/// leaves of one draw deviate by, and the method: a line beyond 75° and `G = 0.5` at 57.5°.
#[test]
fn leaf_area_indices_of_fisheyes() {
    const fn lai(sensor: &'static str, product: &'static str, within: f64) -> Right {
        Right::Value { sensor, product, index: 0, value: 2.0, within }
    }
    const SPHERICAL: &[Right] = &[
        lai("f", "lai_beer", 0.03),
        lai("f", "lai_miller", 0.03),
        lai("f", "lai_2000", 0.03),
        lai("f2", "lai_miller", 0.03),
    ];
    const OTHERS: &[Right] = &[lai("f", "lai_beer", 0.1), lai("f", "lai_miller", 0.1)];
    // Leaves of one draw deviate by more than the noise of fewer samples.
    let options = Options { quality: 0.2, ..Options::default() };
    let cases = [
        Case { scene: "33-fisheye-lai/spherical.ron", right: SPHERICAL },
        Case { scene: "33-fisheye-lai/planophile.ron", right: OTHERS },
        Case { scene: "33-fisheye-lai/erectophile.ron", right: OTHERS },
    ];
    hold_with(&cases, &options);
}

/// *Scene*: sensors whose heights were meant above a ground that is 300 m high. *Expected*: a warning or an
/// error with the height of the ground; none where heights are right.
#[test]
fn sensors_below_the_ground() {
    hold(&[
        Case {
            scene: "41-camera-under-ground/fish.ron",
            right: &[Right::Warns(&[
                "sensors.p.position_m",
                "299.5 m below the ground",
                "301 m high at (10, 10)",
                "above_ground: true",
            ])],
        },
        Case {
            scene: "41-camera-under-ground/persp_z10.ron",
            right: &[Right::Warns(&["290 m below the lowest ground", "above_ground: true"])],
        },
        Case {
            scene: "41-camera-under-ground/persp_inside.ron",
            right: &[Right::Warns(&["251 m below the ground", "above_ground: true"])],
        },
        Case {
            scene: "41-camera-under-ground/in_trunk.ron",
            right: &[Right::Warns(&["sensors.f.position_m", "inside a body"])],
        },
        Case {
            scene: "41-camera-under-ground/vplane_low.ron",
            right: &[Right::Fails(&["nothing leaves through a plane at 5 m", "300"])],
        },
        Case {
            scene: "41-camera-under-ground/flux_below.ron",
            right: &[Right::Warns(&["heights_m[0]", "10 m lies below the ground", "300"])],
        },
        Case {
            scene: "41-camera-under-ground/fapar_layers.ron",
            right: &[Right::Warns(&["all layers lie below the ground", "local frame"])],
        },
        Case {
            scene: "41-camera-under-ground/fish_above.ron",
            right: &[Right::Value {
                sensor: "p",
                product: "gap_fraction",
                index: 0,
                value: 1.0,
                within: 0.03,
            }],
        },
        Case {
            scene: "41-camera-under-ground/list_z0.ron",
            right: &[Right::Warns(&["sunken into the ground", "301.00 m high"])],
        },
        Case {
            scene: "41-camera-under-ground/outside.ron",
            right: &[Right::Warns(&["stand beside the ground"])],
        },
        Case {
            scene: "41-camera-under-ground/persp_upside.ron",
            right: &[Right::Fails(&["lies along the view", "up: (0.0, 1.0, 0.0)"])],
        },
        Case {
            scene: "41-camera-under-ground/persp_up_parallel.ron",
            right: &[Right::Fails(&["lies along the view"])],
        },
    ]);
}

/// *Scene*: neighbours of these: in another tile, with the wrong sign, above sea level, partly below. *Expected*:
/// a warning or an error each.
#[test]
fn neighbours_of_sensors_below_the_ground() {
    hold(&[
        Case {
            scene: "41-camera-under-ground/near_fish_next_tile.ron",
            right: &[Right::Warns(&["299 m below the ground", "301 m high at (-10, 50)"])],
        },
        Case {
            scene: "41-camera-under-ground/near_fish_sunk.ron",
            right: &[Right::Fails(&["the camera is not above the ground", "above the ground"])],
        },
        Case {
            scene: "41-camera-under-ground/near_above_sea_level.ron",
            right: &[Right::Warns(&["302.5 m above the ground", "leave `above_ground` out"])],
        },
        Case {
            scene: "41-camera-under-ground/near_target_deep.ron",
            right: &[Right::Warns(&["sensors.p.target_m", "301 m below the ground"])],
        },
        Case {
            scene: "41-camera-under-ground/near_plane_cuts.ron",
            right: &[Right::Warns(&["50.0 % of the plane at 301 m lie below the ground"])],
        },
        Case {
            scene: "41-camera-under-ground/near_ortho_plane_low.ron",
            right: &[Right::Fails(&["nothing leaves through a plane at 299 m"])],
        },
        Case {
            scene: "41-camera-under-ground/near_flux_cuts.ron",
            right: &[Right::Warns(&["50.0 % of the level at 301 m", "count as 0"])],
        },
        Case {
            scene: "41-camera-under-ground/near_layers_some.ron",
            right: &[Right::Warns(&["1 of 3 layers lies below the ground"])],
        },
        Case {
            scene: "41-camera-under-ground/near_layers_high.ron",
            right: &[Right::Warns(&["all layers lie above the highest point of the scene, 0 m"])],
        },
        Case {
            scene: "41-camera-under-ground/near_in_rock.ron",
            right: &[Right::Warns(&["inside a body", "1.0"])],
        },
        Case { scene: "41-camera-under-ground/near_beside_rock.ron", right: &[Right::Quiet] },
    ]);
}

/// Red, green, blue and opacity of the pixels of a picture without a legend.
fn pixels(folder: &Path, name: &str) -> Vec<[u8; 4]> {
    let file = File::open(folder.join(format!("{name}.pixels.png"))).expect("a picture");
    let mut reader = png::Decoder::new(BufReader::new(file)).read_info().expect("PNG");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
    reader.next_frame(&mut bytes).expect("pixels");
    bytes.as_chunks::<4>().0.to_vec()
}

/// *Scene*: images of several bands, one of them without light. *Expected*: pictures of the others, opaque and
/// neither black nor white.
#[test]
fn pictures_with_a_dark_band() {
    for (scene, names) in [
        ("t2.ron", &["img_brf", "img_radiance"][..]),
        ("near_three_bands.ron", &["img_brf"]),
        ("near_chosen_bands.ron", &["fixed_brf", "free_brf"]),
    ] {
        let path = folder().join("62-blank-picture").join(scene);
        let report = run_file(&path, &Options::default(), &Unwatched).expect("a report");
        let out = tempfile::tempdir().expect("a folder");
        output::write(&report, out.path()).expect("files");
        for name in names {
            let pixels = pixels(out.path(), name);
            let is_shown = |[r, g, b, opacity]: &[u8; 4]| {
                *opacity == 255 && (1..255).contains(r.max(g).max(b))
            };
            assert!(pixels.iter().all(is_shown), "{scene}: {name}: {:?}", pixels[0]);
            assert!(out.path().join(format!("{name}.png")).is_file(), "{scene}: {name}");
        }
    }
}
