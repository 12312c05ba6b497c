//! Radiance that is emitted, reflected or both, and the temperature that it looks like.

use super::Context;
use crate::spectral::{brightness_temperature, planck_mean_slope};

/// Radiance with its standard error, W m⁻² sr⁻¹ nm⁻¹, shape `[.., bands]`: in each band the sum of
/// the sources that it holds.
///
/// - `reflected`: `L / E` and its standard error, if any band holds it
/// - `emitted`: absolute, and its standard error
///
/// The two are independent estimates: their variances add.
#[must_use]
pub fn radiance_of_sources(
    reflected: Option<(&[f64], &[f64])>,
    emitted: (&[f64], &[f64]),
    context: &Context,
) -> (Vec<f64>, Vec<f64>) {
    let bands = context.bands.len();
    let both = emitted.0.iter().zip(emitted.1).enumerate().map(|(index, (&value, &error))| {
        let band = index % bands;
        let source = &context.sources[band];
        let (mut sum, mut spread) = if source.emits { (value, error) } else { (0.0, 0.0) };
        if let Some((relative, relative_error)) = reflected.filter(|_| source.reflects) {
            sum += relative[index] * context.irradiance[band];
            spread = spread.hypot(relative_error[index] * context.irradiance[band]);
        }
        (sum, spread)
    });
    both.unzip()
}

/// Brightness temperature with its standard error, K, shape `[.., bands that hold emission]`, of
/// radiance with its standard error, shape `[.., bands]`: `σ_T = σ_L / (dB/dT)`.
#[must_use]
pub fn brightness((radiance, error): (&[f64], &[f64]), context: &Context) -> (Vec<f64>, Vec<f64>) {
    let bands = context.bands.len();
    let pairs = radiance.iter().zip(error).enumerate();
    pairs
        .filter_map(|(index, (&value, &error))| {
            let source = &context.sources[index % bands];
            source.emits.then(|| {
                let kelvin = brightness_temperature(&source.response, value);
                (kelvin, error / planck_mean_slope(&source.response, kelvin))
            })
        })
        .unzip()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::products::BandSources;
    use crate::spectral::{BandResponse, BandWindow, planck_mean};

    #[test]
    fn sources_add_up_band_by_band() {
        let window = BandResponse::Window(BandWindow { center: 4_000.0, width: 100.0 });
        let source = |emits, reflects| BandSources {
            center_nm: 4_000.0,
            response: window.clone(),
            emits,
            reflects,
        };
        let context = Context {
            scenes: 1,
            bands: ["a", "b", "c"].map(str::to_owned).into(),
            irradiance: vec![2.0, 2.0, 2.0],
            has_sky: false,
            origin: (0.0, 0.0),
            formats: Vec::new(),
            sources: vec![source(false, true), source(true, false), source(true, true)],
        };
        let emitted = ([9.0, 1.0, 3.0], [9.0, 0.1, 0.3]);
        let reflected = ([0.5, 9.0, 1.0], [0.1, 9.0, 0.2]);
        let sum = radiance_of_sources(
            Some((&reflected.0, &reflected.1)),
            (&emitted.0, &emitted.1),
            &context,
        );
        assert_eq!(sum, (vec![1.0, 1.0, 5.0], vec![0.2, 0.1, 0.5]));
        let black = planck_mean(&window, 300.0);
        let step = planck_mean(&window, 300.01) - black;
        let (kelvin, error) = brightness((&[9.0, black, black], &[0.0, step, step]), &context);
        assert_eq!(kelvin.len(), 2);
        assert!((kelvin[0] - 300.0).abs() < 1e-9 && (error[0] - 0.01).abs() < 1e-5, "{error:?}");
    }
}
