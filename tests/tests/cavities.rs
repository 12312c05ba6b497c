//! Slopes, valleys and spheres, whose exchange of light has closed forms.

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::path::Path;

use sunfleck::products::Report;
use sunfleck::run::Options;
use sunfleck::spectral::planck;
use sunfleck_tests::{Estimate, measure, product};

/// Two bands, black ground that is cold, and meshes in OBJ as (material, text, place).
fn run(keys: &str, materials: &str, meshes: &[(&str, &str, &str)], sensors: &str) -> Report {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let (mut definitions, mut instances) = (String::new(), String::new());
    for (index, (material, text, at)) in meshes.iter().enumerate() {
        std::fs::write(dir.path().join(format!("{index}.obj")), text).expect("a file");
        let wears = format!("up: Z, unit_m: 1.0, material: Some(\"{material}\")");
        write!(definitions, "\"m{index}\": Obj(file: \"{index}.obj\", {wears}),")
            .expect("a string");
        write!(instances, "List(of: \"m{index}\", at_m: [{at}]),").expect("a string");
    }
    measure(
        &format!(
            r#"Scene(
    format: 1,
    materials: {{
        "cold": Lambertian(reflectance: Constant(0.0), temperature: Uniform(0.0)),
        "hot": Lambertian(reflectance: Constant(0.0), temperature: Uniform(300.0)),
        {materials}
    }},
    meshes: {{ {definitions} }},
    instances: [{instances}],
    sensors: {{ {sensors} }},
    {keys}
)"#
        ),
        dir.path(),
        &Options::default(),
    )
}

const VISIBLE: &str = "bands: [(name: \"a\", center_nm: 660.0), (name: \"b\", center_nm: 865.0)],";
const THERMAL: &str =
    "bands: [(name: \"a\", center_nm: 10000.0), (name: \"b\", center_nm: 10500.0)],";
const GROUND: &str = "terrain: Plane(size_m: (40.0, 40.0), material: \"cold\"),";
/// All of a path's light goes on, so that its spread is that of its directions alone.
const NO_ROULETTE: &str = "roulette: (after_order: 5, kill: 0.0)";

/// The radiance of `band` is `truth` within 4 standard errors, which are below 0.1 %.
fn assert_radiance(report: &Report, sensor: &str, band: usize, truth: f64) {
    let found = Estimate::of(product(report, sensor, "radiance"), band);
    // Facets of 2° stand for a sphere: areas and cosines differ by less than this.
    let allowed = 4.0 * found.error + 2e-4 * truth;
    assert!((found.value - truth).abs() < allowed, "{sensor}, {band}: {found:?} for {truth}");
    assert!(found.error < 1e-3 * truth, "{sensor}, {band}: {found:?} for {truth}");
}

/// A sphere of `radius` around (0, 0, 0) without its cap within `opening` of the zenith, rad.
fn sphere(radius: f64, opening: f64) -> String {
    let (rings, around) = (90, 180);
    let mut text = "g sphere\n".to_owned();
    for ring in 0..=rings {
        let (sin, cos) = (opening + (PI - opening) * f64::from(ring) / f64::from(rings)).sin_cos();
        for step in 0..around {
            let (y, x) = (TAU * f64::from(step) / f64::from(around)).sin_cos();
            let [x, y, z] = [sin * x, sin * y, cos].map(|along| radius * along);
            writeln!(text, "v {x:.9} {y:.9} {z:.9}").expect("a string");
        }
    }
    for ring in 0..rings {
        for step in 0..around {
            let corner = |ring: i32, step: i32| 1 + ring * around + step % around;
            let (a, b) = (corner(ring, step), corner(ring, step + 1));
            let (c, d) = (corner(ring + 1, step + 1), corner(ring + 1, step));
            // At a pole one of two sides is a point.
            match (ring == 0 && opening == 0.0, ring + 1 == rings) {
                (true, _) => writeln!(text, "f {a} {c} {d}"),
                (_, true) => writeln!(text, "f {a} {b} {c}"),
                _ => writeln!(text, "f {a} {b} {c} {d}"),
            }
            .expect("a string");
        }
    }
    text
}

