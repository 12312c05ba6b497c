//! Rows of numbers under named columns, separated by commas, semicolons, tabs or white space.

use std::path::Path;

use super::AssetError;
use super::text::{Lines, finite, number};

/// What stands between two fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Separator {
    Character(char),
    WhiteSpace,
}

/// What the field of a column is for: a place in the caller's row of numbers, or nothing.
pub(super) struct Column {
    pub(super) name: String,
    pub(super) slot: Option<usize>,
}

/// A text table, open for reading.
pub(super) struct Table {
    lines: Lines,
    separator: Separator,
    /// Fields of the first row, be it a header or not.
    pub(super) first: Vec<String>,
    /// Its line.
    pub(super) first_line: usize,
}

impl Table {
    /// Opens a table and looks at its first row; that row is read again as the first row of numbers
    /// unless the caller skips it.
    pub(super) fn open(path: &Path) -> Result<Self, AssetError> {
        let mut lines = Lines::open(path)?;
        let Some((first_line, line)) = lines.next()? else {
            return Err(AssetError::NoRows { file: path.to_owned() });
        };
        let (separator, first) = names(line);
        lines.hold();
        Ok(Self { lines, separator, first, first_line })
    }

    /// Moves past titles to the header that has this column; stays if there is none before the
    /// first row of numbers.
    pub(super) fn seek_header(&mut self, column: &str) -> Result<(), AssetError> {
        let mut title = self.first.clone();
        while !title.iter().any(|name| name == column) {
            let Some((line, text)) = self.lines.next()? else { return Ok(()) };
            let separator;
            (separator, title) = names(text);
            if is_number(title.first()) {
                return Ok(());
            }
            if title.iter().any(|name| name == column) {
                (self.separator, self.first, self.first_line) = (separator, title.clone(), line);
                self.lines.hold();
            }
        }
        Ok(())
    }

    pub(super) fn file(&self) -> &Path {
        self.lines.file()
    }

    /// Whether the first row is one of numbers.
    pub(super) fn has_header(&self) -> bool {
        !is_number(self.first.first())
    }

    /// Leaves the header behind.
    pub(super) fn skip_header(&mut self) -> Result<(), AssetError> {
        self.lines.next().map(|_header| ())
    }

    /// Reads one row into the slots of its columns; gives its line, or `None` at the end.
    pub(super) fn read_row(
        &mut self,
        columns: &[Column],
        row: &mut [f64],
    ) -> Result<Option<usize>, AssetError> {
        let separator = self.separator;
        // Only for the messages: the lines are borrowed while one of them is read.
        let Some((line, text)) = self.lines.next()? else { return Ok(None) };
        let mut bad = None;
        let mut found = 0;
        for field in Fields::new(text, separator) {
            let column = columns.get(found);
            if column.is_none() && field.is_empty() {
                continue;
            }
            found += 1;
            if let Some(Column { name, slot: Some(slot) }) = column {
                match finite(field) {
                    Some(value) => row[*slot] = value,
                    None => bad = bad.or_else(|| Some((name, field.to_owned()))),
                }
            }
        }
        if found != columns.len() {
            let (file, wanted) = (self.file().to_owned(), columns.len());
            return Err(AssetError::WrongFieldCount { file, line, found, wanted });
        }
        match bad {
            Some((name, field)) => {
                number(&field, &format!("column {name:?}"), self.file(), line).map(|_| Some(line))
            }
            None => Ok(Some(line)),
        }
    }
}

fn is_number(field: Option<&String>) -> bool {
    field.is_some_and(|field| field.parse::<f64>().is_ok())
}

/// The fields of a first row, and what stands between them.
fn names(line: &str) -> (Separator, Vec<String>) {
    let separator = [';', ',', '\t'].into_iter().find(|&c| line.contains(c));
    let separator = separator.map_or(Separator::WhiteSpace, Separator::Character);
    let mut names: Vec<String> = Fields::new(line, separator).map(str::to_owned).collect();
    // Spreadsheets fill up short rows with separators.
    while names.last().is_some_and(String::is_empty) {
        names.pop();
    }
    (separator, names)
}

/// Splits a line; quoted fields may hold the separator, and lose their quotes.
struct Fields<'a> {
    rest: Option<&'a str>,
    separator: Separator,
}

impl<'a> Fields<'a> {
    fn new(line: &'a str, separator: Separator) -> Self {
        Self { rest: Some(line), separator }
    }
}

impl<'a> Iterator for Fields<'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        let rest = self.rest?.trim_start_matches([' ', '\r']);
        let is_separator = |c: char| match self.separator {
            Separator::Character(separator) => c == separator,
            Separator::WhiteSpace => c.is_whitespace(),
        };
        let quoted = rest.strip_prefix('"').and_then(|rest| rest.split_once('"'));
        let (field, after) =
            quoted.unwrap_or_else(|| rest.split_at(rest.find(is_separator).unwrap_or(rest.len())));
        // White space around a separator belongs to neither field.
        let after = match self.separator {
            Separator::WhiteSpace => after.trim_start(),
            Separator::Character(_) => after,
        };
        self.rest = match self.separator {
            Separator::WhiteSpace => (!after.is_empty()).then_some(after),
            Separator::Character(_) => after.find(is_separator).map(|at| &after[at + 1..]),
        };
        Some(field.trim())
    }
}

/// The columns of a header; each name must be among `known`, and its place there is its slot.
pub(super) fn known_columns(
    names: &[String],
    known: &[&str],
    file: &Path,
    line: usize,
) -> Result<Vec<Column>, AssetError> {
    let mut columns: Vec<Column> = Vec::with_capacity(names.len());
    for name in names {
        let Some(slot) = known.iter().position(|candidate| candidate == name) else {
            return Err(AssetError::UnknownColumn {
                file: file.to_owned(),
                line,
                column: name.clone(),
                nearest: nearest(name, known),
                known: known.iter().map(|&name| name.to_owned()).collect(),
            });
        };
        if columns.iter().any(|column| column.slot == Some(slot)) {
            let (first, second) = (name.clone(), name.clone());
            return Err(AssetError::RepeatedColumn { file: file.to_owned(), line, first, second });
        }
        columns.push(Column { name: name.clone(), slot: Some(slot) });
    }
    Ok(columns)
}

/// The error that a column is not there.
pub(super) fn missing(column: &str, names: &[String], file: &Path, line: usize) -> AssetError {
    AssetError::MissingColumn {
        file: file.to_owned(),
        line,
        column: column.to_owned(),
        found: names.to_vec(),
    }
}

/// The known name that is most alike, above all at its beginning: units stand at the end.
pub(super) fn nearest(name: &str, known: &[&str]) -> String {
    let alike = |candidate: &str| strsim::jaro_winkler(name, candidate);
    let best = known.iter().min_by(|a, b| alike(b).total_cmp(&alike(a)));
    best.map_or_else(String::new, |&name| name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_split_at_their_separator_only() {
        let split = |line, separator| Fields::new(line, separator).collect::<Vec<_>>();
        let comma = Separator::Character(',');
        assert_eq!(split("1, 2 ,3", comma), ["1", "2", "3"]);
        assert_eq!(split("\"a, b\" , \"c\",", comma), ["a, b", "c", ""]);
        assert_eq!(split("a,,b", comma), ["a", "", "b"]);
        assert_eq!(split("\"open, b", comma), ["\"open", "b"]);
        assert_eq!(split("1  2\t 3", Separator::WhiteSpace), ["1", "2", "3"]);
        assert_eq!(split("1\t\t3", Separator::Character('\t')), ["1", "", "3"]);
    }
}
