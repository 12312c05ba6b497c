use std::ops::Range;

use sunfleck::products::{AxisPoints, Product, ProductAxis};

use crate::plot::{range_of, tick};

/// Curves of a product's values along its first dimension, one for each point of the others.
#[derive(Debug, PartialEq)]
pub(super) struct Curves {
    /// Name of the axis.
    pub(super) axis: String,
    /// Names of the points 0, 1, .. along it, if they are no numbers.
    pub(super) labels: Option<Vec<String>>,
    /// Range of the axis.
    pub(super) range: Range<f64>,
    pub(super) lines: Vec<Curve>,
}

#[derive(Debug, PartialEq)]
pub(super) struct Curve {
    /// Point of the other dimensions.
    pub(super) name: String,
    /// Position on the axis, and index of the product's value.
    pub(super) points: Vec<(f64, usize)>,
}

/// Maximum numbers of curves, of points of each, and of names along an axis.
const CURVES: usize = 8;
const POINTS: usize = 400;
const LABELS: usize = 16;

impl Curves {
    pub(super) fn new(product: &Product) -> Self {
        let lengths: Vec<usize> = product
            .dimensions
            .iter()
            .map(|axes| axes.first().map_or(1, |a| a.points.len()))
            .collect();
        let along = lengths.first().copied().unwrap_or(1);
        let others: usize = lengths.iter().skip(1).product();
        let first = product.dimensions.first().map_or(&[][..], Vec::as_slice);
        let Along { axis, places, labels } = Along::new(first, along);
        let mut order: Vec<usize> = even(along, POINTS);
        if labels.is_none() {
            order.sort_by(|&a, &b| places[a].total_cmp(&places[b]));
        }
        let curves = even(others, CURVES).into_iter().map(|other| Curve {
            name: name(product, other),
            points: order.iter().map(|&at| (places[at], at * others + other)).collect(),
        });
        let range = if labels.is_some() {
            -0.6..along as f64 - 0.4
        } else {
            range_of(places.iter().copied())
        };
        Self { axis, labels, range, lines: curves.collect() }
    }

    /// All points of all curves.
    pub(super) fn shown(&self) -> impl Iterator<Item = (f64, usize)> {
        self.lines.iter().flat_map(|curve| curve.points.iter().copied())
    }

    /// Offset of one of several systems, so that none hides another.
    pub(super) fn aside(&self, number: usize, count: usize) -> f64 {
        let points = self.lines.first().map_or(1, |curve| curve.points.len());
        let spacing = (self.range.end - self.range.start) / points.max(8) as f64;
        let share = if self.labels.is_some() { 0.5 } else { 0.3 };
        (number as f64 - 0.5 * (count as f64 - 1.0)) / count.max(2) as f64 * share * spacing
    }
}

/// Places along the first dimension.
struct Along {
    axis: String,
    places: Vec<f64>,
    labels: Option<Vec<String>>,
}

impl Along {
    fn new(axes: &[ProductAxis], length: usize) -> Self {
        let numbered = |axis: &str| Self {
            axis: axis.to_owned(),
            places: (0..length).map(|place| place as f64).collect(),
            labels: None,
        };
        let Some(first) = axes.first() else { return numbered("value") };
        match &first.points {
            AxisPoints::Labels(labels) if labels.len() <= LABELS => {
                Self { labels: Some(labels.clone()), ..numbered(&first.name) }
            }
            AxisPoints::Labels(_) => numbered(&format!("number of the {}", first.name)),
            AxisPoints::Numbers(numbers) => {
                let second = axes.get(1).map(|axis| (&axis.name, &axis.points));
                match second {
                    Some((name, AxisPoints::Numbers(azimuths))) if name == "azimuth_deg" => {
                        match signed(numbers, azimuths) {
                            Some(places) => Self { axis: first.name.clone(), places, labels: None },
                            None => numbered("number of the direction"),
                        }
                    }
                    _ => Self { axis: first.name.clone(), places: numbers.clone(), labels: None },
                }
            }
        }
    }
}

