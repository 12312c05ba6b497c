//! Rows of numbers under named columns, separated by commas, semicolons, tabs or white space.

use std::path::Path;

use super::AssetError;
use super::format::{self, FileReader};
use super::numbers::{Decimals, NotANumber, Separator, is_missing, looks_like_number};
use super::text::TextLines;

/// Most title lines that are kept.
const MOST_TITLES: usize = 100;

/// Content of the fields of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ColumnContent {
    /// Nothing that is asked for.
    Ignored,
    /// A number for this place in the caller's row.
    Number(usize),
    /// Number; NaN where the field says that there is none.
    NumberOrMissing(usize),
    /// A text for this place in the caller's texts.
    Text(usize),
}

/// A column: its name and what it holds.
pub(super) struct Column {
    pub(super) name: String,
    pub(super) content: ColumnContent,
}

/// A text table, open for reading.
pub(super) struct Table {
    lines: TextLines,
    separator: Separator,
    decimals: Decimals,
    /// Fields of the first row, be it a header or not.
    pub(super) first: Vec<String>,
    /// Its line.
    pub(super) first_line: usize,
    /// Line and number of fields of the first row of numbers below titles.
    pub(super) below_titles: Option<(usize, usize)>,
}

impl Table {
    /// Opens a table and looks at its first row; that row is read again as the first row of numbers
    /// unless the caller skips it.
    pub(super) fn open(path: &Path) -> Result<Self, AssetError> {
        format::check(path, FileReader::Table)?;
        let mut lines = TextLines::open(path)?;
        let Some((first_line, line)) = lines.next()? else {
            return Err(AssetError::NoRows { file: path.to_owned() });
        };
        let (separator, first) = names(line);
        lines.hold();
        Ok(Self {
            lines,
            separator,
            decimals: Decimals::default(),
            first,
            first_line,
            below_titles: None,
        })
    }

    /// Moves past titles to the header that has these columns, or to the last line before the first
    /// row of numbers; returns the titles.
    pub(super) fn seek_header(&mut self, columns: &[&str]) -> Result<Vec<String>, AssetError> {
        let mut titles = Vec::new();
        if !self.has_header() {
            return Ok(titles);
        }
        // The first row is read again.
        while let Some((line, text)) = self.lines.next()? {
            let (separator, fields) = names(text);
            if is_row_of_numbers(&fields) {
                self.below_titles = Some((line, fields.len()));
                self.lines.hold();
                break;
            }
            let is_header = columns.iter().all(|column| fields.iter().any(|name| name == column));
            if titles.len() < MOST_TITLES {
                titles.push(text.to_owned());
            }
            (self.separator, self.first, self.first_line) = (separator, fields, line);
            if is_header {
                break;
            }
        }
        titles.pop();
        Ok(titles)
    }

    pub(super) fn file(&self) -> &Path {
        self.lines.file()
    }

    /// Returns whether the first row names columns.
    pub(super) fn has_header(&self) -> bool {
        !is_row_of_numbers(&self.first)
    }

    /// Leaves the header behind.
    pub(super) fn skip_header(&mut self) -> Result<(), AssetError> {
        self.lines.next().map(|_header| ())
    }

    /// Reads one row into the places of its columns; returns its line, or `None` at the end.
    pub(super) fn read_row(
        &mut self,
        columns: &[Column],
        numbers: &mut [f64],
    ) -> Result<Option<usize>, AssetError> {
        self.read_mixed_row(columns, numbers, &mut [])
    }

