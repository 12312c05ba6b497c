//! Dimensions of products and their coordinates: those with the same points are shared.

use super::super::rows::columns;
use super::names::{VariableNames, describe, in_words, name_and_unit};
use super::{Attributes, Dimension, Values, Variable};
use crate::products::{AxisPoints, Georeference, Image, ProductAxis, Report};

/// Names of dimensions that several axes run along, by an axis that is among them.
const SEVERAL_AXES: [(&str, &str); 2] = [("zenith_deg", "view"), ("bottom_m", "layer")];

/// Dimensions of a data set, with their coordinates, that grow while products ask for them.
pub(super) struct DatasetAxes<'a> {
    report: &'a Report,
    /// True if views have zenith angles with a sign too: the sun has one azimuth.
    has_signs: bool,
    pub(super) names: VariableNames,
    pub(super) dimensions: Vec<Dimension>,
    pub(super) coordinates: Vec<Variable<'static>>,
    known: Vec<(Points, AlongDimension)>,
}

/// A dimension and the names of its coordinates that do not have its own name.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AlongDimension {
    /// Its place among all dimensions.
    pub(super) place: usize,
    pub(super) auxiliary: Vec<String>,
}

/// Points of a dimension.
#[derive(PartialEq)]
enum Points {
    Axes(Vec<ProductAxis>),
    /// Rows of an image; edge and step in metres if it lies on the ground.
    Rows(usize, Option<[f64; 2]>),
    Columns(usize, Option<[f64; 2]>),
}

impl<'a> DatasetAxes<'a> {
    pub(super) fn new(report: &'a Report, names: VariableNames) -> Self {
        Self {
            report,
            has_signs: true,
            names,
            dimensions: Vec::new(),
            coordinates: Vec::new(),
            known: Vec::new(),
        }
    }

    /// Axes of the points of a sweep, of which each may have another sun.
    pub(super) fn of_sweep(report: &'a Report, names: VariableNames) -> Self {
        Self { has_signs: false, ..Self::new(report, names) }
    }

    /// Dimension of a product's values.
    pub(super) fn along(&mut self, axes: &[ProductAxis], product: &str) -> AlongDimension {
        let (first, _) = name_and_unit(&axes[0].name);
        let has = |(axis, _): &&(&str, &str)| axes.iter().any(|one| one.name == *axis);
        let several = SEVERAL_AXES.iter().find(has).filter(|_| axes.len() > 1);
        self.along_named(several.map_or(first, |(_, name)| *name), axes, product)
    }

    /// Dimension of this name.
    pub(super) fn along_named(
        &mut self,
        dimension: &str,
        axes: &[ProductAxis],
        product: &str,
    ) -> AlongDimension {
        self.known_or(Points::Axes(axes.to_vec()), |all| {
            let all_axes = if all.has_signs { columns(axes, all.report) } else { axes.to_vec() };
            let is_band = axes.iter().any(|axis| axis.name == "band");
            let (place, dimension) = all.dimension(dimension, axes[0].points.len(), product);
            let mut auxiliary = Vec::new();
            for axis in all_axes {
                let (name, unit) = name_and_unit(&axis.name);
                // The coordinate variable of a dimension has its name.
                let is_own = auxiliary.is_empty() && name == dimension.base;
                let taken = if is_own { dimension.name.clone() } else { all.take(name, product) };
                let mut attributes = Attributes::default();
                let unit = match &axis.points {
                    AxisPoints::Numbers(_) => unit,
                    AxisPoints::Labels(_) => "",
                };
                describe(&mut attributes, name, &in_words(name), unit);
                let values = match axis.points {
                    AxisPoints::Numbers(numbers) => Values::Doubles(numbers.into()),
                    AxisPoints::Labels(labels) => Values::Texts(labels),
                };
                all.coordinate(&taken, place, attributes, values);
                if !is_own {
                    auxiliary.push(taken);
                }
            }
            if is_band {
                auxiliary.extend(all.of_bands(axes, place, product));
            }
            AlongDimension { place, auxiliary }
        })
    }

    /// Dimensions of the rows and the columns of an image.
    pub(super) fn of_pixels(&mut self, image: &Image, product: &str) -> [AlongDimension; 2] {
        let place = image.georeference;
        let rows = place.map(|Georeference { north, pixel_height, .. }| [north, -pixel_height]);
        let columns = place.map(|Georeference { west, pixel_width, .. }| [west, pixel_width]);
        [
            self.along_pixels(Points::Rows(image.height, rows), "y", product),
            self.along_pixels(Points::Columns(image.width, columns), "x", product),
        ]
    }

