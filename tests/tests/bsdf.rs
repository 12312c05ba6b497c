//! One battery over every surface model: reference values, energy, reciprocity, and sampling that follows its
//! density.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use sunfleck::components::{
    DirectionalOptics, GlossyOptics, LambertianOptics, LeafCoating, RpvParameters,
    SoilspectParameters, SurfaceOptics,
};
use sunfleck::sampling::{Key, Sampler, sobol4};
use sunfleck::scattering::{Importance, LANES, Lobe, ModelFault, SurfaceId, SurfaceModels};
use sunfleck_tests::shared;

/// Number of bands of the models below.
const BANDS: usize = 2;

/// A surface of each model, by name.
struct Surface {
    name: &'static str,
    models: SurfaceModels,
    /// True if both faces are alike: `f` is then reciprocal across them.
    has_equal_faces: bool,
}

impl Surface {
    fn new(name: &'static str, optics: &SurfaceOptics, has_equal_faces: bool) -> Self {
        let mut models = SurfaceModels::new(BANDS);
        models.add(optics);
        Self { name, models, has_equal_faces }
    }

    fn value(&self, lobe: &Lobe, band: usize) -> f64 {
        self.models.value(lobe, band).into()
    }

    /// `π f`, 0 where a model returns none.
    fn f(&self, wo: DVec3, wi: DVec3, band: usize) -> f64 {
        let at = self.models.at(SurfaceId(0), NORMAL, wo);
        at.f(wi).map_or(0.0, |lobe| self.value(&lobe, band))
    }
}

fn lambertian(front: [f64; 2], back: [f64; 2], through: [f64; 2]) -> LambertianOptics {
    LambertianOptics::new(&front, &back, &through).expect("lawful optics")
}

fn glossy(body: LambertianOptics, refractive_index: f64, roughness: f64) -> SurfaceOptics {
    let coating = LeafCoating::new(refractive_index, roughness);
    SurfaceOptics::GlossyLeaf(GlossyOptics { body, coating })
}

fn rpv(parameters: [[f32; 4]; BANDS]) -> Result<SurfaceOptics, ModelFault> {
    let band =
        |[rho0, k, asymmetry, hot_spot]: [f32; 4]| RpvParameters { rho0, k, asymmetry, hot_spot };
    DirectionalOptics::new(parameters.map(band).to_vec()).map(SurfaceOptics::Rpv)
}

fn soilspect(parameters: [[f32; 6]; BANDS]) -> Result<SurfaceOptics, ModelFault> {
    let band = |[albedo, roughness, b, c, b_prime, c_prime]: [f32; 6]| SoilspectParameters {
        albedo,
        roughness,
        hot_spot: 1.0,
        backward: [b, c],
        forward: [b_prime, c_prime],
    };
    DirectionalOptics::new(parameters.map(band).to_vec()).map(SurfaceOptics::Soilspect)
}

fn lawful(optics: Result<SurfaceOptics, ModelFault>) -> SurfaceOptics {
    optics.expect("parameters that keep energy")
}

fn surfaces() -> Vec<Surface> {
    let two_faced =
        |front, back, through| SurfaceOptics::BiLambertian(lambertian(front, back, through));
    let leaf = lambertian([0.05, 0.5], [0.05, 0.5], [0.01, 0.44]);
    let white = lambertian([0.5, 0.9], [0.5, 0.9], [0.5, 0.1]);
    vec![
        Surface::new("opaque", &two_faced([0.3, 0.7], [0.3, 0.7], [0.0, 0.0]), true),
        Surface::new("leaf", &two_faced([0.05, 0.5], [0.05, 0.5], [0.01, 0.44]), true),
        Surface::new("two faces", &two_faced([0.2, 0.4], [0.6, 0.1], [0.4, 0.3]), false),
        Surface::new("conservative", &two_faced([0.5, 0.9], [0.5, 0.9], [0.5, 0.1]), true),
        Surface::new("glossy leaf", &glossy(leaf.clone(), 1.45, 0.3), true),
        Surface::new("smooth glossy leaf", &glossy(leaf, 1.9, 0.1), true),
        Surface::new("white glossy leaf", &glossy(white, 1.5, 0.6), true),
        Surface::new("rpv", &lawful(rpv([[0.05, 0.95, -0.1, 0.05], [0.1, 0.6, -0.2, 0.1]])), true),
        Surface::new(
            "rpv snow",
            &lawful(rpv([[0.7, 0.95, 0.1, 0.7], [0.75, 0.95, 0.15, 0.75]])),
            true,
        ),
        Surface::new(
            "soilspect",
            &lawful(soilspect([[0.3, 0.1, 0.0, 0.0, 0.0, 0.0], [0.5, 0.2, 0.8, 0.2, 0.3, -0.1]])),
            true,
        ),
        Surface::new(
            "bright soilspect",
            &lawful(soilspect([[0.7, 0.25, 1.2, 0.35, 0.2, 0.4], [0.95, 0.3, 0.0, 0.0, 0.0, 0.0]])),
            true,
        ),
    ]
}

