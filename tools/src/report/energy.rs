//! Where the light of a run of packets goes.

use maud::{Markup, html};
use sunfleck::counts::counted;

use super::context::Context;
use super::figure::{Bar, COLOURS, Figure, Segment, stack};
use super::products::{band_name, shown_bands};
use super::quantity::Quantity;
use super::tables::{all_values, is_balance};
use super::words::{measured, number, short};

/// Maximum number of bars.
const BARS: usize = 12;
/// Part of the whole below which a term is not drawn.
const LEAST: f64 = 1e-6;

/// Balance of each sensor of photons; `None` without such a sensor.
pub(super) fn section(context: &Context<'_>) -> Option<Markup> {
    let has_light = |quantity: &&Quantity| quantity.values.iter().any(|value| *value > 0.0);
    let quantities: Vec<&Quantity> =
        context.results.quantities.iter().filter(|one| is_balance(one)).filter(has_light).collect();
    if quantities.is_empty() {
        return None;
    }
    Some(html! {
        p { "Where the light of each sensor's packets goes. Bars are as long as what comes in." }
        @for quantity in quantities {
            (balance(context, quantity).markup())
            (all_values(context, quantity))
        }
    })
}

/// A term of the balance.
struct Term {
    name: String,
    place: usize,
}

fn balance(context: &Context<'_>, quantity: &Quantity) -> Figure {
    let (bands, note) = shown_bands(quantity, BARS);
    let incident = (0..quantity.place_count())
        .find(|&place| quantity.place_texts(place).first().is_some_and(|name| name == "incident"));
    let size = |place: usize| -> f64 {
        bands.iter().map(|&band| quantity.at(place, band).0.abs()).fold(0.0, f64::max)
    };
    let whole = incident.map_or(1.0, size);
    let mut terms: Vec<Term> = (0..quantity.place_count())
        .filter(|&place| Some(place) != incident && size(place) > LEAST * whole)
        .map(|place| Term {
            name: short(quantity.place_texts(place).first().map_or("", String::as_str))
                .replace("absorbed.", "absorbed by "),
            place,
        })
        .collect();
    // Roulette is noise about zero, and cannot be drawn as a part.
    terms.retain(|term| term.name != "roulette");
    // The last colour stands for one term, or for several.
    let others = if terms.len() > COLOURS { terms.split_off(COLOURS - 1) } else { Vec::new() };
    let bar = |&band: &usize| {
        let mut segments: Vec<Segment> = terms
            .iter()
            .enumerate()
            .map(|(colour, term)| {
                let (value, error) = quantity.at(term.place, band);
                Segment {
                    colour,
                    size: value,
                    label: number(value, 3),
                    tooltip: format!(
                        "{}, {}: {}",
                        band_name(quantity, band),
                        term.name,
                        measured(value, error)
                    ),
                }
            })
            .collect();
        if !others.is_empty() {
            let rest: f64 = others.iter().map(|term| quantity.at(term.place, band).0).sum();
            segments.push(Segment {
                colour: COLOURS - 1,
                size: rest,
                label: number(rest, 3),
                tooltip: format!(
                    "{}, {}: {}",
                    band_name(quantity, band),
                    counted(others.len(), "more term"),
                    number(rest, 4)
                ),
            });
        }
        Bar { name: band_name(quantity, band), segments }
    };
    let has_light =
        |band: &&usize| (0..quantity.place_count()).any(|place| quantity.at(place, **band).0 > 0.0);
    let bars: Vec<Bar> = bands.iter().filter(has_light).map(bar).collect();
    let mut legend: Vec<String> = terms.iter().map(|term| term.name.clone()).collect();
    if !others.is_empty() {
        legend.push(counted(others.len(), "more term"));
    }
    let what =
        if quantity.name == "energy" { "energy balance" } else { "balance of emitted light" };
    let what_is_drawn = if quantity.unit == "1" {
        "Fractions of the power of sun and sky on the terrain's rectangle."
    } else {
        "Emitted light, W m⁻² nm⁻¹ over the terrain's rectangle."
    };
    let run = context.results.summary.runs.get(&quantity.sensor);
    let closing = run.and_then(|run| run.energy_imbalance).map(|missing| {
        format!(
            "All terms with roulette sum to what comes in but for {}.",
            number(missing.abs(), 2)
        )
    });
    let title = format!("{}: {what}", short(&quantity.sensor));
    Figure {
        bar: None,
        panels: vec![stack(&bars, &title)],
        legend,
        caption: [Some(what_is_drawn.to_owned()), closing, note].into_iter().flatten().collect(),
        title,
        data: context.table(quantity),
    }
}