/// Zenith angles with a sign, if all directions lie in one vertical plane: negative on the side of the
/// first one.
fn signed(zeniths: &[f64], azimuths: &[f64]) -> Option<Vec<f64>> {
    let slanted = || zeniths.iter().zip(azimuths).filter(|(zenith, _)| **zenith > 1e-9);
    let (_, &first) = slanted().next()?;
    let turn = |azimuth: f64| (azimuth - first).rem_euclid(360.0);
    let near = |turn: f64, to: f64| (turn - to).abs() < 1e-6;
    let is_first = |turn: f64| near(turn, 0.0) || near(turn, 360.0);
    let in_plane = |azimuth: f64| is_first(turn(azimuth)) || near(turn(azimuth), 180.0);
    let one_sided = slanted().all(|(_, &azimuth)| is_first(turn(azimuth)));
    slanted().all(|(_, &azimuth)| in_plane(azimuth)).then(|| {
        let sign = |azimuth: f64| if !one_sided && is_first(turn(azimuth)) { -1.0 } else { 1.0 };
        zeniths.iter().zip(azimuths).map(|(zenith, &azimuth)| sign(azimuth) * zenith).collect()
    })
}

/// Name of a point of all dimensions but the first.
fn name(product: &Product, mut rest: usize) -> String {
    let mut names = Vec::new();
    for axes in product.dimensions.iter().skip(1).rev() {
        let Some(axis) = axes.first() else { continue };
        let length = axis.points.len().max(1);
        names.push(match &axis.points {
            AxisPoints::Labels(labels) => labels[rest % length].clone(),
            AxisPoints::Numbers(numbers) => {
                format!("{} {}", axis.name, tick(numbers[rest % length]))
            }
        });
        rest /= length;
    }
    names.reverse();
    names.join(", ")
}

/// At most `most` of `0..count`, evenly spaced, both ends included.
fn even(count: usize, most: usize) -> Vec<usize> {
    if count <= most {
        return (0..count).collect();
    }
    (0..most).map(|k| (k * (count - 1) + (most - 1) / 2) / (most - 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_of_one_plane_have_a_sign() {
        let zeniths = [60.0, 0.0, 60.0];
        assert_eq!(signed(&zeniths, &[90.0, 270.0, 270.0]), Some(vec![-60.0, 0.0, 60.0]));
        assert_eq!(signed(&zeniths, &[10.0, 0.0, 10.0]), Some(vec![60.0, 0.0, 60.0]));
        assert_eq!(signed(&zeniths, &[90.0, 0.0, 45.0]), None);
    }

    #[test]
    fn a_curve_holds_the_values_of_one_point_of_the_other_dimensions() {
        let labels = |name: &str, points: &[&str]| ProductAxis {
            name: name.to_owned(),
            points: AxisPoints::Labels(points.iter().map(|&point| point.to_owned()).collect()),
        };
        let heights =
            ProductAxis { name: "top_m".to_owned(), points: AxisPoints::Numbers(vec![2.0, 1.0]) };
        let product = Product {
            name: "fapar".to_owned(),
            unit: "1".to_owned(),
            dimensions: vec![
                vec![heights],
                vec![labels("material", &["leaf", "bark", "soil"])],
                vec![labels("band", &["red", "nir"])],
            ],
            values: vec![0.0; 12],
            standard_error: vec![0.0; 12],
            image: None,
            faces: None,
            replicates: Vec::new(),
        };
        let curves = Curves::new(&product);
        assert_eq!((curves.axis.as_str(), curves.lines.len()), ("top_m", 6));
        let bark_nir = &curves.lines[3];
        assert_eq!(bark_nir.name, "bark, nir");
        assert_eq!(bark_nir.points, [(1.0, 9), (2.0, 3)]);
    }
}
