//! Parameters that an include passes to its file.

use super::super::diagnostic::{Diagnostic, unknown_name};
use super::super::params::{entries, key, plain};
use super::super::ron_text::{Field, Node, Value};
use super::super::scene::Include;
use super::{Including, fields, path_of};

/// Parameters that an include passes, by name.
pub(super) type Passed = Vec<(Node, Node)>;

impl Including<'_> {
    /// Gives the parameters of an included file the values of its variant and of its include.
    pub(super) fn pass(
        &mut self,
        tree: &mut Node,
        include: &Include,
        mut passed: Passed,
        entry: &Node,
        namespace: &str,
    ) -> Option<()> {
        let at = path_of(namespace);
        passed.extend(self.changes_of_variant(tree, include, entry, namespace)?);
        let own: Vec<String> = entries(key(tree, "params"))
            .map(|(name, _)| bare(name, namespace).to_owned())
            .collect();
        for (key, _) in &passed {
            let Value::Text(name) = &key.value else { continue };
            if !own.contains(name) {
                let path = at.key("params").name(name);
                let error = unknown_name(path, "parameter", name, own.iter().map(String::as_str));
                let message = format!("no parameter `{name}` in {}", include.file);
                let help = error.help.map(|help| help.replace("this scene", "that file"));
                let place = self.source.place_of(key.span);
                let error = Diagnostic { message, help, ..error }.at(place);
                self.included.diagnostics.push(error);
            }
        }
        let params = fields(tree)?.iter_mut().find(|field| field.name == "params");
        if let Some(Field { value: Node { value: Value::Map(params), .. }, .. }) = params {
            for (key, value) in params {
                let Value::Text(name) = &key.value else { continue };
                let given = |(key, _): &&(Node, Node)| matches!(&key.value, Value::Text(given) if given == bare(name, namespace));
                if let Some((_, given)) = passed.iter().find(given) {
                    *value = given.clone();
                }
            }
        }
        Some(())
    }

    /// Parameters that the variant of an include sets; `None` after an error.
    fn changes_of_variant(
        &mut self,
        tree: &mut Node,
        include: &Include,
        entry: &Node,
        namespace: &str,
    ) -> Option<Passed> {
        let Some(name) = &include.variant else { return Some(Vec::new()) };
        let full = format!("{namespace}{name}");
        let Some((_, variant)) =
            entries(key(tree, "variants")).find(|(variant, _)| *variant == full)
        else {
            let own = entries(key(tree, "variants"));
            let own = own.map(|(name, _)| bare(name, namespace));
            let path = path_of(namespace).key("variant");
            let error = unknown_name(path, "variant", name, own);
            let error = error.at(self.source.place_of(entry.span));
            self.included.diagnostics.push(Diagnostic {
                message: format!("no variant `{name}` in {}", include.file),
                help: error.help.map(|help| help.replace("this scene", "that file")),
                ..error
            });
            return None;
        };
        let Value::Map(changes) = &variant.inner().value else { return Some(Vec::new()) };
        let changes = changes.iter().filter(|(_, value)| plain(value).is_some());
        let renamed = changes.cloned().map(|(mut key, value)| {
            if let Value::Text(name) = &mut key.value {
                *name = bare(name, namespace).to_owned();
            }
            (key, value)
        });
        Some(renamed.collect())
    }
}

/// Each file by its name, where it stands, and the parameters that are passed to it. Leaves what the
/// decoder can read: formulas have their place in the tree, not here.
pub(super) fn simplify(includes: &mut Node) -> Vec<(String, Node, Passed)> {
    let mut found = Vec::new();
    let Value::Map(map) = &mut includes.value else { return found };
    for (key, node) in map {
        let Value::Text(name) = &key.value else { continue };
        let mut passed = Vec::new();
        let mut place = node.clone();
        if let Value::Text(_) | Value::Formula(_) = node.value {
            let name = "file".to_owned();
            let file = Field { name, name_span: node.span, value: node.clone() };
            node.value = Value::Record(vec![file]);
        } else if let Value::Record(fields) = &mut node.value {
            if let Some(file) = fields.iter().find(|field| field.name == "file") {
                place = file.value.clone();
            }
            let params = fields.iter_mut().find(|field| field.name == "params");
            if let Some(Field { value: Node { value: Value::Map(params), .. }, .. }) = params {
                passed.clone_from(params);
                for (_, value) in params {
                    if let Value::Formula(_) = value.value {
                        value.value = Value::Float(0.0);
                    }
                }
            }
        }
        found.push((name.clone(), place, passed));
    }
    found
}

/// A name as the file itself has it.
fn bare<'a>(name: &'a str, namespace: &str) -> &'a str {
    name.strip_prefix(namespace).unwrap_or(name)
}
