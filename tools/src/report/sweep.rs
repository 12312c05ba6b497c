//! Results of a sweep: values against its parameters.

use maud::{Markup, html};
use sunfleck::output::{ViewPlane, tick};

use super::context::Context;
use super::directions::{SUN_NOTE, sun_mark};
use super::figure::{Across, ErrorStyle, Figure, Line, Mark, Panel, Plot, Point};
use super::long_table::{LongProduct, LongTable};
use super::products::{LINES, PANELS};
use super::quantity::thinned;
use super::words::{axis_of_values, definition, drawn, short, title};

/// Maximum numbers of figures, and of points of a line.
const FIGURES: usize = 40;
const POINTS: usize = 300;
/// Axes that say where along a profile or a plane a value is.
const ALONG: [&str; 5] = ["zenith_deg", "azimuth_deg", "signed_zenith_deg", "bottom_m", "top_m"];

/// Figures of all products.
pub(super) fn figures(context: &Context<'_>, table: &LongTable) -> Option<Markup> {
    let axis = SweepAxis::new(table)?;
    let all: Vec<Figure> = table
        .products
        .iter()
        .filter_map(|product| figure(context, table, &axis, product))
        .collect();
    let more = all.len().saturating_sub(FIGURES);
    (!all.is_empty()).then(|| {
        html! {
            @for figure in all.iter().take(FIGURES) { (figure.markup()) }
            @if more > 0 { p.note { (more) " more figures are not shown: see sweep.csv." } }
        }
    })
}

/// The parameter that values are drawn against, and points of the others.
pub(super) struct SweepAxis {
    name: String,
    /// Place of each point on the axis.
    places: Vec<f64>,
    /// Names of the places, if they are no numbers.
    labels: Option<Vec<String>>,
    /// Number of the combination of the other parameters at each point.
    group_of: Vec<usize>,
    /// Texts of the combinations.
    groups: Vec<String>,
}

impl SweepAxis {
    /// Takes the parameter with most values; `None` without parameters or points.
    pub(super) fn new(table: &LongTable) -> Option<Self> {
        let distinct = |param: usize| {
            let mut texts: Vec<&str> =
                table.points.iter().map(|point| point[param].as_str()).collect();
            texts.sort_unstable();
            texts.dedup();
            texts.len()
        };
        let is_number =
            |param: usize| table.points.iter().all(|point| point[param].parse::<f64>().is_ok());
        // Of several with as many values, the first.
        let chosen = (0..table.params.len())
            .rev()
            .max_by_key(|&param| (is_number(param), distinct(param)))
            .filter(|_| !table.points.is_empty())?;
        let mut labels: Vec<String> = Vec::new();
        let places = table.points.iter().map(|point| match point[chosen].parse::<f64>() {
            Ok(value) if is_number(chosen) => value,
            _ => {
                let label = short(&point[chosen]);
                let known = labels.iter().position(|one| *one == label);
                known.unwrap_or_else(|| {
                    labels.push(label);
                    labels.len() - 1
                }) as f64
            }
        });
        let places = places.collect();
        let mut groups: Vec<String> = Vec::new();
        let group_of = table.points.iter().map(|point| {
            let others = table.params.iter().zip(point).enumerate().filter(|(at, _)| *at != chosen);
            let text = others
                .map(|(_, (name, value))| format!("{} = {}", short(name), shown(value)))
                .collect::<Vec<_>>()
                .join(", ");
            groups.iter().position(|one| *one == text).unwrap_or_else(|| {
                groups.push(text);
                groups.len() - 1
            })
        });
        let group_of = group_of.collect();
        let labels = (!is_number(chosen)).then_some(labels);
        Some(Self { name: table.params[chosen].clone(), places, labels, group_of, groups })
    }

    /// Points of a combination of the other parameters, in the order of the axis.
    fn points_of(&self, group: usize) -> Vec<usize> {
        let mut points: Vec<usize> =
            (0..self.places.len()).filter(|&point| self.group_of[point] == group).collect();
        points.sort_by(|&a, &b| self.places[a].total_cmp(&self.places[b]));
        points
    }

    fn across(&self) -> Across {
        self.labels.clone().map_or(Across::Numbers, Across::Labels)
    }
}

/// A value of a parameter as people write it.
fn shown(value: &str) -> String {
    value.parse::<f64>().map_or_else(|_| short(value), tick)
}

