//! A scene as it is after includes, variant, point and parameters, each value with its origin.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::path::ScenePath;
use super::read::Reading;
use super::ron_text::{Node, Value};
use super::scene::Param;

impl Reading {
    /// The resolved scene as a file: what is read back from it is equal to
    /// [`Scene::resolved`](super::Scene::resolved), keys that are left out have their defaults, and
    /// behind each line stands where its value comes from.
    #[must_use]
    pub fn expanded(&self) -> String {
        let mut out = String::new();
        for (name, value) in &self.scene.params {
            // Writing to a string cannot fail.
            let value = match value {
                Param::Number(number) => format!("{number:?}"),
                Param::Text(text) => format!("{text:?}"),
            };
            let _infallible = writeln!(out, "// {name} = {value}  ({})", self.origin(name));
        }
        let scene = self.scene.resolved();
        out + &scene.to_text().into_file_with(&|path| self.remark(path))
    }

    /// Source of the value of a parameter.
    fn origin(&self, name: &str) -> String {
        let has = |given: &[(String, Param)]| given.iter().any(|(given, _)| given == name);
        if has(&self.options.set) {
            return "--set".to_owned();
        }
        if has(&self.options.point) {
            return "point of the sweep".to_owned();
        }
        if let Some(variant) = &self.options.variant
            && self.scene.variants.get(variant).is_some_and(|changes| changes.contains_key(name))
        {
            return format!("variant {variant}");
        }
        self.remark(&ScenePath::from("params").name(name)).unwrap_or_default()
    }

    /// File, line, and the formulas there.
    fn remark(&self, path: &ScenePath) -> Option<String> {
        let (node, _) = self.source.nearest(path)?;
        let place = self.source.place_of(node.span);
        let mut formulas = BTreeSet::new();
        collect(node, &mut formulas);
        let mut remark = format!("{}:{}", place.file.replace(char::is_control, " "), place.line);
        for formula in formulas.iter().take(4) {
            let shown = formula.escape_debug();
            let _infallible = write!(remark, ", \"={shown}\"");
        }
        Some(remark)
    }
}

fn collect<'a>(node: &'a Node, formulas: &mut BTreeSet<&'a str>) {
    match &node.inner().value {
        Value::Formula(formula) => {
            formulas.insert(formula);
        }
        Value::List(items) | Value::Tuple(items) => {
            for item in items {
                collect(item, formulas);
            }
        }
        Value::Record(fields) => {
            for field in fields {
                collect(&field.value, formulas);
            }
        }
        Value::Map(entries) => {
            for (_, value) in entries {
                collect(value, formulas);
            }
        }
        _ => {}
    }
}
