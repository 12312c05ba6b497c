//! Light split by its order of scattering, cones, and what becomes of it in the canopy.

use std::f64::consts::PI;
use std::sync::LazyLock;

use sunfleck::products::{Product, Report};
use sunfleck::transport::{EnergyCounter, Hemisphere};
use sunfleck_tests::{Estimate, SceneText, product};

const PARTS: [&str; 3] = ["uc", "co_sgl", "mlt"];

/// Trees in a periodic tile; two tests read it.
static PERIODIC: LazyLock<Report> = LazyLock::new(|| trees("Periodic"));

/// Trees of two bands under sun and sky.
fn trees(boundary: &str) -> Report {
    let (points, _) = points_in_cells();
    let views = "List([(0.0, 0.0), (40.0, 100.0), (60.0, 190.0)])";
    let sensors = format!(
        r#"
        "back": Directions(system: Backward, views: {views}, until: Samples(16000), measure: [Brf, Orders]),
        "inside": Directions(system: Backward, views: List([{points}]), until: Samples(4800), measure: [Brf, Orders]),
        "forth": Directions(views: {views}, until: Samples(24000), measure: [Brf, Orders], system: Forward),
        "image": Orthographic(size_px: (4, 4), extent_m: (5.0, 5.0), samples_per_px: 256, measure: [Brf, Orders]),
        "film": Orthographic(size_px: (4, 4), extent_m: (5.0, 5.0), samples_per_px: 512, measure: [Brf, Orders], system: Forward),
        "photons": Photons(per_m2: 5000.0, measure: [
            Albedo, BrfCells(40), BrfViews({views}), Orders,
            BrfCones([(0.0, 0.0, 8.0), (40.0, 100.0, 8.0), (60.0, 190.0, 8.0)]),
            Fapar(layer_m: 0.7),
        ]),
        "layers": Photons(per_m2: 400.0, measure: [Fapar(layer_m: [-1.0, 0.0, 1.5, 9.0])]),
    "#
    );
    SceneText::trees_in_daylight(boundary).with("sensors", sensors).measure()
}

/// Directions in each cell that is looked at.
const POINTS: usize = 96;

/// Directions even in `∫ cos θ dω` over some of the 40 cells: near the horizon, towards the sun and
/// away from it, and the cap; and the numbers of these cells.
fn points_in_cells() -> (String, [usize; 4]) {
    let chosen = [3, 20, 27, 39];
    let cells: Vec<_> = Hemisphere::new(40).cells().collect();
    let mut points = Vec::new();
    for cell in chosen.map(|cell| cells[cell]) {
        let share = |(a, b): (f64, f64), t: f64| a + (b - a) * t;
        let squares = (cell.zenith.0.cos().powi(2), cell.zenith.1.cos().powi(2));
        for point in 0..POINTS {
            let u = (point as f64 + 0.5) / POINTS as f64;
            let v = (point as f64 * 0.618_033_99).fract();
            let zenith = share(squares, u).sqrt().acos().to_degrees();
            points.push(format!("({zenith:?}, {:?})", share(cell.azimuth, v).to_degrees()));
        }
    }
    (points.join(", "), chosen)
}

/// The largest difference between a product and the sum of its parts, over its largest value.
fn gap(report: &Report, sensor: &str, name: &str) -> f64 {
    let whole = product(report, sensor, name);
    let parts: Vec<&Product> =
        PARTS.iter().map(|part| product(report, sensor, &format!("{name}_{part}"))).collect();
    let sums = |of: &dyn Fn(&Product) -> Vec<f64>| {
        let all: Vec<Vec<f64>> = parts.iter().map(|part| of(part)).collect();
        let whole = of(whole);
        let largest = whole.iter().copied().fold(0.0, f64::max);
        let gaps = whole.iter().enumerate().map(|(i, value)| {
            (value - all.iter().map(|part| part[i]).sum::<f64>()).abs() / largest
        });
        gaps.fold(0.0, f64::max)
    };
    assert!(parts.iter().all(|part| part.values.iter().any(|value| *value > 0.0)), "{name}");
    let pixels = |product: &Product| -> Vec<f64> {
        let image = product.image.iter();
        let values = image.flat_map(|image| image.load().expect("pixels can be read").values);
        values.map(f64::from).collect()
    };
    // Pixels are reported as f32.
    assert!(whole.image.is_none() || sums(&pixels) < 3e-7, "{sensor}, {name}");
    sums(&|product| product.values.clone())
}

