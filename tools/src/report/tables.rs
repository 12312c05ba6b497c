//! Tables of values.

use maud::{Markup, html};
use sunfleck::output::axis_title;

use super::context::Context;
use super::products::{band_name, place_name, shown_bands};
use super::quantity::{Quantity, thinned};
use super::words::{measured, name, short, title, unit};

/// Maximum numbers of bands and of rows of a table.
const BANDS: usize = 8;
const ROWS: usize = 80;

/// A cell.
pub(super) enum Cell {
    Text(String),
    /// Text, and the number that rows are sorted by.
    Number(String, f64),
}

impl Cell {
    pub(super) fn of_value((value, error): (f64, f64)) -> Self {
        Self::Number(measured(value, error), value)
    }
}

/// A table in a box of its own, which scrolls if it is wide.
pub(super) fn table(caption: &Markup, header: &[String], rows: &[Vec<Cell>]) -> Markup {
    html! {
        div.wide tabindex="0" {
            table.sortable {
                caption { (caption) }
                thead { tr { @for title in header { th scope="col" { (title) } } } }
                tbody {
                    @for row in rows {
                        tr {
                            @for cell in row {
                                @match cell {
                                    Cell::Text(text) if text.chars().count() > 24 => td.long { (name(text)) },
                                    Cell::Text(text) => td { (name(text)) },
                                    Cell::Number(text, value) => td.number data-v=(value) { (text) },
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Products with one value for each band, and single values: tables with a row each; `None` without any.
pub(super) fn key_values(quantities: &[Quantity]) -> Option<Markup> {
    let all = || quantities.iter().filter(|quantity| is_key(quantity));
    let mut bands: Vec<String> = Vec::new();
    let in_views = quantities.iter().filter(|quantity| nadir_place(quantity).is_some());
    for band in all().chain(in_views).filter_map(Quantity::bands).flatten() {
        if !bands.contains(band) {
            bands.push(band.clone());
        }
    }
    let shown: Vec<&String> =
        thinned(bands.len(), BANDS).into_iter().map(|at| &bands[at]).collect();
    let (mut by_band, mut single) = (Vec::new(), Vec::new());
    for quantity in all() {
        for place in 0..quantity.place_count() {
            let mut row = key_cells(quantity, place);
            if let Some(names) = quantity.bands() {
                row.extend(shown.iter().map(|band| {
                    let at = names.iter().position(|name| name == *band);
                    let value = |at| Cell::of_value(quantity.at(place, at));
                    at.map_or(Cell::Text(String::new()), value)
                }));
                by_band.push(row);
            } else {
                row.push(Cell::of_value(quantity.at(place, 0)));
                single.push(row);
            }
        }
    }
    for (quantity, place) in quantities.iter().filter_map(|one| Some((one, nadir_place(one)?))) {
        let names = quantity.bands().unwrap_or_default();
        let mut row = key_cells(quantity, place);
        let nearest = match place_name(quantity, place) {
            nadir if nadir == "nadir" => nadir,
            other => format!("{other}, nearest to nadir"),
        };
        row[1] = Cell::Text(format!("{}: {nearest}", title(&quantity.name)));
        row.extend(shown.iter().map(|band| {
            let at = names.iter().position(|name| name == *band);
            at.map_or(Cell::Text(String::new()), |at| Cell::of_value(quantity.at(place, at)))
        }));
        by_band.push(row);
    }
    if by_band.is_empty() && single.is_empty() {
        return None;
    }
    let header = |last: Vec<String>| -> Vec<String> {
        ["sensor", "quantity", "unit"].map(str::to_owned).into_iter().chain(last).collect()
    };
    let caption = html! {
        "Values by band ± 1 standard error"
        @if shown.len() < bands.len() { "; " (shown.len()) " of " (bands.len()) " bands, all are in the files" }
        "."
    };
    let names = shown.iter().map(|band| short(band)).collect();
    by_band.truncate(4 * ROWS);
    single.truncate(4 * ROWS);
    Some(html! {
        @if !by_band.is_empty() { (table(&caption, &header(names), &by_band)) }
        @if !single.is_empty() {
            (table(&html! { "Single values ± 1 standard error." }, &header(vec!["value".to_owned()]), &single))
        }
    })
}

/// Sensor, name and unit of the values at a place.
fn key_cells(quantity: &Quantity, place: usize) -> Vec<Cell> {
    let texts = quantity.place_texts(place);
    let of_place = match texts.first().map(String::as_str) {
        None | Some("gap" | "lai" | "class") => String::new(),
        Some(text) => format!(": {}", short(text).replace('_', " ")),
    };
    let is_mean = quantity.is_image() && quantity.name != "gap_fraction";
    let mean = if is_mean { ", mean" } else { "" };
    vec![
        Cell::Text(quantity.sensor.clone()),
        Cell::Text(format!("{}{of_place}{mean}", title(&quantity.name))),
        Cell::Text(if quantity.unit == "1" { String::new() } else { unit(&quantity.unit) }),
    ]
}

/// Place of the view that is nearest to the nadir, of a product by view and band that is no part of another one.
fn nadir_place(quantity: &Quantity) -> Option<usize> {
    let is_part = ["_uc", "_co_sgl", "_mlt"].iter().any(|end| quantity.name.ends_with(end));
    if is_part || quantity.is_image() || quantity.places().len() != 1 || is_key(quantity) {
        return None;
    }
    quantity.bands()?;
    let zeniths = quantity.numbers("azimuth_deg").and(quantity.numbers("zenith_deg"))?;
    (0..zeniths.len()).min_by(|&a, &b| zeniths[a].total_cmp(&zeniths[b]))
}

/// Returns true of a product whose values are few enough to stand among the results.
fn is_key(quantity: &Quantity) -> bool {
    let is_wide = quantity
        .dimensions
        .iter()
        .flatten()
        .any(|(axis, _)| axis.ends_with("_deg") || axis.ends_with("_m"));
    (1..=6).contains(&quantity.place_count())
        && !is_wide
        && !is_balance(quantity)
        && quantity.name != "dominant_component"
}

/// Returns true if the results hold all values of a product.
pub(super) fn is_told(quantity: &Quantity) -> bool {
    is_key(quantity) && quantity.band_count() <= BANDS
}

/// Returns true of the balance of a sensor's packets.
pub(super) fn is_balance(quantity: &Quantity) -> bool {
    quantity.name == "energy" || quantity.name == "emitted_energy"
}

/// All values of a product, or some of very many, folded away.
pub(super) fn all_values(context: &Context<'_>, quantity: &Quantity) -> Markup {
    let (bands, _) = shown_bands(quantity, BANDS);
    let places = thinned(quantity.place_count(), ROWS);
    let axes = quantity.places().iter().flatten().map(|(axis, _)| axis_title(&short(axis)));
    let mut header: Vec<String> = axes.collect();
    let of_unit =
        if quantity.unit == "1" { String::new() } else { format!(" ({})", unit(&quantity.unit)) };
    match quantity.bands() {
        Some(_) => header
            .extend(bands.iter().map(|&band| format!("{}{of_unit}", band_name(quantity, band)))),
        None => header.push(format!("value{of_unit}")),
    }
    let rows: Vec<Vec<Cell>> = places
        .iter()
        .map(|&place| {
            let texts = quantity.place_texts(place).into_iter();
            let mut row: Vec<Cell> = texts
                .map(|text| match text.parse::<f64>() {
                    Ok(value) => Cell::Number(text, value),
                    Err(_) => Cell::Text(text),
                })
                .collect();
            row.extend(bands.iter().map(|&band| Cell::of_value(quantity.at(place, band))));
            row
        })
        .collect();
    let some_places = places.len() < quantity.place_count();
    let some_bands = bands.len() < quantity.band_count();
    let caption = html! {
        "Values ± 1 standard error"
        @if some_places { "; " (places.len()) " of " (quantity.place_count()) " rows" }
        @if some_bands { "; " (bands.len()) " of " (quantity.band_count()) " bands with data" }
        "."
        @if let Some(link) = context.table(quantity) { " All: " a href=(link.address) { (link.name) } "." }
    };
    html! {
        details {
            summary { "Values of " (name(&quantity.sensor)) ": " (title(&quantity.name)) }
            (table(&caption, &header, &rows))
        }
    }
}
