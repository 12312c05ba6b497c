//! Results depend on the scene and its seed and on nothing else.

use sunfleck::products::{Report, SensorReport};
use sunfleck_tests::SceneText;

/// Every kind of sensor.
const SENSORS: &str = r#"
        "image": Orthographic(size_px: (40, 33), extent_m: (5.0, 5.0), zenith_deg: 20.0, samples_per_px: 17, denoised: true),
        "back": Directions(system: Backward, views: PrincipalPlane(max_deg: 60.0, step_deg: 20.0), until: RelError(0.02)),
        "forth": Directions(views: PrincipalPlane(max_deg: 60.0, step_deg: 20.0), until: RelError(0.02), system: Forward),
        "photons": Photons(per_m2: 5000.0, measure: [Albedo, BrfCells(40), Fapar(layer_m: 0.7), Fluxes(pixel_m: 0.5)]),
        "whole": Photons(per_m2: 500.0, measure: [Albedo, BrfCells(40), Absorbed(per: Triangle)], system: Analog),
        "once": Orthographic(size_px: (40, 33), extent_m: (5.0, 5.0), samples_per_px: 17, measure: [Orders], system: FirstOrder),
    "#;

fn scene() -> SceneText {
    SceneText::trees_in_daylight("Periodic").with("sensors", SENSORS)
}

/// All numbers of a report, as bits.
fn bits(report: &Report) -> Vec<u64> {
    let bits = |sensor: &SensorReport| sensor.bits().expect("pixels can be read");
    report.sensors.iter().flat_map(bits).collect()
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        bits(&pool.install(|| scene().measure()))
    };
    let one = with(1);
    assert!(one.len() > 1000);
    assert!(one == with(2), "2 threads differ from 1");
    assert!(one == with(7), "7 threads differ from 1");
}

#[test]
fn another_seed_is_another_estimate() {
    let other = scene().with("transport", "seed: 2");
    assert!(bits(&scene().measure()) != bits(&other.measure()));
}

/// *Scene*: the same with the anchor at a UTM position. *Expected*: the same bits.
#[test]
fn the_anchor_changes_no_result() {
    let anchored = scene().with("frame", "origin_m: (500000.0, 5500000.0, 300.0)");
    assert!(bits(&scene().measure()) == bits(&anchored.measure()));
}

/// *Scene*: the same with one more sensor and one more definition before all others.
/// *Expected*: the other sensors give the same bits, because streams are keyed by name.
#[test]
fn another_sensor_changes_no_result() {
    let first = r#""first": Photons(per_m2: 10.0, measure: [Albedo])"#;
    let more = scene().with("sensors", first).with_more("sensors", SENSORS);
    let one = bits(&scene().measure());
    let report = more.measure();
    let others = Report { sensors: report.sensors[1..].to_vec(), ..report };
    assert!(one == bits(&others));
}
