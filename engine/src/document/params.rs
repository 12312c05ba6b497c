//! Parameters and formulas: settles `params`, then gives every formula its number.

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};

use indexmap::IndexMap;

use super::decode::Reader;
use super::diagnostic::{Diagnostic, unknown_name};
use super::formula::{Scope, evaluate};
use super::path::Step;
use super::read::ReadOptions;
use super::ron_text::{BadNumber, Field, Node, Span, Value};
use super::scene::Param;

/// The parameters of a scene, and what its formulas have made of them.
pub(super) struct Params {
    /// Value of each; NaN where it could not be read.
    pub(super) values: IndexMap<String, Param>,
    /// Namespaces of included files that could not be read.
    lost: Vec<String>,
    used: RefCell<HashSet<String>>,
}

impl Params {
    /// Parameters of the scene file that no formula has used.
    pub(super) fn unused(&self) -> Vec<String> {
        let used = self.used.borrow();
        let own = self.values.keys().filter(|name| !name.contains('.'));
        own.filter(|name| !used.contains(*name)).cloned().collect()
    }
}

/// Values of the parameters: of the file, of the variant, of the point of the sweep, of the options,
/// the later before the earlier.
pub(super) fn settle_params<'a>(
    tree: &'a Node,
    options: &ReadOptions,
    lost: Vec<String>,
    reader: &mut Reader<'a>,
) -> Params {
    let variant = options.variant.as_deref().and_then(|name| chosen_variant(tree, name, reader));
    let mut params = Params { values: IndexMap::new(), lost, used: RefCell::default() };
    let mut later: HashSet<_> = entries(key(tree, "params")).map(|(name, _)| name).collect();
    for (name, node) in entries(key(tree, "params")) {
        let own = reader.within("params".into(), |reader| {
            reader.within(Step::Name(name.to_owned()), |reader| match &node.value {
                Value::Formula(formula) => compute(formula, node, &params, &later, reader),
                _ => plain(node),
            })
        });
        let varied = variant.iter().flatten().find(|(varied, _)| *varied == name);
        let mut given = options.set.iter().rev().chain(options.point.iter().rev());
        let given = given.find(|(given, _)| given == name).map(|(_, value)| value);
        let value = match (given.or(varied.map(|(_, value)| value)), own) {
            (Some(given), Some(own)) => Some(of_kind(name, given, &own, reader)),
            (Some(given), None) => Some(given.clone()),
            (None, own) => own,
        };
        later.remove(name);
        params.values.insert(name.to_owned(), value.unwrap_or(Param::Number(f64::NAN)));
    }
    for (name, value) in options.set.iter().chain(&options.point) {
        if !params.values.contains_key(name) {
            let known = params.values.keys().map(String::as_str);
            let message = format!("no parameter `{name}` to set");
            reader.push(Diagnostic { message, ..unknown_name("params", "parameter", name, known) });
        } else if !value.is_lawful() {
            let message = format!("`{name}` cannot be set to {value}: it must be a finite number");
            reader.push(Diagnostic::error("params", message));
        }
    }
    params
}

/// A value that replaces the scene's own, as one of its kind; the scene's own where it cannot be one.
fn of_kind(name: &str, given: &Param, own: &Param, reader: &mut Reader<'_>) -> Param {
    given.like(own).unwrap_or_else(|| {
        let message = format!("`{name}` cannot be {:?}: it is a number", given.to_string());
        let help = format!("its value in the scene is {own}; write a finite number");
        reader.push(Diagnostic::error("params", message).help(help));
        own.clone()
    })
}

/// One walk over the tree: evaluates formulas, and reports repeated keys and numbers that no scene
/// can hold.
pub(super) fn survey<'a>(tree: &'a Node, params: &Params, reader: &mut Reader<'a>) {
    walk(tree, params, true, reader);
}

fn chosen_variant<'a>(
    tree: &'a Node,
    name: &str,
    reader: &mut Reader<'a>,
) -> Option<Vec<(&'a str, Param)>> {
    let variants: Vec<_> = entries(key(tree, "variants")).collect();
    let Some((_, node)) = variants.iter().find(|(variant, _)| *variant == name) else {
        let known = variants.iter().map(|(variant, _)| *variant);
        reader.push(unknown_name("variants", "variant", name, known));
        return None;
    };
    Some(entries(Some(node)).filter_map(|(name, node)| Some((name, plain(node)?))).collect())
}

pub(super) fn key<'a>(tree: &'a Node, name: &str) -> Option<&'a Node> {
    match &tree.inner().value {
        Value::Record(fields) => fields.iter().find(|field| field.name == name).map(|f| &f.value),
        _ => None,
    }
}

pub(super) fn entries(map: Option<&Node>) -> impl Iterator<Item = (&str, &Node)> {
    let entries = match map.map(|map| &map.inner().value) {
        Some(Value::Map(entries)) => entries.as_slice(),
        _ => &[],
    };
    entries.iter().filter_map(|(key, value)| match &key.value {
        Value::Text(key) => Some((key.as_str(), value)),
        _ => None,
    })
}

/// The value of a node that is no formula.
pub(super) fn plain(node: &Node) -> Option<Param> {
    match &node.value {
        Value::Text(text) => Some(Param::Text(text.clone())),
        _ => plain_number(node).map(Param::Number),
    }
}

