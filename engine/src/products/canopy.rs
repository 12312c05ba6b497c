//! Leaf area of a scene as maps, profiles and tables.

use super::context::{labels, numbers};
use super::{Georeference, Image, PixelRows, Product, ProductAxis, Rendering};
use crate::queries::{CellGrid, HeightModel, LeafAreaGrid};

/// Products of counted leaf area: index by ground cell and by layer, density by layer, and areas in all.
///
/// - `origin`: easting and northing of the local frame's origin, m
/// - `with_cells`: true for the density of every cell of every layer too
///
/// All are one-sided, exact but for rounding, and without a standard error. If surfaces other than leaves are counted,
/// indices and densities are those of plant area.
#[must_use]
pub fn leaf_area_products(
    leaf_area: &LeafAreaGrid,
    origin: (f64, f64),
    with_cells: bool,
) -> Vec<Product> {
    let kind = if leaf_area.is_leaf.contains(&false) { "plant_area" } else { "leaf_area" };
    let columns = Columns::new(leaf_area);
    let grid = &leaf_area.grid;
    let ground = grid.size.element_product();
    let map = columns.with_sum(&leaf_area.columns_total());
    let map = scaled(&map, 1.0 / grid.ground_area());
    let names = &columns.names;
    let sum = names.len() - 1;
    let mut products = vec![map_product(
        &format!("{kind}_index"),
        grid,
        origin,
        (&map, names.len()),
        &[(sum, format!("{} index", kind.replace('_', " ")))],
        Rendering::Map { zero: Some(format!("no {}", kind.replace('_', " "))) },
    )];
    if names.len() > 1 {
        let bands: Vec<(usize, String)> = names.iter().cloned().enumerate().take(sum).collect();
        products.push(map_product(
            &format!("{kind}_index_by_material"),
            grid,
            origin,
            (&map, names.len()),
            &bands,
            Rendering::Quicklook,
        ));
    }
    let layers = columns.with_sum(&leaf_area.layers_total());
    let of_layers = vec![layer_axes(grid), vec![labels("surface", names)]];
    let profile =
        |name: &str, unit: &str, values: Vec<f64>| table(name, unit, of_layers.clone(), values);
    products.push(profile(
        &format!("{kind}_density"),
        "m2 m-3",
        scaled(&layers, 1.0 / (ground * grid.thickness)),
    ));
    let index = scaled(&layers, 1.0 / ground);
    products.push(profile(&format!("{kind}_index_of_layer"), INDEX, index.clone()));
    products.push(profile(&format!("{kind}_index_above"), INDEX, from_above(&index, names.len())));
    if with_cells {
        products.push(cells(&format!("{kind}_density_of_cells"), leaf_area, &columns));
    }
    let places = ["counted", "outside", "below", "over_holes"].map(str::to_owned);
    let counted: Vec<f64> =
        (0..leaf_area.classes.len()).map(|class| leaf_area.total(class)).collect();
    let areas = [&counted, &leaf_area.outside, &leaf_area.below, &leaf_area.over_holes];
    let areas = areas.into_iter().flat_map(|areas| columns.with_sum(areas)).collect();
    products.push(table(
        kind,
        "m2",
        vec![vec![labels("place", &places)], vec![labels("surface", names)]],
        areas,
    ));
    products
}

/// Maps of a height model: canopy height above the ground, and height of the surface, m.
///
/// - `origin`: easting, northing and height of the local frame's origin, m
#[must_use]
pub fn height_products(model: &HeightModel, origin: (f64, f64, f64)) -> Vec<Product> {
    let (x, y, z) = origin;
    let surface: Vec<f64> = model.surface.iter().map(|height| height + z).collect();
    let maps = [
        ("canopy_height", &model.canopy, Some("no plants".to_owned())),
        ("surface_height", &surface, None),
    ];
    let product = |(name, heights, zero): (&str, &Vec<f64>, Option<String>)| {
        let band = [(0, name.replace('_', " "))];
        let rendering = Rendering::Map { zero };
        Product {
            unit: "m".to_owned(),
            ..map_product(name, &model.grid, (x, y), (heights, 1), &band, rendering)
        }
    };
    maps.into_iter().map(product).collect()
}

/// Unit of area of surfaces per area of ground.
const INDEX: &str = "m2 m-2";

/// Columns of tables: the classes, and their sum if there are several.
struct Columns {
    classes: usize,
    names: Vec<String>,
}

impl Columns {
    fn new(leaf_area: &LeafAreaGrid) -> Self {
        let mut names = leaf_area.classes.clone();
        let classes = names.len();
        if classes > 1 {
            names.push("all".to_owned());
        }
        Self { classes, names }
    }

