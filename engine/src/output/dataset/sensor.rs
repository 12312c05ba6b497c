//! Data set of what a sensor measured.

use std::io;

use super::super::names::SensorNames;
use super::super::provenance::{self, RecipeForm, RecipeTexts};
use super::super::{OfSensor, length};
use super::axes::{AlongDimension, DatasetAxes};
use super::grid_mapping::grid_mapping;
use super::names::{VariableNames, describe, in_words, standard_name};
use super::pixels::{ImageRasters, PixelValues};
use super::{Attribute, Attributes, Dataset, Values, Variable};
use crate::products::{Class, Image, Product, Rendering, Report};

/// Version of the conventions that data sets follow.
pub(super) const CONVENTIONS: &str = "CF-1.10";

/// Data set of all products of a sensor.
///
/// - `rasters`: rasters of each product, if it is an image
///
/// # Errors
/// If the file of a raster cannot be opened again.
pub(in crate::output) fn of_sensor<'a>(
    measured: &OfSensor<'a>,
    planned: &SensorNames,
    rasters: Vec<Option<ImageRasters>>,
) -> io::Result<Dataset<'a>> {
    let OfSensor { report, sensor, recipe } = *measured;
    let mut names = VariableNames::default();
    let keys: Vec<ProductKeys> =
        planned.products.iter().map(|product| ProductKeys::new(&product.key, &mut names)).collect();
    let mapping = sensor.products.iter().any(has_place).then(|| grid_mapping(report)).flatten();
    let mapping = mapping.map(|attributes| (names.take("crs"), attributes));
    let mut axes = DatasetAxes::new(report, names);
    let mut variables = Vec::new();
    for ((product, keys), rasters) in sensor.products.iter().zip(&keys).zip(rasters) {
        if product.values.is_empty() {
            continue;
        }
        let mut of_product =
            ProductVariables { product, keys, axes: &mut axes, variables: &mut variables };
        match (&product.image, rasters) {
            (Some(image), Some(rasters)) => {
                let mapping = mapping.as_ref().map_or("", |(name, _)| name);
                of_product.add_image(image, rasters, mapping)?;
            }
            _ => of_product.add_table(),
        }
    }
    let DatasetAxes { dimensions, coordinates, .. } = axes;
    let mapping = mapping.into_iter().map(|(name, attributes)| Variable {
        name,
        dimensions: Vec::new(),
        attributes,
        values: Values::Nothing,
        has_fill: false,
        is_raster: false,
    });
    let variables = coordinates.into_iter().chain(mapping).chain(variables).collect();
    Ok(Dataset { dimensions, attributes: global(report, &sensor.name, recipe), variables })
}

/// Returns true if a product is an image on the ground.
fn has_place(product: &Product) -> bool {
    product.image.as_ref().is_some_and(|image| image.georeference.is_some())
}

/// Attributes of a data set.
pub(super) fn global(report: &Report, sensor: &str, recipe: &RecipeTexts) -> Attributes {
    let mut attributes = Attributes::default();
    attributes.text("Conventions", CONVENTIONS);
    attributes.text("title", format!("{}: {}", report.scene.trim(), sensor));
    attributes.text("source", format!("sunfleck {}", report.version));
    // Without a time, so that equal runs make equal files.
    attributes.text("history", format!("written by sunfleck {}", report.version));
    let provenance = provenance::of_sensor(report, sensor, recipe, RecipeForm::Readable);
    for (key, value) in provenance {
        attributes.text(key, value);
    }
    attributes
}

/// Names of the variables of a product.
pub(super) struct ProductKeys {
    pub(super) values: String,
    pub(super) errors: String,
    coverage: String,
    mean: String,
    mean_errors: String,
}

impl ProductKeys {
    pub(super) fn new(key: &str, names: &mut VariableNames) -> Self {
        let values = names.take(key);
        let mut with = |ending: &str| names.take(&format!("{values}{ending}"));
        Self {
            errors: with("_standard_error"),
            coverage: with("_coverage"),
            mean: with("_mean"),
            mean_errors: with("_mean_standard_error"),
            values,
        }
    }
}

/// Adds the variables of a product.
pub(super) struct ProductVariables<'a, 'v, 'p, 'r> {
    pub(super) product: &'a Product,
    pub(super) keys: &'p ProductKeys,
    pub(super) axes: &'p mut DatasetAxes<'r>,
    pub(super) variables: &'p mut Vec<Variable<'v>>,
}

