//! Texts that nobody means well with: an answer, and soon.

use std::fmt::Write as _;

use proptest::prelude::*;
use sunfleck::document::{ReadError, ReadOptions, Reading, read_text};

const DESIGN: &str = include_str!("design.ron");

fn read(text: &str) -> Result<Reading, ReadError> {
    read_text("scene.ron", text, &ReadOptions::default())
}

fn error(text: &str) -> String {
    match read(text) {
        Ok(reading) => reading.render(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn a_million_brackets_are_one_error() {
    for bracket in ["(", "[", "{\"a\":", "Some(", "{[("] {
        let message = error(&bracket.repeat(1_000_000));
        assert!(message.starts_with("more than 128 brackets are open here"), "{message}");
    }
    let message = error(&"Scene(a:".repeat(1_000_000));
    assert!(message.starts_with("more than 128 brackets are open here"), "{message}");
    for closing in [")", "]", "}", ",", ":"] {
        assert!(error(&closing.repeat(1_000_000)).starts_with("expected a value"), "{closing}");
    }
}

#[test]
fn deep_comments_are_counted_and_not_recursed_into() {
    let comment = format!("{}{}", "/*".repeat(500_000), "*/".repeat(500_000));
    assert!(read(&format!("{comment}{DESIGN}")).is_ok_and(|reading| reading.is_sound()));
    assert!(error(&"/*".repeat(1_000_000)).starts_with("this comment is never closed"));
}

#[test]
fn a_file_cut_anywhere_is_an_error() {
    let end = DESIGN.trim_end().len();
    for cut in (0..end).filter(|&cut| DESIGN.is_char_boundary(cut)) {
        let sound = read(&DESIGN[..cut]).is_ok_and(|reading| reading.is_sound());
        assert!(!sound, "cut at byte {cut}");
    }
}

#[test]
fn of_a_million_errors_the_first_hundred_are_shown() {
    let mut keys = String::from("(");
    for index in 0..200_000 {
        let _infallible = write!(keys, "k{index}: 1, ");
    }
    let message = error(&(keys + ")"));
    // Four required keys are missing as well.
    assert!(message.contains("and 199904 more errors"), "{}", &message[message.len() - 300..]);
    let bands = "(name: \"\", center_nm: 1), ".repeat(100_000);
    let message = error(&DESIGN.replace("bands: [", &format!("bands: [{bands}")));
    assert!(message.contains("more errors"), "{}", &message[message.len() - 300..]);
}

#[test]
fn long_chains_of_names_end() {
    let mut spectra = String::new();
    for index in 0..20_000 {
        let _infallible = write!(spectra, "\"s{index}\": Named(\"s{}\"), ", index + 1);
    }
    let text = DESIGN.replace("spectra: {", &format!("spectra: {{{spectra}"));
    assert!(error(&text).contains("more than 16 spectra name one another from here"));
}

#[test]
fn long_lines_are_shown_in_part() {
    let spaces = " ".repeat(1_000_000);
    let message = error(&format!("Scene({spaces}formt: 1,{spaces})"));
    assert!(message.contains("formt"), "the wrong key is seen");
    assert!(message.len() < 10_000, "{} bytes", message.len());
}

#[test]
fn formulas_never_reach_what_is_not_theirs() {
    let odd = [
        "=",
        "==",
        "= ",
        "=(",
        "=)",
        "=1e",
        "=1e+",
        "=.",
        "=..",
        "=1..2",
        "=0x10",
        "={a}",
        "=a.b",
        "=\u{0}",
        "=é",
        "=😕",
        "=sin",
        "=sin(",
        "=sin()",
        "=max(1)",
        "=max(1,2,3)",
        "=1 2",
        "=-",
        "=^",
        "=2^",
        "=1/0",
        "=0/0",
        "=-1^0.5",
        "=(-1)^0.5",
        "=ln(0)",
        "=1e999",
        "=10^400",
        "=sza(2)",
        "=;",
    ];
    for formula in odd {
        let escaped = formula.escape_debug().to_string();
        let text = DESIGN.replace("\"=sza\"", &format!("\"{escaped}\""));
        let reading = read(&text).unwrap_or_else(|error| panic!("{formula}: {error}"));
        let paths: Vec<_> = reading.diagnostics.iter().map(|one| one.path.to_string()).collect();
        assert_eq!(paths, ["sun.zenith_deg"], "{formula}: {}", reading.render());
    }
}

/// Pieces that say something to a reader of RON.
fn piece() -> impl Strategy<Value = String> {
    prop_oneof![
        Just(DESIGN.to_owned()),
        prop::sample::select(vec![
            "(",
            ")",
            "[",
            "]",
            "{",
            "}",
            ",",
            ":",
            "\"",
            "\\",
            "/*",
            "*/",
            "//",
            "\n",
            "r#\"",
            "\"#",
            "=",
            "NaN",
            "-inf",
            "1e999",
            "0x",
            "Some(",
            "None",
            "Scene(",
            "#![enable(",
            "'",
            "\u{feff}",
            "\"=sza\"",
            "\"=(\"",
            "é",
            "-",
            "+",
            ".",
            "1",
            "sza",
            "bands",
            "sun",
        ])
        .prop_map(str::to_owned),
        any::<String>(),
    ]
}

proptest! {
    #[test]
    fn no_text_makes_the_reader_panic(pieces in prop::collection::vec(piece(), 0..8)) {
        let _shown = error(&pieces.concat());
    }

    /// Bytes of a valid scene are replaced, repeated or taken out.
    #[test]
    fn no_change_of_a_scene_makes_the_reader_panic(
        edits in prop::collection::vec((0..DESIGN.len(), 0..40_usize, piece()), 1..4),
    ) {
        let mut text = DESIGN.to_owned();
        for (start, length, piece) in edits {
            let floor = |at: usize| text.floor_char_boundary(at.min(text.len()));
            let (start, end) = (floor(start), floor(start + length));
            let piece = if piece.len() > 1000 { "" } else { &piece };
            text.replace_range(start..end, piece);
        }
        let shown = error(&text);
        let at_home = !shown.contains("panicked");
        prop_assert!(at_home);
        if let Ok(reading) = read(&text) {
            for one in &reading.diagnostics {
                prop_assert!(!one.message.is_empty());
                prop_assert!(one.place.is_some() || one.path.is_root(), "{}", one.message);
            }
        }
    }
}
