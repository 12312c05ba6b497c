//! Where a known thing lands in the image of each sensor, and what lies beside it.

use std::f64::consts::{FRAC_1_PI, FRAC_PI_4, SQRT_2};

use sunfleck::products::{Image, Product, Report};
use sunfleck_tests::scene_text::{BAND, BANDS};
use sunfleck_tests::{Estimate, SceneText, product};

/// Three squares of 10 cm that cut each other at right angles: seen from everywhere.
const STAR: &str = "v -.05 -.05 0\nv .05 -.05 0\nv .05 .05 0\nv -.05 .05 0\n\
v -.05 0 -.05\nv .05 0 -.05\nv .05 0 .05\nv -.05 0 .05\n\
v 0 -.05 -.05\nv 0 .05 -.05\nv 0 .05 .05\nv 0 -.05 .05\n\
g star\nf 1 2 3 4\nf 5 6 7 8\nf 9 10 11 12\n";

/// A bright star at each of `stars` over black ground of 40 m by 40 m at `height`, in the sun.
fn stars(stars: &str, height: f64, boundary: &str, sensors: &str) -> Report {
    SceneText::default()
        .with("bands", BAND)
        .with("materials", r#""black": Lambertian(reflectance: Constant(0.0)), "bright": Leaf(reflectance: Constant(0.5), transmittance: Constant(0.5))"#)
        .with_obj("star", "bright", STAR)
        .with("terrain", format!(r#"Plane(size_m: (40.0, 40.0), height_m: {height:?}, material: "black")"#))
        .with("instances", format!(r#"List(of: "star", at_m: [{stars}])"#))
        .with("sun", "zenith_deg: 35.0, azimuth_deg: 115.0, irradiance: Constant(1.0)")
        .with("boundary", boundary)
        .with("sensors", sensors)
        .measure()
}

fn image<'a>(report: &'a Report, sensor: &str) -> &'a Image {
    product(report, sensor, "radiance").image.as_ref().expect("an image")
}

/// Middle of the light in an image: across and down, from 0 to 1; with its pixel's size.
fn middle(image: &Image) -> ([f64; 2], f64) {
    let (mut sum, mut at) = (0.0, [0.0; 2]);
    let pixels = image.load().expect("pixels can be read");
    for (index, &value) in pixels.values.iter().enumerate() {
        let value = f64::from(value.max(0.0) * pixels.coverage[index]);
        let (column, row) = (index % image.width, index / image.width);
        sum += value;
        at[0] += value * (column as f64 + 0.5) / image.width as f64;
        at[1] += value * (row as f64 + 0.5) / image.height as f64;
    }
    assert!(sum > 0.0, "the star is in the image");
    (at.map(|at| at / sum), 1.0 / image.width.min(image.height) as f64)
}

/// The star is where it is expected to within a pixel.
fn assert_at(report: &Report, sensor: &str, expected: [f64; 2]) {
    let (found, pixel) = middle(image(report, sensor));
    for axis in 0..2 {
        assert!(
            (found[axis] - expected[axis]).abs() < pixel,
            "{sensor}: found at {found:?}, expected at {expected:?}"
        );
    }
}

/// *Scene*: a star at (3, 1, 2) m from the image's middle, seen from 60° in four azimuths.
/// *Expected*: right is u = d·(-cos φ, sin φ), up is v = d·(-sin φ, -cos φ) cos 60° + 2 sin 60°.
#[test]
fn an_oblique_orthographic_image_shows_a_thing_where_it_is_from_every_quadrant() {
    let cases = [
        (45, [-SQRT_2, 0.317_837]),
        (135, [2.828_427, 1.024_944]),
        (225, [SQRT_2, 3.146_264]),
        (315, [-2.828_427, 2.439_158]),
    ];
    let sensors: Vec<String> = cases
        .iter()
        .map(|(azimuth, _)| {
            format!(
                r#""{azimuth}": Orthographic(size_px: (160, 80), extent_m: (16.0, 8.0), center_m: (18.0, 17.0), zenith_deg: 60.0, azimuth_deg: {azimuth}.0, samples_per_px: 16, measure: [Radiance]),"#
            )
        })
        .collect();
    let report = stars("(21.0, 18.0, 2.0)", 0.0, "Isolated", &sensors.concat());
    for (azimuth, [u, v]) in cases {
        assert_at(&report, &azimuth.to_string(), [0.5 + u / 16.0, 0.5 - v / 8.0]);
    }
}

/// *Scene*: as above, from cameras 20 m from the target (18, 17, 5) at its height; the star is 2 m
/// above it. *Expected*: tangents u / depth and 2 / depth of fields of 60° and 40°.
#[test]
fn a_perspective_image_shows_a_thing_where_it_is_from_every_quadrant() {
    let s = 14.142_136;
    let cases = [
        ("a", [s, s], -SQRT_2, 17.171_573),
        ("b", [s, -s], 2.828_427, 18.585_786),
        ("c", [-s, -s], SQRT_2, 22.828_427),
        ("d", [-s, s], -2.828_427, 21.414_214),
    ];
    let place = |[x, y]: [f64; 2]| format!("({:?}, {:?}, 5.0)", 18.0 + x, 17.0 + y);
    let sensors: Vec<String> = cases
        .iter()
        .map(|&(name, from, ..)| {
            let keys = "target_m: (18.0, 17.0, 5.0), fov_deg: (60.0, 40.0), samples_per_px: 16";
            format!(
                r#""{name}": Perspective(size_px: (240, 150), position_m: {}, {keys}),"#,
                place(from)
            )
        })
        .collect();
    let down = r#""down": Perspective(size_px: (150, 150), position_m: (21.5, 18.0, 20.0), target_m: (21.5, 18.0, 0.0), up: (0.0, 3.0, 1.0), fov_deg: (30.0, 10.0), samples_per_px: 16),"#;
    let report = stars("(21.0, 18.0, 7.0)", 0.0, "Isolated", &(sensors.concat() + down));
    for (name, _, u, depth) in cases {
        let (across, up) = (u / depth / 0.577_350, 2.0 / depth / 0.363_970);
        assert_at(&report, name, [0.5 + 0.5 * across, 0.5 - 0.5 * up]);
    }
    // 0.5 m west at 13 m below; tan 15° = 0.267949.
    assert_at(&report, "down", [0.5 - 0.5 * 0.5 / 13.0 / 0.267_949, 0.5]);
}

/// *Scene*: a star 60° from the zenith, seen from below by each projection of a hemisphere.
/// *Expected*: distances from the middle of 60/90, sin 30°/sin 45°, sin 60° and tan 30°/tan 45°;
/// north at the top and east on the left, as in a photograph.
#[test]
fn each_fisheye_projection_shows_a_thing_where_it_is_in_every_quadrant() {
    let projections = [
        ("Equidistant", 0.666_667),
        ("Equisolid", 0.5 / 0.5_f64.sqrt()),
        ("Orthographic", 0.866_025),
        ("Stereographic", 0.577_350),
    ];
    let sensors: Vec<String> = projections
        .iter()
        .map(|(projection, _)| {
            let keys = "size_px: (150, 120), position_m: (20.0, 20.0, 1.0), samples_per_px: 16";
            format!(r#""{projection}": Fisheye({keys}, projection: {projection}),"#)
        })
        .collect();
    // 4 m from the camera: 2 m up and 3.4641 m towards 30°, 120°, 210° and 300°.
    let cases = [
        ([0.5, 0.866_025], "(21.7320508, 23.0, 3.0)"),
        ([0.866_025, -0.5], "(23.0, 18.2679492, 3.0)"),
        ([-0.5, -0.866_025], "(18.2679492, 17.0, 3.0)"),
        ([-0.866_025, 0.5], "(17.0, 21.7320508, 3.0)"),
    ];
    for ([east, north], star) in cases {
        let report = stars(star, 0.0, "Isolated", &sensors.concat());
        for (projection, distance) in projections {
            let across = 0.5 - 0.5 * distance * east * 120.0 / 150.0;
            assert_at(&report, projection, [across, 0.5 - 0.5 * distance * north]);
        }
    }
}

/// *Scene*: a star on the horizon 30° to the right and one below, seen by fisheyes that look in a
/// direction, at a target and straight down.
#[test]
fn a_fisheye_looks_where_it_is_told() {
    let keys = "size_px: (120, 120), position_m: (20.0, 20.0, 3.0), fov_deg: 120.0, projection: Equidistant, samples_per_px: 16";
    let sensors = format!(
        r#""towards": Fisheye({keys}, look: Towards(zenith_deg: 90.0, azimuth_deg: 100.0)),
           "target": Fisheye({keys}, look: Target(at_m: (29.8480775, 18.2635182, 3.0))),
           "turned": Fisheye({keys}, look: Target(at_m: (29.8480775, 18.2635182, 3.0)), up: (0.0, 1.0, 0.0)),
           "down": Fisheye({keys}, look: Down),"#
    );
    // Towards 130°, 4 m: (3.0642, -2.5712, 0).
    let report = stars("(23.0641778, 17.4288496, 3.0)", 0.0, "Isolated", &sensors);
    assert_at(&report, "towards", [0.75, 0.5]);
    assert_at(&report, "target", [0.75, 0.5]);
    // With north up, what was right (south) is down.
    assert_at(&report, "turned", [0.5, 0.75]);
    // 1 m east and 1.7320508 m south, 3.4641016 m below: 30° off the axis, towards 150°.
    let report = stars("(21.0, 18.2679492, -0.4641016)", -5.0, "Isolated", &sensors);
    assert_at(&report, "down", [0.5 + 0.25 * 0.5, 0.5 + 0.25 * 0.866_025]);
}

/// *Scene*: ground at 100 m; cameras 5 m above it. *Expected*: the same images, whether heights are
/// written as above the ground or not.
#[test]
fn heights_may_be_above_the_ground() {
    let view = "size_px: (60, 60), fov_deg: (40.0, 40.0), samples_per_px: 16";
    let sky = "size_px: (60, 60), fov_deg: 90.0, samples_per_px: 16, look:";
    let report = stars(
        "(20.5, 20.5, 106.0)",
        100.0,
        "Isolated",
        &format!(
            r#""a": Perspective({view}, position_m: (20.0, 10.0, 105.0), target_m: (20.0, 20.0, 106.0)),
               "b": Perspective({view}, position_m: (20.0, 10.0, 5.0), target_m: (20.0, 20.0, 6.0), above_ground: true),
               "c": Fisheye({sky} Target(at_m: (20.0, 20.0, 104.0)), position_m: (20.0, 17.0, 105.0)),
               "d": Fisheye({sky} Target(at_m: (20.0, 20.0, 4.0)), position_m: (20.0, 17.0, 5.0), above_ground: true),"#
        ),
    );
    for (plain, above) in [("a", "b"), ("c", "d")] {
        let ((plain, pixel), (above, _)) =
            (middle(image(&report, plain)), middle(image(&report, above)));
        for axis in 0..2 {
            assert!((plain[axis] - above[axis]).abs() < pixel, "{plain:?} {above:?}");
        }
    }
}

/// *Scene*: a periodic tile of 40 m; a camera three tiles to the east looks at the star's copy there.
#[test]
fn a_camera_stands_in_any_tile_of_a_periodic_scene() {
    let keys = "size_px: (60, 60), fov_deg: (10.0, 10.0), samples_per_px: 16";
    let report = stars(
        "(39.0, 20.0, 5.0)",
        0.0,
        "Periodic",
        &format!(
            r#""far": Perspective({keys}, position_m: (169.0, 20.0, 5.0), target_m: (159.0, 20.5, 5.0)),"#
        ),
    );
    // 10 m west; the axis points 0.5 m north of it, so that it lies to the left by 0.05 of tan 5°.
    // Copies beyond lie behind it or are small: it has the brightest pixel.
    let image = image(&report, "far").load().expect("pixels can be read");
    let brightness = |&index: &usize| image.values[index].max(0.0) * image.coverage[index];
    let brightest = (0..image.values.len())
        .max_by(|a, b| brightness(a).total_cmp(&brightness(b)))
        .expect("there are pixels");
    let (column, row) = (brightest % 60, brightest / 60);
    // The star is 3.4 pixels wide around 12.86 and 30.
    assert!((10..=15).contains(&column) && (27..=32).contains(&row), "{column}, {row}");
}

/// Black ground under an isotropic sky, and discs between that a fisheye at (20, 20, 1) looks at.
fn under_discs(discs: &str, sensors: &str) -> Report {
    SceneText::default()
        .with("bands", BANDS)
        .with("materials", r#""black": Lambertian(reflectance: Constant(0.0))"#)
        .with_discs("discs", "black", discs)
        .with("terrain", r#"Plane(size_m: (40.0, 40.0), material: "black")"#)
        .with("instances", r#"List(of: "discs", at_m: [(20.0, 20.0, 1.0)])"#)
        .with("sky", "Isotropic(irradiance: Bands([2.0, 3.0]))")
        .with("sensors", sensors)
        .measure()
}

const UP: &str = "position_m: (20.0, 20.0, 1.0), samples_per_px: 32";

/// *Scene*: nothing above. *Expected*: each pixel that the disc touches shows E/π, however little of
/// it lies on the disc; coverage is the disc's share; beside it is no data.
#[test]
fn a_fisheye_sees_an_even_sky_and_nothing_beside_its_disc() {
    for projection in ["Equisolid", "Equidistant", "Orthographic", "Stereographic"] {
        // A disc far below the ground is never seen.
        let report = under_discs(
            "1,0,0,-9,0,0,1",
            &format!(
                r#""up": Fisheye(size_px: (40, 32), {UP}, projection: {projection}, measure: [Radiance, Brf])"#
            ),
        );
        let sky = image(&report, "up").load().expect("pixels can be read");
        for (index, &coverage) in sky.coverage.iter().enumerate() {
            for (band, e) in [(0, 2.0), (1, 3.0)] {
                let value = f64::from(sky.values[2 * index + band]);
                if coverage > 0.0 {
                    assert!((value / (e * FRAC_1_PI) - 1.0).abs() < 1e-6, "{projection}: {value}");
                } else {
                    assert!(value.is_nan(), "{projection}: {value}");
                }
            }
        }
        assert!(sky.coverage[0] == 0.0 && sky.coverage[16 * 40 + 20] >= 1.0);
        let share = sky.coverage.iter().map(|&c| f64::from(c)).sum::<f64>() / (40.0 * 32.0);
        // 40960 stratified samples.
        assert!((share - FRAC_PI_4 * 32.0 / 40.0).abs() < 2e-3, "{projection}: {share}");
        let hdrf = product(&report, "up", "hdrf");
        assert!(hdrf.values.iter().all(|value| (value - 1.0).abs() < 1e-6), "{:?}", hdrf.values);
    }
}

/// *Scene*: black discs with the outline of a sphere, R = 1 and h = 3, overhead and at an offset of
/// 2. *Expected*: the orthographic image weighs with the cosine, so that its mean lacks the view
/// factor (R/h)² = 1/9 and R² h / (h² + d²)^1.5 = 0.0640039; the equisolid image lacks the share of
/// the hemisphere's solid angle, 1 - √(1 - R²/D²).
#[test]
fn a_fisheye_image_has_the_view_factor_of_a_sphere() {
    // A sphere at distance D has the outline of a disc of radius D tan asin(R/D).
    let cases = [
        ("1.0606602,0,0,3,0,0,1", 0.111_111_1, 0.057_191_0),
        ("1.0408330,0,2,3,0,2,3", 0.064_003_9, 0.039_231_1),
    ];
    for (disc, factor, solid) in cases {
        let report = under_discs(
            disc,
            &format!(
                r#""cosine": Fisheye(size_px: (64, 64), {UP}, projection: Orthographic, measure: [Brf]),
                   "solid": Fisheye(size_px: (64, 64), {UP}, projection: Equisolid, measure: [Brf])"#
            ),
        );
        for (sensor, hidden) in [("cosine", factor), ("solid", solid)] {
            let of_sky: &Product = product(&report, sensor, "hdrf");
            let mean = Estimate::of(of_sky, 0);
            assert!(mean.error < 1e-3, "{mean:?}");
            assert!(mean.z(1.0 - hidden).abs() < 4.0, "{sensor}: {mean:?}, hidden {hidden}");
        }
    }
}

/// Grey ground under the sun.
fn plane(sensors: &str) -> Report {
    SceneText::bare(0.5, "size_m: (20.0, 20.0), corner_m: (5.0, -3.0), height_m: 2.0")
        .with("sun", "zenith_deg: 60.0, irradiance: Constant(1.0)")
        .with("sky", "Fraction([0.4])")
        .with("sensors", sensors)
        .measure()
}

/// *Scene*: a plane that ends, seen by cameras that look over its edge. *Expected*: wherever there
/// is data it is the plane's: what lies beyond is left out of mixed pixels, and coverage tells.
#[test]
fn pixels_half_beside_the_scene_are_not_mixed() {
    let report = plane(
        r#""view": Perspective(size_px: (30, 20), position_m: (15.0, -8.0, 6.0), target_m: (15.0, 17.0, 3.0), fov_deg: (60.0, 40.0), measure: [Radiance, Brf]),
           "sky": Perspective(size_px: (30, 20), position_m: (15.0, -8.0, 6.0), target_m: (15.0, 17.0, 3.0), fov_deg: (60.0, 40.0), sees_sky: true),
           "map": Orthographic(size_px: (21, 21), extent_m: (25.0, 25.0), zenith_deg: 30.0, azimuth_deg: 20.0, measure: [Radiance]),
           "eye": Fisheye(size_px: (30, 30), position_m: (15.0, 7.0, 6.0), look: Down, fov_deg: 160.0, sees_sky: false)"#,
    );
    // Irradiance 0.5 of a sun of 1 at 60°, π L = ρ E; the share of the sky is a random choice.
    let radiance = 0.5 * 0.5 * FRAC_1_PI;
    for sensor in ["view", "map", "eye"] {
        let image = image(&report, sensor).load().expect("pixels can be read");
        let mut kinds = [0; 3];
        for (pixel, &coverage) in image.coverage.iter().enumerate() {
            let (value, error) = (image.values[pixel], f64::from(image.standard_error[pixel]));
            if coverage == 0.0 {
                assert!(value.is_nan(), "{sensor}: {value}");
            } else {
                // What one sample alone met has no standard error.
                let error = if error.is_nan() { 0.0 } else { error };
                let deviation = (f64::from(value) - radiance).abs();
                assert!(deviation < 6.0 * error + 1e-6, "{sensor}: {value} +- {error}");
            }
            kinds[if coverage == 0.0 { 0 } else { 1 + usize::from(coverage >= 1.0) }] += 1;
        }
        assert!(kinds.iter().all(|&count| count > 0), "{sensor} has all kinds: {kinds:?}");
    }
    // The sky of 0.4 over π is seen above the horizon.
    let sky = image(&report, "sky").load().expect("pixels can be read");
    let top = f64::from(sky.values[15]);
    assert!((top / (0.5 * 0.4 * FRAC_1_PI) - 1.0).abs() < 1e-6, "{top}");
}

/// *Scene*: the same plane, covered whole. *Expected*: the terrain's own rectangle from above; from
/// the diagonal a rectangle of which half is scene; samples by area.
#[test]
fn an_image_may_cover_the_whole_scene_and_count_samples_by_area() {
    let report = plane(
        r#""map": Orthographic(size_px: (10, 5), cover: WholeScene, samples_per_m2: 5.0, measure: [Radiance]),
           "same": Orthographic(size_px: (10, 5), extent_m: (20.0, 20.0), samples_per_px: 40, measure: [Radiance]),
           "askew": Orthographic(size_px: (64, 64), cover: WholeScene, zenith_deg: 60.0, azimuth_deg: 135.0, samples_per_px: 32, measure: [Radiance])"#,
    );
    let place = image(&report, "map").georeference.expect("a place");
    assert_eq!(image(&report, "same").georeference, Some(place));
    let numbers = [place.west, place.north, place.pixel_width, place.pixel_height];
    for (found, expected) in numbers.into_iter().zip([5.0, 17.0, 2.0, 4.0]) {
        assert!((found - expected).abs() < 1e-12, "{place:?}");
    }
    let of = |name: &str| report.sensors.iter().find(|s| s.name == name).expect("a sensor");
    assert_eq!(of("map").samples, 50 * 40, "pixels are 8 m²");
    let map = image(&report, "map").load().expect("pixels can be read");
    assert!(map.coverage.iter().all(|&coverage| coverage >= 1.0));
    let askew = image(&report, "askew").load().expect("pixels can be read").coverage;
    let share = askew.iter().map(|&c| f64::from(c)).sum::<f64>() / askew.len() as f64;
    assert!((share - 0.5).abs() < 2e-3, "{share}");
}