/// *Scene*: squares of slope β and aspect φ over black ground, under the sun, then under an isotropic
/// sky. *Expected*: `L = ρ E cos i / π` with `cos i = cos θ cos β + sin θ sin β cos(φ_sun - φ)`, in
/// every sample; and `L = ρ E (1 + cos β) / 2π`, as a tilted plane sees that share of the sky.
#[test]
fn a_slope_takes_its_share_of_the_sun_and_of_the_sky() {
    let (rho, sun, azimuth) = ([0.5, 0.2], 40_f64.to_radians(), 200_f64.to_radians());
    let slopes = [(0.0, 0.0), (20.0, 30.0), (35.0, 130.0), (50.0, 220.0), (70.0, 290.0_f64)]
        .map(|(slope, aspect): (f64, f64)| (slope.to_radians(), aspect.to_radians()));
    let mut meshes = Vec::new();
    let mut sensors = String::new();
    for (index, (slope, aspect)) in slopes.into_iter().enumerate() {
        // Along the contour, and down the slope, which is where it looks.
        let (across, down) = ([aspect.cos(), -aspect.sin(), 0.0], {
            let ((sin, cos), level) = (aspect.sin_cos(), slope.cos());
            [sin * level, cos * level, -slope.sin()]
        });
        let mut text = "g slope\n".to_owned();
        for (u, v) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            let corner = [0, 1, 2].map(|axis| u * across[axis] + v * down[axis]);
            writeln!(text, "v {} {} {}", corner[0], corner[1], corner[2]).expect("a string");
        }
        // Far enough apart that the sky which one hides from another is below 1e-3 of the cosine.
        let x = 200.0 * index as f64;
        meshes.push((text + "f 1 2 3 4\n", format!("({x:?}, 0.0, 2.0)")));
        write!(
            sensors,
            "\"{index}\": Orthographic(size_px: (1, 1), extent_m: (0.2, 0.2), center_m: ({x:?}, 0.0), samples_per_px: 1048576, measure: [Radiance]),"
        )
        .expect("a string");
    }
    let meshes: Vec<_> =
        meshes.iter().map(|(text, at)| ("grey", text.as_str(), at.as_str())).collect();
    let ground =
        "terrain: Plane(size_m: (900.0, 100.0), corner_m: (-50.0, -50.0), material: \"cold\"),";
    let grey = "\"grey\": Lambertian(reflectance: Bands([0.5, 0.2])),";
    for light in [
        "sun: (zenith_deg: 40.0, azimuth_deg: 200.0, irradiance: Constant(1.0))",
        "sky: Isotropic(irradiance: Constant(1.0))",
    ] {
        let report = run(&format!("{VISIBLE} {ground} {light},"), grey, &meshes, &sensors);
        for (index, (slope, aspect)) in slopes.into_iter().enumerate() {
            for (band, rho) in rho.into_iter().enumerate() {
                let found = Estimate::of(product(&report, &index.to_string(), "radiance"), band);
                // Normals are f32 and known to 1e-5.
                let (share, most) = if light.starts_with("sun") {
                    let across = sun.sin() * slope.sin() * (azimuth - aspect).cos();
                    ((sun.cos() * slope.cos() + across).max(0.0), 2e-5)
                } else {
                    (0.5 * (1.0 + slope.cos()), 4.0 * found.error + 1e-6)
                };
                let truth = rho * share / PI;
                let off = (found.value - truth).abs();
                assert!(off <= most, "{light}, {index}: {found:?} for {truth}");
                assert!(found.error <= 1e-3 * truth, "{light}, {index}: {found:?} for {truth}");
            }
        }
    }
}

/// *Scene*: endless valleys with walls of slope b. *Expected*: walls have cos b of the sky on the mean,
/// so that light of the first order has the HDRF ρ cos b towards the zenith; and one wall that is hot
/// and black lights the other, which is white, by `F = 1 - cos b`: the mean radiance is `B (1 + F) / 2`.
#[test]
fn walls_of_a_valley_share_the_sky_and_light_each_other() {
    let slope = 40.0_f64;
    let (high, cos) = (slope.to_radians().tan(), slope.to_radians().cos());
    let west = format!("g w\nv 0 -1 {high}\nv 1 -1 0\nv 1 2 0\nv 0 2 {high}\nf 1 2 3 4\n");
    let east = format!("g e\nv 1 -1 0\nv 2 -1 {high}\nv 2 2 {high}\nv 1 2 0\nf 1 2 3 4\n");
    let tile = "terrain: Plane(size_m: (2.0, 1.0), material: \"cold\"), boundary: Periodic,";
    let at = "(0.0, 0.0, 0.1)";
    let grey = "\"grey\": Lambertian(reflectance: Bands([0.5, 0.2])),";
    let nadir = "views: List([(0.0, 0.0)]), until: RelError(0.00099)";
    let report = run(
        &format!(
            "{VISIBLE} {tile} sky: Isotropic(irradiance: Constant(1.0)), \
                 transport: (first_order_only: true),"
        ),
        grey,
        &[("grey", &west, at), ("grey", &east, at)],
        &format!("\"back\": Directions({nadir}), \"forth\": Directions({nadir}, system: Forward)"),
    );
    for sensor in ["back", "forth"] {
        for (band, rho) in [0.5, 0.2].into_iter().enumerate() {
            let found = Estimate::of(product(&report, sensor, "hdrf"), band);
            let truth = rho * cos;
            // Forwards all packets carry the same, as f32.
            let off = (found.value - truth).abs();
            assert!(off < 4.0 * found.error + 1e-6, "{slope}, {sensor}: {found:?} for {truth}");
            assert!(found.error < 1e-3 * truth, "{slope}, {sensor}: {found:?} for {truth}");
        }
    }
    let white = "\"white\": Lambertian(reflectance: Constant(1.0), temperature: Uniform(0.0)),";
    let report = run(
        &format!("{THERMAL} {tile}"),
        white,
        &[("hot", &west, at), ("white", &east, at)],
        &format!("\"nadir\": Directions({nadir}, measure: [Radiance])"),
    );
    for (band, nm) in [10_000.0, 10_500.0].into_iter().enumerate() {
        let truth = 0.5 * (2.0 - cos) * planck(nm, 300.0);
        let found = Estimate::of(product(&report, "nadir", "radiance"), band);
        assert!(found.z(truth).abs() < 4.0, "{slope}: {found:?} for {truth}");
        assert!(found.error < 1e-3 * truth, "{slope}: {found:?} for {truth}");
    }
}

