//! Formulas over a scene's parameters: `2*PI/n`, `sqrt(lai)*scale`.
//!
//! Ours, because exmex (0.21) reads `-2^2` as 4, reads neither `1e-3` nor `max(1, max(2, 3))`, takes
//! a parameter called `e` for Euler's number and does not say where a formula is wrong.

mod functions;
#[cfg(test)]
mod tests;

use std::cell::RefCell;
use std::collections::HashSet;
use std::f64::consts;
use std::ops::Range;

use indexmap::IndexMap;

use super::diagnostic::suggestion;
use super::scene::Param;
use functions::{ANGULAR, CONSTANTS, FUNCTIONS, FUNCTIONS_OF_TWO};
pub(super) use functions::{functions_text, is_function};

/// A formula may be so long, bytes.
const LENGTH: usize = 1000;

/// Parentheses, signs and powers may nest so deep.
const DEPTH: usize = 50;

/// Reason why a formula has no value.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FormulaError {
    /// Bytes of the formula.
    pub(super) at: Range<usize>,
    /// None where a parameter has no value: that was reported where it is defined.
    pub(super) message: Option<String>,
    pub(super) help: Option<String>,
}

impl FormulaError {
    fn new(at: Range<usize>, message: impl Into<String>, help: Option<String>) -> Self {
        Self { at, message: Some(message.into()), help }
    }
}

/// Meaning of the names in a formula.
#[derive(Debug)]
pub(super) struct Scope<'a> {
    /// Parameters that have been settled, by their full names; those without a value are NaN.
    pub(super) params: &'a IndexMap<String, Param>,
    /// Prefix of the full names of the formula's own file.
    pub(super) namespace: &'a str,
    /// Parameters that are settled later.
    pub(super) later: &'a HashSet<&'a str>,
    /// Namespaces of included files that could not be read.
    pub(super) lost: &'a [String],
    /// Parameters that some formula has used.
    pub(super) used: &'a RefCell<HashSet<String>>,
    /// Parts of the formula that are lawful and may not be meant.
    pub(super) doubts: &'a RefCell<Vec<FormulaError>>,
}

/// Value of a formula; the text of a parameter that stands alone, if it is one.
///
/// # Errors
/// Where it is not a formula, names what is unknown, or comes to no finite number.
pub(super) fn evaluate(
    formula: &str,
    scope: &Scope<'_>,
) -> std::result::Result<Param, FormulaError> {
    let full = format!("{}{}", scope.namespace, formula.trim());
    if let Some(Param::Text(text)) = scope.params.get(&full) {
        scope.used.borrow_mut().insert(full);
        return Ok(Param::Text(text.clone()));
    }
    evaluate_number(formula, scope).map(Param::Number)
}

