//! Lines of a chart, from the axes of a product.

use super::scale::are_unlike;
use super::tracks::{SunAngles, Track, axis_of_zeniths, planes, upright};
use super::view_plane::ViewPlane;
use crate::products::{AxisPoints, Product, ProductAxis};

/// Maximum number of lines that can be distinguished.
const MOST_LINES: usize = 8;

/// A chart of lines.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Lines {
    /// Title of the axis that values are drawn against.
    pub(super) axis: String,
    /// True if that axis is height, and stands upright.
    pub(super) is_profile: bool,
    /// Zenith angle of the sun, where it lies in a plane of the views: the place of the hot spot, degrees.
    pub(super) sun: Option<f64>,
    pub(super) curves: Vec<Line>,
    /// Lines that are left out.
    pub(super) hidden: usize,
}

/// A line of a chart.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Line {
    /// Name of the values; empty if there is only one line.
    pub(super) name: String,
    /// Name of its band; empty of a product without bands.
    pub(super) band: String,
    pub(super) points: Vec<Point>,
}

/// A value with its standard error, 0 if it has none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Point {
    pub(super) at: f64,
    pub(super) value: f64,
    pub(super) error: f64,
}

impl Lines {
    /// Values by zenith angle, one line for each vertical plane and band; or by height, one for each material
    /// and band. Nothing of other products, of views all over the hemisphere, and of single points.
    ///
    /// - `sun`: position of the sun, if it is known
    pub(super) fn new(product: &Product, sun: Option<SunAngles>) -> Option<Self> {
        if product.image.is_some() || product.faces.is_some() {
            return None;
        }
        let (first, others) = product.dimensions.split_first()?;
        let (tracks, axis, is_profile) =
            match (numbers(first, "zenith_deg"), numbers(first, "bottom_m")) {
                (Some(zeniths), _) => {
                    let azimuths = numbers(first, "azimuth_deg")?;
                    let mut tracks = planes(&upright(zeniths, azimuths), sun)?;
                    let title = axis_of_zeniths(&mut tracks);
                    (tracks, title, false)
                }
                (_, Some(bottoms)) => {
                    let tops = numbers(first, "top_m")?;
                    let middles =
                        bottoms.iter().zip(tops).map(|(bottom, top)| 0.5 * (bottom + top));
                    let places = middles.zip(0..).collect();
                    let track = Track { name: String::new(), plane: None, places };
                    (vec![track], "height (m)".to_owned(), true)
                }
                _ => return None,
            };
        if tracks.iter().all(|track| track.places.len() < 2) {
            return None;
        }
        let each: usize =
            others.iter().map(|axes| axes.first().map_or(1, |axis| axis.points.len())).product();
        // Lines of a material, say, belong together: they differ in the dimensions behind it.
        let first =
            others.first().and_then(|axes| axes.first()).map_or(1, |axis| axis.points.len());
        let of_group = if others.len() > 1 { each / first.max(1) } else { each }.max(1);
        let band_of = |other: usize| match others.last().and_then(|axes| axes.first()) {
            Some(ProductAxis { name, points: AxisPoints::Labels(bands) }) if name == "band" => {
                bands[other % bands.len().max(1)].clone()
            }
            _ => String::new(),
        };
        let mut lines = Vec::new();
        for other in 0..each {
            for track in &tracks {
                let value = |&(at, number): &(f64, usize)| {
                    let index = number * each + other;
                    let error = product.standard_error[index];
                    let error = if error.is_finite() { error } else { 0.0 };
                    Point { at, value: product.values[index], error }
                };
                let points: Vec<Point> = track.places.iter().map(value).collect();
                let points: Vec<Point> =
                    points.into_iter().filter(|point| point.value.is_finite()).collect();
                let mut names = names_of(others, other);
                names.extend(Some(track.name.clone()).filter(|name| !name.is_empty()));
                let line = Line { name: names.join(", "), band: band_of(other), points };
                lines.push(GroupedLine { group: other / of_group, line });
            }
        }
        // What is 0 throughout, as a material that absorbs nothing, hides nothing else.
        lines.retain(|one| !one.line.points.is_empty());
        let is_lit = |one: &GroupedLine| one.line.points.iter().any(|point| point.value != 0.0);
        if lines.len() > MOST_LINES && lines.iter().any(is_lit) {
            lines.retain(is_lit);
        }
        let (mut lines, hidden) = thinned(lines);
        if let [line] = &mut lines[..] {
            line.name.clear();
        }
        let is_principal = |track: &Track| track.plane == Some(ViewPlane::Principal);
        let sun = sun.filter(|_| tracks.iter().any(is_principal)).map(|sun| sun.zenith_deg);
        (!lines.is_empty()).then_some(Self { axis, is_profile, sun, curves: lines, hidden })
    }