/// Uniform directions of the sphere, density 1 / 4π.
fn sphere(index: u32, seed: u64) -> DVec3 {
    let [u, v, ..] = sobol4(index, seed);
    let (z, azimuth) = (1.0 - 2.0 * u, TAU * v);
    let r = (1.0 - z * z).sqrt();
    DVec3::new(r * azimuth.cos(), r * azimuth.sin(), z)
}

const NORMAL: DVec3 = DVec3::new(0.36, -0.48, 0.8);

/// Unit vector at an angle from the normal, degrees.
fn oblique(degrees: f64) -> DVec3 {
    let tangent = NORMAL.cross(DVec3::Z).try_normalize().expect("the normal is no vertical");
    NORMAL * degrees.to_radians().cos() + tangent * degrees.to_radians().sin()
}

/// `∫ f |cos θ| dω` over the sphere is the scattered fraction, over the side of `wo` the reflected one; the absorbed
/// fraction is the rest, and none is negative.
#[test]
fn every_model_scatters_the_fraction_that_it_states() {
    for surface in surfaces() {
        for wo in [NORMAL, -NORMAL, sphere(3, 1), sphere(4, 1), oblique(80.0)] {
            let at = surface.models.at(SurfaceId(0), NORMAL, wo);
            let n = 1 << 16;
            let (mut all, mut same) = ([0.0; BANDS], [0.0; BANDS]);
            for index in 0..n {
                let wi = sphere(index, 7);
                let Some(f) = at.f(wi) else { continue };
                for band in 0..BANDS {
                    let value = surface.value(&f, band) / PI * NORMAL.dot(wi).abs();
                    all[band] += value;
                    same[band] += if at.is_same_side(wi) { value } else { 0.0 };
                }
            }
            for band in 0..BANDS {
                let name = surface.name;
                let stated = surface.value(&at.scattered_fraction(), band);
                let reflected = surface.value(&at.reflected_fraction(), band);
                let absorbed = surface.value(&at.absorbed_fraction(), band);
                let [all, same] = [all[band], same[band]].map(|sum| sum * 2.0 * TAU / f64::from(n));
                // 2^16 points at random would leave 2e-3; low-discrepancy points do better but in narrow lobes.
                let tolerance = 3e-3 * stated + 2e-4;
                assert!((all - stated).abs() < tolerance, "{name} from {wo}: {all} for {stated}");
                assert!((same - reflected).abs() < tolerance, "{name}: {same} for {reflected}");
                assert!((stated + absorbed - 1.0).abs() < 1e-6, "{name}: {stated} + {absorbed}");
                assert!(absorbed >= 0.0 && reflected <= stated + 1e-7, "{name} gains energy");
            }
        }
    }
}

/// `f(wi, wo) = f(wo, wi)`; across faces that differ, not even Lambertian reflection is asked for it.
#[test]
fn every_model_is_reciprocal() {
    for surface in surfaces() {
        for index in 0..400 {
            let (wo, wi) = (sphere(index, 11), sphere(index, 12));
            let is_same_side = NORMAL.dot(wo) * NORMAL.dot(wi) > 0.0;
            if !is_same_side && !surface.has_equal_faces {
                continue;
            }
            for band in 0..BANDS {
                let (f, reversed) = (surface.f(wo, wi, band), surface.f(wi, wo, band));
                let name = surface.name;
                assert!((f - reversed).abs() <= 1e-5 * f.max(1e-3), "{name}: {f} and {reversed}");
            }
        }
    }
}

