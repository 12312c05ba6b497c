//! Numbers hold at the edges of what a scene can be: its size, its place on Earth, the size of leaves
//! and the gaps between them, grazing light and views, next to no leaves and very many, light that
//! nothing absorbs, and sums of 10⁹ terms.
//!
//! Infinite sheets of leaf have a closed form: adding layers, R₁₂ = R₁ + T₁² R₂ / (1 - R₁ R₂), from
//! any direction to any other. Where a case differs from another in nothing but what should not
//! matter, both draw the same random numbers, and their difference has next to no noise.
//!
//! `SUNFLECK_FULL=1 cargo test --release -p sunfleck-tests --test stress -- --nocapture` measures closed
//! forms with 128 times the samples.

use std::fmt::Write as _;

use sunfleck::products::Report;
use sunfleck::run::Options;
use sunfleck::statistics::Sums;
use sunfleck_tests::scene_text::LEAF;
use sunfleck_tests::{Estimate, SceneText, product};

/// What a relative deviation may be.
const MOST: f64 = 1e-3;

/// Standard errors that an estimate may be off: two-sided significance 6e-5.
const MOST_ERRORS: f64 = 4.0;

/// Share of the energy that may get lost in rounding.
const BALANCE: f64 = 1e-9;

/// Factor on the samples: 1 for a quick look.
fn quality() -> f64 {
    if std::env::var_os("SUNFLECK_FULL").is_some() { 128.0 } else { 1.0 }
}

/// All numbers of a run: BRF by view and band, then the albedo by band; and the energy lost.
fn numbers(report: &Report) -> (Vec<Estimate>, f64) {
    let mut all = Vec::new();
    for (sensor, name) in [("views", "brf"), ("photons", "albedo")] {
        let product = product(report, sensor, name);
        all.extend((0..product.values.len()).map(|at| Estimate::of(product, at)));
    }
    let balance = report.sensors.iter().filter_map(|sensor| sensor.energy_imbalance);
    (all, balance.fold(0.0, f64::max))
}

/// Says how far numbers are off, and asserts that it is not far. Against a closed form errors count:
/// only where they are small enough can the deviation be.
#[expect(clippy::print_stdout, reason = "`--nocapture` shows the table")]
fn assert_close(case: &str, report: &Report, expected: &[f64], is_closed_form: bool) {
    let (found, balance) = numbers(report);
    assert_eq!(found.len(), expected.len(), "{case}");
    let (mut most, mut most_z, mut allowed) = (0.0_f64, 0.0_f64, true);
    for (found, expected) in found.iter().zip(expected) {
        let deviation = (found.value / expected - 1.0).abs();
        let error = found.error / expected;
        // Weights are f32: where there is no noise this much of rounding is left.
        let z = (deviation - 1e-5).max(0.0) / error.max(1e-12);
        (most, most_z) = (most.max(deviation), most_z.max(z));
        let is_sharp = !is_closed_form || MOST_ERRORS * error < MOST;
        allowed &= z < MOST_ERRORS && (deviation < MOST || !is_sharp);
        assert!(deviation.is_finite(), "{case}: {found:?} for {expected}");
    }
    let errors = found.iter().zip(expected).map(|(found, expected)| found.error / expected);
    let error = errors.fold(0.0, f64::max);
    let row = format!(
        "{case:44} deviation {most:8.1e}, {most_z:4.1} of the errors, the largest {error:7.1e}; energy {balance:7.1e}"
    );
    println!("{row}");
    assert!(allowed && balance < BALANCE, "{row}\n{found:?}\nfor {expected:?}");
}

