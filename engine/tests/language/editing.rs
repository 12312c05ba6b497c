//! Changes of a text by a program: comments, order and layout stay.

use proptest::prelude::*;
use sunfleck::document::{format, with_values_of};

use crate::writing::{read_back, scene};

const STAND: &str = r#"// A stand.
Scene(
    format: 1,
    // Two bands.
    bands: [
        (name: "red", center_nm: 660.0), // chlorophyll
        (name: "nir", center_nm: 865.0),
    ],
    materials: { "soil": Lambertian(reflectance: Constant(0.2)) },
    terrain: Plane(size_m: (10.0, 10.0), material: "soil"), // flat
    // At noon.
    sun: (zenith_deg: 30.0), // from the south
    sensors: {
        // From above.
        "nadir": Directions(views: List([(0.0, 0.0)])),
        "all": Photons, // the balance
    },
)
"#;

fn edited(text: &str, new: &str) -> String {
    with_values_of("stand.ron", text, new).unwrap_or_else(|error| panic!("{error}\n{new}"))
}

/// The stand after changes of its text that a program may have made.
fn changed(changes: &[(&str, &str)]) -> String {
    let mut new = STAND.to_owned();
    for (from, to) in changes {
        assert!(new.contains(from), "{from}");
        new = new.replace(from, to);
    }
    // A program has no comments.
    let new = read_back(&new).to_ron_line();
    edited(STAND, &new)
}

#[test]
fn a_value_changes_in_its_place() {
    let expected = STAND.replace("30.0", "42.5");
    assert_eq!(changed(&[("30.0", "42.5")]), expected);
    assert_eq!(changed(&[]), STAND);
}

#[test]
fn keys_and_items_come_and_go_with_their_comments() {
    insta::assert_snapshot!(changed(&[
        ("        (name: \"red\", center_nm: 660.0), // chlorophyll\n", ""),
        ("    // At noon.\n    sun: (zenith_deg: 30.0), // from the south\n", ""),
        ("(name: \"nir\", center_nm: 865.0)", "(name: \"nir\", center_nm: 865.0, width_nm: 5.0)"),
        ("{ \"soil\"", "{ \"leaf\": Lambertian(reflectance: Constant(0.1)), \"soil\""),
        ("\"all\": Photons,", "\"all\": Photons(per_m2: 3.0), \"more\": Photons,"),
        ("sensors: {", "boundary: Periodic, sensors: {"),
    ]));
}

/// *Expected*: a text that its author laid out by hand keeps that layout.
#[test]
fn a_text_in_no_normal_form_is_not_laid_out_anew() {
    let text = "Scene( format:1,\n  bands: [(name: \"red\",  center_nm: 660.0) /* red */, (name: \"nir\", center_nm: 865.0) ],\n  sun: (zenith_deg: 30.0)\n  /* end */ )";
    let new = "Scene(format: 1, bands: [(name: \"red\", center_nm: 661.0)], sun: (azimuth_deg: 5.0), title: \"T\")";
    let expected = "Scene( format:1,\n  bands: [(name: \"red\",  center_nm: 661.0) /* red */, ],\n  sun: (azimuth_deg: 5.0), title: \"T\"\n  /* end */ )";
    assert_eq!(edited(text, new), expected);
}

#[test]
fn every_example_changes_by_one_line() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).expect("scenes") {
        let path = entry.expect("a file").path();
        if path.extension().is_none_or(|extension| extension != "ron") {
            continue;
        }
        let text = std::fs::read_to_string(&path).expect("a text");
        let Some(line) = text.lines().find(|line| line.trim_start().starts_with("title: \""))
        else {
            continue;
        };
        let new = text.replace(line, "    title: \"Another\",");
        let new: String = new.lines().map(|line| line.split("//").next().unwrap_or("")).collect();
        let expected = text.replace(line, "    title: \"Another\",");
        assert_eq!(edited(&text, &new), expected, "{}", path.display());
        count += 1;
    }
    assert!(count >= 5, "{count} scenes");
}

proptest! {
    #[test]
    fn whatever_is_edited_has_the_new_values(old in scene(), new in scene()) {
        for old in [old.to_ron(), old.to_ron_line()] {
            let text = edited(&old, &new.to_ron_line());
            prop_assert_eq!(&read_back(&text), &new, "{}", text);
            // A text in its normal form stays in it.
            let normal = format("a.ron", &text);
            prop_assert!(normal.is_ok_and(|normal| normal == text || old.lines().count() < 2));
        }
    }
}