/// *Expected*: the three parts sum to the whole in every product; each part is the same forwards
/// and backwards, in cones, cells and towards directions.
#[test]
fn parts_sum_to_the_whole_and_agree_between_all_estimators() {
    let isolated = trees("Isolated");
    for (boundary, report) in [("Periodic", &*PERIODIC), ("Isolated", &isolated)] {
        for (sensor, name) in [
            ("back", "hdrf"),
            ("forth", "hdrf"),
            ("image", "hdrf"),
            ("film", "hdrf"),
            ("photons", "albedo"),
            ("photons", "hdrf_cells"),
            ("photons", "hdrf_cones"),
            ("photons", "hdrf_views"),
        ] {
            let gap = gap(report, sensor, name);
            assert!(gap < 1e-12, "{boundary}, {sensor}, {name}: {gap}");
        }
        for suffix in ["", "_uc", "_co_sgl", "_mlt"] {
            let of = |sensor, name: &str| product(report, sensor, &format!("{name}{suffix}"));
            let back = of("back", "hdrf");
            let others =
                [of("forth", "hdrf"), of("photons", "hdrf_views"), of("photons", "hdrf_cones")];
            for (which, other) in others.into_iter().enumerate() {
                for index in 0..6 {
                    let (one, other) = (Estimate::of(back, index), Estimate::of(other, index));
                    // Over a cone of 8° the factor bends by less than this.
                    let bend = if which == 2 { 0.01 * one.value } else { 0.0 };
                    let allowed = 4.0 * one.error.hypot(other.error) + bend + 1e-6;
                    assert!(
                        (one.value - other.value).abs() < allowed,
                        "{boundary}{suffix}, {which}, {index}: {one:?} {other:?}"
                    );
                }
            }
            // A cell is the mean of directions that are even in ∫ cos θ dω. They share their points on the
            // ground: the errors of all of them may go the same way.
            let (inside, cells) = (of("inside", "hdrf"), of("photons", "hdrf_cells"));
            let (_, chosen) = points_in_cells();
            for (which, cell) in chosen.into_iter().enumerate() {
                for band in 0..2 {
                    let first = which * POINTS;
                    let n = POINTS as f64;
                    let values: Vec<f64> = (first..first + POINTS)
                        .map(|view| inside.values[2 * view + band])
                        .collect();
                    let value = values.iter().sum::<f64>() / n;
                    let squares: f64 = values.iter().map(|one| (one - value).powi(2)).sum();
                    let spread = (squares / (n * (n - 1.0))).sqrt();
                    let shared: f64 = (first..first + POINTS)
                        .map(|view| inside.standard_error[2 * view + band])
                        .sum::<f64>()
                        / n;
                    let one = Estimate { value, error: spread.hypot(shared) };
                    let other = Estimate::of(cells, 2 * cell + band);
                    let allowed = 4.0 * one.error.hypot(other.error) + 1e-6;
                    assert!(one.error < 0.2 * one.value + 1e-5, "{boundary}{suffix}: {one:?}");
                    assert!(
                        (one.value - other.value).abs() < allowed,
                        "{boundary}{suffix}, cell {cell}, {band}: {one:?} {other:?}"
                    );
                }
            }
            // One of 150 samples a pixel backwards, and packets forwards.
            let (image, film) = (of("image", "hdrf"), of("film", "hdrf"));
            for band in 0..2 {
                let (one, other) = (Estimate::of(image, band), Estimate::of(film, band));
                let allowed = 4.0 * one.error.hypot(other.error) + 1e-6;
                assert!(
                    (one.value - other.value).abs() < allowed,
                    "{boundary}{suffix}: {one:?} {other:?}"
                );
            }
        }
    }
}