    /// Numbers of the lines of each panel: all in one, or those of each band alone where bands are so unlike in size that
    /// they are not legible on one axis.
    pub(super) fn panels(&self) -> Vec<Vec<usize>> {
        let mut bands: Vec<(&str, Vec<usize>)> = Vec::new();
        for (number, line) in self.curves.iter().enumerate() {
            match bands.iter_mut().find(|(band, _)| *band == line.band) {
                Some((_, lines)) => lines.push(number),
                None => bands.push((&line.band, vec![number])),
            }
        }
        let peak =
            |lines: &[usize]| lines.iter().map(|&at| self.curves[at].peak()).fold(0.0, f64::max);
        if are_unlike(bands.iter().map(|(_, lines)| peak(lines))) {
            return bands.into_iter().map(|(_, lines)| lines).collect();
        }
        vec![(0..self.curves.len()).collect()]
    }
}

impl Line {
    /// Largest absolute value.
    fn peak(&self) -> f64 {
        self.points.iter().map(|point| point.value.abs()).fold(0.0, f64::max)
    }
}

/// A line and the point of the first dimension behind that of the axis that it belongs to.
struct GroupedLine {
    group: usize,
    line: Line,
}

/// At most [`MOST_LINES`] lines, and the number of those that are left out. Groups are kept whole, those with
/// the largest values first; of a single group, and of one that is too large, lines are taken evenly.
fn thinned(lines: Vec<GroupedLine>) -> (Vec<Line>, usize) {
    let count = lines.len();
    if count <= MOST_LINES {
        return (lines.into_iter().map(|one| one.line).collect(), 0);
    }
    let mut groups: Vec<(usize, f64, usize)> = Vec::new();
    for GroupedLine { group, line } in &lines {
        match groups.last_mut() {
            Some((last, highest, members)) if last == group => {
                *highest = highest.max(line.peak());
                *members += 1;
            }
            _ => groups.push((*group, line.peak(), 1)),
        }
    }
    groups.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut room = MOST_LINES;
    let mut kept = Vec::new();
    for (group, _, members) in groups {
        if kept.is_empty() || members <= room {
            kept.push(group);
            room = room.saturating_sub(members);
        }
    }
    let lines = lines.into_iter().filter(|one| kept.contains(&one.group)).map(|one| one.line);
    let mut lines: Vec<Line> = lines.collect();
    if lines.len() > MOST_LINES {
        let last = lines.len() - 1;
        let even = (0..MOST_LINES).map(|number| lines[number * last / (MOST_LINES - 1)].clone());
        lines = even.collect();
    }
    let hidden = count - lines.len();
    (lines, hidden)
}

fn numbers<'a>(axes: &'a [ProductAxis], name: &str) -> Option<&'a [f64]> {
    let axis = axes.iter().find(|axis| axis.name == name)?;
    match &axis.points {
        AxisPoints::Numbers(numbers) => Some(numbers),
        AxisPoints::Labels(_) => None,
    }
}

