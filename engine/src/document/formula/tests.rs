use exmex::Express as _;
use indexmap::IndexMap;
use proptest::prelude::*;

use super::{FormulaError, Param, Scope, evaluate};

fn over(params: &IndexMap<String, f64>, formula: &str) -> super::Result {
    let (later, used, doubts) = Default::default();
    let params = params.iter().map(|(name, value)| (name.clone(), Param::Number(*value)));
    let params = params.chain([("leaf".to_owned(), "birch.csv".into())]).collect();
    let scope = Scope {
        params: &params,
        namespace: "",
        later: &later,
        lost: &[],
        used: &used,
        doubts: &doubts,
    };
    evaluate(formula, &scope).map(|value| value.number().expect("a number"))
}

fn value(formula: &str) -> f64 {
    let params = IndexMap::from([("n".to_owned(), 3.0), ("e".to_owned(), 0.5)]);
    over(&params, formula).expect("a value")
}

fn error(formula: &str) -> FormulaError {
    over(&IndexMap::from([("sza".to_owned(), 30.0)]), formula).expect_err("no value")
}

#[test]
fn operators_bind_as_in_mathematics() {
    let cases = [
        ("1 + 2 * 3", 7.0),
        ("-2^2", -4.0),
        ("2^-1", 0.5),
        ("2^3^2", 512.0),
        ("7 - 2 - 1", 4.0),
        ("8 / 4 / 2", 1.0),
        ("-(1 + n) * 2", -8.0),
        ("1e-3 * 1.5E+3", 1.5),
        ("e", 0.5),
        ("7 % 4", 3.0),
        ("max(1, n) + min(1, n)", 4.0),
        ("max(1, max(n, 2))", 3.0),
        ("cos(radians(60)) * 2", 2.0 * 60_f64.to_radians().cos()),
        ("sqrt( n ^ 2 )", 3.0),
        (".5 + 1.", 1.5),
        ("- -2", 2.0),
    ];
    for (formula, expected) in cases {
        assert_eq!(value(formula).to_bits(), expected.to_bits(), "{formula}");
    }
}

#[test]
fn an_error_points_at_the_bytes_that_are_wrong() {
    let at = |formula: &str| error(formula).at;
    assert_eq!(at("90 - sna"), 5..8);
    assert_eq!(at("2 * "), 4..4);
    assert_eq!(at("(1 + 2"), 6..6);
    assert_eq!(at("1 2"), 2..3);
    assert_eq!(at("sine(1)"), 0..4);
    assert_eq!(at("1/0"), 0..3);
    assert_eq!(at("é"), 0..2);
    assert_eq!(at(""), 0..0);
}

#[test]
fn a_text_stands_alone() {
    let (later, used, doubts) = Default::default();
    let params = IndexMap::from([("leaf".to_owned(), Param::from("birch.csv"))]);
    let scope = Scope {
        params: &params,
        namespace: "",
        later: &later,
        lost: &[],
        used: &used,
        doubts: &doubts,
    };
    assert_eq!(evaluate(" leaf ", &scope), Ok("birch.csv".into()));
    assert!(used.borrow().contains("leaf"));
    let found = error("2 * leaf");
    assert_eq!(found.at, 4..8);
    assert!(found.message.is_some_and(|message| message.contains("the text \"birch.csv\"")));
}

#[test]
fn deep_and_long_formulas_are_errors() {
    for piece in ["(", "-", "2^", "sin("] {
        let formula = piece.repeat(900 / piece.len());
        assert!(error(&formula).message.is_some_and(|m| m.contains("deep")), "{piece}");
    }
    let sum = "1+".repeat(600);
    assert!(error(&sum).message.is_some_and(|m| m.contains("longer")));
}

/// A formula with parentheses around every operation: precedence, where exmex differs, is left
/// out.
fn formula() -> BoxedStrategy<String> {
    let leaf = prop_oneof![
        Just("n".to_owned()),
        Just("PI".to_owned()),
        (0_u32..1000).prop_map(|value| value.to_string()),
        (0.0..10.0_f64).prop_map(|value| format!("{value:.3}")),
    ];
    let grow = |inner: BoxedStrategy<String>| {
        let operator = prop::sample::select(vec!["+", "-", "*", "/", "^"]);
        let function = prop::sample::select(vec!["sin", "cos", "sqrt", "exp", "abs", "floor"]);
        prop_oneof![
            (inner.clone(), operator, inner.clone()).prop_map(|(a, o, b)| format!("({a} {o} {b})")),
            (function, inner.clone()).prop_map(|(f, a)| format!("{f}({a})")),
            inner.prop_map(|a| format!("(-{a})")),
        ]
    };
    leaf.prop_recursive(4, 20, 2, grow).boxed()
}

proptest! {
    /// The exmex crate is a second evaluator, by other authors.
    #[test]
    fn both_evaluators_agree(formula in formula()) {
        let params = IndexMap::from([("n".to_owned(), 3.0)]);
        let other = exmex::parse::<f64>(&formula).expect("a formula");
        let names = vec![3.0; other.var_names().len()];
        let other = other.eval(&names).expect("a value");
        match over(&params, &formula) {
            Ok(own) => prop_assert_eq!(own.to_bits(), other.to_bits(), "{}", formula),
            Err(error) => prop_assert!(!other.is_finite(), "{formula}: {error:?}"),
        }
    }
}
