//! Settings that a scene takes from its parameters.

use anyhow::Result;
use indexmap::IndexMap;

use super::batch::{Axis, Batch};
use super::conf::Node;
use super::report::Report;
use super::settings::Rule;
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

    /// Returns true if the batch varies a setting.
    pub(super) fn varies(&self, name: &str) -> bool {
        self.axis(name).is_some()
    }

    fn axis(&self, name: &str) -> Option<&'a Axis> {
        self.batch.and_then(|batch| batch.axes().find(|axis| axis.name == name))
    }

    /// The number of a key, or the parameter that holds it.
    pub(super) fn term(
        &mut self,
        parent: &Node,
        key: &str,
        rule: &Rule,
        report: &Report,
    ) -> Result<Term> {
        let number = rule.read(parent, key, report)?;
        let Some(axis) = self.axis(key) else { return Ok(Term::Number(number)) };
        axis.check(|value| rule.fault(value))?;
        self.params.entry(key.to_owned()).or_insert(number);
        Ok(Term::Formula(key.to_owned()))
    }

    /// Whole numbers from 2 on: sunfleck estimates errors from the differences between samples.
    pub(super) fn samples(&mut self, parent: &Node, key: &str, report: &Report) -> Result<Term> {
        let term = self.term(parent, key, &Rule::SAMPLES, report)?;
        Ok(match term {
            Term::Number(number) if number < 2.0 => {
                let what = "2 samples per pixel: one alone has no error estimate";
                report.differs(&parent.path_of(key), "1", what);
                Term::Number(2.0)
            }
            Term::Formula(formula) => Term::Formula(format!("max({formula}, 2)")),
            term @ Term::Number(_) => term,
        })
    }
}
