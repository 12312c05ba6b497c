//! Distributions of leaf angles.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec3;

use super::CrownError;
use super::stream::Stream;
use crate::document::LeafAngle;

/// Lawful axis ratios of an ellipsoidal distribution.
const RATIOS: [f64; 2] = [1e-4, 1e4];

/// Lawful mean angles of an ellipsoidal distribution, degrees: within those of [`RATIOS`].
const MEANS: [f64; 2] = [0.1, 89.9];

/// Lawful parameters of a beta distribution.
const EXPONENTS: [f64; 2] = [0.1, 100.0];

/// A distribution of leaf normals, ready to be drawn from.
#[derive(Clone, Debug)]
pub(super) enum Normals {
    /// Density of the zenith angle.
    Plain(LeafAngle),
    /// Axis ratio.
    Ellipsoidal(f64),
    /// μ and ν.
    Beta(f64, f64),
}

impl Normals {
    pub(super) fn new(distribution: &LeafAngle) -> Result<Self, CrownError> {
        let within = |what, value: f64, [least, most]: [f64; 2]| {
            if (least..=most).contains(&value) {
                return Ok(value);
            }
            Err(CrownError::BadLeafAngle { what, value, least, most })
        };
        match *distribution {
            LeafAngle::Ellipsoidal { x: Some(x), mean_deg: None } => {
                Ok(Self::Ellipsoidal(within("x", x, RATIOS)?))
            }
            LeafAngle::Ellipsoidal { x: None, mean_deg: Some(mean) } => {
                Ok(Self::Ellipsoidal(ratio_of_mean(within("mean_deg", mean, MEANS)?)))
            }
            LeafAngle::Ellipsoidal { .. } => Err(CrownError::RatioOrMean),
            LeafAngle::Beta { mu, nu } => {
                Ok(Self::Beta(within("mu", mu, EXPONENTS)?, within("nu", nu, EXPONENTS)?))
            }
            ref plain => Ok(Self::Plain(plain.clone())),
        }
    }

    /// Unit normal of a leaf, to either side with probability 1/2.
    pub(super) fn draw(&self, random: &mut Stream) -> DVec3 {
        let side = if random.uniform() < 0.5 { 1.0 } else { -1.0 };
        let (sin_azimuth, cos_azimuth) = (TAU * random.uniform()).sin_cos();
        let (sin, cos) = match *self {
            Self::Plain(LeafAngle::Spherical) => {
                let cos = 1.0 - random.uniform();
                ((1.0 - cos * cos).sqrt(), cos)
            }
            Self::Plain(ref plain) => inclination(plain, random).sin_cos(),
            Self::Ellipsoidal(x) => on_ellipsoid(x, random),
            Self::Beta(mu, nu) => {
                let (near_zenith, near_horizon) = (gamma(mu, random), gamma(nu, random));
                (FRAC_PI_2 * near_horizon / (near_zenith + near_horizon)).sin_cos()
            }
        };
        side * DVec3::new(sin * cos_azimuth, sin * sin_azimuth, cos)
    }
}

/// Angle between normal and zenith, 0 to π/2, of a distribution `g(θ) = (2/π)(1 + f(θ))` with
/// |f| ≤ 1, by rejection: every second angle is taken on average.
fn inclination(distribution: &LeafAngle, random: &mut Stream) -> f64 {
    loop {
        let theta = FRAC_PI_2 * random.uniform();
        let density = match distribution {
            // Spherical leaves have their exact inverse above; this is g(θ) = sin θ all the same.
            LeafAngle::Spherical => 2.0 * theta.sin(),
            LeafAngle::Uniform => return theta,
            LeafAngle::Planophile => 1.0 + (2.0 * theta).cos(),
            LeafAngle::Erectophile => 1.0 - (2.0 * theta).cos(),
            LeafAngle::Plagiophile => 1.0 - (4.0 * theta).cos(),
            LeafAngle::Extremophile => 1.0 + (4.0 * theta).cos(),
            LeafAngle::Ellipsoidal { .. } | LeafAngle::Beta { .. } => {
                unreachable!("`Normals::new` keeps these apart")
            }
        };
        if 2.0 * random.uniform() < density {
            return theta;
        }
    }
}

/// Sine and cosine of the normal's zenith angle at a point uniform on the surface of an ellipsoid of
/// horizontal semi-axes x and vertical semi-axis 1.
///
/// Stretching the unit sphere turns the normal `(s, c)` to `(s, x c)` and areas by the length of that;
/// at least every second point is taken.
fn on_ellipsoid(x: f64, random: &mut Stream) -> (f64, f64) {
    loop {
        let cos = 1.0 - random.uniform();
        let (sin, cos) = ((1.0 - cos * cos).sqrt(), x * cos);
        let length = sin.hypot(cos);
        if x.max(1.0) * random.uniform() < length {
            return (sin / length, cos / length);
        }
    }
}

/// Mean angle between the normals of that ellipsoid and the vertical, rad.
fn mean_of_ratio(x: f64) -> f64 {
    const POINTS: u32 = 2000;
    let (mut area, mut moment) = (0.0, 0.0);
    for point in 0..POINTS {
        let cos = (f64::from(point) + 0.5) / f64::from(POINTS);
        let (sin, cos) = ((1.0 - cos * cos).sqrt(), x * cos);
        area += sin.hypot(cos);
        moment += sin.hypot(cos) * sin.atan2(cos);
    }
    moment / area
}

/// The axis ratio that has this mean angle, degrees: flatter ellipsoids have smaller ones.
///
/// Campbell (1990) approximates it by `(mean / 9.65)^-0.6061 - 3`, mean in rad, which is 1.1° off at x = 1.
fn ratio_of_mean(mean_deg: f64) -> f64 {
    let mean = mean_deg.to_radians();
    let [mut low, mut high] = RATIOS.map(f64::ln);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if mean_of_ratio(middle.exp()) > mean { &mut low } else { &mut high }) = middle;
    }
    (0.5 * (low + high)).exp()
}

/// A number of the gamma distribution of this shape and scale 1.
///
/// Source: Marsaglia & Tsang (2000), ACM Trans. Math. Softw. 26, 363–372.
fn gamma(shape: f64, random: &mut Stream) -> f64 {
    if shape < 1.0 {
        return gamma(shape + 1.0, random) * (1.0 - random.uniform()).powf(shape.recip());
    }
    let d = shape - 1.0 / 3.0;
    let c = (9.0 * d).sqrt().recip();
    loop {
        // A standard normal number by Box and Muller.
        let radius = (-2.0 * (1.0 - random.uniform()).ln()).sqrt();
        let normal = radius * (TAU * random.uniform()).cos();
        let root = 1.0 + c * normal;
        if root <= 0.0 {
            continue;
        }
        let v = root * root * root;
        if (1.0 - random.uniform()).ln() < 0.5 * normal * normal + d * (1.0 - v + v.ln()) {
            return d * v;
        }
    }
}
