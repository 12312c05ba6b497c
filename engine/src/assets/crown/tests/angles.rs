//! Leaf angle distributions against their closed forms.

use std::f64::consts::{FRAC_PI_2, PI};

use super::super::angles::Normals;
use super::super::stream::{Purpose, Stream};
use super::*;

/// Normals that each distribution is tested with.
const DRAWS: u64 = 200_000;

fn draw(angle: &LeafAngle) -> Vec<DVec3> {
    let normals = Normals::new(angle).unwrap();
    (0..DRAWS).map(|leaf| normals.draw(&mut Stream::new(SEED, Purpose::Normal, leaf))).collect()
}

/// A density g(θ) up to a factor.
type Density = Box<dyn Fn(f64) -> f64>;

/// Each distribution with its density.
fn distributions() -> Vec<(LeafAngle, Density)> {
    let ellipsoidal = |x: f64| -> Density {
        Box::new(move |t: f64| t.sin() / (t.cos().powi(2) + (x * t.sin()).powi(2)).powi(2))
    };
    let beta = |mu: f64, nu: f64| -> Density {
        Box::new(move |t: f64| {
            (1.0 - t / FRAC_PI_2).powf(mu - 1.0) * (t / FRAC_PI_2).powf(nu - 1.0)
        })
    };
    let x = |x: f64| LeafAngle::Ellipsoidal { x: Some(x), mean_deg: None };
    let mean = LeafAngle::Ellipsoidal { x: None, mean_deg: Some(1_f64.to_degrees()) };
    vec![
        (LeafAngle::Spherical, Box::new(f64::sin)),
        (LeafAngle::Uniform, Box::new(|_| 1.0)),
        (LeafAngle::Planophile, Box::new(|t| 1.0 + (2.0 * t).cos())),
        (LeafAngle::Erectophile, Box::new(|t| 1.0 - (2.0 * t).cos())),
        (LeafAngle::Plagiophile, Box::new(|t| 1.0 - (4.0 * t).cos())),
        (LeafAngle::Extremophile, Box::new(|t| 1.0 + (4.0 * t).cos())),
        (x(0.3), ellipsoidal(0.3)),
        (x(1.0), ellipsoidal(1.0)),
        (x(4.0), ellipsoidal(4.0)),
        // The mean of the spherical distribution is 1 rad.
        (mean, ellipsoidal(1.0)),
        // Planophile and erectophile leaves in the table of Goel & Strebel (1984).
        (LeafAngle::Beta { mu: 2.770, nu: 1.172 }, beta(2.770, 1.172)),
        (LeafAngle::Beta { mu: 1.172, nu: 2.770 }, beta(1.172, 2.770)),
        (LeafAngle::Beta { mu: 1.0, nu: 1.0 }, beta(1.0, 1.0)),
        (LeafAngle::Beta { mu: 12.0, nu: 5.0 }, beta(12.0, 5.0)),
    ]
}

/// Integral over [a, b] by the midpoint rule.
fn integral(f: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    const POINTS: u32 = 4000;
    let step = (b - a) / f64::from(POINTS);
    (0..POINTS).map(|i| f(a + (f64::from(i) + 0.5) * step)).sum::<f64>() * step
}

/// Pearson's statistic over 30 equal classes of θ has 29 degrees of freedom, mean 29 and variance 58;
/// 70 is exceeded with probability 3e-5. Classes that expect fewer than ten join the next.
#[test]
fn angles_follow_their_density() {
    for (angle, density) in distributions() {
        let mut counts = [0.0; 30];
        for normal in draw(&angle) {
            let theta = normal.truncate().length().atan2(normal.z.abs());
            counts[((theta / FRAC_PI_2 * 30.0) as usize).min(29)] += 1.0;
        }
        let whole = integral(&density, 0.0, FRAC_PI_2);
        let (mut chi_square, mut found, mut expected) = (0.0, 0.0, 0.0);
        for (class, count) in counts.iter().enumerate() {
            let edge = |i: usize| FRAC_PI_2 * i as f64 / 30.0;
            found += count;
            expected += DRAWS as f64 / whole * integral(&density, edge(class), edge(class + 1));
            if expected >= 10.0 {
                chi_square += (found - expected).powi(2) / expected;
                (found, expected) = (0.0, 0.0);
            }
        }
        assert!(chi_square < 70.0, "{angle:?}: {chi_square}");
    }
}