/// *Scene*: a sphere of 1 m at 320 K in one of 2 m at 300 K. *Expected*: the net exchange is
/// `q₁ = π (B₁ - B₂) / (1/ε₁ + (r₁/r₂)² (1/ε₂ - 1))`, so that the inner sphere has the radiance
/// `B₁ - (1/ε₁ - 1) q₁/π` and the outer one `B₂ + (1/ε₂ - 1) (r₁/r₂)² q₁/π`.
#[test]
fn concentric_spheres_exchange_by_their_emissivities() {
    let emissivities = [(0.8, 0.6), (0.3, 0.45)];
    let materials = "\"inner\": Lambertian(reflectance: Bands([0.2, 0.7]), temperature: Uniform(320.0)), \
         \"outer\": Lambertian(reflectance: Bands([0.4, 0.55]), temperature: Uniform(300.0)),";
    let camera = "size_px: (2, 2), position_m: (21.5, 20.0, 5.0), fov_deg: (10.0, 10.0), samples_per_px: 8192, measure: [Radiance]";
    let report = run(
        &format!("{THERMAL} {GROUND} transport: ({NO_ROULETTE}),"),
        materials,
        &[
            ("inner", &sphere(1.0, 0.0), "(20.0, 20.0, 5.0)"),
            ("outer", &sphere(2.0, 0.0), "(20.0, 20.0, 5.0)"),
        ],
        &format!(
            "\"in\": Perspective({camera}, target_m: (20.0, 20.0, 5.0)), \
             \"out\": Perspective({camera}, target_m: (22.0, 20.0, 5.0))"
        ),
    );
    for (band, (inner, outer)) in emissivities.into_iter().enumerate() {
        let nm = [10_000.0, 10_500.0][band];
        let black = [planck(nm, 320.0), planck(nm, 300.0)];
        let net = (black[0] - black[1]) / (1.0 / inner + 0.25 * (1.0 / outer - 1.0));
        assert_radiance(&report, "in", band, black[0] - (1.0 / inner - 1.0) * net);
        assert_radiance(&report, "out", band, black[1] + (1.0 / outer - 1.0) * 0.25 * net);
    }
}

/// *Scene*: a sphere at 300 K with an opening of the share f of its whole area, seen through it.
/// *Expected*: the emissivity `ε / (ε (1 - f) + f)` at every place.
#[test]
fn an_open_cavity_has_the_emissivity_of_its_opening() {
    for share in [0.1, 0.3_f64] {
        let opening = (1.0 - 2.0 * share).acos();
        let report = run(
            &format!("{THERMAL} {GROUND} transport: ({NO_ROULETTE}),"),
            "\"wall\": Lambertian(reflectance: Bands([0.3, 0.8]), temperature: Uniform(300.0)),",
            &[("wall", &sphere(1.0, opening), "(20.0, 20.0, 2.0)")],
            "\"nadir\": Orthographic(size_px: (4, 4), extent_m: (0.4, 0.4), samples_per_px: 8192, measure: [Radiance])",
        );
        for (band, emissivity) in [0.7, 0.2].into_iter().enumerate() {
            let apparent = emissivity / (emissivity * (1.0 - share) + share);
            let nm = [10_000.0, 10_500.0][band];
            assert_radiance(&report, "nadir", band, apparent * planck(nm, 300.0));
        }
    }
}

