//! Tables of stems, coordinates, the sun by place and time, paths.

use sunfleck::document::{self, read_file};
use sunfleck::run::{Options, Unwatched, run_file};
use sunfleck_tests::field::Right::{Fails, Quiet, Value, Warns};
use sunfleck_tests::field::{Case, Right, folder, hold};

const fn case<'a>(scene: &'static str, right: &'a [Right]) -> Case<'a> {
    Case { scene, right }
}

/// Light that an instance absorbs, W nm⁻¹: entry 0 is the terrain, the instances follow.
const fn absorbed(index: usize, value: f64) -> Right {
    Value { sensor: "alb", product: "absorbed_by_instance", index, value, within: 1e-6 * value }
}

#[test]
fn tables_of_stems_are_read_as_inventories_write_them() {
    hold(&[
        case("40-stand-table/blank_end.ron", &[Quiet]),
        case("40-stand-table/columns_key.ron", &[Quiet]),
        case("40-stand-table/columns_key_header.ron", &[Quiet]),
        case("40-stand-table/quoted.ron", &[Quiet]),
        case("40-stand-table/rindex.ron", &[Quiet]),
        case("40-stand-table/semicolon.ron", &[Quiet]),
        case("40-stand-table/tab_comma.ron", &[Quiet]),
        case("40-stand-table/utm_frame.ron", &[Quiet]),
        // A flat mesh, and a column of heights.
        case("40-stand-table/extra_columns.ron", &[Warns(&["`height_m`", "cannot scale it"])]),
        case("40-stand-table/plain_names.ron", &[Fails(&["\"X\"", "columns"])]),
        case("40-stand-table/na.ron", &[Fails(&["na.csv:2", "\"NA\""])]),
        case("40-stand-table/comma_decimals.ron", &[Fails(&["comma_decimals.csv:2", "`;`"])]),
        case("40-stand-table/quoted_comma.ron", &[Fails(&["quoted_comma.csv:2", "`10.5`"])]),
        case("40-stand-table/thousands.ron", &[Fails(&["thousands.csv:2", "`1010.5`"])]),
        case("40-stand-table/utm_no_frame.ron", &[Fails(&["2 instances", "origin_m: ("])]),
    ]);
}

#[test]
fn inventories_choose_and_scale_meshes() {
    hold(&[
        // The plate is scaled from 2 x 2 m to 4 x 4 m; the pole catches no light from above.
        case(
            "40-stand-table/near_inventory.ron",
            &[absorbed(1, 16.0), absorbed(2, 0.0), absorbed(0, 0.8 * (1e4 - 16.0)), Quiet],
        ),
        case(
            "40-stand-table/near_unknown_species.ron",
            &[Fails(&["near_inventory.csv:3", "`pole`", "did you mean `poles`"])],
        ),
        case(
            "40-stand-table/near_stem_diameter.ron",
            &[Fails(&["near_stem_diameter.csv:2", "0.3 m", "crown_diameter_m"])],
        ),
        case("40-stand-table/near_far_periodic.ron", &[Fails(&["2 instances", "origin_m: ("])]),
        case(
            "40-stand-table/near_either.ron",
            &[Fails(&["coordinates: Local", "coordinates: Map"])],
        ),
        case("40-stand-table/near_either_said.ron", &[absorbed(1, 4.0), Quiet]),
        case(
            "40-stand-table/near_thousands_or_decimals.ron",
            &[Fails(&["near_thousands_or_decimals.csv:2", "`12.125`", "`12125`"])],
        ),
        case("40-stand-table/near_height_without_unit.ron", &[Warns(&["`Height`", "`height_m`"])]),
    ]);
}

#[test]
fn instances_of_a_map_stand_on_the_terrain() {
    let path = folder().join("40-stand-table/near_inventory.ron");
    let report = run_file(&path, &Options::default(), &Unwatched).expect("a report");
    let places = format!("{:?}", report.sensors[0].products[0].dimensions);
    for part in ["10.5", "50.25"] {
        assert!(places.contains(part), "{places}");
    }
    let has_note = |part: &str| report.notes.iter().any(|note| note.contains(part));
    assert!(has_note("coordinates are those of the map"), "{:?}", report.notes);
    assert!(has_note("`tree_id`, `X_utm`, `Art`, `dbh_cm`"), "{:?}", report.notes);
}

