//! Isolated scenes: one footprint for every sensor and transport system.

use std::fmt::Write as _;

use sunfleck::products::Report;
use sunfleck_tests::{Estimate, SceneText, product};

const VIEWS: &str = "[(0.0, 0.0), (30.0, 90.0), (45.0, 200.0), (60.0, 150.0), (75.0, 330.0)]";
const CONES: &str = "[(0.0, 0.0, 20.0), (30.0, 90.0, 20.0), (45.0, 200.0, 20.0), (60.0, 150.0, 20.0), (75.0, 330.0, 20.0)]";
const COUNT: usize = 5;

/// A site: its ground and what stands on it.
struct Site {
    name: &'static str,
    mesh: &'static str,
    at_m: &'static str,
    terrain: &'static str,
}

const SITES: [Site; 3] = [
    Site {
        name: "pole",
        mesh: r#"Faces(faces_m: [[(0, 0, 0), (0.1, 0, 0), (0.1, 0, 20), (0, 0, 20)]], material: "soil")"#,
        at_m: "[(10.0, 10.0, 0.0)]",
        terrain: r#"Plane(size_m: (20.0, 20.0), height_m: 350.0, material: "soil")"#,
    },
    Site {
        name: "trees",
        mesh: r#"Crown(shape: Ellipsoid(diameter_m: 4.0, height_m: 6.0), base_m: 2.0, leaf_area_m2: 40.0, leaf: Square(side_m: 0.3), leaf_material: "leaf")"#,
        at_m: "[(6.0, 8.0, 0.0), (14.0, 13.0, 0.0)]",
        terrain: r#"Plane(size_m: (20.0, 20.0), material: "soil")"#,
    },
    Site {
        name: "slope",
        mesh: r#"Faces(faces_m: [[(0, 0, 0), (0.1, 0, 0), (0.1, 0, 0.1)]], material: "soil")"#,
        at_m: "[]",
        terrain: r#"Raster(file: "slope.asc", material: "soil")"#,
    },
];

/// Measures a site under a sun with directions backward and forward, and with packets and photons.
fn measured(site: &Site, sun_deg: f64, slope: &str) -> Report {
    let Site { mesh, at_m, terrain, .. } = site;
    SceneText::bare(0.3, "")
        .with_leaf(0.4, 0.3)
        .with("meshes", format!(r#""m": {mesh}"#))
        .with("terrain", *terrain)
        .with_file("slope.asc", slope)
        .with("instances", format!(r#"List(of: "m", at_m: {at_m}, on_terrain: true)"#))
        .with("sun", format!("zenith_deg: {sun_deg:?}, azimuth_deg: 160.0"))
        .with("sensors", format!(r#"
        "backward": Directions(system: Backward, views: List({VIEWS}), until: Samples(60000)),
        "forward": Directions(system: Forward, views: List({VIEWS}), until: Samples(120000)),
        "packets": Photons(per_m2: 300.0, measure: [BrfViews(List({VIEWS})), BrfCones({CONES}), Albedo]),
        "photons": Photons(per_m2: 600.0, measure: [BrfCones({CONES}), Albedo], system: Analog)"#))
        .measure()
}

/// *Scene*: a pole, a pair of trees and a slope of 30° on 20 m x 20 m, with the sun at 30°, 75° and
/// 89.9°. *Expected*: five directions and the albedo agree between four systems within four standard
/// errors; the level ground has its reflectance, whatever stands on it.
#[test]
fn all_systems_measure_one_footprint() {
    let step = 30_f64.to_radians().tan();
    let mut slope = "ncols 20\nnrows 20\nxllcorner 0\nyllcorner 0\ncellsize 1\n".to_owned();
    for row in 0..20 {
        let height = 100.0 + step * (19.5 - f64::from(row));
        let _infallible = writeln!(slope, "{}", vec![format!("{height:.9}"); 20].join(" "));
    }
    for site in &SITES {
        for sun_deg in [30.0, 75.0, 89.9] {
            let report = measured(site, sun_deg, &slope);
            let of = |sensor: &str, name: &str, index| {
                Estimate::of(product(&report, sensor, name), index)
            };
            let agree = |what: &str, one: Estimate, other: Estimate| {
                if one == other {
                    // The slope turns its back on a view: nothing is seen, without an error.
                    return;
                }
                let z = one.z_against(other);
                assert!(z.abs() < 4.0, "{} at {sun_deg}, {what}: {one:?} {other:?}", site.name);
            };
            for view in 0..COUNT {
                let reference = of("backward", "brf", view);
                agree(&format!("forward {view}"), of("forward", "brf", view), reference);
                agree(&format!("packets {view}"), of("packets", "brf_views", view), reference);
                // Of a sun at 89.9° hardly a photon meets the ground, and none leaves within a cone.
                if sun_deg < 80.0 {
                    let packets = of("packets", "brf_cones", view);
                    agree(&format!("photons {view}"), of("photons", "brf_cones", view), packets);
                }
                if site.name == "pole" && sun_deg < 60.0 {
                    // The pole is 2 m² that are lit and seen, of 400 m² of ground.
                    assert!(
                        (reference.value - 0.3).abs() < 0.01,
                        "{sun_deg}, {view}: {reference:?}"
                    );
                }
            }
            agree("albedo", of("packets", "albedo", 0), of("photons", "albedo", 0));
        }
    }
}
