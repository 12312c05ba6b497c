//! Tables of a file as they are, or some rows of long ones.

use std::path::Path;

use anyhow::Context as _;
use maud::{Markup, html};
use sunfleck::output::axis_title;

use super::context::Context;
use super::quantity::thinned;
use super::tables::{Cell, table};
use super::words::{number, short};

/// Maximum numbers of rows and columns.
const ROWS: usize = 120;
const COLUMNS: usize = 24;

/// Rows of a CSV file of the results under a title; `None` if there is no such file.
pub(super) fn csv_table(
    context: &Context<'_>,
    file: &str,
    title: &str,
) -> anyhow::Result<Option<Markup>> {
    if !context.has(file) {
        return Ok(None);
    }
    let path = context.results.folder.join(file);
    let CsvRows { header, rows, count } = read(&path).with_context(|| {
        format!("{} is damaged: run the command again that made it", path.display())
    })?;
    let link = context.link(file);
    let caption = html! {
        (title)
        @if rows.len() < count { "; " (rows.len()) " of " (count) " rows" }
        ". Data: " a href=(link.address) { (link.name) } "."
    };
    Ok(Some(table(&caption, &header, &rows)))
}

struct CsvRows {
    header: Vec<String>,
    rows: Vec<Vec<Cell>>,
    /// Number of rows in the file.
    count: usize,
}

fn read(path: &Path) -> anyhow::Result<CsvRows> {
    let mut reader = csv::Reader::from_path(path)?;
    let header: Vec<String> = reader.headers()?.iter().take(COLUMNS).map(str::to_owned).collect();
    let mut row = csv::StringRecord::new();
    let mut count = 0;
    while reader.read_record(&mut row)? {
        count += 1;
    }
    let shown = thinned(count, ROWS);
    let mut wanted = shown.iter().peekable();
    let mut reader = csv::Reader::from_path(path)?;
    let (mut rows, mut used) = (Vec::new(), vec![false; header.len()]);
    let mut at = 0;
    while reader.read_record(&mut row)? {
        if wanted.next_if_eq(&&at).is_some() {
            for (used, text) in used.iter_mut().zip(row.iter()) {
                *used |= !text.is_empty();
            }
            rows.push(row.iter().take(COLUMNS).map(cell).collect::<Vec<Cell>>());
        }
        at += 1;
    }
    // Columns of axes that no row has say nothing.
    let keep = |values: Vec<Cell>| -> Vec<Cell> {
        values.into_iter().zip(&used).filter(|(_, used)| **used).map(|(cell, _)| cell).collect()
    };
    let rows = rows.into_iter().map(keep).collect();
    let names = header.iter().zip(&used).filter(|(_, used)| **used);
    let header = names.map(|(name, _)| axis_title(&short(name))).collect();
    Ok(CsvRows { header, rows, count })
}

fn cell(text: &str) -> Cell {
    match text.parse::<f64>() {
        Ok(value) if value.fract() == 0.0 && value.abs() < 1e15 => {
            Cell::Number(format!("{value}"), value)
        }
        Ok(value) => Cell::Number(number(value, 5), value),
        Err(_) => Cell::Text(text.to_owned()),
    }
}
