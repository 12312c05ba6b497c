//! Functions and constants of formulas.

use std::f64::consts;

/// Function of one number.
pub(super) type Function = fn(f64) -> f64;
/// Function of two numbers.
pub(super) type FunctionOfTwo = fn(f64, f64) -> f64;

/// Functions of one number, by name.
pub(super) const FUNCTIONS: [(&str, Function); 21] = [
    ("abs", f64::abs),
    ("acos", f64::acos),
    ("asin", f64::asin),
    ("atan", f64::atan),
    ("cbrt", f64::cbrt),
    ("ceil", f64::ceil),
    ("cos", f64::cos),
    ("cosh", f64::cosh),
    ("degrees", f64::to_degrees),
    ("exp", f64::exp),
    ("floor", f64::floor),
    ("ln", f64::ln),
    ("log10", f64::log10),
    ("log2", f64::log2),
    ("radians", f64::to_radians),
    ("round", f64::round),
    ("sin", f64::sin),
    ("sinh", f64::sinh),
    ("sqrt", f64::sqrt),
    ("tan", f64::tan),
    ("tanh", f64::tanh),
];

/// Functions of two numbers, by name.
pub(super) const FUNCTIONS_OF_TWO: [(&str, FunctionOfTwo); 4] =
    [("atan2", f64::atan2), ("hypot", f64::hypot), ("max", f64::max), ("min", f64::min)];

/// Functions of an angle.
pub(super) const ANGULAR: [&str; 3] = ["sin", "cos", "tan"];

/// Returns whether a function of formulas has this name.
pub(in super::super) fn is_function(name: &str) -> bool {
    FUNCTIONS.iter().any(|(known, _)| *known == name)
        || FUNCTIONS_OF_TWO.iter().any(|(known, _)| *known == name)
}

/// Names of all functions and constants, and what angles they take.
pub(in super::super) fn functions_text() -> String {
    let of_one = FUNCTIONS.iter().map(|(name, _)| format!("`{name}(x)`"));
    let of_two = FUNCTIONS_OF_TWO.iter().map(|(name, _)| format!("`{name}(x, y)`"));
    let functions: Vec<_> = of_one.chain(of_two).collect();
    let constants: Vec<_> = CONSTANTS.iter().map(|(name, _)| format!("`{name}`")).collect();
    format!(
        "A formula is a text that starts with `=`. It has numbers, names of `params`, `+ - * / % ^`, \
         parentheses, the constants {} and the functions {}. **`sin`, `cos` and `tan` take radians, and \
         `asin`, `acos`, `atan` and `atan2` return radians**: write `cos(radians(sza))` and \
         `degrees(asin(0.5))`. A parameter that is a text stands alone: `\"=species\"`.",
        constants.join(", "),
        functions.join(", ")
    )
}

/// A parameter of the same name hides a constant.
pub(super) const CONSTANTS: [(&str, f64); 3] =
    [("PI", consts::PI), ("E", consts::E), ("TAU", consts::TAU)];