/// Names of a point of some dimensions, of those that have several.
fn names_of(dimensions: &[Vec<ProductAxis>], mut number: usize) -> Vec<String> {
    let mut names = Vec::new();
    for axes in dimensions.iter().rev() {
        let Some(axis) = axes.first() else { continue };
        let points = axis.points.len().max(1);
        let at = number % points;
        number /= points;
        if points > 1 {
            names.insert(
                0,
                match &axis.points {
                    AxisPoints::Labels(labels) => labels[at].clone(),
                    AxisPoints::Numbers(numbers) => super::scale::tick(numbers[at]),
                },
            );
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(name: &str, numbers: &[f64]) -> ProductAxis {
        ProductAxis { name: name.to_owned(), points: AxisPoints::Numbers(numbers.to_vec()) }
    }

    fn bands(names: &[&str]) -> Vec<ProductAxis> {
        let labels = names.iter().map(|&name| name.to_owned()).collect();
        vec![ProductAxis { name: "band".to_owned(), points: AxisPoints::Labels(labels) }]
    }

    fn product(dimensions: Vec<Vec<ProductAxis>>, values: &[f64]) -> Product {
        Product {
            name: "brf".to_owned(),
            unit: "1".to_owned(),
            dimensions,
            values: values.to_vec(),
            standard_error: vec![0.1; values.len()],
            image: None,
            faces: None,
            replicates: Vec::new(),
        }
    }

    #[test]
    fn a_principal_plane_is_one_line_with_signs() {
        let views = vec![
            axis("zenith_deg", &[30.0, 0.0, 30.0]),
            axis("azimuth_deg", &[335.0, 155.0, 155.0]),
        ];
        let lines = Lines::new(&product(vec![views, bands(&["red"])], &[1.0, 2.0, 3.0]), None);
        let lines = lines.expect("a chart");
        assert_eq!(lines.curves.len(), 1);
        let places: Vec<(f64, f64)> =
            lines.curves[0].points.iter().map(|point| (point.at, point.value)).collect();
        assert_eq!(places, [(-30.0, 1.0), (0.0, 2.0), (30.0, 3.0)]);
    }

    /// The last view is opposite of the sun: positive zenith angles are on the side of the sun all the same.
    #[test]
    fn the_principal_plane_has_the_sun_on_its_positive_side() {
        let views = || {
            vec![axis("zenith_deg", &[30.0, 0.0, 30.0]), axis("azimuth_deg", &[10.0, 10.0, 190.0])]
        };
        let lines = |azimuth_deg: f64| {
            let sun = Some(SunAngles { zenith_deg: 40.0, azimuth_deg });
            Lines::new(&product(vec![views(), bands(&["red"])], &[1.0, 2.0, 3.0]), sun)
                .expect("a chart")
        };
        let values = |lines: &Lines| -> Vec<f64> {
            lines.curves[0].points.iter().map(|point| point.value).collect()
        };
        let principal = lines(10.0);
        assert_eq!((values(&principal), principal.sun), (vec![3.0, 2.0, 1.0], Some(40.0)));
        assert!(principal.axis.contains("+ backward scattering (side of the sun)"));
        let cross = lines(280.0);
        assert_eq!((values(&cross), cross.sun), (vec![3.0, 2.0, 1.0], None));
        assert_eq!(cross.axis, "cross plane, view zenith (°), + clockwise of the sun");
        assert_eq!(lines(55.0).axis, "view zenith (°), + towards 190°");
    }

    #[test]
    fn bands_of_unlike_size_have_panels_of_their_own() {
        let layers = || vec![axis("bottom_m", &[0.0, 2.0]), axis("top_m", &[2.0, 4.0])];
        let panels = |red: f64| {
            let values = [red, 0.4, 0.5 * red, 0.3];
            Lines::new(&product(vec![layers(), bands(&["red", "nir"])], &values), None)
                .expect("a chart")
                .panels()
        };
        assert_eq!(panels(0.2), [vec![0, 1]]);
        assert_eq!(panels(0.02), [vec![0], vec![1]]);
    }

    #[test]
    fn planes_and_bands_have_lines_of_their_own_and_hemispheres_none() {
        let views = |azimuths: &[f64]| {
            let zeniths: Vec<f64> =
                azimuths.iter().enumerate().map(|(at, _)| 10.0 + at as f64).collect();
            vec![axis("zenith_deg", &zeniths), axis("azimuth_deg", azimuths)]
        };
        let values: Vec<f64> = (0..8).map(f64::from).collect();
        let of = |azimuths: &[f64]| {
            Lines::new(&product(vec![views(azimuths), bands(&["red", "nir"])], &values), None)
        };
        let two = of(&[0.0, 0.0, 90.0, 90.0]).expect("a chart");
        let names: Vec<&str> = two.curves.iter().map(|line| line.name.as_str()).collect();
        assert_eq!(
            names,
            ["red, azimuth 0°", "red, azimuth 90°", "nir, azimuth 0°", "nir, azimuth 90°"]
        );
        let all = product(
            vec![views(&[0.0, 20.0, 40.0, 60.0, 80.0, 100.0, 120.0, 140.0]), bands(&["red"])],
            &values,
        );
        assert_eq!(Lines::new(&all, None), None);
    }

    #[test]
    fn layers_are_a_profile() {
        let layers = vec![axis("bottom_m", &[0.0, 2.0]), axis("top_m", &[2.0, 4.0])];
        let lines =
            Lines::new(&product(vec![layers, bands(&["red", "nir"])], &[1.0, 2.0, 3.0, 4.0]), None);
        let lines = lines.expect("a chart");
        assert!(lines.is_profile);
        assert_eq!(lines.curves[1].points[1], Point { at: 3.0, value: 4.0, error: 0.1 });
    }

    #[test]
    fn many_lines_are_thinned_out() {
        let layers = vec![axis("bottom_m", &[0.0, 2.0]), axis("top_m", &[2.0, 4.0])];
        let names: Vec<String> = (0..20).map(|band| format!("b{band}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let lines = Lines::new(&product(vec![layers, bands(&names)], &[1.0; 40]), None);
        let lines = lines.expect("a chart");
        assert_eq!((lines.curves.len(), lines.hidden), (8, 12));
        assert_eq!((lines.curves[0].name.as_str(), lines.curves[7].name.as_str()), ("b0", "b19"));
    }

    #[test]
    fn the_materials_that_are_kept_have_lines_for_all_bands() {
        let layers = vec![axis("bottom_m", &[0.0, 2.0]), axis("top_m", &[2.0, 4.0])];
        let materials = ["grass", "soil", "leaf", "bark"].map(str::to_owned).to_vec();
        let material = vec![ProductAxis {
            name: "material".to_owned(),
            points: AxisPoints::Labels(materials),
        }];
        // Of 4 materials the first and the third absorb most.
        let values: Vec<f64> = (0..24).map(|at| [4.0, 1.0, 3.0, 2.0][at / 3 % 4]).collect();
        let all = product(vec![layers, material, bands(&["blue", "red", "nir"])], &values);
        let lines = Lines::new(&all, None).expect("a chart");
        let names: Vec<&str> = lines.curves.iter().map(|line| line.name.as_str()).collect();
        let [grass, leaf] = ["grass", "leaf"]
            .map(|material| ["blue", "red", "nir"].map(|band| format!("{material}, {band}")));
        assert_eq!(names, [grass, leaf].concat());
        assert_eq!(lines.hidden, 6);
    }
}
