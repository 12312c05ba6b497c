//! Numbers of a scene that a batch may vary.

use std::fmt;

/// A number, or a formula of the scene's parameters.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Term {
    Number(f64),
    Formula(String),
}

impl Term {
    /// `offset - self`.
    pub(super) fn subtracted_from(self, offset: f64) -> Self {
        match self {
            Self::Number(number) => Self::Number(offset - number),
            Self::Formula(formula) => Self::Formula(format!("{offset:?} - ({formula})")),
        }
    }

    /// `1 / self²`.
    pub(super) fn inverse_square(self) -> Self {
        match self {
            // Rounded, so that a resolution of 0.02 m means 2500 photons.
            Self::Number(number) => Self::Number((1e9 / (number * number)).round() / 1e9),
            Self::Formula(formula) => Self::Formula(format!("1 / ({formula})^2")),
        }
    }

    /// Text of the term, as a whole number where it is one.
    pub(super) fn whole(&self) -> String {
        match self {
            Self::Number(number) => format!("{number}"),
            Self::Formula(_) => self.to_string(),
        }
    }
}

impl fmt::Display for Term {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number:?}"),
            Self::Formula(formula) => write!(f, "\"={formula}\""),
        }
    }
}
