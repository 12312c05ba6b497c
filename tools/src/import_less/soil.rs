//! The SOILSPECT model of soil, and the surface that stands in for it.

use std::f64::consts::PI;

use anyhow::Result;

use super::conf::Node;
use super::light::counted;
use super::report::Report;

/// Parameters of the model in one band.
///
/// Source: Jacquemoud, Baret and Hanocq (1992), Remote Sensing of Environment 41, 123-132.
#[derive(Clone, Copy, Debug)]
struct Soilspect {
    /// Single scattering albedo ω.
    albedo: f64,
    /// Coefficients of the phase function.
    c: [f64; 4],
    /// Height and width of the hot spot.
    h: [f64; 2],
}

/// Keys of LESS's window, and the values that it starts with.
const KEYS: [(&str, f64); 7] = [
    ("albedo", 0.537),
    ("c1", 1.492),
    ("c2", 0.56),
    ("c3", 0.238),
    ("c4", -0.06),
    ("h1", 1.0),
    ("h2", 0.114),
];

/// Largest parameter; those of real soils are below 10.
const LARGEST: f64 = 1000.0;

/// Directions in zenith and azimuth over which the reflectance is integrated.
const STEPS: u32 = 180;

/// Reflectance over all directions, band by band, of the soil that `soilSpectParams` describes, for a
/// sun at a zenith angle.
pub(super) fn reflectance(
    terrain: &Node,
    bands: usize,
    zenith_deg: f64,
    report: &Report,
) -> Result<Vec<f64>> {
    let parameters = terrain.need("soilSpectParams")?;
    let mut columns = Vec::new();
    for (key, usual) in KEYS {
        let Some(node) = parameters.get(key) else {
            let what = format!("{usual}, as LESS has it");
            report.assumed(&parameters.path_of(key), parameters.lack_of(key), what);
            columns.push(vec![usual; bands]);
            continue;
        };
        let mut values = node.numbers()?;
        if values.len() == 1 {
            values.resize(bands, values[0]);
        }
        if values.len() != bands {
            let values = counted(values.len());
            return Err(node.wrong(&format!("has {values}, `sensor.bands` has {bands}")));
        }
        let is_valid = |value: &f64| match key {
            "albedo" => (0.0..=1.0).contains(value),
            "h2" => *value > 0.0 && *value <= LARGEST,
            _ => value.abs() <= LARGEST,
        };
        if let Some(wrong) = values.iter().find(|value| !is_valid(value)) {
            let range = match key {
                "albedo" => "between 0 and 1",
                "h2" => "above 0 and up to 1000",
                _ => "between -1000 and 1000",
            };
            return Err(node.wrong(&format!("{wrong} is not {range}")));
        }
        columns.push(values);
    }
    let band = |band: usize| {
        let value = |column: usize| columns[column][band];
        let soil = Soilspect {
            albedo: value(0),
            c: [value(1), value(2), value(3), value(4)],
            h: [value(5), value(6)],
        };
        let reflectance = soil.over_all_directions(zenith_deg.to_radians());
        if (0.0..=1.0).contains(&reflectance) {
            // Six digits are more than the integral is good for.
            return Ok((reflectance * 1e6).round() / 1e6);
        }
        let what = format!(
            "`albedo`, `c1` to `c4`, `h1` and `h2` make the soil reflect {reflectance:.3} of the light in band {}",
            band + 1
        );
        Err(parameters.wrong(&what))
    };
    (0..bands).map(band).collect()
}

impl Soilspect {
    /// Reflectance over all directions of a beam (directional-hemispherical), by the midpoint rule.
    fn over_all_directions(&self, sun: f64) -> f64 {
        let step = |steps: u32, range: f64, index: u32| {
            range * (f64::from(index) + 0.5) / f64::from(steps)
        };
        let mut sum = 0.0;
        for row in 0..STEPS {
            // Even steps of sin² weigh directions by their cosine.
            let view = step(STEPS, 1.0, row).sqrt().asin();
            for column in 0..STEPS {
                sum += self.factor(sun, view, step(STEPS, PI, column));
            }
        }
        sum / f64::from(STEPS * STEPS)
    }

    /// Bidirectional reflectance factor for zenith angles of sun and view and the angle between their
    /// azimuths, radians.
    fn factor(&self, sun: f64, view: f64, azimuth: f64) -> f64 {
        let (mu_sun, mu_view) = (sun.cos(), view.cos());
        let across = sun.sin() * view.sin() * azimuth.cos();
        let phase = (mu_sun * mu_view + across).clamp(-1.0, 1.0);
        let specular = (mu_sun * mu_view - across).clamp(-1.0, 1.0);
        let legendre = |x: f64| 0.5 * (3.0 * x * x - 1.0);
        let [c1, c2, c3, c4] = self.c;
        let p = 1.0 + c1 * phase + c2 * legendre(phase) + c3 * specular + c4 * legendre(specular);
        let [h1, h2] = self.h;
        let b = h1 / (1.0 + (0.5 * phase.acos()).tan() / h2);
        let many = |mu: f64| (1.0 + 2.0 * mu) / (1.0 + 2.0 * mu * (1.0 - self.albedo).sqrt());
        0.25 * self.albedo / (mu_sun + mu_view)
            * ((1.0 + b) * p + many(mu_sun) * many(mu_view) - 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONSERVATIVE: Soilspect = Soilspect { albedo: 1.0, c: [0.0; 4], h: [0.0, 1.0] };

    /// *Scene*: isotropic scatterers that absorb nothing, with no hot spot.
    /// *Expected*: Hapke's approximation H(x) = 1 + 2x conserves energy to within a few percent.
    #[test]
    fn a_soil_that_absorbs_nothing_reflects_nearly_all() {
        for zenith in [0.0_f64, 30.0, 60.0] {
            let reflectance = CONSERVATIVE.over_all_directions(zenith.to_radians());
            assert!((reflectance - 1.0).abs() < 0.05, "{reflectance} at {zenith}°");
        }
    }

    /// The factor of isotropic scatterers at nadir is `ω / 8 H²`.
    #[test]
    fn the_factor_at_nadir_is_that_of_the_formula() {
        let soil = Soilspect { albedo: 0.5, ..CONSERVATIVE };
        let h = 3.0 / (1.0 + 2.0 * 0.5_f64.sqrt());
        assert!((soil.factor(0.0, 0.0, 0.0) - 0.0625 * h * h).abs() < 1e-12);
    }

    #[test]
    fn the_hot_spot_is_where_sun_and_view_agree() {
        let soil = Soilspect { albedo: 0.5, c: [0.5, 0.2, 0.0, 0.0], h: [1.0, 0.1] };
        let (sun, view) = (0.7, 0.7);
        let hot = soil.factor(sun, view, 0.0);
        for azimuth in [0.05, 0.3, 1.0, 2.0, 3.0] {
            assert!(hot > soil.factor(sun, view, azimuth), "{azimuth}");
        }
        // Without the term of the hot spot, `B`, the peak is gone but for the phase function's slope.
        let without = Soilspect { h: [0.0, 0.1], ..soil };
        let peak = |soil: &Soilspect| soil.factor(sun, view, 0.0) / soil.factor(sun, view, 0.3);
        assert!(peak(&soil) > 1.2 * peak(&without), "{} {}", peak(&soil), peak(&without));
    }
}
