//! Numbers in tables: decimal points and commas, separators of thousands, marks of missing values.

use super::text::finite;

/// Separator of two fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Separator {
    Character(char),
    WhiteSpace,
}

/// Decimal marks that the rows of a table have had so far.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Decimals {
    /// First line with a decimal point.
    point: Option<usize>,
    /// First line with a decimal comma.
    comma: Option<usize>,
}

/// Error of a field that is no number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct NotANumber {
    /// Text to write instead, if it can be known.
    pub(super) advice: Option<String>,
}

impl Decimals {
    /// The number of a field; decimal commas are read where commas do not separate fields.
    pub(super) fn read(
        &mut self,
        field: &str,
        separator: Separator,
        line: usize,
    ) -> Result<f64, NotANumber> {
        let wrong = |advice: String| Err(NotANumber { advice: Some(advice) });
        if let Some(value) = finite(field) {
            if field.contains('.') {
                self.point.get_or_insert(line);
                if let Some(comma) = self.comma {
                    return wrong(mixed(comma, "comma", "point"));
                }
            }
            return Ok(value);
        }
        let Some((before, after)) = field.split_once(',') else {
            return Err(NotANumber { advice: None });
        };
        let digits = before.trim_start_matches(['+', '-']);
        let is_grouped = after.contains([',', '.']) || before.contains('.');
        let Some(value) = finite(&format!("{before}.{after}")).filter(|_| !is_grouped) else {
            let plain = ungrouped(field);
            return match plain {
                Some(plain) => wrong(format!("take the separators of thousands out: `{plain}`")),
                None => Err(NotANumber { advice: None }),
            };
        };
        let may_be_thousands =
            after.len() == 3 && (1..=3).contains(&digits.len()) && !digits.starts_with('0');
        match separator {
            Separator::Character(',') => {
                return wrong(format!(
                    "write `{before}.{after}` if that is its decimal comma, or save the table with `;` \
                     between its columns"
                ));
            }
            Separator::Character(';') => {}
            _ if may_be_thousands => {
                return wrong(format!(
                    "write `{before}.{after}` if that is its decimal comma, `{before}{after}` if it \
                     separates thousands"
                ));
            }
            _ => {}
        }
        self.comma.get_or_insert(line);
        match self.point {
            Some(point) => wrong(mixed(point, "point", "comma")),
            None => Ok(value),
        }
    }
}

fn mixed(line: usize, first: &str, now: &str) -> String {
    format!("line {line} has a decimal {first}, this one a decimal {now}: write all alike")
}

/// A number without the separators of its thousands, if that is what it has.
fn ungrouped(field: &str) -> Option<String> {
    let last = field.rfind([',', '.'])?;
    let (whole, fraction) = field.split_at(last);
    let mark = fraction.chars().next()?;
    let (whole, fraction) = if whole.contains(mark) {
        // 1,234,567 has no fraction.
        (field.replace([',', '.'], ""), String::new())
    } else {
        (whole.replace([',', '.'], ""), format!(".{}", &fraction[1..]))
    };
    let text = format!("{whole}{fraction}");
    finite(&text).map(|_| text)
}

/// Returns whether a field says that there is no value.
pub(super) fn is_missing(field: &str) -> bool {
    const MARKS: [&str; 10] = ["", "na", "n/a", "#n/a", "nan", "null", "none", "-", "--", "*"];
    let field = field.trim();
    MARKS.iter().any(|mark| mark.eq_ignore_ascii_case(field))
}

/// Returns whether a field looks like a number, its decimal mark whichever.
pub(super) fn looks_like_number(field: &str) -> bool {
    let has_digit = field.contains(|c: char| c.is_ascii_digit());
    has_digit && (field.parse::<f64>().is_ok() || ungrouped(field).is_some())
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEMICOLON: Separator = Separator::Character(';');
    const COMMA: Separator = Separator::Character(',');
    const TAB: Separator = Separator::Character('\t');

    fn read(field: &str, separator: Separator) -> Option<f64> {
        Decimals::default().read(field, separator, 1).ok()
    }

    fn advice(field: &str, separator: Separator) -> String {
        let error = Decimals::default().read(field, separator, 1).expect_err(field);
        error.advice.expect(field)
    }

    #[test]
    fn decimal_commas_are_read_where_commas_separate_nothing() {
        assert_eq!(read("10,5", SEMICOLON), Some(10.5));
        assert_eq!(read("-0,052", TAB), Some(-0.052));
        assert_eq!(read("500010,125", Separator::WhiteSpace), Some(500_010.125));
        assert_eq!(read("1,5e3", SEMICOLON), Some(1500.0));
        assert_eq!(read("12,125", SEMICOLON), Some(12.125));
        assert!(advice("10,5", COMMA).contains("`10.5`"));
        assert!(advice("12,125", TAB).contains("`12125`"));
        assert!(advice("1,010.5", COMMA).contains("`1010.5`"));
        assert!(advice("1.010,5", SEMICOLON).contains("`1010.5`"));
        assert!(advice("1,234,567", SEMICOLON).contains("`1234567`"));
        assert_eq!(Decimals::default().read("a,b", TAB, 1), Err(NotANumber { advice: None }));
    }

    #[test]
    fn a_table_has_one_decimal_mark() {
        let mut decimals = Decimals::default();
        assert_eq!(decimals.read("10", SEMICOLON, 1), Ok(10.0));
        assert_eq!(decimals.read("10,5", SEMICOLON, 2), Ok(10.5));
        let error = decimals.read("10.5", SEMICOLON, 3).expect_err("two marks");
        assert!(error.advice.is_some_and(|advice| advice.contains("line 2")));
    }
}
