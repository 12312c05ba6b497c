//! Light finds the same way back: ten woods that are drawn at random, on hilly ground, of leaves that
//! let light through and are unlike on their sides.

use std::fmt::Write as _;
use std::path::Path;

use sunfleck::products::Report;
use sunfleck::run::Options;
use sunfleck::sampling::Key;
use sunfleck_tests::{Estimate, measure, product};

/// Standard errors that two estimates may differ by: two-sided significance 6e-5.
const MOST: f64 = 4.0;

/// Woods.
const COUNT: u64 = 10;

/// Side of the tile, m, and cells of its ground along it.
const SIDE: f64 = 4.0;
const CELLS: usize = 4;

/// A wood drawn at random.
struct Wood {
    key: Key,
    drawn: u64,
    /// Ground, materials, meshes and what stands where.
    text: String,
    ground: String,
}

impl Wood {
    fn new(number: u64) -> Self {
        let key = Key::new(number).path("wood");
        let mut wood = Self { key, drawn: 0, text: String::new(), ground: String::new() };
        wood.ground = wood.hills();
        let (mut meshes, mut instances) = (String::new(), String::new());
        for kind in 0..2 {
            let (width, height) = (wood.draw(0.6, 2.5), wood.draw(0.6, 2.0));
            let (base, leaf) = (wood.draw(0.3, 1.5), wood.draw(0.08, 0.3));
            let area = wood.draw(0.5, 4.0) * width * width;
            writeln!(
                meshes,
                r#""crown {kind}": Crown(shape: Ellipsoid(diameter_m: {width}, height_m: {height}),
                base_m: {base}, leaf_area_m2: {area}, leaf: Square(side_m: {leaf}), leaf_material: "leaf {kind}"),"#
            )
            .expect("memory");
            // Crowns reach over the tile's borders.
            let at: Vec<_> =
                (0..2).map(|_| (wood.draw(0.0, SIDE), wood.draw(0.0, SIDE), 0.0)).collect();
            writeln!(instances, r#"List(of: "crown {kind}", at_m: {at:?}),"#).expect("memory");
        }
        let mut materials = String::new();
        for kind in 0..2 {
            let front = wood.spectrum(0.05, 0.5, 0.05);
            let back = wood.spectrum(0.05, 0.5, 0.1);
            let through = wood.spectrum(0.02, 0.45, 0.03);
            writeln!(
                materials,
                r#""leaf {kind}": Leaf(reflectance: {front}, back_reflectance: Some({back}), transmittance: {through},
                temperature: {}),"#,
                wood.temperature()
            )
            .expect("memory");
        }
        let soil = wood.spectrum(0.05, 0.6, 0.1);
        wood.text = format!(
            r#"materials: {{ {materials} "soil": Lambertian(reflectance: {soil}, temperature: {}) }},
    meshes: {{ {meshes} "hills": Obj(file: "hills.obj", up: Z, unit_m: 1.0, material: Some("soil")) }},
    terrain: Mesh(mesh: "hills"),
    instances: [{instances}],"#,
            wood.temperature()
        );
        wood
    }

    fn draw(&mut self, low: f64, high: f64) -> f64 {
        self.drawn += 1;
        low + (high - low) * self.key.uniform(self.drawn)
    }

    /// In red, near and thermal infrared, each up to this.
    fn spectrum(&mut self, red: f64, near: f64, thermal: f64) -> String {
        let values = [red, near, thermal].map(|most| self.draw(0.2, 1.0) * most);
        format!("Bands({values:?})")
    }

    fn temperature(&mut self) -> String {
        let (shaded, more) = (self.draw(285.0, 300.0), self.draw(0.0, 20.0));
        format!("SunlitShaded(sunlit_k: {}, shaded_k: {shaded})", shaded + more)
    }

    fn direction(&mut self) -> (f64, f64) {
        (self.draw(0.0, 70.0), self.draw(0.0, 360.0))
    }

    /// Ground whose opposite borders fit.
    fn hills(&mut self) -> String {
        let heights: [f64; CELLS * CELLS] = std::array::from_fn(|_| self.draw(0.0, 0.8));
        let mut mesh = "g hills\n".to_owned();
        for (i, j) in (0..=CELLS).flat_map(|i| (0..=CELLS).map(move |j| (i, j))) {
            let at = |i: usize| SIDE * i as f64 / CELLS as f64;
            let height = heights[i % CELLS * CELLS + j % CELLS];
            writeln!(mesh, "v {} {} {height}", at(i), at(j)).expect("memory");
        }
        for (i, j) in (0..CELLS).flat_map(|i| (0..CELLS).map(move |j| (i, j))) {
            let (here, next) = (i * (CELLS + 1) + j + 1, (i + 1) * (CELLS + 1) + j + 1);
            writeln!(mesh, "f {here} {next} {}\nf {here} {} {}", next + 1, next + 1, here + 1)
                .expect("memory");
        }
        mesh
    }

    fn run(&self, sun: (f64, f64), more: &str, sensors: &str) -> Report {
        let dir = tempfile::tempdir().expect("a temporary folder");
        std::fs::write(dir.path().join("hills.obj"), &self.ground).expect("a file");
        self.run_in(dir.path(), sun, more, sensors)
    }

    fn run_in(&self, folder: &Path, sun: (f64, f64), more: &str, sensors: &str) -> Report {
        let text = format!(
            r#"Scene(
    format: 1,
    bands: [
        (name: "red", center_nm: 660.0),
        (name: "nir", center_nm: 865.0),
        (name: "tir", center_nm: 10500.0),
    ],
    {}
    sun: (zenith_deg: {}, azimuth_deg: {}, irradiance: Constant(1.0)),
    {more}
    sensors: {{ {sensors} }},
)"#,
            self.text, sun.0, sun.1
        );
        measure(&text, folder, &Options::default())
    }
}

