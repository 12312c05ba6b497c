use super::context::{labels, numbers};
use super::directions::axes;
use super::{Context, Image, PixelRows, Pixels, Product, reflectance};
use crate::components::View;
use crate::extract::Stage;
use crate::statistics::Spread;
use crate::transport::{
    AlbedoCounter, ConeCounter, EnergyCounter, FluxCounter, FluxLevel, GROUND_TERMS, Hemisphere,
    LayerCounter, ViewCounter,
};

/// Values and errors of a spread, each multiplied by a factor that depends on the cell.
fn scaled(spread: &Spread, bands: usize, factor: impl Fn(usize) -> f64) -> (Vec<f64>, Vec<f64>) {
    let by_cell = |values: &[f64]| -> Vec<f64> {
        values.iter().enumerate().map(|(i, value)| value * factor(i / bands)).collect()
    };
    (by_cell(spread.mean()), by_cell(&spread.standard_error()))
}

/// Albedo: power that leaves through the reference plane over the power that falls on it.
#[must_use]
pub fn albedo(spread: &Spread, counter: &AlbedoCounter, context: &Context) -> Product {
    let (values, errors) = scaled(spread, context.bands.len(), |_| counter.plane.gain);
    context.product(("albedo", "1"), Vec::new(), (&values, &errors), reflectance::fraction)
}

/// BRF of each cell of the hemisphere, its mean over the cell with the weight cos θ:
/// `π P / (E A ∫cos θ dω)` (LESS manual eq. 5 with the exact integral in place of ΔΩ cos θ); `gain` is
/// that of the plane that light leaves through.
#[must_use]
pub fn brf_cells(
    spread: &Spread,
    hemisphere: &Hemisphere,
    gain: f64,
    context: &Context,
) -> Product {
    let cells: Vec<_> = hemisphere.cells().collect();
    let (values, errors) =
        scaled(spread, context.bands.len(), |cell| gain / cells[cell].projected_solid_angle);
    let degrees = |f: fn(&crate::transport::Cell) -> f64| {
        cells.iter().map(move |cell| f(cell).to_degrees()).collect::<Vec<_>>()
    };
    let axes = vec![
        numbers("zenith_deg", degrees(crate::transport::Cell::zenith_center)),
        numbers("azimuth_deg", degrees(crate::transport::Cell::azimuth_center)),
        numbers("solid_angle_cos_sr", cells.iter().map(|cell| cell.projected_solid_angle)),
    ];
    let name = (format!("{}_cells", context.factor()), "1");
    context.product(name, vec![axes], (&values, &errors), reflectance::brf)
}

/// BRF towards directions by virtual photons (LESS manual eq. 8).
#[must_use]
pub fn brf_views(
    spread: &Spread,
    counter: &ViewCounter,
    views: &[View],
    stage: &Stage,
    context: &Context,
) -> Product {
    let bands = context.bands.len();
    let errors = spread.standard_error();
    let (mut values, mut standard_error) = (Vec::new(), Vec::new());
    for (camera, &cell) in counter.cameras().iter().zip(counter.first_cells()) {
        let scale = camera.radiance_per_count(stage);
        let range = cell * bands..(cell + 1) * bands;
        values.extend(spread.mean()[range.clone()].iter().map(|value| value * scale));
        standard_error.extend(errors[range].iter().map(|error| error * scale));
    }
    let name = (format!("{}_views", context.factor()), "1");
    context.product(name, vec![axes(views)], (&values, &standard_error), reflectance::brf)
}

/// BRF within cones, the mean over each with the weight cos θ: `π P / (E A ∫cos θ dω)`.
#[must_use]
pub fn brf_cones(spread: &Spread, counter: &ConeCounter, context: &Context) -> Product {
    let cones = &counter.cones;
    let gain = counter.plane.gain;
    let (values, errors) = scaled(spread, context.bands.len(), |cell| {
        gain / ConeCounter::projected_solid_angle(&cones[cell])
    });
    let views: Vec<View> = cones.iter().map(|cone| cone.axis).collect();
    let mut axes = axes(&views);
    let full = |cone: &crate::components::Cone| 2.0 * cone.half_angle.to_degrees();
    axes.push(numbers("full_angle_deg", cones.iter().map(full)));
    let name = (format!("{}_cones", context.factor()), "1");
    context.product(name, vec![axes], (&values, &errors), reflectance::brf)
}

/// Fractions of the incident flux: `fapar` that each material absorbs in each horizontal layer,
/// `fapar_material` in all, `fapar_vegetation` that all but the ground absorbs; and `ftran` that
/// arrives at the ground: total, uncollided, collided by the canopy alone, and after bounces between
/// ground and canopy.
///
/// With a virtual plane of the area `A` they are `P / (E A)`: the power that is absorbed in the column below the
/// plane, or arrives at the ground there, over the power on the plane.
#[must_use]
pub fn fapar(
    spread: &Spread,
    counter: &LayerCounter,
    stage: &Stage,
    context: &Context,
) -> Vec<Product> {
    let gain = counter.plane.gain;
    let (values, errors) = scaled(spread, context.bands.len(), |_| gain);
    let borders = counter.borders();
    let layers = vec![
        numbers("bottom_m", borders[..counter.layers()].iter().copied()),
        numbers("top_m", borders[1..].iter().copied()),
    ];
    let names = stage.surface_names.clone();
    let materials = || vec![labels("material", &names)];
    let terms = GROUND_TERMS.map(str::to_owned);
    let product = |name: &str, dimensions, cells: std::ops::Range<usize>| {
        let range = cells.start * context.bands.len()..cells.end * context.bands.len();
        let values = (&values[range.clone()], &errors[range]);
        context.product((name, "1"), dimensions, values, reflectance::fraction)
    };
    let (totals, vegetation) = (counter.totals(), counter.vegetation());
    let ground = vegetation + 1;
    vec![
        product("fapar", vec![layers, materials()], 0..totals),
        product("fapar_material", vec![materials()], totals..vegetation),
        product("fapar_vegetation", Vec::new(), vegetation..ground),
        product("ftran", vec![vec![labels("term", &terms)]], ground..ground + terms.len()),
    ]
}