fn evaluate_number(formula: &str, scope: &Scope<'_>) -> Result {
    let error = |message: String| FormulaError::new(0..formula.len(), message, None);
    if formula.len() > LENGTH {
        return Err(error(format!("this formula is longer than {LENGTH} bytes")));
    }
    let mut parser = Parser { text: formula, at: 0, depth: 0, scope };
    let value = parser.sum()?;
    parser.skip_blank();
    if parser.at < formula.len() {
        return Err(parser.unexpected("an operator or the end of the formula"));
    }
    if value.is_finite() {
        Ok(value)
    } else {
        Err(error(format!("this formula gives {value}, which is not a finite number")))
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
    scope: &'a Scope<'a>,
}

type Result = std::result::Result<f64, FormulaError>;

impl Parser<'_> {
    fn sum(&mut self) -> Result {
        let mut value = self.product()?;
        loop {
            if self.take('+') {
                value += self.product()?;
            } else if self.take('-') {
                value -= self.product()?;
            } else {
                return Ok(value);
            }
        }
    }

    fn product(&mut self) -> Result {
        let mut value = self.signed()?;
        loop {
            if self.take('*') {
                value *= self.signed()?;
            } else if self.take('/') {
                value /= self.signed()?;
            } else if self.take('%') {
                value %= self.signed()?;
            } else {
                return Ok(value);
            }
        }
    }

    /// A sign binds less than a power: `-2^2` is -4.
    fn signed(&mut self) -> Result {
        self.deeper(|parser| {
            if parser.take('-') {
                Ok(-parser.signed()?)
            } else if parser.take('+') {
                parser.signed()
            } else {
                parser.power()
            }
        })
    }

    /// Power, evaluated from the right: `2^3^2` is 2^9.
    fn power(&mut self) -> Result {
        let base = self.atom()?;
        if self.take('^') { Ok(base.powf(self.signed()?)) } else { Ok(base) }
    }

    fn atom(&mut self) -> Result {
        if self.take('(') {
            let value = self.sum()?;
            self.close()?;
            return Ok(value);
        }
        match self.peek() {
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c == '_' || c.is_alphabetic() => self.name(),
            _ => Err(self.unexpected("a number, a parameter or `(`")),
        }
    }

    fn number(&mut self) -> Result {
        let start = self.at;
        let bytes = self.text.as_bytes();
        let digits = |mut at: usize| {
            while bytes.get(at).is_some_and(u8::is_ascii_digit) {
                at += 1;
            }
            at
        };
        self.at = digits(self.at);
        if bytes.get(self.at) == Some(&b'.') {
            self.at = digits(self.at + 1);
        }
        if matches!(bytes.get(self.at), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(self.at + 1), Some(b'+' | b'-')));
            let end = digits(self.at + 1 + sign);
            if end > self.at + 1 + sign {
                self.at = end;
            }
        }
        let literal = &self.text[start..self.at];
        literal.parse().map_err(|_not_a_number| {
            FormulaError::new(start..self.at, format!("`{literal}` is not a number"), None)
        })
    }

    fn name(&mut self) -> Result {
        let start = self.at;
        let rest = &self.text[start..];
        let letter = |c: char| c == '_' || c.is_alphabetic();
        let mut length = 0;
        // `birch.lai` is one name, `birch.5` is none.
        while let Some(c) = rest[length..].chars().next()
            && (letter(c) || c.is_numeric() || c == '.' && rest[length + 1..].starts_with(letter))
        {
            length += c.len_utf8();
        }
        let name = &rest[..length];
        self.at += length;
        if self.take('(') {
            return self.call(name, start);
        }
        let at = start..start + length;
        let constant = || CONSTANTS.iter().find(|(known, _)| *known == name).map(|&(_, v)| v);
        let full = format!("{}{name}", self.scope.namespace);
        let param = match self.scope.params.get(&full) {
            Some(Param::Text(text)) => {
                let message = format!("the parameter `{name}` is the text {text:?}");
                let help = format!("formulas are of numbers; a text stands alone: `\"={name}\"`");
                self.scope.used.borrow_mut().insert(full);
                return Err(FormulaError::new(at, message, Some(help)));
            }
            Some(Param::Number(value)) => Some(*value),
            None => None,
        };
        match param.or_else(constant) {
            Some(value) if value.is_nan() => Err(FormulaError { at, message: None, help: None }),
            Some(value) => {
                if param.is_some() {
                    self.scope.used.borrow_mut().insert(full);
                }
                Ok(value)
            }
            None if self.scope.lost.iter().any(|lost| full.starts_with(lost)) => {
                Err(FormulaError { at, message: None, help: None })
            }
            None => Err(self.unknown_name(name, &full, at)),
        }
    }

    /// Parameters by the names that the formula's file has for them.
    fn params(&self) -> impl Iterator<Item = &str> {
        self.scope.params.keys().filter_map(|name| name.strip_prefix(self.scope.namespace))
    }

    fn unknown_name(&self, name: &str, full: &str, at: Range<usize>) -> FormulaError {
        if self.scope.later.contains(full) {
            let message = format!("the parameter `{name}` has no value yet here");
            let help = "a parameter may use those above it, neither itself nor those below";
            return FormulaError::new(at, message, Some(help.to_owned()));
        }
        if FUNCTIONS.iter().any(|(function, _)| *function == name) {
            let message = format!("the function `{name}` needs a value");
            return FormulaError::new(at, message, Some(format!("write `{name}(..)`")));
        }
        let names: Vec<_> = self.params().collect();
        let help = if names.is_empty() {
            format!("define it: `params: {{ \"{name}\": 1.0 }}`")
        } else {
            suggestion(name, &names, "this scene's parameters")
        };
        FormulaError::new(at, format!("no parameter `{name}`"), Some(help))
    }

    /// After `name(`.
    fn call(&mut self, name: &str, start: usize) -> Result {
        let at = start..start + name.len();
        if let Some((_, function)) = FUNCTIONS.iter().find(|(known, _)| *known == name) {
            let value = self.sum()?;
            if ANGULAR.contains(&name) && value.abs() > consts::TAU {
                self.doubt_degrees(name, value, start..self.at);
            }
            self.close()?;
            return Ok(function(value));
        }
        if let Some((_, function)) = FUNCTIONS_OF_TWO.iter().find(|(known, _)| *known == name) {
            let first = self.sum()?;
            if !self.take(',') {
                return Err(self.unexpected(&format!("`,` and the second value of `{name}`")));
            }
            let second = self.sum()?;
            self.close()?;
            return Ok(function(first, second));
        }
        let known: Vec<_> = FUNCTIONS
            .iter()
            .map(|(known, _)| *known)
            .chain(FUNCTIONS_OF_TWO.iter().map(|(known, _)| *known))
            .collect();
        let help = if self.params().any(|param| param == name) {
            format!("`{name}` is a parameter; to multiply, write `{name} * (..)`")
        } else {
            suggestion(name, &known, "functions")
        };
        Err(FormulaError::new(at, format!("no function `{name}`"), Some(help)))
    }

    /// Notes an angle beyond a whole turn: degrees, most likely.
    fn doubt_degrees(&self, name: &str, value: f64, at: Range<usize>) {
        let message = format!("`{name}` takes radians, and {value} are more than a whole turn");
        let help = format!("of an angle in degrees, write `{name}(radians(..))`");
        self.scope.doubts.borrow_mut().push(FormulaError::new(at, message, Some(help)));
    }

    fn close(&mut self) -> std::result::Result<(), FormulaError> {
        if self.take(')') { Ok(()) } else { Err(self.unexpected("an operator or `)`")) }
    }

    fn deeper(&mut self, read: impl FnOnce(&mut Self) -> Result) -> Result {
        if self.depth == DEPTH {
            let message = format!("this formula nests more than {DEPTH} deep");
            return Err(FormulaError::new(0..self.text.len(), message, None));
        }
        self.depth += 1;
        let value = read(self);
        self.depth -= 1;
        value
    }

    fn skip_blank(&mut self) {
        let rest = &self.text[self.at..];
        self.at += rest.find(|c: char| !c.is_whitespace()).unwrap_or(rest.len());
    }

    fn peek(&mut self) -> Option<char> {
        self.skip_blank();
        self.text[self.at..].chars().next()
    }

    fn take(&mut self, mark: char) -> bool {
        let found = self.peek() == Some(mark);
        if found {
            self.at += mark.len_utf8();
        }
        found
    }

    fn unexpected(&mut self, wanted: &str) -> FormulaError {
        let (found, length) = match self.peek() {
            Some(c) => (format!("`{}`", c.escape_debug()), c.len_utf8()),
            None => ("the end of the formula".to_owned(), 0),
        };
        let at = self.at..self.at + length;
        FormulaError::new(at, format!("expected {wanted}, found {found}"), None)
    }
}