/// *Scene*: the sun falls straight through the opening f of a sphere of area A, P = E π sin² α of it.
/// *Expected*: what it lights scatters `ρ P / A` evenly on all of the wall, the next order
/// `ρ (1 - f)` times that, and so on; the wall beside the sunlit spot has ρ/π of their sum.
#[test]
fn an_integrating_sphere_lights_its_wall_evenly() {
    let (share, rho) = (0.4_f64, [0.5, 0.8]);
    let opening = (1.0 - 2.0 * share).acos();
    let wall = sphere(1.0, opening);
    for order in [2, 3, 200] {
        let report = run(
            &format!(
                "{VISIBLE} {GROUND} sun: (zenith_deg: 0.0, irradiance: Constant(1.0)), \
                 transport: ({NO_ROULETTE}, max_order: {order}),"
            ),
            "\"wall\": Lambertian(reflectance: Bands([0.5, 0.8])),",
            &[("wall", &wall, "(20.0, 20.0, 2.0)")],
            "\"side\": Perspective(size_px: (2, 2), position_m: (20.0, 20.0, 2.0), target_m: (21.0, 20.0, 2.0), fov_deg: (4.0, 4.0), samples_per_px: 524288, measure: [Radiance])",
        );
        for (band, rho) in rho.into_iter().enumerate() {
            let first = rho * opening.sin().powi(2) / 4.0;
            let each = rho * (1.0 - share);
            let sum = (1.0 - f64::powi(each, order - 1)) / (1.0 - each);
            assert_radiance(&report, "side", band, rho / PI * first * sum);
        }
    }
}

/// *Scene*: a sphere of small discs of spherical angles, of the leaf area indices 1 and 5 over its outline,
/// from 56 directions. *Expected*: the mean gap over the outline is `2 (1 - (1 + x) e⁻ˣ) / x²` with
/// `x = 2 G u R = 3 LAI / 4`.
#[test]
fn a_sphere_of_small_discs_has_the_gaps_of_a_turbid_one() {
    let (views, side) = (56, 2.02);
    let mut sensors = String::new();
    for view in 0..views {
        // Even over the directions within 75° of the zenith; views further apart than a disc's size over
        // the radius see independent overlaps.
        let share = (f64::from(view) + 0.5) / f64::from(views);
        let zenith = (1.0 - (1.0 - 75_f64.to_radians().cos()) * share).acos();
        let azimuth = (f64::from(view) * 2.399_963_23) % TAU;
        // The sphere's middle is 2 m above the plane on which the image's middle is given.
        let away = 2.0 * zenith.tan();
        let (x, y) = (20.0 - away * azimuth.sin(), 20.0 - away * azimuth.cos());
        let (zenith, azimuth) = (zenith.to_degrees(), azimuth.to_degrees());
        write!(
            sensors,
            "\"{view}\": Orthographic(size_px: (1, 1), extent_m: ({side}, {side}), \
             center_m: ({x:?}, {y:?}), zenith_deg: {zenith:?}, azimuth_deg: {azimuth:?}, \
             samples_per_px: 40960, measure: [GapFraction]),"
        )
        .expect("a string");
    }
    for (lai, most) in [(1.0, 1.3e-3), (5.0, 4e-3)] {
        let x = 0.75 * lai;
        let truth = 2.0 * (1.0 - (1.0 + x) * f64::exp(-x)) / (x * x);
        let area = lai * PI;
        let report = measure(
            &format!(
                r#"Scene(
    format: 1,
    bands: [(name: "a", center_nm: 660.0)],
    {GROUND}
    materials: {{ "cold": Lambertian(reflectance: Constant(0.0)) }},
    meshes: {{ "sphere": Crown(
        shape: Ellipsoid(diameter_m: 2.0, height_m: 2.0), base_m: 1.0, leaf_area_m2: {area:?},
        leaf_angle: Spherical, leaf: Disc(radius_m: 0.005), leaf_material: "cold",
    ) }},
    instances: [List(of: "sphere", at_m: [(20.0, 20.0, 0.0)])],
    sensors: {{ {sensors} }},
)"#
            ),
            Path::new("."),
            &Options::default(),
        );
        let gaps: Vec<f64> = (0..views)
            .map(|view| {
                let gap = product(&report, &view.to_string(), "gap_fraction").values[0];
                1.0 - (1.0 - gap) * side * side / PI
            })
            .collect();
        let n = f64::from(views);
        let value = gaps.iter().sum::<f64>() / n;
        let squares: f64 = gaps.iter().map(|gap| (gap - value).powi(2)).sum();
        let found = Estimate { value, error: (squares / (n * (n - 1.0))).sqrt() };
        // Leaves reach beyond their centres: the blurred outline hides some 6e-4 of the gaps more.
        let allowed = 4.0 * found.error + 1e-3 * truth;
        assert!((found.value - truth).abs() < allowed, "{lai}: {found:?} for {truth}");
        assert!(found.error < most * truth, "{lai}: {found:?} for {truth}");
    }
}
