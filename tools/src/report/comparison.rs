//! Results of `compare`: values of each transport system, and their differences.

use maud::{Markup, html};
use sunfleck::output::tick;

use super::context::Context;
use super::figure::{Across, ErrorStyle, Figure, Line, NORMAL_95, Panel, Plot, Point};
use super::long_table::{LongProduct, LongTable};
use super::quantity::thinned;
use super::words::{axis_of_values, drawn, short, title};

/// Maximum numbers of figures, of panels of each, and of points of a line.
const FIGURES: usize = 24;
const PANELS: usize = 4;
const POINTS: usize = 300;

/// Values of the systems side by side.
pub(super) fn figures(context: &Context<'_>, table: &LongTable) -> Option<Markup> {
    let is_shared = |product: &&LongProduct| {
        (0..table.points.len()).filter(|&system| has_values(product, system)).count() > 1
    };
    let all: Vec<&LongProduct> = table.products.iter().filter(is_shared).collect();
    if all.is_empty() {
        return None;
    }
    Some(html! {
        p { "Lines are transport systems. Differences are to the reference, over the standard error of both: without bias, 95 % of them lie within ± 1.96." }
        @for product in all.iter().take(FIGURES) {
            (values(context, table, product).markup())
        }
        @if all.len() > FIGURES { p.note { (all.len() - FIGURES) " more products are not shown: see compare.csv." } }
    })
}

fn has_values(product: &LongProduct, system: usize) -> bool {
    (0..product.places.len()).any(|place| {
        (0..product.bands.len()).any(|band| product.at(system, place, band).value.is_finite())
    })
}

/// Values of a product on an axis.
struct Along {
    title: String,
    across: Across,
    /// Bands that have a panel of their own; none if bands are the axis.
    bands: Vec<usize>,
    /// Position, and numbers of place and band; the latter is that of the panel where that has one.
    places: Vec<Place>,
}

#[derive(Clone, Copy)]
struct Place {
    at: f64,
    index: usize,
    band: Option<usize>,
}

impl Along {
    fn new(product: &LongProduct) -> Self {
        let bands = thinned(product.bands.len(), PANELS);
        if product.places.len() == 1 {
            let shown = thinned(product.bands.len(), 16);
            let place =
                |(at, band): (usize, &usize)| Place { at: at as f64, index: 0, band: Some(*band) };
            return Self {
                title: "band".to_owned(),
                across: Across::Labels(
                    shown.iter().map(|&band| short(&product.bands[band])).collect(),
                ),
                bands: Vec::new(),
                places: shown.iter().enumerate().map(place).collect(),
            };
        }
        let numbers = |name: &str| -> Option<Vec<f64>> {
            let column = product.axis(name)?;
            product.places.iter().map(|texts| texts[column].parse().ok()).collect()
        };
        let only = |name: &str| {
            product
                .axes
                .iter()
                .all(|axis| axis == name || axis.ends_with("_deg") || axis == "top_m")
        };
        let numbered = numbers("signed_zenith_deg")
            .filter(|_| only("signed_zenith_deg"))
            .map(|all| (all, "view zenith (°), + towards the sun"))
            .or_else(|| {
                numbers("bottom_m")
                    .filter(|_| only("bottom_m"))
                    .map(|all| (all, "bottom of the layer (m)"))
            });
        if let Some((all, title)) = numbered {
            let mut places: Vec<Place> = all
                .into_iter()
                .zip(0..)
                .map(|(at, place)| Place { at, index: place, band: None })
                .collect();
            places.sort_by(|a, b| a.at.total_cmp(&b.at));
            let shown = thinned(places.len(), POINTS).into_iter().map(|at| places[at]).collect();
            return Self { title: title.to_owned(), across: Across::Numbers, bands, places: shown };
        }
        let shown = thinned(product.places.len(), 12);
        let label = |&place: &usize| {
            let texts = product.places[place].iter();
            let texts = texts.map(|text| text.parse().map_or_else(|_| short(text), tick));
            texts.collect::<Vec<_>>().join(" ").replace("absorbed.", "")
        };
        let axes: Vec<String> =
            product.axes.iter().map(|axis| short(axis).replace('_', " ")).collect();
        Self {
            title: axes.join(", "),
            across: Across::Labels(shown.iter().map(label).collect()),
            bands,
            places: shown
                .into_iter()
                .enumerate()
                .map(|(at, place)| Place { at: at as f64, index: place, band: None })
                .collect(),
        }
    }

    /// Bands of the panels; a single panel of all if bands are the axis.
    fn panels(&self) -> Vec<Option<usize>> {
        if self.bands.is_empty() {
            vec![None]
        } else {
            self.bands.iter().map(|&band| Some(band)).collect()
        }
    }
}

fn values(context: &Context<'_>, table: &LongTable, product: &LongProduct) -> Figure {
    let along = Along::new(product);
    let systems: Vec<usize> =
        (0..table.points.len()).filter(|&system| has_values(product, system)).collect();
    // Systems stand beside each other where a place is a name.
    let aside = |number: usize| match along.across {
        Across::Labels(_) => 0.5 * ((number as f64 + 0.5) / systems.len() as f64 - 0.5),
        _ => 0.0,
    };
    let panel = |panel: Option<usize>, scores: bool| {
        let lines = systems.iter().enumerate().map(|(number, &system)| {
            let points = along.places.iter().map(|place| {
                let found = product.at(system, place.index, place.band.or(panel).unwrap_or(0));
                let at = place.at + aside(number);
                if scores {
                    Point { at, value: found.score, error: f64::NAN }
                } else {
                    Point { at, value: found.value, error: found.error }
                }
            });
            Line { name: system_name(table, system), colour: system, points: points.collect() }
        });
        let title = panel.map_or_else(String::new, |band| short(&product.bands[band]));
        Panel { title, scale: 0, x_title: None, lines: lines.collect(), marks: Vec::new() }
    };
    let plot = |scores: bool| Plot {
        x_title: along.title.clone(),
        y_title: if scores {
            "difference (standard errors)".to_owned()
        } else {
            axis_of_values(&product.name, &product.unit)
        },
        across: along.across.clone(),
        is_profile: false,
        errors: ErrorStyle::Bars,
        panels: along
            .panels()
            .into_iter()
            .map(|band| panel(band, scores))
            .filter(is_known)
            .collect(),
        guides: if scores { vec![-NORMAL_95, 0.0, NORMAL_95] } else { Vec::new() },
    };
    let (values, scores) = (plot(false), plot(true));
    let fewer = (along.bands.len() < product.bands.len() && !along.bands.is_empty())
        .then(|| format!("{}.", drawn(along.bands.len(), product.bands.len(), "bands")));
    let note = values.error_note();
    Figure {
        panels: values.draw().into_iter().chain(scores.draw()).collect(),
        legend: (0..table.points.len()).map(|system| system_name(table, system)).collect(),
        bar: None,
        title: format!("{}: {}", short(&product.sensor), title(&product.name)),
        caption: [note, fewer].into_iter().flatten().collect(),
        data: Some(context.link("compare.csv")),
    }
}

fn is_known(panel: &Panel) -> bool {
    panel.lines.iter().flat_map(|line| &line.points).any(|point| point.value.is_finite())
}

fn system_name(table: &LongTable, system: usize) -> String {
    short(table.points[system].first().map_or("", String::as_str))
}