/// Sampled directions fall into cells of the sphere as their density asks for: χ² below the value
/// that one run in 10 000 exceeds.
#[test]
fn every_model_samples_its_density() {
    const ROWS: usize = 8;
    const COLUMNS: usize = 8;
    let cell = |w: DVec3| {
        let row = (w.z.midpoint(1.0) * ROWS as f64) as usize;
        let column = ((w.y.atan2(w.x) / TAU + 0.5) * COLUMNS as f64) as usize;
        row.min(ROWS - 1) * COLUMNS + column.min(COLUMNS - 1)
    };
    let mut throughput = [0.0; LANES];
    throughput[..2].copy_from_slice(&[1.0, 0.3]);
    let importance = Importance::Representatives(&throughput);
    for surface in surfaces() {
        let name = surface.name;
        for wo in [sphere(3, 1), sphere(4, 1), oblique(75.0)] {
            let at = surface.models.at(SurfaceId(0), NORMAL, wo);
            let mut expected = [0.0; ROWS * COLUMNS];
            let points = 1 << 20;
            for index in 0..points {
                let w = sphere(index, 5);
                expected[cell(w)] += at.pdf(importance, w) * 2.0 * TAU / f64::from(points);
            }
            let whole: f64 = expected.iter().sum();
            // Specular samples below the surface are masked: their density is missing.
            assert!(whole < 1.002, "{name}: the density integrates to {whole}");
            let n = 100_000_u64;
            let mut counts = [0.0; ROWS * COLUMNS];
            let mut masked = 0.0;
            for index in 0..n {
                // Events from the fifth on are plain random numbers, as the test assumes.
                let mut sampler = Sampler::new(Key::new(9), index);
                let [a, b, c, _] = (0..5).map(|_| sampler.next_4d()).last().expect("five");
                let Some(sample) = at.sample_f(importance, [a, b, c]) else {
                    masked += 1.0;
                    continue;
                };
                counts[cell(sample.wi)] += 1.0;
            }
            let missing: f64 = masked / n as f64;
            assert!((missing - (1.0 - whole)).abs() < 3e-3, "{name}: {missing} of 1 - {whole}");
            let (mut chi2, mut cells) = (0.0, 0.0);
            for (count, expected) in counts.iter().zip(expected) {
                let expected = expected * n as f64;
                if expected > 10.0 {
                    chi2 += (count - expected).powi(2) / expected;
                    cells += 1.0;
                } else {
                    assert!(*count < 40.0, "{name}: {count} where next to none should be");
                }
            }
            // Wilson and Hilferty's normal approximation of χ²; 3.72 is exceeded by 1 in 10 000.
            let freedom: f64 = cells - 1.0;
            let spread = 2.0 / (9.0 * freedom);
            let z = ((chi2 / freedom).cbrt() - (1.0 - spread)) / spread.sqrt();
            assert!(z < 3.72, "{name}: χ² = {chi2:.1} for {freedom} degrees of freedom");
        }
    }
}

/// The mean weight of samples is the scattered fraction, at grazing angles too.
#[test]
fn the_mean_weight_of_samples_is_the_scattered_fraction() {
    let mut throughput = [0.0; LANES];
    throughput[..2].copy_from_slice(&[1.0, 0.3]);
    let importance = Importance::Representatives(&throughput);
    for surface in surfaces() {
        for wo in [sphere(3, 1), sphere(4, 1), oblique(80.0), oblique(89.0)] {
            let at = surface.models.at(SurfaceId(0), NORMAL, wo);
            let n = 1_u32 << 16;
            let mut weights = [0.0; BANDS];
            for index in 0..n {
                let [a, b, c, _] = sobol4(index, 3);
                let Some(sample) = at.sample_f(importance, [a, b, c]) else { continue };
                for (band, sum) in weights.iter_mut().enumerate() {
                    *sum += surface.value(&sample.weight, band);
                }
            }
            for (band, sum) in weights.iter().enumerate() {
                let stated = surface.value(&at.scattered_fraction(), band);
                let mean = sum / f64::from(n);
                let name = surface.name;
                assert!(
                    (mean / stated - 1.0).abs() < 3e-3,
                    "{name} from {wo}: {mean} for {stated}"
                );
            }
        }
    }
}

/// Unit vector with a zenith and an azimuth angle, degrees.
fn direction(zenith: f64, azimuth: f64) -> DVec3 {
    let (sin, cos) = zenith.to_radians().sin_cos();
    let azimuth = azimuth.to_radians();
    DVec3::new(sin * azimuth.cos(), sin * azimuth.sin(), cos)
}

