//! Figures of products, chosen by their axes.

use super::context::Context;
use super::directions::directions;
use super::figure::{Across, ErrorStyle, Figure, Line, Panel, Plot, Point};
use super::quantity::{Quantity, thinned};
use super::summary::Points;
use super::words::{axis_of_values, definition, drawn, short, title};
use sunfleck::output::tick;

/// Maximum numbers of lines of a panel, of panels, and of bands where there are several places.
pub(super) const LINES: usize = 6;
pub(super) const PANELS: usize = 12;
/// Number of bands from which on values are drawn as a spectrum.
const SPECTRUM: usize = 5;
/// Maximum number of points of a line.
pub(super) const POINTS: usize = 400;

/// Figures of a product; none of one that a table tells better.
pub(super) fn figures(context: &Context<'_>, quantity: &Quantity) -> Vec<Figure> {
    let Some(first) = quantity.dimensions.first().and_then(|axes| axes.first()) else {
        return Vec::new();
    };
    if quantity.values.iter().all(|value| !value.is_finite()) {
        return Vec::new();
    }
    // Parts of a hemisphere by order of scattering are in the tables alone.
    let is_part = ["_uc", "_co_sgl", "_mlt"].iter().any(|end| quantity.name.ends_with(end));
    let mut figures: Vec<Figure> = match first.0.as_str() {
        "zenith_deg" if is_part && quantity.name.contains("_cells") => return Vec::new(),
        "zenith_deg" => directions(context, quantity),
        "bottom_m" => profile(context, quantity).into_iter().collect(),
        _ => Vec::new(),
    };
    figures.extend(spectrum(context, quantity));
    figures
}

/// Returns true of an image by band, whose means are drawn together with those of other images.
pub(super) fn is_joint(quantity: &Quantity) -> bool {
    quantity.is_image() && quantity.bands().is_some() && quantity.places().is_empty()
}

/// Means of the images of each quantity, with a place for each sensor.
pub(super) fn joint_images(quantities: &[Quantity]) -> Vec<Quantity> {
    let mut all: Vec<Quantity> = Vec::new();
    for quantity in quantities.iter().filter(|quantity| is_joint(quantity)) {
        let is_alike = |other: &&mut Quantity| {
            (&other.name, &other.unit, other.bands())
                == (&quantity.name, &quantity.unit, quantity.bands())
        };
        if let Some(joint) = all.iter_mut().find(is_alike) {
            joint.values.extend(&quantity.values);
            joint.errors.extend(&quantity.errors);
            if let Some((_, Points::Labels(sensors))) = joint.dimensions[0].first_mut() {
                sensors.push(quantity.sensor.clone());
            }
        } else {
            let sensors = Points::Labels(vec![quantity.sensor.clone()]);
            let mut joint = Quantity { sensor: "images".to_owned(), ..quantity.clone() };
            joint.dimensions.insert(0, vec![("sensor".to_owned(), sensors)]);
            all.push(joint);
        }
    }
    all
}

/// Numbers of the bands that are shown, and a sentence about those that are not.
pub(super) fn shown_bands(quantity: &Quantity, most: usize) -> (Vec<usize>, Option<String>) {
    let is_known = |band: &usize| {
        (0..quantity.place_count()).any(|place| quantity.at(place, *band).0.is_finite())
    };
    let known: Vec<usize> = (0..quantity.band_count()).filter(is_known).collect();
    let shown: Vec<usize> = thinned(known.len(), most).into_iter().map(|at| known[at]).collect();
    let left_out = known.len() - shown.len();
    let note = format!("{}; the table has all.", drawn(shown.len(), known.len(), "bands"));
    (shown, (left_out > 0).then_some(note))
}

/// Name of a band; empty of a product without bands.
pub(super) fn band_name(quantity: &Quantity, band: usize) -> String {
    quantity.bands().map_or_else(String::new, |bands| short(&bands[band]))
}

pub(super) fn caption(
    quantity: &Quantity,
    notes: impl IntoIterator<Item = Option<String>>,
) -> Vec<String> {
    let defined = definition(&quantity.name).map(str::to_owned);
    std::iter::once(defined).chain(notes).flatten().collect()
}

pub(super) fn heading(quantity: &Quantity, what: &str) -> String {
    format!("{}: {}{what}", short(&quantity.sensor), title(&quantity.name))
}

