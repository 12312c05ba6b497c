//! Places of a scene whose value is a parameter.

use super::parsed::ParsedScene;
use super::path::{ScenePath, Step};
use super::ron_text::{Node, Value};

impl ParsedScene {
    /// Paths to all values that are a parameter as it is, such as `sun.zenith_deg` of `zenith_deg: "=sza"`, in the order
    /// of the text.
    #[must_use]
    pub fn uses_of_param(&self, name: &str) -> Vec<ScenePath> {
        let mut uses = Vec::new();
        collect(self.tree(), name, &mut ScenePath::root(), &mut uses);
        uses
    }
}

fn collect(node: &Node, name: &str, path: &mut ScenePath, uses: &mut Vec<ScenePath>) {
    let mut below = |step: Step, node: &Node, uses: &mut Vec<ScenePath>| {
        path.push(step);
        collect(node, name, path, uses);
        path.pop();
    };
    match &node.inner().value {
        Value::Formula(formula) if formula.trim() == name => uses.push(path.clone()),
        Value::List(items) | Value::Tuple(items) => {
            for (index, item) in items.iter().enumerate() {
                below(Step::Index(index), item, uses);
            }
        }
        Value::Record(fields) => {
            for field in fields {
                below(Step::Key(field.name.clone().into()), &field.value, uses);
            }
        }
        Value::Map(entries) => {
            for (key, value) in entries {
                if let Value::Text(key) = &key.value {
                    below(Step::Name(key.clone()), value, uses);
                }
            }
        }
        _ => {}
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests {
    use super::*;

    #[test]
    fn uses_are_found_within_names_lists_and_maps() {
        let text = r#"Scene(
            format: 1, title: "=a", params: { "a": 1.0, "b": "=a" },
            sun: (zenith_deg: "=a", azimuth_deg: "=2 * a", irradiance: Constant("= a ")),
            materials: { "soil": Lambertian(reflectance: Bands([0.1, "=a"])) },
        )"#;
        let uses = ParsedScene::new("a.ron", text).unwrap().uses_of_param("a");
        let shown: Vec<String> = uses.iter().map(ToString::to_string).collect();
        let expected = [
            "title",
            "params.b",
            "sun.zenith_deg",
            "sun.irradiance",
            "materials.soil.reflectance[1]",
        ];
        assert_eq!(shown, expected);
    }
}