    /// Reads the next row of a table that holds texts too.
    ///
    /// Rows in which all fields are empty are skipped: spreadsheets leave them behind.
    pub(super) fn read_mixed_row(
        &mut self,
        columns: &[Column],
        numbers: &mut [f64],
        texts: &mut [String],
    ) -> Result<Option<usize>, AssetError> {
        let Self { lines, separator, decimals, .. } = self;
        let separator = *separator;
        let (line, text) = loop {
            let Some((line, text)) = lines.next()? else { return Ok(None) };
            let is_empty = RowFields::new(text, separator).all(str::is_empty);
            if !is_empty || columns.len() < 2 {
                break (line, text);
            }
        };
        let mut bad = None;
        let mut found = 0;
        for field in RowFields::new(text, separator) {
            let column = columns.get(found);
            if column.is_none() && field.is_empty() {
                continue;
            }
            found += 1;
            let Some(Column { name, content }) = column else { continue };
            match *content {
                ColumnContent::Ignored => {}
                ColumnContent::Text(place) => field.clone_into(&mut texts[place]),
                ColumnContent::NumberOrMissing(place) if is_missing(field) => {
                    numbers[place] = f64::NAN;
                }
                ColumnContent::Number(place) | ColumnContent::NumberOrMissing(place) => {
                    match decimals.read(field, separator, line) {
                        Ok(value) => numbers[place] = value,
                        Err(error) => bad = bad.or_else(|| Some((name, field.to_owned(), error))),
                    }
                }
            }
        }
        let file = || lines.file().to_owned();
        if found != columns.len() {
            let wanted = columns.len();
            let is_of_commas = separator == Separator::Character(',') && found == 2 * wanted;
            let advice = if is_of_commas {
                "; if commas are decimal marks, save the table with `;` between its columns"
            } else {
                ""
            };
            return Err(AssetError::WrongFieldCount { file: file(), line, found, wanted, advice });
        }
        match bad {
            Some((name, field, NotANumber { advice })) => {
                let what = format!("column {name:?}");
                Err(AssetError::bad_number(file(), line, what, &field, advice))
            }
            None => Ok(Some(line)),
        }
    }
}

/// Returns whether fields are a row of numbers, rather than a header or a title: the first is a number, and
/// so is at least half of them.
fn is_row_of_numbers(fields: &[String]) -> bool {
    let numbers = fields.iter().filter(|field| looks_like_number(field) || is_missing(field));
    fields.first().is_some_and(|field| looks_like_number(field))
        && 2 * numbers.count() >= fields.len()
}

/// The fields of a first row, and what stands between them.
fn names(line: &str) -> (Separator, Vec<String>) {
    let separator = [';', '\t', ','].into_iter().find(|&c| line.contains(c));
    let separator = separator.map_or(Separator::WhiteSpace, Separator::Character);
    let mut names: Vec<String> = RowFields::new(line, separator).map(str::to_owned).collect();
    // Spreadsheets fill up short rows with separators.
    while names.last().is_some_and(String::is_empty) {
        names.pop();
    }
    (separator, names)
}

/// Splits a line; quoted fields may hold the separator, and lose their quotes.
struct RowFields<'a> {
    rest: Option<&'a str>,
    separator: Separator,
}

impl<'a> RowFields<'a> {
    fn new(line: &'a str, separator: Separator) -> Self {
        Self { rest: Some(line), separator }
    }
}

impl<'a> Iterator for RowFields<'a> {
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
        if columns.iter().any(|column| column.content == ColumnContent::Number(slot)) {
            let (first, second) = (name.clone(), name.clone());
            return Err(AssetError::RepeatedColumn { file: file.to_owned(), line, first, second });
        }
        columns.push(Column { name: name.clone(), content: ColumnContent::Number(slot) });
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
        let split = |line, separator| RowFields::new(line, separator).collect::<Vec<_>>();
        let comma = Separator::Character(',');
        assert_eq!(split("1, 2 ,3", comma), ["1", "2", "3"]);
        assert_eq!(split("\"a, b\" , \"c\",", comma), ["a, b", "c", ""]);
        assert_eq!(split("a,,b", comma), ["a", "", "b"]);
        assert_eq!(split("\"open, b", comma), ["\"open", "b"]);
        assert_eq!(split("1  2\t 3", Separator::WhiteSpace), ["1", "2", "3"]);
        assert_eq!(split("1\t\t3", Separator::Character('\t')), ["1", "", "3"]);
    }
}
