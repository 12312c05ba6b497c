//! Figures of values by direction.

use sunfleck::output::are_unlike;

use super::context::Context;
use super::figure::{
    Across, ErrorStyle, Figure, Hemisphere, Line, Mark, Panel, Plot, Point, View, colour_bar,
    common_range,
};
use super::planes::{Plane, planes};
use super::products::{LINES, PANELS, POINTS, band_name, caption, heading, legend, shown_bands};
use super::quantity::{Quantity, thinned};
use super::words::{axis_of_values, number};

/// Maximum number of views of a hemisphere that are drawn.
const VIEWS: usize = 1500;

/// Figures of a product by direction: in planes through the nadir, or all over the hemisphere.
pub(super) fn directions(context: &Context<'_>, quantity: &Quantity) -> Vec<Figure> {
    match planes(quantity, context.sun) {
        Some(planes) => in_planes(context, quantity, &planes).into_iter().collect(),
        None => hemisphere(context, quantity).into_iter().collect(),
    }
}

/// Values in vertical planes through the nadir: a panel a plane, a line a band.
fn in_planes(context: &Context<'_>, quantity: &Quantity, planes: &[Plane]) -> Option<Figure> {
    if planes.iter().all(|plane| plane.places.len() < 2) {
        return None;
    }
    let (bands, note) = shown_bands(quantity, LINES.min(PANELS / planes.len()));
    let line = |plane: &Plane, (colour, &band): (usize, &usize)| {
        let points = thinned(plane.places.len(), POINTS).into_iter().map(|at| {
            let place = &plane.places[at];
            let (value, error) = quantity.at(place.index, band);
            Point { at: place.signed_zenith, value, error }
        });
        Line { name: band_name(quantity, band), colour, points: points.collect() }
    };
    let panel = |plane: &Plane, lines: Vec<Line>| Panel {
        title: if planes.len() > 1 { plane.name.clone() } else { String::new() },
        scale: 0,
        x_title: Some(plane.axis.to_owned()),
        marks: plane.hot_spot.map(sun_mark).into_iter().collect(),
        lines,
    };
    let all = |plane: &Plane| {
        panel(plane, bands.iter().enumerate().map(|band| line(plane, band)).collect())
    };
    let joint: Vec<Panel> = planes.iter().map(all).collect();
    let panels = if are_unlike_bands(&joint) {
        // A band has the same axis in all planes.
        let mut single = Vec::new();
        for (number, band) in bands.iter().enumerate() {
            for plane in planes {
                let alone = panel(plane, vec![line(plane, (number, band))]);
                let names = [band_name(quantity, *band), alone.title.clone()];
                let names: Vec<String> =
                    names.into_iter().filter(|name| !name.is_empty()).collect();
                single.push(Panel { title: names.join(", "), scale: number, ..alone });
            }
        }
        single
    } else {
        joint
    };
    let plot = Plot {
        x_title: planes[0].axis.to_owned(),
        y_title: axis_of_values(&quantity.name, &quantity.unit),
        across: Across::Numbers,
        is_profile: false,
        errors: ErrorStyle::Areas,
        panels,
        guides: Vec::new(),
    };
    let what = if let [plane] = planes { format!(" in the {}", plane.name) } else { String::new() };
    let sun = planes.iter().any(|plane| plane.hot_spot.is_some()).then(|| SUN_NOTE.to_owned());
    let notes = [note, sun, plot.scale_note(), plot.error_note()];
    Some(Figure {
        panels: plot.draw(),
        legend: legend(quantity, &bands),
        bar: None,
        title: heading(quantity, &what),
        caption: caption(quantity, notes),
        data: context.table(quantity),
    })
}

/// Sentences about the principal plane.
pub(super) const SUN_NOTE: &str = "Positive zenith angles are views from the side of the sun (backward scattering), negative ones from the opposite side (forward scattering). The dashed line is the direction of the sun, where the hot spot is.";

/// The place of the sun in the principal plane.
pub(super) fn sun_mark(zenith: f64) -> Mark {
    Mark { at: zenith, name: "sun".to_owned(), colour: None }
}

/// Returns true if lines of the same number are so unlike others in size that they need panels of their own.
fn are_unlike_bands(panels: &[Panel]) -> bool {
    let peak = |number: usize| {
        let of_panel = |panel: &Panel| {
            let line = panel.lines.get(number).cloned();
            Panel { lines: line.into_iter().collect(), ..panel.clone() }.peak()
        };
        panels.iter().map(of_panel).fold(0.0, f64::max)
    };
    are_unlike((0..panels.first().map_or(0, |panel| panel.lines.len())).map(peak))
}

/// Values all over the hemisphere: a panel a band.
fn hemisphere(context: &Context<'_>, quantity: &Quantity) -> Option<Figure> {
    let (zeniths, azimuths) = (quantity.numbers("zenith_deg")?, quantity.numbers("azimuth_deg")?);
    if zeniths.len() > VIEWS || quantity.places().len() > 1 {
        return None;
    }
    let (bands, note) = shown_bands(quantity, 3);
    let are_cells = quantity.name.contains("_cells");
    let hemisphere = |&band: &usize| {
        let views = zeniths.iter().zip(azimuths).enumerate().map(|(place, (&zenith, &azimuth))| {
            let (value, error) = quantity.at(place, band);
            View { zenith, azimuth, value, error }
        });
        let title = band_name(quantity, band);
        Hemisphere { title, views: views.collect(), sun: context.sun, are_cells }
    };
    let all: Vec<Hemisphere> = bands.iter().map(hemisphere).collect();
    let common = common_range(&all);
    let sun = context
        .sun
        .map(|_| "The ring with a dot is the sun's direction, where the hot spot is.".to_owned());
    let error = quantity.relative_error().map(|error| {
        format!("Median standard error: {} % of the value.", number(100.0 * error, 2))
    });
    let values = axis_of_values(&quantity.name, &quantity.unit);
    let bars = common.is_none().then(|| format!("Colours are {values}."));
    let seen = "Distance from the centre is the view zenith angle, north is at the top.".to_owned();
    Some(Figure {
        panels: all.iter().map(|one| one.draw(common.as_ref())).collect(),
        legend: Vec::new(),
        bar: common.as_ref().map(|range| colour_bar(range, &values)),
        title: heading(quantity, " by view direction"),
        caption: caption(quantity, [Some(seen), bars, sun, error, note]),
        data: context.table(quantity),
    })
}
