//! All numbers, names of definitions and paths of files in a document, each with the keys that it stands under.

use super::encode::Encode;
use super::path::{ScenePath, Step};
use super::scene::Scene;

/// A value without parts that means something beyond itself.
#[derive(Clone, Copy, Debug)]
pub(super) enum LeafValue<'a> {
    /// A real number.
    Number(f64),
    /// Name of a definition.
    Reference {
        /// Kind of definition that it refers to.
        target: Target,
        /// The name.
        name: &'a str,
    },
    /// Path of a file.
    File(&'a str),
}

/// Definitions that a name refers to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    /// Name of such a definition in messages.
    pub(super) kind: &'static str,
    /// Key of the scene that holds the definitions.
    pub(super) key: &'static str,
    /// Returns whether a definition has this name.
    pub(super) is_defined: fn(&Scene, &str) -> bool,
    /// Returns the names of all definitions.
    pub(super) names: fn(&Scene) -> Vec<&str>,
}

/// Function that receives the path to a leaf and the leaf.
pub(super) type Visit<'v, 'a> = &'v mut dyn FnMut(&ScenePath, LeafValue<'a>);

/// Traversal of all leaves of a document.
pub(super) struct Walk<'v, 'a> {
    path: ScenePath,
    visit: Visit<'v, 'a>,
}

impl<'a> Walk<'_, 'a> {
    /// Visits all leaves below a step.
    pub(super) fn below(&mut self, step: Step, value: &'a (impl Encode + ?Sized)) {
        self.path.push(step);
        value.visit(self);
        self.path.pop();
    }

    /// Visits the key of a map, which stands at the step to its value.
    pub(super) fn key(&mut self, name: &'a str, leaf: Option<LeafValue<'a>>) {
        if let Some(leaf) = leaf {
            self.path.push(Step::Name(name.to_owned()));
            self.leaf(leaf);
            self.path.pop();
        }
    }

    /// Visits a leaf at the present path.
    pub(super) fn leaf(&mut self, leaf: LeafValue<'a>) {
        (self.visit)(&self.path, leaf);
    }
}

/// Visits all leaves of a value.
pub(super) fn visit_leaves<'a>(value: &'a impl Encode, visit: Visit<'_, 'a>) {
    value.visit(&mut Walk { path: ScenePath::root(), visit });
}