impl ProductVariables<'_, '_, '_, '_> {
    /// Dimensions of the product's values.
    pub(super) fn along(&mut self) -> Vec<AlongDimension> {
        let Self { product, keys, axes, .. } = self;
        let dimensions =
            product.dimensions.iter().filter(|axes| length(axes) > 0 && !axes.is_empty());
        dimensions.map(|dimension| axes.along(dimension, &keys.values)).collect()
    }
}

impl<'a: 'v, 'v> ProductVariables<'a, 'v, '_, '_> {
    /// Adds the values of a table and their errors.
    fn add_table(&mut self) {
        let along = self.along();
        let [values, errors] = [&self.product.values, &self.product.standard_error]
            .map(|values| Values::Doubles(values.as_slice().into()));
        let name = in_words(&self.keys.values);
        let (one, other) = (self.keys.values.clone(), self.keys.errors.clone());
        self.add_pair([one, other], &name, &along, (values, Some(errors)), "");
    }

    /// Adds the pixels of an image, their errors and coverage, and the mean over the image.
    fn add_image(&mut self, image: &Image, rasters: ImageRasters, mapping: &str) -> io::Result<()> {
        let of_mean = self.along();
        let of_pixels = self.axes.of_pixels(image, &self.keys.values);
        let along: Vec<_> = of_mean.iter().cloned().chain(of_pixels.clone()).collect();
        let first = self.variables.len();
        let name = in_words(&self.keys.values);
        let names = [self.keys.values.clone(), self.keys.errors.clone()];
        let PixelValues { values, errors, coverage } = rasters.into_values(image)?;
        self.add_pair(names, &name, &along, (values, errors), &self.keys.coverage.clone());
        let mut attributes = Attributes::default();
        attributes.text("long_name", "fraction of the pixel that shows the scene");
        attributes.text("units", "1");
        self.add(self.keys.coverage.clone(), &of_pixels, attributes, coverage);
        for variable in &mut self.variables[first..] {
            variable.is_raster = true;
            if image.georeference.is_some() {
                variable.attributes.text("grid_mapping", mapping);
            }
        }
        if let Rendering::Classes(classes) = &image.rendering {
            let attributes = &mut self.variables[first].attributes;
            let numbers = (1..=classes.len()).map(|number| number as f32).collect();
            attributes.0.push(("flag_values".to_owned(), Attribute::Floats(numbers)));
            let word = |class: &Class| class.name.split_whitespace().collect::<Vec<_>>().join("_");
            attributes
                .text("flag_meanings", classes.iter().map(word).collect::<Vec<_>>().join(" "));
        }
        let [values, errors] = [&self.product.values, &self.product.standard_error]
            .map(|values| Values::Doubles(values.as_slice().into()));
        let names = [self.keys.mean.clone(), self.keys.mean_errors.clone()];
        self.add_pair(
            names,
            &format!("mean of {name} over the image"),
            &of_mean,
            (values, image.has_errors.then_some(errors)),
            "",
        );
        Ok(())
    }
}

impl<'v> ProductVariables<'_, 'v, '_, '_> {
    /// Adds values and their standard errors, if they have some.
    ///
    /// - `more`: name of a further ancillary variable, or none
    pub(super) fn add_pair(
        &mut self,
        [name, error]: [String; 2],
        long_name: &str,
        along: &[AlongDimension],
        (values, errors): (Values<'v>, Option<Values<'v>>),
        more: &str,
    ) {
        let Product { name: quantity, unit, .. } = self.product;
        let unit = if unit.is_empty() { "1" } else { unit };
        let mut attributes = Attributes::default();
        describe(&mut attributes, quantity, long_name, unit);
        let ancillary = if errors.is_some() { format!("{error} {more}") } else { more.to_owned() };
        attributes.text("ancillary_variables", ancillary.trim_end());
        self.add(name, along, attributes, values);
        let Some(errors) = errors else { return };
        let mut attributes = Attributes::default();
        let standard = standard_name(quantity);
        if !standard.is_empty() {
            attributes.text("standard_name", format!("{standard} standard_error"));
        }
        attributes.text("long_name", format!("standard error of {long_name}"));
        attributes.text("units", unit);
        self.add(error, along, attributes, errors);
    }

    fn add(
        &mut self,
        name: String,
        along: &[AlongDimension],
        mut attributes: Attributes,
        values: Values<'v>,
    ) {
        let auxiliary: Vec<&str> =
            along.iter().flat_map(|one| &one.auxiliary).map(String::as_str).collect();
        attributes.text("coordinates", auxiliary.join(" "));
        let dimensions = along.iter().map(|one| one.place).collect();
        let (has_fill, is_raster) = (true, false);
        self.variables.push(Variable { name, dimensions, attributes, values, has_fill, is_raster });
    }
}