pub(super) fn plain_number(node: &Node) -> Option<f64> {
    match node.value {
        Value::Float(value) => Some(value),
        Value::Integer { negative, magnitude } => {
            Some(if negative { -(magnitude as f64) } else { magnitude as f64 })
        }
        _ => None,
    }
}

fn compute<'a>(
    formula: &str,
    node: &'a Node,
    params: &Params,
    later: &HashSet<&str>,
    reader: &mut Reader<'a>,
) -> Option<Param> {
    let doubts = RefCell::default();
    let scope = Scope {
        params: &params.values,
        namespace: reader.namespace(node),
        later,
        lost: &params.lost,
        used: &params.used,
        doubts: &doubts,
    };
    let value = match evaluate(formula, &scope) {
        Ok(value) => {
            for doubt in doubts.take() {
                let span = within_text(reader.text(), node.span, formula, &doubt.at);
                reader.warn(span, doubt.message.unwrap_or_default(), doubt.help);
            }
            Some(value)
        }
        Err(error) => {
            match error.message {
                Some(message) => {
                    let span = within_text(reader.text(), node.span, formula, &error.at);
                    reader.error(span, message, error.help);
                }
                None => reader.mark_broken(),
            }
            None
        }
    };
    reader.set_computed(node, value.clone());
    value
}

/// Bytes of the text that are these bytes of the formula; all of the string where it has escapes.
fn within_text(text: &str, span: Span, formula: &str, at: &std::ops::Range<usize>) -> Span {
    let own = text.get(span.range()).unwrap_or("");
    match own.find('=').map(|equals| equals + 1) {
        Some(start) if own[start..].starts_with(formula) => {
            let start = span.start as usize + start;
            Span::new(start + at.start, start + at.end)
        }
        _ => span,
    }
}

fn walk<'a>(node: &'a Node, params: &Params, is_scene: bool, reader: &mut Reader<'a>) {
    let node = node.inner();
    match &node.value {
        Value::BadNumber(bad) => report_bad_number(node, *bad, reader),
        Value::Formula(formula) => {
            compute(formula, node, params, &HashSet::new(), reader);
        }
        Value::List(items) | Value::Tuple(items) => {
            for (index, item) in items.iter().enumerate() {
                reader.within(Step::Index(index), |reader| walk(item, params, false, reader));
            }
        }
        Value::Record(fields) => {
            let keys = fields.iter().map(|f| (f.name.as_str(), f.name_span));
            report_repeated(keys, |key| Step::Key(key.into()), reader);
            for Field { name, value, .. } in fields {
                // `params` are settled, variants hold plain values, and a title is what it says.
                let is_plain =
                    is_scene && matches!(name.as_str(), "params" | "variants" | "sweep" | "title");
                let step = Step::Key(name.clone().into());
                reader.within(step, |reader| match &value.inner().value {
                    Value::Formula(_) if is_plain => {}
                    Value::Map(_) if is_plain => walk_plain(value, reader),
                    _ => walk(value, params, false, reader),
                });
            }
        }
        Value::Map(entries) => {
            report_repeated(names(entries), Step::Name, reader);
            for (key, value) in entries {
                if let Value::Text(key) = &key.value {
                    let step = Step::Name(key.clone());
                    reader.within(step, |reader| walk(value, params, false, reader));
                }
            }
        }
        _ => {}
    }
}

/// Walks over a node whose formulas are already evaluated.
fn walk_plain<'a>(node: &'a Node, reader: &mut Reader<'a>) {
    match &node.inner().value {
        Value::BadNumber(bad) => report_bad_number(node, *bad, reader),
        Value::List(items) => {
            for (index, item) in items.iter().enumerate() {
                reader.within(Step::Index(index), |reader| walk_plain(item, reader));
            }
        }
        Value::Map(entries) => {
            report_repeated(names(entries), Step::Name, reader);
            for (key, value) in entries {
                if let Value::Text(key) = &key.value {
                    reader.within(Step::Name(key.clone()), |reader| walk_plain(value, reader));
                }
            }
        }
        _ => {}
    }
}

fn names(entries: &[(Node, Node)]) -> impl Iterator<Item = (&str, Span)> {
    entries.iter().filter_map(|(key, _)| match &key.value {
        Value::Text(name) => Some((name.as_str(), key.span)),
        _ => None,
    })
}

fn report_bad_number(node: &Node, bad: BadNumber, reader: &mut Reader<'_>) {
    let text = reader.text().get(node.span.range()).unwrap_or("");
    let (message, help) = match bad {
        BadNumber::NotFinite => (format!("`{text}` has no meaning here"), "write a finite number"),
        BadNumber::TooLarge => {
            ("this number is too large".to_owned(), "the largest is about 1.8e308")
        }
    };
    reader.error(node.span, message, Some(help.to_owned()));
}

fn report_repeated<'a>(
    names: impl Iterator<Item = (&'a str, Span)>,
    step: impl Fn(String) -> Step,
    reader: &mut Reader<'a>,
) {
    let mut seen = HashMap::new();
    for (name, span) in names {
        if seen.contains_key(name) && !reader.has_room() {
            continue;
        }
        if let Some(&first) = seen.get(name) {
            let first = reader.place_of(first);
            let message = format!("the key `{name}` is given twice");
            let help = format!(
                "it stands at line {}, column {} already: take one of the two out",
                first.line, first.column
            );
            reader.within(step(name.to_owned()), |reader| {
                reader.error(span, message, Some(help));
            });
        } else {
            seen.insert(name, span);
        }
    }
}