/// Lines of a reference table without its header.
fn table(name: &str) -> Option<Vec<Vec<f64>>> {
    let text = std::fs::read_to_string(shared()?.join("reference").join(name)).expect("a table");
    let numbers =
        |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
    Some(text.lines().skip(1).map(numbers).collect())
}

fn brf(optics: &SurfaceOptics, sun: DVec3, view: DVec3) -> f64 {
    let mut models = SurfaceModels::new(1);
    models.add(optics);
    let f = models.at(SurfaceId(0), DVec3::Z, view).f(sun).expect("both are above");
    models.value(&f, 0).into()
}

/// *Expected*: the tables of RAMI-IV, whose azimuth of 180° is the side of the sun, rounded to four digits.
#[test]
fn rpv_gives_the_values_of_the_literature() {
    let Some(rows) = table("rpv_values.csv") else { return };
    let mut seen = 0;
    for row in rows {
        let [rho0, k, asymmetry, hot_spot] = [row[0], row[1], row[2], row[3]].map(|v| v as f32);
        let bands = vec![RpvParameters { rho0, k, asymmetry, hot_spot }];
        let optics = lawful(DirectionalOptics::new(bands).map(SurfaceOptics::Rpv));
        for (azimuth, expected) in (0..7).map(|step| 30.0 * f64::from(step)).zip(&row[6..]) {
            let value = brf(&optics, direction(row[4], 180.0), direction(row[5], azimuth));
            assert!((value - expected).abs() < 1e-4, "{row:?}, {azimuth}: {value} for {expected}");
            seen += 1;
        }
    }
    assert_eq!(seen, 210);
}

/// *Expected*: values of the formula in f64, whose azimuth of 0 is the side of the sun.
#[test]
fn soilspect_gives_the_values_of_the_literature() {
    let Some(rows) = table("soilspect_values.csv") else { return };
    for row in &rows {
        let [albedo, roughness, b, c, b_prime, c_prime] =
            [row[0], row[1], row[2], row[3], row[4], row[5]].map(|value| value as f32);
        let parameters = SoilspectParameters {
            albedo,
            roughness,
            hot_spot: 1.0,
            backward: [b, c],
            forward: [b_prime, c_prime],
        };
        let optics = lawful(DirectionalOptics::new(vec![parameters]).map(SurfaceOptics::Soilspect));
        let value = brf(&optics, direction(row[6], 0.0), direction(row[7], row[8]));
        assert!((value - row[9]).abs() < 1e-4 * row[9], "{row:?}: {value}");
    }
    assert_eq!(rows.len(), 48);
}

/// *Expected*: directional-hemispherical reflectance by numerical integration, apart from this program.
#[test]
fn soilspect_reflects_as_much_as_integration_says() {
    let optics = lawful(soilspect([[0.5, 0.2, 0.8, 0.2, 0.3, -0.1]; 2]));
    let mut models = SurfaceModels::new(BANDS);
    models.add(&optics);
    for (zenith, expected) in [(0.0, 0.21533), (20.0, 0.21726), (50.0, 0.22968)] {
        let at = models.at(SurfaceId(0), DVec3::Z, direction(zenith, 0.0));
        let dhr = f64::from(models.value(&at.reflected_fraction(), 0));
        assert!((dhr - expected).abs() < 3e-5, "{zenith}: {dhr} for {expected}");
    }
}

/// Parameters that would reflect more light than arrives are refused.
#[test]
fn models_that_gain_energy_are_refused() {
    assert!(rpv([[0.1, 0.6, -0.2, 0.1]; 2]).is_ok());
    let fault = rpv([[0.1, 0.6, -0.2, 0.1], [0.9, 0.6, 0.0, 0.9]]).expect_err("too bright");
    assert!(fault.band == 1 && fault.dhr > 1.0, "{fault:?}");
    assert!(soilspect([[0.95, 0.3, 0.0, 0.0, 0.0, 0.0]; 2]).is_ok());
    // The paper's formula lets a soil that absorbs nothing reflect up to 1.11 of the light.
    assert!(soilspect([[1.0, 0.3, 0.0, 0.0, 0.0, 0.0]; 2]).is_err());
}
