//! Gaps of a crown against Beer's law.

use super::super::stream::{Purpose, Stream};
use super::*;

/// Vertical and slanted lines through balls of radius R with N leaves of area a, spherically
/// oriented: a line with the chord s is free with probability `(1 - G a s / V)^N`, G = 1/2, Beer's
/// `exp(-G u s)` in the limit. Leaves reach over the ball's edge by their radius r, which changes the
/// mean over lines by less than (r / R)² = 3e-4. Crowns are independent, and their spread is the error.
#[test]
fn gaps_of_a_ball_of_spherical_leaves_follow_beer() {
    const CROWNS: u64 = 400;
    const LINES: u64 = 100;
    let (radius, leaf) = (3.0, 0.05);
    let (sin, cos) = 40_f64.to_radians().sin_cos();
    for direction in [DVec3::Z, DVec3::new(sin, 0.0, cos)] {
        let (right, up) = direction.any_orthonormal_pair();
        let excess = (0..CROWNS).map(|seed| {
            let mesh = grow_crown(&GeneratedCrown {
                seed,
                base_m: -radius,
                leaf_area_m2: 40.0,
                ..spec(
                    CrownShape::Ellipsoid { diameter_m: 2.0 * radius, height_m: 2.0 * radius },
                    LeafShape::Disc { radius_m: leaf },
                )
            })
            .unwrap();
            let count = mesh.discs.len() as f64;
            let volume = 4.0 / 3.0 * PI * radius.powi(3);
            let line = |line: u64| {
                let random = &mut Stream::new(seed, Purpose::Turn, 1_000_000 + line);
                // Away from the rim, where the chord hardly changes over a leaf's width.
                let (r, turn) = (0.9 * radius * random.uniform().sqrt(), random.uniform());
                let (sin, cos) = (2.0 * PI * turn).sin_cos();
                let point = r * (cos * right + sin * up);
                let is_hit = mesh.discs.iter().any(|disc| {
                    let (center, normal) = (disc.center.as_dvec3(), disc.normal.as_dvec3());
                    let t = normal.dot(center - point) / normal.dot(direction);
                    let distance = (point + t * direction - center).length();
                    distance < f64::from(disc.radius)
                });
                let chord = 2.0 * (radius * radius - r * r).sqrt();
                let expected = (1.0 - 0.5 * (40.0 / count) * chord / volume).powf(count);
                assert!((expected / (-0.5 * 40.0 / volume * chord).exp() - 1.0).abs() < 1e-3);
                f64::from(u8::from(!is_hit)) - expected
            };
            (0..LINES).map(line).sum::<f64>() / LINES as f64
        });
        assert_mean(&format!("{direction}"), excess, 0.0);
    }
}