/// *Expected*: in every band absorption by layer sums to that by material, that to the canopy's and
/// the ground's; what reaches the ground does so uncollided, collided or after a bounce; and
/// `fref + fabs + (1 - soil) ftran = 1` but for what roulette adds by chance.
#[test]
fn absorption_and_transmission_account_for_all_light() {
    let report = &*PERIODIC;
    let of = |name| product(report, "photons", name);
    for (band, soil) in [0.1, 0.3].into_iter().enumerate() {
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-9, "band {band}: {a} {b}");
        let entry = |name, index: usize| Estimate::of(of(name), index * 2 + band);
        for material in 0..2 {
            let layers = of("fapar").values.len() / 4;
            let sum = (0..layers).map(|layer| entry("fapar", layer * 2 + material).value).sum();
            near(entry("fapar_material", material).value, sum);
            near(entry("energy", EnergyCounter::ABSORBED + material).value, sum);
        }
        near(entry("fapar_vegetation", 0).value, entry("fapar_material", 1).value);
        let terms: f64 = (1..4).map(|term| entry("ftran", term).value).sum();
        near(entry("ftran", 0).value, terms);
        for term in 0..4 {
            let one = entry("ftran", term);
            assert!(one.value > 0.0 && one.error > 0.0 && one.error < 0.01, "{term}: {one:?}");
        }
        let sum = entry("albedo", 0).value
            + entry("fapar_vegetation", 0).value
            + (1.0 - soil) * entry("ftran", 0).value;
        let allowed = 4.0 * entry("energy", EnergyCounter::ROULETTE).error + 1e-6;
        assert!((sum - 1.0).abs() < allowed, "band {band}: {sum} +- {allowed}");
        // Given borders: the lowest layer is under the ground, the others hold everything.
        let layers = product(report, "layers", "fapar");
        let total = product(report, "layers", "fapar_vegetation").values[band];
        let leaf: Vec<f64> =
            (0..3).map(|layer| layers.values[(layer * 2 + 1) * 2 + band]).collect();
        near(leaf[0], 0.0);
        assert!(leaf[1] > 0.0 && leaf[2] > 0.0, "{leaf:?}");
        near(leaf.iter().sum(), total);
    }
}

/// *Scene*: a sheet of leaf (r, t) over soil s. *Expected*: light of order 1 is r, of order 3
/// t s t, of order 5 t s r s t, of even orders nothing; cut there, both systems give the sum.
#[test]
fn a_highest_order_cuts_the_series_of_a_sheet() {
    let (r, t, s) = (0.45, 0.35, 0.2);
    let series = [r, 0.0, t * s * t, 0.0, t * s * r * s * t];
    for order in 1..=5 {
        let report = SceneText::sheets(&[(r, t, s)], &[1.0])
            .with("transport", format!("max_order: {order}"))
            .with(
                "sensors",
                r#"
        "photons": Photons(per_m2: 500.0, measure: [Albedo]),
        "back": Directions(system: Backward, views: List([(20.0, 90.0)]), until: Samples(16000)),
        "forth": Directions(views: List([(20.0, 90.0)]), until: Samples(16000), system: Forward)"#,
            )
            .measure();
        let expected: f64 = series[..order].iter().sum();
        for (sensor, name) in [("photons", "albedo"), ("back", "brf"), ("forth", "brf")] {
            let one = Estimate::of(product(&report, sensor, name), 0);
            let allowed = 4.0 * one.error + 1e-6;
            assert!(one.error < 1.5e-3, "the third order, 0.0245, is seen: {one:?}");
            assert!(
                (one.value - expected).abs() < allowed,
                "{order}, {sensor}: {one:?} {expected}"
            );
        }
    }
}