/// Names of bands as a legend; none for a single line.
pub(super) fn legend(quantity: &Quantity, bands: &[usize]) -> Vec<String> {
    if bands.len() < 2 && quantity.band_count() < 2 {
        return Vec::new();
    }
    bands.iter().map(|&band| band_name(quantity, band)).collect()
}

/// Values by height: a panel a band, a line a material.
fn profile(context: &Context<'_>, quantity: &Quantity) -> Option<Figure> {
    let (bottoms, tops) = (quantity.numbers("bottom_m")?, quantity.numbers("top_m")?);
    let layers = bottoms.len();
    if layers < 2 {
        return None;
    }
    let (bands, note) = shown_bands(quantity, 4);
    let groups = quantity.place_count() / layers;
    let group_of = |place: usize| place % groups.max(1);
    // Number of layers where something is.
    let lit_layers = |group: usize| {
        let is_lit = |layer: &usize| {
            bands.iter().any(|&band| quantity.at(layer * groups + group, band).0 > 0.0)
        };
        (0..layers).filter(is_lit).count()
    };
    let mut lit: Vec<usize> = (0..groups).filter(|&group| lit_layers(group) > 0).collect();
    // What is in one layer alone, as level ground, is no profile, and would hide those of the others.
    let (single, others): (Vec<usize>, Vec<usize>) =
        lit.iter().partition(|&&group| lit_layers(group) == 1);
    if !others.is_empty() {
        lit = others;
    }
    let shown: Vec<usize> = thinned(lit.len(), LINES).into_iter().map(|at| lit[at]).collect();
    let name_of = |group: usize| {
        // The first two texts of a place are the bounds of its layer.
        let texts = quantity.place_texts(group_of(group));
        texts.get(2..).map_or_else(String::new, |names| short(&names.join(", ")))
    };
    let panel = |&band: &usize| Panel {
        title: band_name(quantity, band),
        scale: 0,
        x_title: None,
        marks: Vec::new(),
        lines: shown
            .iter()
            .enumerate()
            .map(|(colour, &group)| {
                let points = thinned(layers, POINTS).into_iter().map(|layer| {
                    let (value, error) = quantity.at(layer * groups + group, band);
                    Point { at: 0.5 * (bottoms[layer] + tops[layer]), value, error }
                });
                Line { name: name_of(group), colour, points: points.collect() }
            })
            .collect(),
    };
    let plot = Plot {
        x_title: "height (m)".to_owned(),
        y_title: axis_of_values(&quantity.name, &quantity.unit),
        across: Across::Numbers,
        is_profile: true,
        errors: ErrorStyle::Areas,
        panels: bands.iter().map(panel).collect(),
        guides: Vec::new(),
    };
    let single =
        (lit.len() < groups && !single.is_empty() && !lit.contains(&single[0])).then(|| {
            let names: Vec<String> =
                single.iter().take(LINES).map(|&group| name_of(group)).collect();
            format!("Not drawn, as it is in one layer alone: {}.", names.join(", "))
        });
    let missing = (lit.len() > shown.len())
        .then(|| format!("{}; the table has all.", drawn(shown.len(), lit.len(), "lines")));
    Some(Figure {
        panels: plot.draw(),
        legend: if groups > 1 {
            shown.iter().map(|&group| name_of(group)).collect()
        } else {
            Vec::new()
        },
        bar: None,
        title: heading(quantity, ", middles of layers"),
        caption: caption(quantity, [single, note, missing, plot.scale_note(), plot.error_note()]),
        data: context.table(quantity),
    })
}

