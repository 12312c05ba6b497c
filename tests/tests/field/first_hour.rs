//! Mistakes of a first hour that gave numbers without a word: units, columns, coordinates.

use sunfleck::run::{Options, check_file};
use sunfleck_tests::field::Right::{Fails, Quiet, Warns};
use sunfleck_tests::field::{Case, Right, folder, hold};

const fn case<'a>(scene: &'static str, right: &'a [Right]) -> Case<'a> {
    Case { scene, right }
}

/// Cameras far from the ground, or beside it with nothing to look at; satellites and cameras that look at the
/// scene from its side are as they are meant.
#[test]
fn cameras_beside_the_ground() {
    hold(&[
        case(
            "71-first-hour/camera_on_map.ron",
            &[Fails(&[
                "sensors.f.position_m",
                "m beside the ground",
                "position_m: (10.0, 10.0, 1.3)",
            ])],
        ),
        case(
            "71-first-hour/camera_on_map_periodic.ron",
            &[Fails(&["sensors.p.position_m", "position_m: (10.0, 10.0, 30.0)"])],
        ),
        case(
            "71-first-hour/fisheye_beside.ron",
            &[Warns(&["80 m beside the ground", "from (0, 0) to (20, 20) m"])],
        ),
        case(
            "71-first-hour/fisheye_beside_above_ground.ron",
            &[Fails(&["80 m beside the ground", "height above the ground has no meaning"])],
        ),
        case("71-first-hour/camera_from_the_side.ron", &[Quiet]),
        case("71-first-hour/satellite.ron", &[Quiet]),
    ]);
}

#[test]
fn spectra_of_other_columns_and_units() {
    hold(&[
        case(
            "71-first-hour/columns_of_leaf.ron",
            &[Warns(&["materials.leaf.transmittance", "\"Mean R\"", "\"Mean T\"", "value:"])],
        ),
        case("71-first-hour/column_named.ron", &[Quiet]),
        case("71-first-hour/column_beside_its_spread.ron", &[Quiet]),
        case(
            "71-first-hour/fractions_as_percent.ron",
            &[Warns(&["spread.csv:14", "2.000e-3", "leave `scale` out"])],
        ),
        case(
            "71-first-hour/gap_in_spectrum.ron",
            &[Warns(&["no value between 600 and 800 nm", "band `red`"])],
        ),
        case(
            "71-first-hour/broad_band.ron",
            &[Warns(&["band `all` is 600 nm wide", "from 0.050 to 0.450"])],
        ),
        case(
            "71-first-hour/two_leaves.ron",
            &[Warns(&["materials.leaf.transmittance", "two different leaves"])],
        ),
        case("71-first-hour/one_leaf.ron", &[Quiet]),
    ]);
}

#[test]
fn degrees_celsius_radians_and_centimetres() {
    hold(&[
        case(
            "71-first-hour/cosine_of_degrees.ron",
            &[Warns(&["`cos` takes radians, and 50", "cos(radians(..))"])],
        ),
        case("71-first-hour/cosine_of_radians.ron", &[Quiet]),
        case("71-first-hour/celsius.ron", &[Warns(&["27 °C is 300.15 K"])]),
        case("71-first-hour/celsius_sky.ron", &[Warns(&["thermal_sky", "10 °C is 283.15 K"])]),
        case("71-first-hour/irradiance_of_1000.ron", &[Warns(&["sun.irradiance", "at most 2.2"])]),
        case(
            "71-first-hour/trunk_in_centimetres.ron",
            &[Warns(&["meshes.tree.trunk.diameter_m", "20 m thick and 8 m high"])],
        ),
        case("71-first-hour/heights_in_centimetres.ron", &[Warns(&["up to 1600 m high"])]),
        case(
            "71-first-hour/unit_of_a_mesh_in_metres.ron",
            &[Warns(&["0.120 m large", "`unit_m: 1.0`"])],
        ),
        case(
            "71-first-hour/stems_in_degrees.ron",
            &[Warns(&["all 12 rows stand within 0.0003 m", "longitudes and latitudes"])],
        ),
    ]);
}

/// A plate in the plane of the ground may be meant to be hidden: a note says that it may not be seen.
#[test]
fn surfaces_that_lie_in_others() {
    let told =
        check_file(&folder().join("71-first-hour/flat_in_the_ground.ron"), &Options::default());
    let told = told.expect("the scene is sound");
    let note = "note: 1 of `plate` are flat and lie exactly in the ground";
    assert!(told.iter().any(|text| text.starts_with(note)), "{told:?}");
    hold(&[
        case("71-first-hour/flat_in_the_ground.ron", &[Quiet]),
        case("71-first-hour/flat_above_the_ground.ron", &[Quiet]),
        case(
            "71-first-hour/ground_of_a_micrometre.ron",
            &[Fails(&["the ground is 8.0 m x 1e-6 m", "at least 0.001 m"])],
        ),
    ]);
}