/// Energy balance, as fractions of the flux on the scene's rectangle. For emitted light, under an irradiance of 1,
/// it is in W m⁻² nm⁻¹, and `incident` is the emission of surfaces and sky.
///
/// # Panics
/// If a term of [`EnergyCounter`] has no name here.
#[must_use]
pub fn energy(spread: &Spread, stage: &Stage, context: &Context) -> Product {
    let errors = spread.standard_error();
    let mut terms: Vec<String> =
        ["incident", "reflected", "beside", "missed", "lost", "roulette"].map(str::to_owned).into();
    assert_eq!(terms.len(), EnergyCounter::ABSORBED, "a name for each term");
    terms.extend(stage.surface_names.iter().map(|name| format!("absorbed.{name}")));
    context.product(
        ("energy", "1"),
        vec![vec![labels("term", &terms)]],
        (spread.mean(), &errors),
        reflectance::fraction,
    )
}

/// Down- and upwelling flux density through each level, one image each: per m² of horizontal area, and
/// at the level `terrain_surface` per m² of the inclined ground.
#[must_use]
pub fn fluxes(spread: &Spread, counter: &FluxCounter, context: &Context) -> Vec<Product> {
    let bands = context.bands.len();
    let gain = counter.plane.gain;
    let scaled = |values: &[f64]| -> Vec<f64> { values.iter().map(|value| value * gain).collect() };
    let pixels = counter.pixels();
    let plane = &counter.plane;
    let pixel = plane.size / counter.size.as_dvec2();
    let mut products = Vec::new();
    for (index, level) in counter.levels.iter().enumerate() {
        let level = match level {
            FluxLevel::Terrain => "terrain".to_owned(),
            FluxLevel::TerrainSurface => "terrain_surface".to_owned(),
            FluxLevel::Top => "top".to_owned(),
            FluxLevel::Height(height) => format!("{height}m"),
        };
        for (is_up, direction) in [(false, "downwelling"), (true, "upwelling")] {
            let first = counter.first_cell(index, is_up);
            // The pixels, and their total last.
            let cells = first * bands..(first + pixels + 1) * bands;
            let values = scaled(&spread.mean()[cells.clone()]);
            let errors = scaled(&spread.standard_error_of(cells));
            let total = pixels * bands..;
            // Each pixel holds a share of the power on the whole plane.
            let per_pixel = |values: &[f64]| -> Vec<f32> {
                reflectance::flux_density(&values[..pixels * bands], &context.irradiance)
                    .iter()
                    .map(|value| (value * pixels as f64) as f32)
                    .collect()
            };
            let image = Image {
                width: counter.size.x as usize,
                height: counter.size.y as usize,
                bands: context.bands.clone(),
                pixels: Pixels::from(PixelRows {
                    width: counter.size.x as usize,
                    values: per_pixel(&values),
                    standard_error: per_pixel(&errors),
                    coverage: vec![1.0; pixels],
                }),
                has_errors: true,
                rendering: super::Rendering::Quicklook,
                georeference: Some(super::Georeference {
                    west: context.origin.0 + plane.corner.x,
                    north: context.origin.1 + plane.corner.y + plane.size.y,
                    pixel_width: pixel.x,
                    pixel_height: pixel.y,
                }),
            };
            let mean = (&values[total.clone()], &errors[total]);
            let name = (format!("{direction}_{level}"), "W m-2 nm-1");
            let product = context.product(name, Vec::new(), mean, reflectance::flux_density);
            products.push(Product { image: Some(image), ..product });
        }
    }
    products
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn cells_of_a_lambertian_surface_have_its_reflectance_and_sum_to_its_albedo() {
        let hemisphere = Hemisphere::new(150);
        // Share of the power that a surface of reflectance 0.4 sends into each cell.
        let shares: Vec<f64> =
            hemisphere.cells().map(|cell| 0.4 * cell.projected_solid_angle / PI).collect();
        let spread = Spread::from_rows(150, [shares.as_slice(), shares.as_slice()]);
        let context = Context {
            scenes: 1,
            bands: vec!["b".to_owned()],
            irradiance: vec![1.5],
            has_sky: false,
            origin: (0.0, 0.0),
            formats: Vec::new(),
            sources: Vec::new(),
        };
        let product = brf_cells(&spread, &hemisphere, 1.0, &context);
        assert!(product.values.iter().all(|brf| (brf - 0.4).abs() < 1e-12));
        let albedo = hemisphere
            .cells()
            .zip(&product.values)
            .map(|(cell, brf)| brf * cell.projected_solid_angle / PI)
            .sum::<f64>();
        assert!((albedo - 0.4).abs() < 1e-12);
    }
}
