//! What a person is told about an import.

use std::cell::RefCell;
use std::fmt::Write as _;

/// What became of the settings that sunfleck has no equal of.
#[derive(Debug, Default)]
pub(super) struct Report {
    rows: RefCell<Vec<[String; 3]>>,
}

impl Report {
    /// Says what became of a setting.
    pub(super) fn add(&self, setting: &str, value: &str, what: impl Into<String>) {
        let row = [setting.to_owned(), value.to_owned(), what.into()];
        let mut rows = self.rows.borrow_mut();
        if !rows.contains(&row) {
            rows.push(row);
        }
    }

    /// A line for each setting, in columns.
    pub(super) fn lines(&self) -> Vec<String> {
        let rows = self.rows.borrow();
        let width =
            |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
        let (first, second) = (width(0), width(1));
        let line = |[setting, value, what]: &[String; 3]| {
            format!("{setting:first$}  {value:second$}  {what}")
        };
        rows.iter().map(line).collect()
    }

    /// The table for a terminal.
    pub(super) fn table(&self) -> String {
        let mut text = String::new();
        for line in self.lines() {
            // Writing to a string cannot fail.
            let _infallible = writeln!(text, "  {line}");
        }
        text
    }
}
