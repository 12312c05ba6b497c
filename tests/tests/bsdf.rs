//! One battery over every surface model: energy, reciprocity, and sampling that follows its density.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use sunfleck::components::SurfaceOptics;
use sunfleck::sampling::{Key, Sampler, sobol4};
use sunfleck::scattering::{BiLambertian, Bsdf, LANES, Spectrum};

/// Models in two bands, each with a name.
fn models() -> Vec<(&'static str, Bsdf)> {
    let surface = |front: [f64; 2], back: [f64; 2], through: [f64; 2]| {
        let optics = SurfaceOptics::new(&front, &back, &through).expect("lawful optics");
        Bsdf::BiLambertian(BiLambertian::new(&optics))
    };
    vec![
        ("opaque", surface([0.3, 0.7], [0.3, 0.7], [0.0, 0.0])),
        ("leaf", surface([0.05, 0.5], [0.05, 0.5], [0.01, 0.44])),
        ("two faces", surface([0.2, 0.4], [0.6, 0.1], [0.4, 0.3])),
        ("conservative", surface([0.5, 0.9], [0.5, 0.9], [0.5, 0.1])),
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

/// `∫ f |cos θ| dω` over the sphere is what `scattered` says, and at most 1.
#[test]
fn every_model_scatters_what_it_says() {
    for (name, bsdf) in models() {
        for wo in [NORMAL, -NORMAL, sphere(3, 1), sphere(4, 1)] {
            let n = 1 << 16;
            let mut integral = [0.0_f64; 2];
            for index in 0..n {
                let wi = sphere(index, 7);
                if let Some(f) = bsdf.eval(NORMAL, wo, wi) {
                    for (sum, value) in integral.iter_mut().zip(f.iter()) {
                        *sum += f64::from(*value) / PI * NORMAL.dot(wi).abs();
                    }
                }
            }
            for (sum, &said) in integral.iter().zip(bsdf.scattered(NORMAL, wo).iter()) {
                let (found, said) = (sum * 2.0 * TAU / f64::from(n), f64::from(said));
                // 2^16 points at random would leave 2e-3; low-discrepancy points do far better.
                assert!((found - said).abs() < 2e-3 * said, "{name}: {found} for {said}");
                assert!(said <= 1.0, "{name} gains energy");
            }
        }
    }
}

/// `f(wi, wo) = f(wo, wi)`, but for faces that differ: then only of directions on one side.
#[test]
fn every_model_is_reciprocal() {
    for (name, bsdf) in models() {
        for index in 0..200 {
            let (wo, wi) = (sphere(index, 11), sphere(index, 12));
            assert_eq!(bsdf.eval(NORMAL, wo, wi), bsdf.eval(NORMAL, wi, wo), "{name}");
        }
    }
}

/// Sampled directions fall into cells of the sphere as their density asks for: χ² below the value
/// that one run in 10 000 exceeds. And the mean of weights is what is scattered.
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
    let power =
        |lobe: &Spectrum| throughput.iter().zip(lobe.iter()).map(|(weight, f)| weight * f).sum();
    for (name, bsdf) in models() {
        let Bsdf::BiLambertian(model) = &bsdf;
        for wo in [sphere(3, 1), sphere(4, 1)] {
            let mut expected = [0.0; ROWS * COLUMNS];
            let points = 1 << 18;
            for index in 0..points {
                let w = sphere(index, 5);
                expected[cell(w)] +=
                    model.pdf(NORMAL, wo, w, &throughput) * 2.0 * TAU / f64::from(points);
            }
            let whole: f64 = expected.iter().sum();
            assert!((whole - 1.0).abs() < 1e-3, "{name}: the density integrates to {whole}");
            let n = 100_000_u64;
            let mut counts = [0.0; ROWS * COLUMNS];
            let mut weights = [0.0; 2];
            for index in 0..n {
                // The fifth event on are plain random numbers, as the test assumes.
                let mut sampler = Sampler::new(Key::new(9), index);
                let [a, b, c, _] = (0..5).map(|_| sampler.next_event()).last().expect("five");
                let sample = bsdf.sample(NORMAL, wo, power, [a, b, c]).expect("not black");
                counts[cell(sample.direction)] += 1.0;
                for (sum, factor) in weights.iter_mut().zip(sample.spectrum.iter()) {
                    *sum += f64::from(factor * sample.scale);
                }
            }
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
            for (sum, &said) in weights.iter().zip(bsdf.scattered(NORMAL, wo).iter()) {
                let (mean, said) = (sum / n as f64, f64::from(said));
                assert!((mean / said - 1.0).abs() < 0.02, "{name}: {mean} for {said}");
            }
        }
    }
}
