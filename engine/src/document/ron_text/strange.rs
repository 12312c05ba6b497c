//! Characters and words of other languages, with what the scene language has in their place.

/// Advice for a character that starts no token.
pub(super) fn advice_for(character: char) -> Option<&'static str> {
    Some(match character {
        '#' => "comments start with `//`",
        '=' => "write `key: value`, with a colon",
        ';' => "separate values by commas",
        '°' | '²' | '³' => {
            "write the number alone: its unit is in the name of the key (`_deg`, `_m`, `_nm`)"
        }
        '%' => "write the number alone; of fractions 0.1 for 10 %",
        '“' | '”' | '„' | '«' | '»' | '‘' | '’' | '‚' | '`' => {
            "write strings in double quotes: \"leaf\""
        }
        '*' | '/' | '^' | '$' | '&' | '!' => {
            "formulas stand in a string that starts with `=`: \"=2 * lai\""
        }
        '−' | '–' | '—' => "write the minus sign of the keyboard: `-`",
        '，' | '、' => "write the comma of the keyboard: `,`",
        '：' => "write the colon of the keyboard: `:`",
        '（' | '）' | '［' | '］' | '｛' | '｝' => {
            "write the brackets of the keyboard: `(` and `)`"
        }
        '<' | '>' => "write a value in place of `<..>`",
        _ => return None,
    })
}

/// Advice where a bracket follows a word that it cannot follow.
pub(super) fn bracket_advice(word: &str, bracket: char) -> Option<String> {
    match bracket {
        '{' => {
            Some(format!("write `{word}(..)`: keys stand in parentheses, and `{{..}}` is a map"))
        }
        '[' => Some(format!("write `{word}([..])`: a list stands in parentheses")),
        _ => None,
    }
}

/// A number with the point that was meant, if what starts at `at` is the second half of one that is written
/// with a comma, as in `30,0`.
pub(in super::super) fn decimal_comma(text: &str, at: usize) -> Option<String> {
    let is_digit = |c: char| c.is_ascii_digit();
    let fraction = &text[at..at + text[at..].find(|c| !is_digit(c)).unwrap_or(text.len() - at)];
    let before = text[..at].strip_suffix(',')?;
    let whole = before.trim_end_matches(is_digit);
    let whole = &before[whole.trim_end_matches('-').len()..];
    (!fraction.is_empty() && whole.ends_with(is_digit)).then(|| format!("{whole}.{fraction}"))
}

/// Advice to write a number that `at` is the second half of with a point.
pub(in super::super) fn decimal_advice(text: &str, at: usize) -> Option<String> {
    decimal_comma(text, at).map(|number| format!("numbers have a decimal point: write `{number}`"))
}