    /// Values of classes, shape `[.., classes]`, with the sum behind those of each.
    fn with_sum(&self, values: &[f64]) -> Vec<f64> {
        let has_sum = self.names.len() > self.classes;
        let row = |row: &[f64]| {
            let sum = has_sum.then(|| row.iter().sum::<f64>());
            row.iter().copied().chain(sum).collect::<Vec<f64>>()
        };
        values.chunks_exact(self.classes).flat_map(row).collect()
    }
}

fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| value * factor).collect()
}

/// Sums over a layer and all above it, shape `[layers, columns]`.
fn from_above(values: &[f64], columns: usize) -> Vec<f64> {
    let mut sums = values.to_vec();
    for index in (0..sums.len().saturating_sub(columns)).rev() {
        sums[index] += sums[index + columns];
    }
    sums
}

fn layer_axes(grid: &CellGrid) -> Vec<ProductAxis> {
    let sides =
        |offset: usize| (0..grid.layers).map(move |layer| grid.layer_bottom(layer + offset));
    vec![numbers("bottom_m", sides(0)), numbers("top_m", sides(1))]
}

/// Density of each cell of each layer, m² m⁻³.
fn cells(name: &str, leaf_area: &LeafAreaGrid, columns: &Columns) -> Product {
    let grid = &leaf_area.grid;
    let volume = grid.ground_area() * grid.thickness;
    let classes = leaf_area.classes.len();
    let layer = grid.rows * grid.columns;
    let of_cell = |cell: usize| {
        (0..grid.layers).flat_map(move |above| {
            let start = (above * layer + cell) * classes;
            &leaf_area.areas[start..start + classes]
        })
    };
    let areas: Vec<f64> = (0..layer).flat_map(of_cell).map(|area| area / volume).collect();
    let middle = |axis: usize, count: usize| {
        let step = grid.size[axis] / count as f64;
        (0..count).map(move |number| grid.corner[axis] + (number as f64 + 0.5) * step)
    };
    let dimensions = vec![
        vec![numbers("y_m", middle(1, grid.rows))],
        vec![numbers("x_m", middle(0, grid.columns))],
        layer_axes(grid),
        vec![labels("surface", &columns.names)],
    ];
    table(name, "m2 m-3", dimensions, columns.with_sum(&areas))
}

fn table(name: &str, unit: &str, dimensions: Vec<Vec<ProductAxis>>, values: Vec<f64>) -> Product {
    Product {
        name: name.to_owned(),
        unit: unit.to_owned(),
        dimensions,
        standard_error: vec![f64::NAN; values.len()],
        values,
        image: None,
        faces: None,
        replicates: Vec::new(),
    }
}

/// Map of exact values on the ground: some columns of values, shape `[rows from south to north, columns of cells, columns]`.
fn map_product(
    name: &str,
    grid: &CellGrid,
    origin: (f64, f64),
    (values, stride): (&[f64], usize),
    bands: &[(usize, String)],
    rendering: Rendering,
) -> Product {
    let mean = |column: usize| {
        let known = values.iter().skip(column).step_by(stride).filter(|value| !value.is_nan());
        known.clone().sum::<f64>() / known.count() as f64
    };
    let means: Vec<f64> = bands.iter().map(|band| mean(band.0)).collect();
    // The first row of an image is the northernmost.
    let rows = (0..grid.rows).rev();
    let cells =
        rows.flat_map(|row| (0..grid.columns).map(move |column| row * grid.columns + column));
    let pixels =
        cells.flat_map(|cell| bands.iter().map(move |band| values[cell * stride + band.0] as f32));
    let values: Vec<f32> = pixels.collect();
    let names: Vec<String> = bands.iter().map(|band| band.1.clone()).collect();
    let is_known = |pixel: &[f32]| f32::from(u8::from(pixel.iter().any(|value| !value.is_nan())));
    let coverage = values.chunks_exact(names.len()).map(is_known).collect();
    let standard_error = vec![f32::NAN; values.len()];
    let axes = vec![vec![labels("band", &names)]];
    let image = Image {
        width: grid.columns,
        height: grid.rows,
        bands: names,
        pixels: PixelRows { width: grid.columns, values, standard_error, coverage }.into(),
        has_errors: false,
        rendering,
        georeference: Some(Georeference {
            west: origin.0 + grid.corner.x,
            north: origin.1 + grid.corner.y + grid.size.y,
            pixel_width: grid.size.x / grid.columns as f64,
            pixel_height: grid.size.y / grid.rows as f64,
        }),
    };
    Product { image: Some(image), ..table(name, INDEX, axes, means) }
}
