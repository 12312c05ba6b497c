//! The index that is counted against gap fractions of the same scene.

use std::fmt::Write as _;

use sunfleck::queries::{CountedSurfaces, LeafAreaRequest};
use sunfleck_tests::{Estimate, SceneText, product};

use crate::stand::Numbers;
use crate::{REQUEST, counted};

/// *Scene*: 3000 small discs of all directions, at random in a periodic tile; 24 such scenes. *Expected*: gap fractions
/// obey Beer's law, `exp(-G LAI / cos θ)` with `G = 0.5`, with the leaf area index that is counted.
#[test]
fn gap_fractions_obey_beers_law_with_the_counted_index() {
    const SCENES: u64 = 24;
    let zeniths: [f64; 3] = [0.0, 30.0, 57.5];
    let mut ratios: Vec<Vec<f64>> = vec![Vec::new(); zeniths.len()];
    for seed in 0..SCENES {
        let mut numbers = Numbers(1000 + seed);
        let mut discs = String::new();
        for _ in 0..3000 {
            let (x, y, z) =
                (8.0 * numbers.next(), 8.0 * numbers.next(), 0.5 + 6.0 * numbers.next());
            let (cos, azimuth) =
                (2.0 * numbers.next() - 1.0, std::f64::consts::TAU * numbers.next());
            let sin = (1.0_f64 - cos * cos).sqrt();
            writeln!(
                discs,
                "0.08,{x},{y},{z},{},{},{cos}",
                sin * azimuth.cos(),
                sin * azimuth.sin()
            )
            .expect("memory");
        }
        let views: Vec<String> =
            zeniths.iter().map(|zenith| format!("({zenith:?}, 33.0)")).collect();
        let scene = SceneText::bare(0.2, "size_m: (8.0, 8.0)")
            .with_leaf(0.1, 0.1)
            .with_discs("cloud", "leaf", &discs)
            .with("instances", r#"List(of: "cloud", at_m: [(0.0, 0.0, 0.0)])"#)
            .with("boundary", "Periodic")
            .with("sun", "zenith_deg: 30.0")
            .with("sensors", format!(r#""gaps": Directions(views: List([{}]), until: Samples(20000), measure: [GapFraction])"#, views.join(", ")));
        let found = counted(
            &scene.world(),
            &LeafAreaRequest { surfaces: CountedSurfaces::Leaves, ..REQUEST },
        );
        let lai = found.total(0) / 64.0;
        assert!((lai - 3000.0 * 0.0064 * std::f64::consts::PI / 64.0).abs() < 1e-6);
        let report = scene.measure();
        let gaps = product(&report, "gaps", "gap_fraction");
        for (view, zenith) in zeniths.iter().enumerate() {
            let expected = (-0.5 * lai / zenith.to_radians().cos()).exp();
            ratios[view].push(Estimate::of(gaps, view).value / expected);
        }
    }
    for (ratios, zenith) in ratios.iter().zip(zeniths) {
        let count = ratios.len() as f64;
        let mean = ratios.iter().sum::<f64>() / count;
        let variance =
            ratios.iter().map(|ratio| (ratio - mean).powi(2)).sum::<f64>() / (count - 1.0);
        let z = (mean - 1.0) / (variance / count).sqrt();
        // 24 scenes: 4.5 standard errors happen once in 6000 by Student's distribution.
        assert!(z.abs() < 4.5 && (mean - 1.0).abs() < 0.05, "{zenith}°: {mean}, z = {z}");
    }
}