/// *Scene*: LAI 3 of small discs with spherical angles, in a periodic layer. *Expected*: single
/// scattering as Ross has it for a turbid medium away from the hot spot, and exactly, whatever the
/// size of the discs, where the sensor looks along the sun's rays; the transmission of the beam.
#[test]
fn single_scattering_by_small_discs_is_that_of_a_turbid_medium() {
    let (rho, tau, soil, lai) = (0.4957_f64, 0.4409_f64, 0.159_f64, 3.0_f64);
    let sun = (20_f64, 30_f64);
    let views = [(20_f64, 30_f64), (60.0, 210.0), (45.0, 120.0), (65.0, 30.0)];
    let list: Vec<String> = views.iter().map(|(z, a)| format!("({z:?}, {a:?})")).collect();
    let list = list.join(", ");
    let (zenith, azimuth) = sun;
    let report = SceneText::bare(soil, "size_m: (4.0, 4.0)")
        .with("bands", r#"(name: "nir", center_nm: 865.0)"#)
        .with_leaf(rho, tau)
        .with("meshes", r#""layer": Crown(
        shape: Box(size_m: (4.0, 4.0, 1.98)), base_m: 0.01, leaf_area_m2: 48.0,
        leaf_angle: Spherical, leaf: Disc(radius_m: 0.01), leaf_material: "leaf",
    )"#)
        .with("instances", r#"List(of: "layer", at_m: [(2.0, 2.0, 0.0)])"#)
        .with("sun", format!("zenith_deg: {zenith:?}, azimuth_deg: {azimuth:?}, irradiance: Constant(1.0)"))
        .with("boundary", "Periodic")
        .with("transport", "first_order_only: true")
        .with("sensors", format!(r#"
        "views": Directions(system: Backward, views: List([{list}]), until: Samples(20000), measure: [Orders]),
        "photons": Photons(per_m2: 4000.0, measure: [Fapar(layer_m: 1.0)])"#))
        .measure();
    let direction = |(zenith, azimuth): (f64, f64)| {
        let ((sz, cz), (sa, ca)) = (zenith.to_radians().sin_cos(), azimuth.to_radians().sin_cos());
        [sz * sa, sz * ca, cz]
    };
    let (to_sun, mu0) = (direction(sun), sun.0.to_radians().cos());
    for (index, view) in views.into_iter().enumerate() {
        let towards = direction(view);
        let muv = towards[2];
        let cos_b = -to_sun.iter().zip(towards).map(|(a, b)| a * b).sum::<f64>();
        let b = cos_b.clamp(-1.0, 1.0).acos();
        let gamma = (rho + tau) / (3.0 * PI) * (b.sin() - b * b.cos()) + tau / 3.0 * b.cos();
        let (k0, kv) = (0.5 / mu0, 0.5 / muv);
        // Along the sun's rays every point that is seen is lit.
        let k = if index == 0 { k0 } else { k0 + kv };
        let single = gamma / (mu0 * muv) * (1.0 - (-k * lai).exp()) / k;
        let uncollided = soil * (-k * lai).exp();
        for (name, expected) in [("brf_co_sgl", single), ("brf_uc", uncollided)] {
            let one = Estimate::of(product(&report, "views", name), index);
            // One layer of many: gaps of this one differ from their mean by about a percent.
            let allowed = 4.0 * one.error + 0.015 * expected;
            assert!(
                (one.value - expected).abs() < allowed,
                "{view:?}, {name}: {one:?}, expected {expected}"
            );
        }
    }
    let transmission = Estimate::of(product(&report, "photons", "ftran"), 1);
    let expected = (-0.5 / mu0 * lai).exp();
    let allowed = 4.0 * transmission.error + 0.01 * expected;
    assert!((transmission.value - expected).abs() < allowed, "{transmission:?} {expected}");
}
