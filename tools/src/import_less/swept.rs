//! Which settings a scene takes from its parameters.

use anyhow::Result;
use indexmap::IndexMap;

use super::batch::Batch;
use super::conf::Node;
use super::term::Term;

/// Settings that a batch varies, and those of them that the scene follows.
#[derive(Debug)]
pub(super) struct Swept<'a> {
    batch: Option<&'a Batch>,
    /// Parameters of the scene, with the values of `input.conf`.
    pub(super) params: IndexMap<String, f64>,
}

impl<'a> Swept<'a> {
    pub(super) fn new(batch: Option<&'a Batch>) -> Self {
        Self { batch, params: IndexMap::new() }
    }

    /// Whether the batch varies a setting.
    pub(super) fn varies(&self, name: &str) -> bool {
        self.batch.is_some_and(|batch| batch.axes().any(|axis| axis.name == name))
    }

    /// The number of a setting, or the parameter that holds it.
    pub(super) fn term(&mut self, node: &Node) -> Result<Term> {
        let number = node.number()?;
        let name = node.name();
        if !self.varies(name) {
            return Ok(Term::Number(number));
        }
        self.params.entry(name.to_owned()).or_insert(number);
        Ok(Term::Formula(name.to_owned()))
    }
}