fn figure(
    context: &Context<'_>,
    table: &LongTable,
    axis: &SweepAxis,
    product: &LongProduct,
) -> Option<Figure> {
    if product.name == "emitted_energy" || product.name == "energy" || product.places.is_empty() {
        return None;
    }
    let is_along = product.axes.iter().any(|name| ALONG.contains(&name.as_str()));
    let (plot, legend, notes) = if is_along && product.places.len() > 2 {
        along(context, table, axis, product)?
    } else {
        against(context, axis, product)
    };
    let has_value = |panel: &Panel| {
        panel.lines.iter().flat_map(|line| &line.points).any(|point| point.value.is_finite())
    };
    let plot = Plot { panels: plot.panels.into_iter().filter(has_value).collect(), ..plot };
    if plot.panels.is_empty() {
        return None;
    }
    let thin = (table.points.len() < table.point_count).then(|| {
        format!("{}.", drawn(table.points.len(), table.point_count, "points of the sweep"))
    });
    let defined = definition(&product.name).map(str::to_owned);
    let caption =
        [defined, thin, plot.scale_note(), plot.error_note()].into_iter().flatten().chain(notes);
    Some(Figure {
        panels: plot.draw(),
        legend,
        bar: None,
        title: format!("{}: {}", short(&product.sensor), title(&product.name)),
        caption: caption.collect(),
        data: Some(context.link("sweep.csv")),
    })
}

/// A drawing, its legend and sentences about it.
type Drawn = (Plot, Vec<String>, Vec<String>);

/// Values against the parameter: a panel a band and place, a line a combination of the other parameters.
fn against(context: &Context<'_>, axis: &SweepAxis, product: &LongProduct) -> Drawn {
    let groups = thinned(axis.groups.len(), LINES);
    let chosen = Grid::new(product.places.len(), product.bands.len());
    let panel = |&(place, band): &(usize, usize)| {
        let lines = groups.iter().enumerate().map(|(colour, &group)| {
            let points = axis.points_of(group);
            let points = thinned(points.len(), POINTS).into_iter().map(|at| {
                let point = points[at];
                let found = product.at(point, place, band);
                Point { at: axis.places[point], value: found.value, error: found.error }
            });
            Line { name: axis.groups[group].clone(), colour, points: points.collect() }
        });
        let title = place_and_band(product, place, band);
        Panel { title, scale: place, x_title: None, lines: lines.collect(), marks: Vec::new() }
    };
    let plot = Plot {
        x_title: context.swept.param_title(&axis.name),
        y_title: axis_of_values(&product.name, &product.unit),
        across: axis.across(),
        is_profile: false,
        errors: ErrorStyle::Bars,
        panels: chosen.cells.iter().map(panel).collect(),
        guides: Vec::new(),
    };
    let notes = [
        fewer(groups.len(), axis.groups.len(), "combinations of the other parameters"),
        chosen.note(),
    ];
    let legend = if axis.groups.len() > 1 {
        groups.iter().map(|&group| axis.groups[group].clone()).collect()
    } else {
        Vec::new()
    };
    (plot, legend, notes.into_iter().flatten().collect())
}

/// Panels for places and bands: all, or an even choice of both.
struct Grid {
    /// Place and band of each panel.
    cells: Vec<(usize, usize)>,
    count: usize,
}

impl Grid {
    fn new(places: usize, bands: usize) -> Self {
        let most_bands = if places > 1 { 3 } else { PANELS };
        let bands_shown = thinned(bands, most_bands);
        let places_shown = thinned(places, PANELS / bands_shown.len().max(1));
        let cells = places_shown
            .iter()
            .flat_map(|&place| bands_shown.iter().map(move |&band| (place, band)));
        Self { cells: cells.collect(), count: places * bands }
    }

    fn note(&self) -> Option<String> {
        fewer(self.cells.len(), self.count, "bands and terms")
    }
}

fn fewer(shown: usize, all: usize, what: &str) -> Option<String> {
    (shown < all).then(|| format!("{}.", drawn(shown, all, what)))
}

fn place_and_band(product: &LongProduct, place: usize, band: usize) -> String {
    let names = product.places[place].iter().chain([&product.bands[band]]);
    let names: Vec<String> = names
        .filter(|name| !name.is_empty() && *name != "gap" && *name != "lai")
        .map(|name| shown(name))
        .collect();
    names.join(", ").replace('_', " ")
}