/// Crowns on a periodic tile; all lengths are in units of `unit` metres, and its corner lies at `place`.
fn forest(unit: f64, place: (f64, f64, f64), origin: (f64, f64, f64), quality: f64) -> Report {
    let m = |length: f64| length * unit;
    let at = |x: f64, y: f64| (place.0 + m(x), place.1 + m(y), place.2);
    let [width, base, side] = [3.0, 0.5, 0.125].map(m);
    let area = 15.0 * unit * unit;
    let (size, corner, height) = ((m(5.0), m(4.0)), (place.0, place.1), place.2);
    let trees = [at(4.5, 3.875), at(2.25, 1.0)];
    let per_m2 = 200.0 / (unit * unit);
    SceneText::default()
        .with("frame", format!("origin_m: {origin:?}"))
        .with("bands", r#"(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.0)"#)
        .with("materials", format!(r#""soil": Lambertian(reflectance: Bands([0.127, 0.159])), {LEAF}"#))
        .with("meshes", format!(r#""crown": Crown(
        shape: Ellipsoid(diameter_m: {width:?}, height_m: {width:?}), base_m: {base:?}, leaf_area_m2: {area:?},
        leaf: Square(side_m: {side:?}), leaf_material: "leaf",
    )"#))
        .with("terrain", format!(r#"Plane(size_m: {size:?}, corner_m: {corner:?}, height_m: {height:?}, material: "soil")"#))
        .with("instances", format!(r#"List(of: "crown", at_m: {trees:?})"#))
        .with("sun", "zenith_deg: 40.0, azimuth_deg: 110.0, irradiance: Constant(1.0)")
        .with("boundary", "Periodic")
        .with("sensors", format!(r#"
        "views": Directions(system: Backward, views: List([(0.0, 0.0), (50.0, 77.0), (40.0, 110.0)]), until: Samples(4096)),
        "photons": Photons(per_m2: {per_m2:?}, measure: [Albedo])"#))
        .measure_with(&Options { quality, ..Options::default() })
}

/// *Scene*: two crowns on a periodic tile, 1024 times smaller to 16 384 times larger (leaves of 0.1 mm to
/// 2 km), with an anchor of up to 10⁷ m, and up to 10⁷ m from the origin and 5 km above it.
/// *Expected*: the numbers of the same scene at unit scale and at the origin; to the last bit where
/// lengths are multiplied by powers of two, which round nothing, and anchors move nothing.
#[test]
fn neither_the_scale_nor_the_place_of_a_scene_matters() {
    let here = (0.0, 0.0, 0.0);
    let (unit, _) = numbers(&forest(1.0, here, here, 1.0));
    for exponent in [-10, -7, -3, 3, 7, 10, 14] {
        let (found, balance) = numbers(&forest(2_f64.powi(exponent), here, here, 1.0));
        assert_eq!(found, unit, "scale 2^{exponent}");
        assert!(balance < BALANCE, "{balance}");
    }
    for anchor in [(5e5, 5.5e6, 300.0), (1e7, -1e7, 8e3)] {
        let (found, _) = numbers(&forest(1.0, here, anchor, 1.0));
        assert_eq!(found, unit, "anchor {anchor:?}");
    }
    let (unit, _) = numbers(&forest(1.0, here, here, 16.0));
    let expected: Vec<f64> = unit.iter().map(|estimate| estimate.value).collect();
    for place in [(5e5, 5.5e6, 300.0), (1e7, -1e7, 5e3)] {
        let report = forest(1.0, place, here, 16.0);
        assert_close(&format!("place {place:?}"), &report, &expected, false);
    }
}

/// A stack of infinite sheets of leaf, each a square of `leaves` x `leaves` leaves.
struct Sheets {
    /// Side of the periodic tile, m.
    tile: f64,
    leaves: usize,
    /// Height of every second row of corners over the others, m.
    pleat: f64,
    count: usize,
    /// Distance of a sheet from the next one, and of the lowest one from the soil, m.
    gap: f64,
    /// Middle of the tile, m.
    place: (f64, f64, f64),
    leaf: (f64, f64),
    soil: f64,
    sun_deg: f64,
    view_deg: f64,
    samples: f64,
    kill: f64,
}

impl Default for Sheets {
    fn default() -> Self {
        Self {
            tile: 1.0,
            leaves: 1,
            pleat: 0.0,
            count: 2,
            gap: 0.25,
            place: (0.0, 0.0, 0.0),
            leaf: (0.45, 0.35),
            soil: 0.2,
            sun_deg: 30.0,
            view_deg: 20.0,
            samples: 8192.0,
            kill: 0.05,
        }
    }
}

impl Sheets {
    /// Reflectance of the stack, by adding layers.
    fn reflectance(&self) -> f64 {
        let (r, t) = self.leaf;
        (0..self.count).fold(self.soil, |below, _| r + t * t * below / (1.0 - r * below))
    }

    /// Sheets as large as the tile.
    fn run(&self, quality: f64) -> Report {
        self.run_of(self.tile, quality)
    }

    /// Square sheets of this side, m.
    fn run_of(&self, side: f64, quality: f64) -> Report {
        let mut sheet = "g sheet\n".to_owned();
        let n = self.leaves;
        let at = |i: usize| side * (i as f64 / n as f64 - 0.5);
        for (i, j) in (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))) {
            let up = if i % 2 == 1 { self.pleat } else { 0.0 };
            writeln!(sheet, "v {} {} {up}", at(i), at(j)).expect("memory");
        }
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let (here, next) = (i * (n + 1) + j + 1, (i + 1) * (n + 1) + j + 1);
            writeln!(sheet, "f {here} {next} {} {}", next + 1, here + 1).expect("memory");
        }
        let &Self { tile, sun_deg, view_deg, kill, samples, .. } = self;
        let (x, y, ground) = self.place;
        let heights = (1..=self.count).map(|sheet| (x, y, ground + sheet as f64 * self.gap));
        let at = heights.collect::<Vec<_>>();
        let corner = (x - 0.5 * tile, y - 0.5 * tile);
        let per_m2 = samples / (tile * tile);
        SceneText::bare(self.soil, &format!("size_m: ({tile:?}, {tile:?}), corner_m: {corner:?}, height_m: {ground:?}"))
            .with_leaf(self.leaf.0, self.leaf.1)
            .with_obj("sheet", "leaf", &sheet)
            .with("instances", format!(r#"List(of: "sheet", at_m: {at:?})"#))
            .with("sun", format!("zenith_deg: {sun_deg:?}, azimuth_deg: 10.0, irradiance: Constant(1.0)"))
            .with("boundary", "Periodic")
            .with("transport", format!("roulette: (after_order: 5, kill: {kill:?})"))
            .with("sensors", format!(r#"
        "views": Directions(system: Backward, views: List([({view_deg:?}, 77.0)]), until: Samples({samples})),
        "photons": Photons(per_m2: {per_m2:?}, measure: [Albedo])"#))
            .measure_with(&Options { quality, ..Options::default() })
    }

    /// Its numbers, of as many samples as it says.
    fn numbers(&self) -> Vec<f64> {
        numbers(&self.run(1.0)).0.iter().map(|estimate| estimate.value).collect()
    }

    /// Asserts that BRF and albedo are the closed form.
    fn assert_exact(&self, case: &str) {
        let expected = self.reflectance();
        assert_close(case, &self.run(quality()), &[expected, expected], true);
    }

    /// Asserts that BRF and albedo are these, of the same random numbers.
    fn assert_same(&self, case: &str, expected: &[f64]) {
        assert_close(case, &self.run(1.0), expected, false);
    }
}

/// *Scene*: two sheets over soil; then sheets of leaves of 1 m to 0.1 mm, and sun and view at up to 89.9°.
/// *Expected*: the closed form of two layers, and its very numbers.
#[test]
fn neither_the_size_of_leaves_nor_the_angles_matter_where_all_is_covered() {
    let first = Sheets::default();
    first.assert_exact("two sheets");
    let expected = first.numbers();
    for (tile, leaves) in [(4.0, 4), (1.0, 10), (1.0, 100), (0.1, 100), (0.02, 200)] {
        let sheets = Sheets { tile, leaves, gap: 0.25 * tile, ..Sheets::default() };
        sheets.assert_same(&format!("leaves of {:e} m", tile / leaves as f64), &expected);
    }
    for sun_deg in [0.0, 60.0, 89.0, 89.9] {
        for view_deg in [0.0, 60.0, 89.0, 89.9] {
            let sheets = Sheets { sun_deg, view_deg, ..Sheets::default() };
            sheets.assert_same(&format!("sun at {sun_deg}°, view at {view_deg}°"), &expected);
        }
    }
}

/// *Scene*: two sheets over soil, a metre to a hundredth of a millimetre apart, at the origin, 140 km
/// and 14 000 km from it; pleated, so that places across decide heights; and opaque over white soil.
/// *Expected*: the numbers of the first of them; of opaque ones, whatever is below.
#[test]
fn neither_gaps_nor_places_matter() {
    let places = [(0.0, 0.0, 0.0), (1e5, 1e5, 1e3), (1e7, -1e7, 5e3)];
    let flat = Sheets::default();
    let pleated = || Sheets { leaves: 2, pleat: 0.2, ..Sheets::default() };
    let opaque = || Sheets { leaf: (0.6, 0.0), soil: 1.0, ..pleated() };
    let (flat, covered) = (flat.numbers(), opaque().numbers());
    for gap in [1.0, 1e-2, 1e-3, 1e-4, 1e-5] {
        let of_gap = Sheets { gap, ..pleated() }.numbers();
        for place in places {
            let case = |what: &str| format!("{what} sheets, {gap:e} m, {place:?}");
            Sheets { gap, place, ..Sheets::default() }.assert_same(&case("flat"), &flat);
            Sheets { gap, place, ..pleated() }.assert_same(&case("pleated"), &of_gap);
            Sheets { gap, place, ..opaque() }.assert_same(&case("opaque"), &covered);
        }
    }
}

/// *Scene*: 1 to 20 sheets, so a leaf area index of 1 to 20; and single square leaves of a hundredth and
/// a tenth of the tile over black soil. *Expected*: layers that add up; the leaf's share of the light,
/// `LAI ρ`.
#[test]
fn few_and_many_leaves_are_exact() {
    for count in [1, 3, 8, 20] {
        let sheets = Sheets { count, gap: 0.1, ..Sheets::default() };
        sheets.assert_exact(&format!("leaf area index {count}"));
    }
    for (tile, sun_deg) in [(10.0, 30.0), (10.0, 75.0), (10.0_f64.sqrt(), 30.0)] {
        let lai = 1.0 / (tile * tile);
        let leaf =
            Sheets { tile, sun_deg, view_deg: 50.0, count: 1, soil: 0.0, ..Sheets::default() };
        // Most light misses so small a leaf.
        let rare = if quality() > 1.0 { 2.0 / lai } else { 1.0 };
        let report = leaf.run_of(1.0, quality() * rare);
        let expected = lai * leaf.leaf.0;
        assert_close(&format!("leaf area index {lai:.2}"), &report, &[expected, expected], true);
    }
}

/// *Scene*: 100 sheets that absorb nothing over soil that absorbs nothing, where light is scattered up to
/// 10⁴ times, with and without roulette. *Expected*: all of it comes out again; without roulette
/// without any noise but that of f32.
#[test]
fn what_nothing_absorbs_comes_out_after_thousands_of_orders() {
    for leaf in [(0.5, 0.5), (0.7, 0.3), (0.1, 0.9)] {
        let sheets = Sheets {
            count: 100,
            gap: 0.1,
            leaf,
            soil: 1.0,
            samples: 512.0,
            kill: 0.0,
            ..Sheets::default()
        };
        let report = sheets.run(1.0);
        let albedo = Estimate::of(product(&report, "photons", "albedo"), 0);
        assert!((albedo.value - 1.0).abs() < MOST && albedo.error < 1e-4, "{leaf:?}: {albedo:?}");
        assert_close(&format!("nothing absorbs, leaves {leaf:?}"), &report, &[1.0, 1.0], true);
    }
}

/// *Expected*: 10⁹ weights, summed as packets are, deviate from their exact sum by less than 10⁻¹².
#[test]
fn a_thousand_million_terms_add_up() {
    const BANDS: usize = 8;
    const BLOCK: u64 = 2048;
    let calls = 1_000_000_000 / BANDS as u64;
    let mut total = Sums::new(1, BANDS);
    let mut exact = [0_u64; BANDS];
    let mut state = 1_u64;
    for _ in 0..calls / BLOCK {
        let mut block = Sums::new_sparse(1, BANDS);
        for _ in 0..BLOCK {
            // Whole multiples of 2⁻²⁴ of all sizes, none of which f32 rounds.
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let weights: [u64; BANDS] =
                std::array::from_fn(|band| (state >> (32 + band)) & 0xff_ffff);
            let spectrum = weights.map(|weight| weight as f32 * (-24_f32).exp2());
            for (sum, value) in block.cell_mut(0).iter_mut().zip(&spectrum) {
                *sum += f64::from(*value) * 0.3;
            }
            for (sum, weight) in exact.iter_mut().zip(weights) {
                *sum += weight;
            }
        }
        total.merge(&block);
    }
    for (sum, exact) in total.values().iter().zip(exact) {
        let exact = exact as f64 * (-24_f64).exp2() * 0.3;
        assert!((sum / exact - 1.0).abs() < 1e-12, "{sum} for {exact}");
    }
}