/// Values by wavelength where there are many bands: a line a place, at most a few of them.
fn spectrum(context: &Context<'_>, quantity: &Quantity) -> Option<Figure> {
    let bands = quantity.bands().filter(|bands| bands.len() >= SPECTRUM)?;
    let is_of_energy = quantity.name == "energy" || quantity.name == "emitted_energy";
    if quantity.places().len() > 1 || is_of_energy {
        return None;
    }
    let waves: Option<Vec<f64>> =
        bands.iter().map(|band| context.results.wavelength(band)).collect();
    let waves = waves.filter(|waves| waves.iter().all(|nm| *nm > 0.0));
    let mut order = thinned(bands.len(), POINTS);
    let across = if let Some(waves) = &waves {
        order.sort_by(|&a, &b| waves[a].total_cmp(&waves[b]));
        let is_wide = waves[order[order.len() - 1]] > 6.0 * waves[order[0]];
        if is_wide { Across::Logarithm } else { Across::Numbers }
    } else {
        order = thinned(bands.len(), 24);
        Across::Labels(order.iter().map(|&band| short(&bands[band])).collect())
    };
    let places = spectrum_places(context, quantity);
    let line = |(colour, &place): (usize, &usize)| {
        let points = order.iter().enumerate().map(|(at, &band)| {
            let (value, error) = quantity.at(place, band);
            Point { at: waves.as_ref().map_or(at as f64, |waves| waves[band]), value, error }
        });
        Line { name: place_name(quantity, place), colour, points: points.collect() }
    };
    let plot = Plot {
        x_title: if waves.is_some() { "wavelength (nm)" } else { "band" }.to_owned(),
        y_title: axis_of_values(&quantity.name, &quantity.unit),
        across,
        is_profile: false,
        errors: ErrorStyle::Areas,
        panels: vec![Panel {
            title: String::new(),
            scale: 0,
            x_title: None,
            lines: places.iter().enumerate().map(line).collect(),
            marks: Vec::new(),
        }],
        guides: Vec::new(),
    };
    let missing = (places.len() < quantity.place_count()).then(|| {
        format!("{}; the table has all.", drawn(places.len(), quantity.place_count(), "lines"))
    });
    let fewer = (order.len() < bands.len())
        .then(|| format!("{}; the table has all.", drawn(order.len(), bands.len(), "bands")));
    let mean = quantity.is_image().then(|| "Means of the images.".to_owned());
    Some(Figure {
        panels: plot.draw(),
        legend: if places.len() > 1 {
            places.iter().map(|&place| place_name(quantity, place)).collect()
        } else {
            Vec::new()
        },
        bar: None,
        title: heading(quantity, ", spectrum"),
        caption: caption(quantity, [mean, missing, fewer, plot.error_note()]),
        data: context.table(quantity),
    })
}

/// Places whose spectra are drawn: of directions the nadir, the hot spot and the most slanted one, else an even choice.
fn spectrum_places(context: &Context<'_>, quantity: &Quantity) -> Vec<usize> {
    let Some((zeniths, azimuths)) =
        quantity.numbers("zenith_deg").zip(quantity.numbers("azimuth_deg"))
    else {
        return thinned(quantity.place_count(), LINES);
    };
    let direction = |zenith: f64, azimuth: f64| {
        let ((a, b), (c, d)) = (zenith.to_radians().sin_cos(), azimuth.to_radians().sin_cos());
        [a * c, a * d, b]
    };
    let nearest = |zenith: f64, azimuth: f64| {
        let to = direction(zenith, azimuth);
        let cosine = |place: &usize| -> f64 {
            direction(zeniths[*place], azimuths[*place]).iter().zip(to).map(|(a, b)| a * b).sum()
        };
        (0..zeniths.len()).max_by(|a, b| cosine(a).total_cmp(&cosine(b)))
    };
    let slanted = (0..zeniths.len()).max_by(|&a, &b| zeniths[a].total_cmp(&zeniths[b]));
    let hot_spot = context.sun.and_then(|[zenith, azimuth]| nearest(zenith, azimuth));
    let mut places: Vec<usize> =
        [nearest(0.0, 0.0), hot_spot, slanted].into_iter().flatten().collect();
    places.sort_unstable();
    places.dedup();
    places
}

/// Name of a place for a legend: `leaf`, `zenith 30°, azimuth 90°`.
pub(super) fn place_name(quantity: &Quantity, place: usize) -> String {
    if let (Some(zeniths), Some(azimuths)) =
        (quantity.numbers("zenith_deg"), quantity.numbers("azimuth_deg"))
        && quantity.places().len() == 1
    {
        let (zenith, azimuth) = (tick(zeniths[place]), tick(azimuths[place]));
        return if zenith == "0" {
            "nadir".to_owned()
        } else {
            format!("zenith {zenith}°, azimuth {azimuth}°")
        };
    }
    short(quantity.place_texts(place).first().map_or("", String::as_str))
}