/// Values of pvlib 0.13 (`nrel_numpy`).
#[test]
fn the_sun_stands_where_pvlib_has_it() {
    for (name, zenith, azimuth) in [
        ("t0", 45.2615, 90.5068),
        ("t1", 59.7991, 340.9131),
        ("t2", 29.3500, 190.2322),
        ("t3", 80.5334, 90.1337),
        ("t4", 58.6805, 238.7567),
        ("t6", 7.2945, 133.7169),
        ("t7", 78.0250, 11.8204),
    ] {
        let path = folder().join(format!("34-sun-position/{name}.ron"));
        let reading = read_file(&path, &document::ReadOptions::default()).expect("a scene");
        let sun = reading.scene.sun.as_ref().and_then(document::Sun::angles_deg).expect("a sun");
        assert!((sun.0 - zenith).abs() < 2e-4 && (sun.1 - azimuth).abs() < 2e-4, "{name}: {sun:?}");
    }
    hold(&[
        case("34-sun-position/t5.ron", &[Fails(&["38.92° below the horizon"])]),
        case("34-sun-position/near_no_such_day.ron", &[Fails(&["near_no_such_day.ron", "date"])]),
        case("34-sun-position/near_offset.ron", &[Fails(&["from -18 to 18, found 25"])]),
    ]);
}

/// A scene at coordinates of a map is the same as at the origin, bit for bit.
#[test]
fn results_do_not_depend_on_where_the_scene_lies() {
    let options = Options { quality: 0.02, ..Options::default() };
    let values = |name: &str| -> Vec<u64> {
        let path = folder().join(format!("27-utm-coordinates/{name}.ron"));
        let report = run_file(&path, &options, &Unwatched).expect("a report");
        let products = report.sensors.iter().flat_map(|sensor| &sensor.products);
        products.flat_map(|product| product.values.iter().map(|value| value.to_bits())).collect()
    };
    for (moved, kept) in [
        ("utm", "zero"),
        ("utm_frac", "zero"),
        ("utm_origin", "zero"),
        ("cam_utm", "cam_zero"),
        ("near_west", "zero"),
        ("near_range", "zero"),
    ] {
        assert_eq!(values(moved), values(kept), "{moved}");
    }
}

#[test]
fn paths_and_encodings_are_read_or_refused_clearly() {
    let half = Value { sensor: "i", product: "brf", index: 0, value: 0.5, within: 1e-6 };
    for scene in [
        "38-paths/bom.ron",
        "38-paths/cr.ron",
        "38-paths/crlf.ron",
        "38-paths/nbsp.ron",
        "38-paths/set.ron",
        "38-paths/set2.ron",
    ] {
        hold(&[case(scene, &[half, Quiet])]);
    }
    hold(&[
        case("38-paths/space.ron", &[Warns(&["float above the ground"])]),
        case("38-paths/backslash.ron", &[Fails(&["no file", "write `/`"])]),
        case("38-paths/windows.ron", &[Fails(&["no file", "write `/`"])]),
        case("38-paths/case.ron", &[Fails(&["no file", "My Träes/Birch (1) 树.obj"])]),
        case("38-paths/missing.ron", &[Fails(&["no file", "my traes/birch.obj"])]),
        case("38-paths/tilde.ron", &[Fails(&["no file", "~/birch.obj", "in full"])]),
        case("38-paths/dir.ron", &[Fails(&["is a folder"])]),
        case("38-paths/dup.ron", &[Fails(&["the key `i` is given twice"])]),
        case("38-paths/huge.ron", &[Fails(&["200000 x 200000 pixels"])]),
        case("38-paths/huge2.ron", &[Fails(&["65000 x 65000 pixels"])]),
        case("38-paths/latin1.ron", &[Fails(&["from line 2 on, not UTF-8 text"])]),
        case("38-paths/utf16.ron", &[Fails(&["UTF-16 text"])]),
        case("38-paths/smart.ron", &[Fails(&["unexpected character `“`"])]),
        case("38-paths/near ö (copy).ron", &[Quiet]),
        case("38-paths/near_missing.ron", &[Fails(&["no file", "near boden.csv"])]),
    ]);
}
