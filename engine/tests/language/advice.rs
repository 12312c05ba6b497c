//! Advice is worth following: what a diagnostic tells to write is right.

use std::collections::BTreeMap;

use sunfleck::document::{Diagnostic, ReadOptions, Reading, read_text};

/// Every variant of the language, empty.
const EMPTY: &str = "Scene(
    frame: (),
    bands: [()],
    spectra: { \"a\": Constant, \"b\": Bands, \"c\": Points, \"d\": Table, \"e\": Named, \"f\": Prospect },
    materials: {
        \"leaf\": Leaf(temperature: MeanDelta), \"soil\": Lambertian(temperature: SunlitShaded),
        \"bark\": Lambertian(temperature: Uniform),
    },
    meshes: {
        \"a\": Obj, \"b\": Gltf, \"c\": Discs, \"d\": Crown, \"i\": Faces,
        \"e\": Crown(shape: Cone, leaf: Square, trunk: (), branches: ()),
        \"f\": Crown(shape: Cylinder, leaf: Rhombus),
        \"g\": Crown(shape: Box, leaf: Disc),
        \"h\": Crown(shape: Ellipsoid, leaf: Disc),
    },
    terrain: Plane,
    instances: [Table, List],
    sun: (position: Spa),
    sky: Isotropic,
    thermal_sky: Radiance,
    sensors: {
        \"a\": Orthographic(size_px: (8, 8), cover: WholeScene, picture: Bands), \"b\": Directions,
        \"c\": Directions(views: CrossPlane, until: RelError),
        \"d\": Directions(views: List, until: Seconds),
        \"e\": Directions(views: List, until: Samples),
        \"g\": Perspective, \"h\": Fisheye, \"i\": Fisheye(look: Towards), \"j\": Fisheye(look: Target),
        \"f\": Photons(measure: [BrfCells, BrfViews, BrfCones, Albedo, Orders, Absorbed, Fapar, Fluxes]),
    },
    transport: (roulette: ()),
    variants: { \"winter\": {} },
)";

fn read(text: &str) -> Reading {
    read_text("scene.ron", text, &ReadOptions::default())
        .unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// What stands between backquotes behind `write, for example,`.
fn advised(diagnostic: &Diagnostic) -> Option<String> {
    let help = diagnostic.help.as_ref()?.strip_prefix("write, for example, `")?;
    Some(help.strip_suffix('`')?.to_owned())
}

/// The text with all advice about missing keys and values followed.
fn followed(text: &str) -> String {
    let reading = read(text);
    let mut keys = BTreeMap::<_, Vec<String>>::new();
    let mut values = BTreeMap::new();
    for one in &reading.diagnostics {
        let (Some(place), Some(advised)) = (&one.place, advised(one)) else { continue };
        let (start, end) = (place.span.start as usize, place.span.end as usize);
        if one.message.contains("lacks the key") {
            keys.entry((start, end)).or_default().push(advised);
        } else if one.message.contains("takes one value") {
            values.insert((start, end), advised);
        }
    }
    let keys = keys.into_iter().map(|((start, end), keys)| {
        let own = &text[start..end];
        let keys = keys.join(", ");
        let has_parentheses = own == "(" || text[end..].starts_with('(');
        let end = if own == "(" { end } else { end + usize::from(has_parentheses) };
        let more = if text[end..].starts_with(')') || !has_parentheses { "" } else { ", " };
        let keys = if has_parentheses { keys + more } else { format!("({keys})") };
        (end..end, keys)
    });
    let values = values.into_iter().map(|((start, end), value)| (start..end, value));
    let mut edits: Vec<_> = keys.chain(values).collect();
    edits.sort_by_key(|(range, _)| range.start);
    let mut text = text.to_owned();
    for (range, with) in edits.into_iter().rev() {
        text.replace_range(range, &with);
    }
    text
}

#[test]
fn whoever_writes_what_the_errors_tell_gets_a_scene() {
    let lacks = read(EMPTY).diagnostics.len();
    assert!(lacks > 60, "{lacks}");
    let text = followed(EMPTY);
    let found = read(&text);
    // What is left are names that the examples take for granted, and files' materials.
    for one in &found.diagnostics {
        let is_name = one.message.starts_with("no ") || one.message.contains("material");
        assert!(is_name || one.message.contains("has 2 values"), "{}\n{text}", found.render());
    }
}
