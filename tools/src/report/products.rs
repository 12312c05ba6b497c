//! Figures of products, chosen by their axes.

use super::context::Context;
use super::figure::{Across, ErrorStyle, Figure, Hemisphere, Line, Mark, Panel, Plot, Point, View};
use super::planes::{Plane, planes};
use super::quantity::{Quantity, thinned};
use super::summary::Points;
use super::words::{self, definition, number, short, title, with_unit};
use sunfleck::output::tick;

/// Maximum numbers of lines of a panel, of panels, and of bands where there are several places.
pub(super) const LINES: usize = 6;
pub(super) const PANELS: usize = 12;
/// Number of bands from which on values are drawn as a spectrum.
const SPECTRUM: usize = 5;
/// Maximum number of points of a line.
const POINTS: usize = 400;
/// Maximum number of views of a hemisphere that are drawn.
const VIEWS: usize = 1500;

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
    let note = format!("{} of {} bands are drawn; the table has all.", shown.len(), known.len());
    (shown, (left_out > 0).then_some(note))
}

/// Name of a band; empty of a product without bands.
pub(super) fn band_name(quantity: &Quantity, band: usize) -> String {
    quantity.bands().map_or_else(String::new, |bands| short(&bands[band]))
}

fn caption(quantity: &Quantity, notes: impl IntoIterator<Item = Option<String>>) -> Vec<String> {
    let defined = definition(&quantity.name).map(str::to_owned);
    std::iter::once(defined).chain(notes).flatten().collect()
}

fn heading(quantity: &Quantity, what: &str) -> String {
    format!("{}: {}{what}", short(&quantity.sensor), title(&quantity.name))
}

fn directions(context: &Context<'_>, quantity: &Quantity) -> Vec<Figure> {
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
    let (bands, note) = shown_bands(quantity, LINES);
    let panel = |plane: &Plane| Panel {
        scale: 0,
        title: if planes.len() > 1 { plane.name.clone() } else { String::new() },
        marks: plane
            .hot_spot
            .map(|at| Mark { at, name: "hot spot".to_owned() })
            .into_iter()
            .collect(),
        lines: bands
            .iter()
            .enumerate()
            .map(|(colour, &band)| {
                let points = thinned(plane.places.len(), POINTS).into_iter().map(|at| {
                    let place = &plane.places[at];
                    let (value, error) = quantity.at(place.index, band);
                    Point { at: place.signed_zenith, value, error }
                });
                Line { name: band_name(quantity, band), colour, points: points.collect() }
            })
            .collect(),
    };
    let plot = Plot {
        x_title: planes[0].axis.to_owned(),
        y_title: with_unit(&words::quantity(&quantity.name), &quantity.unit),
        across: Across::Numbers,
        is_profile: false,
        errors: ErrorStyle::Areas,
        panels: planes.iter().map(panel).collect(),
        guides: Vec::new(),
    };
    let what = if let [plane] = planes { format!(" in the {}", plane.name) } else { String::new() };
    let notes = [note, plot.error_note()];
    Some(Figure {
        panels: plot.draw(),
        legend: legend(quantity, &bands),
        title: heading(quantity, &what),
        caption: caption(quantity, notes),
        data: context.table(quantity),
    })
}

/// Names of bands as a legend; none for a single line.
fn legend(quantity: &Quantity, bands: &[usize]) -> Vec<String> {
    if bands.len() < 2 && quantity.band_count() < 2 {
        return Vec::new();
    }
    bands.iter().map(|&band| band_name(quantity, band)).collect()
}

/// Values all over the hemisphere: a panel a band.
fn hemisphere(context: &Context<'_>, quantity: &Quantity) -> Option<Figure> {
    let (zeniths, azimuths) = (quantity.numbers("zenith_deg")?, quantity.numbers("azimuth_deg")?);
    if zeniths.len() > VIEWS || quantity.places().len() > 1 {
        return None;
    }
    let (bands, note) = shown_bands(quantity, 3);
    let are_cells = quantity.name.contains("_cells");
    let panel = |&band: &usize| {
        let views = zeniths.iter().zip(azimuths).enumerate().map(|(place, (&zenith, &azimuth))| {
            let (value, error) = quantity.at(place, band);
            View { zenith, azimuth, value, error }
        });
        let title = band_name(quantity, band);
        Hemisphere { title, views: views.collect(), sun: context.sun, are_cells }.draw()
    };
    let sun = context
        .sun
        .map(|_| "The ring with a dot is the sun's direction, where the hot spot is.".to_owned());
    let error = quantity.relative_error().map(|error| {
        format!("Median standard error: {} % of the value.", number(100.0 * error, 2))
    });
    let seen = "Distance from the centre is the view zenith angle, north is at the top.".to_owned();
    Some(Figure {
        panels: bands.iter().map(panel).collect(),
        legend: Vec::new(),
        title: heading(quantity, " by view direction"),
        caption: caption(quantity, [Some(seen), sun, error, note]),
        data: context.table(quantity),
    })
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
        y_title: with_unit(&words::quantity(&quantity.name), &quantity.unit),
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
        .then(|| format!("{} of {} lines are drawn; the table has all.", shown.len(), lit.len()));
    Some(Figure {
        panels: plot.draw(),
        legend: if groups > 1 {
            shown.iter().map(|&group| name_of(group)).collect()
        } else {
            Vec::new()
        },
        title: heading(quantity, ", middles of layers"),
        caption: caption(quantity, [single, note, missing, plot.error_note()]),
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
        y_title: with_unit(&words::quantity(&quantity.name), &quantity.unit),
        across,
        is_profile: false,
        errors: ErrorStyle::Areas,
        panels: vec![Panel {
            title: String::new(),
            scale: 0,
            lines: places.iter().enumerate().map(line).collect(),
            marks: Vec::new(),
        }],
        guides: Vec::new(),
    };
    let missing = (places.len() < quantity.place_count()).then(|| {
        format!(
            "{} of {} lines are drawn; the table has all.",
            places.len(),
            quantity.place_count()
        )
    });
    let fewer = (order.len() < bands.len())
        .then(|| format!("{} of {} bands are drawn; the table has all.", order.len(), bands.len()));
    let mean = quantity.is_image().then(|| "Means of the images.".to_owned());
    Some(Figure {
        panels: plot.draw(),
        legend: if places.len() > 1 {
            places.iter().map(|&place| place_name(quantity, place)).collect()
        } else {
            Vec::new()
        },
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