    fn along_pixels(&mut self, points: Points, name: &str, product: &str) -> AlongDimension {
        let (length, on_ground) = match &points {
            Points::Rows(length, place) | Points::Columns(length, place) => (*length, *place),
            Points::Axes(axes) => (axes[0].points.len(), None),
        };
        self.known_or(points, |all| {
            let (place, dimension) = all.dimension(name, length, product);
            let mut attributes = Attributes::default();
            // An image without a place on the ground counts from its lower left corner, so that programs that turn y
            // upwards show it upright.
            let [edge, step] =
                on_ground.unwrap_or(if name == "x" { [0.0, 1.0] } else { [length as f64, -1.0] });
            match (on_ground, name) {
                (Some(_), "x") => describe(&mut attributes, name, "easting", "m"),
                (Some(_), _) => describe(&mut attributes, name, "northing", "m"),
                (None, "x") => describe(&mut attributes, "", "pixels from the left edge", "1"),
                (None, _) => describe(&mut attributes, "", "pixels from the lower edge", "1"),
            }
            attributes.text("axis", name.to_uppercase());
            let centres = (0..length).map(|index| edge + step * (index as f64 + 0.5));
            let values = Values::Doubles(centres.collect::<Vec<f64>>().into());
            all.coordinate(&dimension.name, place, attributes, values);
            AlongDimension { place, auxiliary: Vec::new() }
        })
    }

    fn known_or(
        &mut self,
        points: Points,
        make: impl FnOnce(&mut Self) -> AlongDimension,
    ) -> AlongDimension {
        if let Some((_, found)) = self.known.iter().find(|(known, _)| *known == points) {
            return found.clone();
        }
        let made = make(self);
        self.known.push((points, made.clone()));
        made
    }

    /// A new dimension and its place.
    fn dimension(&mut self, base: &str, length: usize, product: &str) -> (usize, NewDimension) {
        let name = self.take(base, product);
        self.dimensions.push(Dimension { name: name.clone(), length });
        (self.dimensions.len() - 1, NewDimension { base: base.to_owned(), name })
    }

    /// A name that no other variable has: with that of the product, if one has it.
    fn take(&mut self, name: &str, product: &str) -> String {
        if self.names.is_free(name) {
            self.names.take(name)
        } else {
            self.names.take(&format!("{name}_{product}"))
        }
    }

    fn coordinate(
        &mut self,
        name: &str,
        dimension: usize,
        attributes: Attributes,
        values: Values<'static>,
    ) {
        self.coordinates.push(Variable {
            name: name.to_owned(),
            dimensions: vec![dimension],
            attributes,
            values,
            has_fill: false,
            is_raster: false,
        });
    }

    /// Adds centres and widths of bands; returns the names of these coordinates.
    fn of_bands(&mut self, axes: &[ProductAxis], place: usize, product: &str) -> Vec<String> {
        let report = self.report;
        let names = axes.iter().find_map(|axis| match &axis.points {
            AxisPoints::Labels(labels) if axis.name == "band" => Some(labels),
            _ => None,
        });
        let known = names.into_iter().flatten().map(|name| {
            let index = report.bands.iter().position(|band| band == name)?;
            let width = report.bandwidths.get(index).copied().unwrap_or(f64::NAN);
            Some([*report.wavelengths.get(index)?, width])
        });
        let Some(known) = known.collect::<Option<Vec<[f64; 2]>>>().filter(|all| !all.is_empty())
        else {
            return Vec::new();
        };
        let kinds = [("wavelength", "centre wavelength"), ("bandwidth", "width of the band")];
        let add = |(kind, (name, long_name)): (usize, (&str, &str))| {
            let taken = self.take(name, product);
            let mut attributes = Attributes::default();
            describe(&mut attributes, name, long_name, "nm");
            let values = known.iter().map(|pair| pair[kind]).collect::<Vec<f64>>();
            self.coordinate(&taken, place, attributes, Values::Doubles(values.into()));
            taken
        };
        let is_known =
            |(kind, _): &(usize, (&str, &str))| known.iter().all(|pair| pair[*kind].is_finite());
        kinds.into_iter().enumerate().filter(is_known).map(add).collect()
    }
}

/// Name of a dimension, and the name that it would have if it were the only one of its kind.
struct NewDimension {
    base: String,
    name: String,
}
