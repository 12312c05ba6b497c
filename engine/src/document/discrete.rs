//! Values of scenes that are no real numbers: they have no derivatives.

use super::encode::Encode as _;
use super::path::{ScenePath, Step};
use super::ron_text::{Group, Item, Text};
use super::scene::Scene;

/// Path of the first value in which two scenes differ by more than real numbers: in a whole number, a name, or keys and
/// lists that one of them does not have.
#[must_use]
pub fn discrete_difference(a: &Scene, b: &Scene) -> Option<ScenePath> {
    let mut path = ScenePath::root();
    let [a, b] = [a, b].map(|scene| scene.resolved().encode());
    (!is_alike(&a, &b, &mut path)).then_some(path)
}

/// Returns whether two texts differ in real numbers alone; otherwise the path leads to where they differ.
fn is_alike(a: &Text, b: &Text, path: &mut ScenePath) -> bool {
    match (a, b) {
        (Text::Leaf(a), Text::Leaf(b)) => a == b || without_numbers(a) == without_numbers(b),
        (Text::Group(a), Text::Group(b)) => a.open == b.open && are_items_alike(a, b, path),
        (Text::Leaf(_), Text::Group(_)) | (Text::Group(_), Text::Leaf(_)) => false,
    }
}

fn are_items_alike(a: &Group, b: &Group, path: &mut ScenePath) -> bool {
    // A key whose value is its default is not written.
    let is_default = |item: &Item, others: &Group| {
        item.step.is_some()
            && is_real(&item.text)
            && others.items.iter().all(|other| other.step != item.step)
    };
    let of_a = a.items.iter().filter(|item| !is_default(item, b));
    let of_b = b.items.iter().filter(|item| !is_default(item, a));
    let ([of_a, of_b], mut places) = ([of_a.collect::<Vec<_>>(), of_b.collect()], 0..);
    if of_a.len() != of_b.len() {
        return false;
    }
    of_a.iter().zip(of_b).all(|(a, b)| {
        let place = places.next().unwrap_or(0);
        if a.step != b.step {
            return false;
        }
        path.push(a.step.clone().unwrap_or(Step::Index(place)));
        let is_alike = is_alike(&a.text, &b.text, path);
        if is_alike {
            path.pop();
        }
        is_alike
    })
}

fn is_real(text: &Text) -> bool {
    matches!(text, Text::Leaf(leaf) if without_numbers(leaf) == "#")
}

/// The text of a leaf, such as `Constant(0.3)`, with `#` in place of its real number.
fn without_numbers(leaf: &str) -> String {
    if leaf.starts_with('"') {
        return leaf.to_owned();
    }
    let is_of_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | 'e' | '-' | '+');
    let start = leaf.rfind('(').map_or(0, |open| open + 1);
    let end = leaf[start..].find(')').map_or(leaf.len(), |close| start + close);
    let number = &leaf[start..end];
    let is_real = number.contains(['.', 'e']) && number.chars().all(is_of_number);
    if is_real { format!("{}#{}", &leaf[..start], &leaf[end..]) } else { leaf.to_owned() }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests {
    use super::super::{Param, ReadOptions, read_text};
    use super::*;

    fn scene(name: &str, value: f64) -> Scene {
        let text = r#"Scene(
            format: 1,
            params: { "rho": 0.3, "n": 4.0, "disc": 0.5, "size": 5.0 },
            bands: [(name: "red", center_nm: 660.0)],
            materials: { "soil": Lambertian(reflectance: Constant("=rho")) },
            terrain: Plane(size_m: ("=size", 10.0), material: "soil"),
            sun: (zenith_deg: 30.0, azimuth_deg: 0.0, irradiance: Bands(["=rho"]), disc_deg: "=disc"),
            sensors: { "p": Photons(per_m2: "=size", measure: [BrfCells("=n")]) },
        )"#;
        let options = ReadOptions {
            point: vec![(name.to_owned(), Param::Number(value))],
            ..ReadOptions::default()
        };
        let reading = read_text("a.ron", text, &options).unwrap();
        assert!(reading.is_sound(), "{}", reading.render());
        reading.scene
    }

    #[test]
    fn scenes_may_differ_in_real_numbers_alone() {
        let difference = |name: &str, low: f64, high: f64| {
            discrete_difference(&scene(name, low), &scene(name, high)).map(|path| path.to_string())
        };
        assert_eq!(difference("rho", 0.25, 1.0), None);
        assert_eq!(difference("size", 5.0, 1e-7), None);
        // The default, which is not written.
        assert_eq!(difference("disc", 0.0, 0.5), None);
        assert_eq!(difference("n", 4.0, 5.0).as_deref(), Some("sensors.p.measure[0]"));
    }
}