/// G(θ) is the mean of |n·Ω|: of a leaf at θ' it is Ross's kernel, the mean over azimuths.
#[test]
fn mean_projections_are_those_of_the_density() {
    for (angle, density) in distributions() {
        let normals = draw(&angle);
        let whole = integral(&density, 0.0, FRAC_PI_2);
        for view_deg in [0.0_f64, 20.0, 57.5, 80.0] {
            let (sin, cos) = view_deg.to_radians().sin_cos();
            let kernel = |theta: f64| {
                let (upright, flat) = (sin * theta.sin(), cos * theta.cos());
                if flat >= upright {
                    return flat;
                }
                let turn = (-flat / upright).acos();
                (2.0 / PI) * (flat * (turn - FRAC_PI_2) + upright * turn.sin())
            };
            let g = integral(|t| density(t) * kernel(t), 0.0, FRAC_PI_2) / whole;
            let toward = DVec3::new(sin, 0.0, cos);
            let projections = normals.iter().map(|n| n.dot(toward).abs());
            assert_mean(&format!("{angle:?} at {view_deg}°"), projections, g);
        }
    }
}

/// An ellipsoid's shadow over half its surface: with semi-axes x, x, 1 that is
/// `π x sqrt(x² cos² θ + sin² θ) / (S / 2)`, S in closed form.
#[test]
fn ellipsoidal_leaves_cast_the_shadow_of_an_ellipsoid() {
    for x in [0.2_f64, 2.5, 30.0] {
        let half_surface = if x < 1.0 {
            let e = (1.0 - x * x).sqrt();
            PI * x * (x + e.asin() / e)
        } else {
            let e = (1.0 - x.powi(-2)).sqrt();
            PI * (x * x + e.atanh() / e)
        };
        let normals = draw(&LeafAngle::Ellipsoidal { x: Some(x), mean_deg: None });
        for view_deg in [0.0_f64, 35.0, 75.0] {
            let (sin, cos) = view_deg.to_radians().sin_cos();
            let shadow = PI * x * (x * cos).hypot(sin) / half_surface;
            let toward = DVec3::new(sin, 0.0, cos);
            let what = format!("x = {x} at {view_deg}°");
            assert_mean(&what, normals.iter().map(|n| n.dot(toward).abs()), shadow);
        }
    }
}

/// Means of 200 000 leaves lie within four standard errors.
#[test]
fn ellipsoidal_leaves_have_the_mean_that_was_asked_for() {
    for mean_deg in [20.0_f64, 35.0, 57.3, 80.0] {
        let angle = LeafAngle::Ellipsoidal { x: None, mean_deg: Some(mean_deg) };
        let theta = |n: &DVec3| n.truncate().length().atan2(n.z.abs()).to_degrees();
        assert_mean(&format!("{mean_deg}"), draw(&angle).iter().map(theta), mean_deg);
    }
}

#[test]
fn unlawful_distributions_are_errors() {
    let ellipsoidal = |x, mean_deg| LeafAngle::Ellipsoidal { x, mean_deg };
    for (angle, message) in [
        (ellipsoidal(None, None), "either x or mean_deg"),
        (ellipsoidal(Some(1.0), Some(50.0)), "either x or mean_deg"),
        (ellipsoidal(Some(0.0), None), "leaf_angle.x is 0"),
        (ellipsoidal(Some(f64::NAN), None), "leaf_angle.x is NaN"),
        (ellipsoidal(None, Some(90.0)), "leaf_angle.mean_deg is 90"),
        (LeafAngle::Beta { mu: 0.0, nu: 1.0 }, "leaf_angle.mu is 0"),
        (LeafAngle::Beta { mu: 1.0, nu: 1e9 }, "leaf_angle.nu is 1000000000"),
    ] {
        let crown = GeneratedCrown { leaf_angle: angle, ..spec(shapes()[0].clone(), DISC) };
        let error = grow_crown(&crown).unwrap_err().to_string();
        assert!(error.contains(message), "{error} / {message}");
    }
}
