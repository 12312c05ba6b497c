//! Estimates compared with what they estimate.

use std::path::Path;

use super::checkpoint::CheckpointStore;
use super::convergence::{ErrorCheck, Start, relative_errors};
use super::rounds::trace;
use super::sensors::{Begun, MeasureContext, SensorEntity, begin, in_order, measure};
use super::setting::{context, setting};
use super::{Options, SceneWorld, Unwatched, document};
use crate::extract::{SceneOptics, extract};
use crate::products::{Product, ProductSize};
use crate::scratch::ScratchSpace;

/// A tree on soil in two bands of reflected light and one of emitted, with these sensors.
fn for_each_sensor(sensors: &str, test: impl Fn(&SensorEntity, MeasureContext<'_>)) {
    let text = format!(
        r#"Scene(
            format: 1,
            bands: [
                (name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.0),
                (name: "tir", center_nm: 10500.0, width_nm: 100.0),
            ],
            materials: {{
                "soil": Lambertian(reflectance: Bands([0.1, 0.3, 0.05]), temperature: Uniform(300.0)),
                "leaf": Leaf(
                    reflectance: Bands([0.05, 0.5, 0.02]), transmittance: Bands([0.03, 0.45, 0.0]),
                    temperature: Uniform(290.0),
                ),
            }},
            meshes: {{ "tree": Crown(
                shape: Ellipsoid(diameter_m: 2.0, height_m: 3.0), base_m: 0.5, leaf_area_m2: 12.0,
                leaf: Rhombus(length_m: 0.1, width_m: 0.07), leaf_material: "leaf",
            ) }},
            terrain: Plane(size_m: (5.0, 5.0), material: "soil"),
            instances: [List(of: "tree", at_m: [(0.2, 2.0, 0.0), (3.0, 4.9, 0.0)])],
            sun: (zenith_deg: 50.0, azimuth_deg: 10.0, irradiance: Constant(1.0)),
            boundary: Periodic,
            sensors: {{ {sensors} }},
        )"#
    );
    let reading =
        document::read_text("test.ron", &text, &document::ReadOptions::default()).expect("a scene");
    assert!(reading.is_sound(), "{}", reading.render());
    let built = SceneWorld::from_scene(&reading.scene, Path::new("")).expect("a world");
    let optics = SceneOptics::from_world(&built.world, reading.scene.bands.len());
    let stage = extract(&built.world, &optics, &setting(&reading.scene), None).expect("a stage");
    let context = context(&reading.scene, built.resources.responses.all(), &optics);
    for sensor in in_order(&built.world) {
        let scratch = &ScratchSpace::default();
        test(&sensor, MeasureContext { stage: &stage, context: &context, scratch });
    }
}

/// Products have the sizes that were estimated, except for single numbers.
#[test]
fn products_have_the_estimated_extents() {
    let many = |extent: &ProductSize| extent.values() > 3;
    for_each_sensor(
        r#"
        "map": Orthographic(size_px: (20, 33), extent_m: (5.0, 5.0), measure: [Brf, Radiance, Orders, BrightnessTemperature, FourComponents, GapFraction], denoised: true),
        "film": Orthographic(size_px: (7, 4), extent_m: (5.0, 5.0), system: Forward, samples_per_px: 50, measure: [Brf, Radiance, Orders]),
        "eye": Fisheye(size_px: (20, 20), position_m: (2.5, 2.5, 0.2), measure: [Radiance, GapFraction]),
        "views": Directions(views: PrincipalPlane(max_deg: 60.0, step_deg: 15.0), measure: [Brf, Radiance, Orders, BrightnessTemperature, FourComponents, GapFraction], until: Samples(64)),
        "photons": Photons(per_m2: 20.0, measure: [
            Albedo, Exitance, BrfCells(12), RadianceCells(12), BrfViews(List([(0.0, 0.0), (30.0, 20.0)])),
            RadianceViews(List([(0.0, 0.0), (30.0, 20.0)])), BrfCones([(0.0, 0.0, 5.0), (30.0, 5.0, 5.0)]),
            RadianceCones([(0.0, 0.0, 5.0), (30.0, 5.0, 5.0)]), BrightnessTemperature,
            Fapar(layer_m: 1.0), Orders, Fluxes(pixel_m: 1.0, heights_m: [2.0]), Absorbed(per: Triangle),
        ]),
        "borders": Photons(per_m2: 20.0, measure: [Fapar(layer_m: [0.0, 1.5, 2.0, 9.0]), Absorbed(per: Instance)]),
        "#,
        |sensor, scene| {
            let Begun { mut measurement, .. } = begin(&sensor.name, &sensor.sensor, scene, 1.0);
            let mut estimated: Vec<ProductSize> =
                measurement.product_sizes().into_iter().filter(many).map(in_memory).collect();
            trace(measurement.as_mut(), 16, &|_| ()).expect("memory");
            let products: Vec<Product> = measurement.products().expect("memory");
            let mut found: Vec<ProductSize> =
                products.iter().map(ProductSize::new).filter(many).collect();
            let order = |extent: &ProductSize| format!("{extent:?}");
            estimated.sort_by_key(order);
            found.sort_by_key(order);
            assert_eq!(estimated, found, "{}", sensor.name);
        },
    );
}

/// Size of a product whose pixels are in memory, as that of one that was made cannot tell where they are.
fn in_memory(size: ProductSize) -> ProductSize {
    match size {
        ProductSize::Image { width, pixels, bands, .. } => {
            ProductSize::Image { width, pixels, bands, is_kept: true, is_denoised: false }
        }
        other => other,
    }
}

/// The errors of the first samples give the number of all samples within a factor of two.
#[test]
fn first_errors_give_the_number_of_samples() {
    for_each_sensor(
        r#"
        "map": Orthographic(size_px: (20, 20), extent_m: (5.0, 5.0), measure: [Brf], until: RelError(0.05)),
        "views": Directions(views: PrincipalPlane(max_deg: 60.0, step_deg: 15.0), measure: [Brf], until: RelError(0.005)),
        "photons": Photons(measure: [BrfCells(50), Fapar(layer_m: 1.0)], until: RelError(0.03)),
        "counted": Photons(measure: [Albedo], until: [Samples(100000), RelError(1e-9)]),
        "#,
        |sensor, scene| {
            let name = &sensor.name;
            let Begun { mut measurement, convergence } = begin(name, &sensor.sensor, scene, 1.0);
            let look = convergence
                .schedule
                .evaluations()
                .find(|&look| look >= 32)
                .expect("looks never end");
            trace(measurement.as_mut(), look, &|_| ()).expect("memory");
            let errors = relative_errors(measurement.as_mut()).expect("pixels");
            let check = ErrorCheck { samples: look, errors };
            let start = Start { samples: 0, seconds: 0.0 };
            let estimated = convergence.expected_end(&start, 1.0, Some(&check));
            let store = &mut CheckpointStore::disabled();
            let report = measure(sensor, scene, &Options::default(), store, &Unwatched);
            let samples = report.expect("a report").samples as f64;
            let first = measurement.films().iter().map(|paced| paced.film.samples()).sum::<u64>();
            let ratio = estimated * first as f64 / look as f64 / samples;
            assert!((0.5..2.0).contains(&ratio), "{name}: {ratio}, {estimated} from {look}");
        },
    );
}
