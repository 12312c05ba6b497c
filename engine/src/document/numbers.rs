//! All real numbers of a document, each with the keys that it stands under.

use super::encode::Encode;

/// A step of the path to a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step<'a> {
    /// A key of the language.
    Key(&'static str),
    /// A name that the author gave.
    Name(&'a str),
    /// Place in a list or a tuple, from 0.
    Index(usize),
}

/// Receives the path to a number and the number.
pub(super) type Visit<'v, 'a> = &'v mut dyn FnMut(&[Step<'a>], f64);

/// A walk over all numbers of a document.
pub(super) struct Walk<'v, 'a> {
    steps: Vec<Step<'a>>,
    visit: Visit<'v, 'a>,
}

impl<'a> Walk<'_, 'a> {
    /// Visits all numbers below a step.
    pub(super) fn below(&mut self, step: Step<'a>, value: &'a (impl Encode + ?Sized)) {
        self.steps.push(step);
        value.numbers(self);
        self.steps.pop();
    }

    /// Visits a number at the present path.
    pub(super) fn number(&mut self, value: f64) {
        (self.visit)(&self.steps, value);
    }
}

/// Visits all numbers of a value.
pub(super) fn visit_numbers<'a>(value: &'a impl Encode, visit: Visit<'_, 'a>) {
    value.numbers(&mut Walk { steps: Vec::new(), visit });
}

/// Path in the document, such as `instances[0].at_m[2][1]`.
pub(super) fn path_of(steps: &[Step<'_>]) -> String {
    let mut path = String::new();
    for step in steps {
        match step {
            Step::Key(name) | Step::Name(name) if path.is_empty() => path.push_str(name),
            Step::Key(name) | Step::Name(name) => path.extend([".", name]),
            Step::Index(index) => path.extend(["[", &index.to_string(), "]"]),
        }
    }
    path
}