/// *Scene*: each wood repeated without end, in sunlight; and again with sun and sensor in each other's
/// place. *Expected*: the same BRF.
#[test]
#[expect(clippy::print_stdout, reason = "`--nocapture` shows the table")]
fn sun_and_sensor_may_change_places() {
    for number in 0..COUNT {
        let mut wood = Wood::new(number);
        let (a, b) = (wood.direction(), wood.direction());
        let brf = |sun, view| {
            let views = format!(
                r#""views": Directions(system: Backward, views: List([{view:?}]), until: Samples(65536))"#
            );
            let report = wood.run(sun, "boundary: Periodic,", &views);
            let brf = product(&report, "views", "brf");
            [0, 1].map(|band| Estimate::of(brf, band))
        };
        for (band, (there, back)) in brf(a, b).into_iter().zip(brf(b, a)).enumerate() {
            let z = there.z_against(back);
            println!(
                "wood {number}, band {band}: {:.5} and {:.5}, z = {z:.2}",
                there.value, back.value
            );
            assert!(z.abs() < MOST, "wood {number}, {a:?}, {b:?}: {there:?}, {back:?}, z = {z}");
            assert!(there.error < 0.02 * there.value, "{there:?}");
        }
    }
}

/// *Scene*: each wood under sun and sky, by turns without end and on its own, in two views, reflecting
/// and, in the thermal infrared, emitting. *Expected*: paths from the sensor and photon packets find
/// the same radiance.
#[test]
#[expect(clippy::print_stdout, reason = "`--nocapture` shows the table")]
fn forward_and_backward_are_the_same() {
    for number in 0..COUNT {
        let mut wood = Wood::new(number);
        let (sun, views) = (wood.direction(), [wood.direction(), wood.direction()]);
        let boundary = ["Periodic", "Isolated"][number as usize % 2];
        let shares = [wood.draw(0.0, 0.6), wood.draw(0.0, 0.4), 0.0];
        let more = format!(
            "boundary: {boundary}, sky: Fraction({shares:?}), thermal_sky: BlackBody(240.0),"
        );
        let sensor = |samples: u32, system: &str| {
            format!(
                "Directions(views: List({views:?}), until: Samples({samples}), measure: [Radiance], system: {system})"
            )
        };
        let sensors = format!(
            r#""back": {}, "forth": {}"#,
            sensor(32768, "Backward"),
            sensor(65536, "Forward")
        );
        let report = wood.run(sun, &more, &sensors);
        for index in 0..6 {
            let of = |sensor| Estimate::of(product(&report, sensor, "radiance"), index);
            let (back, forth) = (of("back"), of("forth"));
            let z = back.z_against(forth);
            println!(
                "wood {number}, {boundary}, value {index}: {:.5} and {:.5}, errors {:.1e} and {:.1e}, z = {z:.2}",
                back.value,
                forth.value,
                back.error / back.value,
                forth.error / forth.value
            );
            assert!(z.abs() < MOST, "wood {number}, value {index}: {back:?}, {forth:?}, z = {z}");
            assert!(forth.error < 0.05 * forth.value, "{forth:?}");
        }
    }
}