/// Values along a plane or a profile: a panel a band and material, a line a value of the parameter.
fn along(
    context: &Context<'_>,
    table: &LongTable,
    axis: &SweepAxis,
    product: &LongProduct,
) -> Option<Drawn> {
    let number_of = |name: &str| {
        let column = product.axis(name)?;
        product
            .places
            .iter()
            .map(|texts| texts[column].parse::<f64>().ok())
            .collect::<Option<Vec<f64>>>()
    };
    let is_profile = product.axis("bottom_m").is_some();
    let positions = if is_profile {
        let (bottoms, tops) = (number_of("bottom_m")?, number_of("top_m")?);
        bottoms.iter().zip(tops).map(|(bottom, top)| 0.5 * (bottom + top)).collect()
    } else {
        number_of("signed_zenith_deg").or_else(|| number_of("zenith_deg"))?
    };
    let parts = Parts::new(product, &positions);
    if !is_profile && parts.places.iter().any(|places| has_repeated(places, &positions)) {
        // Views all over the hemisphere are no curve.
        return None;
    }
    let points = axis.points_of(axis.group_of[0]);
    let chosen = thinned(points.len(), LINES);
    let grid = Grid::new(parts.names.len(), product.bands.len());
    let line_name = |point: usize| match &axis.labels {
        Some(labels) => labels[axis.places[point] as usize].clone(),
        None => format!("{} = {}", short(&axis.name), tick(axis.places[point])),
    };
    let suns: Vec<Option<[f64; 2]>> = chosen
        .iter()
        .map(|&at| context.swept.sun(&table.params, &table.points[points[at]]))
        .collect();
    let plane = plane_of(product, &suns);
    let marks = if plane == Some(ViewPlane::Principal) { sun_marks(&suns) } else { Vec::new() };
    let panel = |&(part, band): &(usize, usize)| {
        let lines = chosen.iter().enumerate().map(|(colour, &at)| {
            let point = points[at];
            let values = parts.places[part].iter().map(|&place| {
                let found = product.at(point, place, band);
                Point { at: positions[place], value: found.value, error: found.error }
            });
            Line { name: line_name(point), colour, points: values.collect() }
        });
        let names = [parts.names[part].clone(), short(&product.bands[band])];
        let names: Vec<String> = names.into_iter().filter(|name| !name.is_empty()).collect();
        let title = names.join(", ");
        Panel { title, scale: part, x_title: None, lines: lines.collect(), marks: marks.clone() }
    };
    let plot = Plot {
        x_title: if is_profile {
            "height (m)".to_owned()
        } else {
            plane.map_or("view zenith (°), + towards the sun", ViewPlane::axis_title).to_owned()
        },
        y_title: axis_of_values(&product.name, &product.unit),
        across: Across::Numbers,
        is_profile,
        errors: ErrorStyle::Areas,
        panels: grid.cells.iter().map(panel).collect(),
        guides: Vec::new(),
    };
    let others = (axis.groups.len() > 1).then(|| format!("For {}.", axis.groups[axis.group_of[0]]));
    let sun = (!marks.is_empty()).then(|| SUN_NOTE.to_owned());
    let notes =
        [others, sun, fewer(chosen.len(), points.len(), "values of the parameter"), grid.note()];
    let legend = chosen.iter().map(|&at| line_name(points[at])).collect();
    Some((plot, legend, notes.into_iter().flatten().collect()))
}

/// The plane of the views of a product; `None` if they lie in several, or in another one at each point.
fn plane_of(product: &LongProduct, suns: &[Option<[f64; 2]>]) -> Option<ViewPlane> {
    let (zenith, azimuth) = (product.axis("zenith_deg")?, product.axis("azimuth_deg")?);
    let slanted = product.places.iter().filter_map(|texts| {
        let zenith = texts[zenith].parse::<f64>().ok().filter(|zenith| zenith.abs() > 1e-9)?;
        let azimuth = texts[azimuth].parse::<f64>().ok()?;
        zenith.is_finite().then_some(azimuth)
    });
    let mut planes = slanted.flat_map(|azimuth| {
        suns.iter().map(move |sun| ViewPlane::new(azimuth, sun.map(|[_, azimuth]| azimuth)))
    });
    let first = planes.next()?;
    planes.all(|plane| plane == first).then_some(first)
}

/// Marks of the sun: one for all lines, or one in the colour of each line.
fn sun_marks(suns: &[Option<[f64; 2]>]) -> Vec<Mark> {
    let zeniths: Vec<f64> = suns.iter().flatten().map(|[zenith, _]| *zenith).collect();
    let is_one = zeniths.windows(2).all(|pair| (pair[0] - pair[1]).abs() < 1e-9);
    if let (true, Some(zenith)) = (is_one, zeniths.first()) {
        return vec![sun_mark(*zenith)];
    }
    let of_line = |(colour, sun): (usize, &Option<[f64; 2]>)| {
        let [zenith, _] = (*sun)?;
        let name = if colour == 0 { "sun" } else { "" };
        Some(Mark { at: zenith, name: name.to_owned(), colour: Some(colour) })
    };
    suns.iter().enumerate().filter_map(of_line).collect()
}

/// Returns true if two places are at the same position.
fn has_repeated(places: &[usize], positions: &[f64]) -> bool {
    places.windows(2).any(|pair| (positions[pair[0]] - positions[pair[1]]).abs() < 1e-9)
}

/// Places along a curve, for each combination of the other axes.
struct Parts {
    names: Vec<String>,
    /// In the order of their positions.
    places: Vec<Vec<usize>>,
}

impl Parts {
    fn new(product: &LongProduct, positions: &[f64]) -> Self {
        let mut parts = Self { names: Vec::new(), places: Vec::new() };
        for (place, texts) in product.places.iter().enumerate() {
            let others =
                product.axes.iter().zip(texts).filter(|(name, _)| !ALONG.contains(&name.as_str()));
            let name = others.map(|(_, text)| short(text)).collect::<Vec<_>>().join(", ");
            if let Some(part) = parts.names.iter().position(|one| *one == name) {
                parts.places[part].push(place);
            } else {
                parts.names.push(name);
                parts.places.push(vec![place]);
            }
        }
        for places in &mut parts.places {
            places.sort_by(|&a, &b| positions[a].total_cmp(&positions[b]));
        }
        parts
    }
}
