mod file;
mod table;

use std::collections::BTreeSet;

use super::Resources;
use crate::document::{
    Diagnostic, IRRADIANCE, Prospect, ScenePath, SoilMixture, Spectrum, unknown_name,
};
use crate::spectral::prospect::{LeafChemistry, LeafSpectrum, leaf_spectrum_at};
use crate::spectral::{
    ASTM_E490, ASTM_G173, BandResponse, OutsideSpectrum, SolarSpectrum, library_spectrum,
    soil_reflectance,
};

pub(super) use file::read_columns;
use file::table_points;
use table::table_means;

/// Irradiance above this is several times that of the sun outside the atmosphere, W m⁻² nm⁻¹.
pub(super) const STRONG: f64 = 10.0;

/// Width of a band, nm, and difference of the values in it from which on a mean over it says little.
const WIDE_NM: f64 = 200.0;
const VARIED: f64 = 0.25;

/// Quantity that a spectrum holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SpectrumQuantity {
    Reflectance,
    Transmittance,
    Irradiance,
    /// Parameter of a surface model within these bounds.
    Parameter {
        least: f64,
        most: f64,
    },
}

impl SpectrumQuantity {
    const fn is_fraction(self) -> bool {
        matches!(self, Self::Reflectance | Self::Transmittance)
    }
}

/// A leaf that PROSPECT has computed.
#[derive(Clone, Debug)]
pub(super) struct LastLeaf {
    chemistry: LeafChemistry,
    /// Ranges of wavelengths that it was computed for, nm.
    ranges: Vec<(f64, f64)>,
    spectrum: LeafSpectrum,
}

/// Value of a spectrum in each band, shape `[bands]`; `None` after an error.
pub(super) fn resolve_spectrum(
    spectrum: &Spectrum,
    quantity: SpectrumQuantity,
    path: &ScenePath,
    resources: &mut Resources,
) -> Option<Vec<f64>> {
    let resolved = resolve(spectrum, quantity, path, &mut BTreeSet::new(), resources);
    if quantity == SpectrumQuantity::Irradiance && !reads_file(spectrum, resources) {
        warn_strong_light(resolved.as_deref().unwrap_or_default(), path, resources);
    }
    match resolved.and_then(|values| lawful(values, quantity, path)) {
        Ok(values) => Some(values),
        Err(problem) => {
            resources.report(*problem);
            None
        }
    }
}

/// Warns of light that is several times that of the sun: other units may have been meant.
fn warn_strong_light(values: &[f64], path: &ScenePath, resources: &mut Resources) {
    let strongest = values.iter().copied().fold(0.0, f64::max);
    if strongest <= STRONG || !strongest.is_finite() {
        return;
    }
    let message = format!(
        "an irradiance of {strongest} W m⁻² nm⁻¹: the sun has at most 2.2 outside the atmosphere"
    );
    let help = "irradiance is per nanometre: 1000 W m⁻² over 400 to 700 nm are 3.3; results that are \
                    ratios do not depend on it";
    resources.report(Diagnostic::warning(path, message).help(help));
}

/// Warns of a wide band within which a surface differs so much that its mean says little.
fn warn_wide_bands(points: &[(f64, f64)], path: &ScenePath, resources: &mut Resources) {
    for (band, response) in resources.bands.iter().zip(resources.responses.all()) {
        let (low, high) = response.range();
        let width = response.width();
        let within =
            points.iter().filter(|(nm, value)| (low..=high).contains(nm) && value.is_finite());
        let (least, most) = within
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), &(_, v)| {
                (least.min(v), most.max(v))
            });
        if width < WIDE_NM || most - least < VARIED {
            continue;
        }
        let message = format!(
            "band `{}` is {width} nm wide, and values differ from {least:.3} to {most:.3} within it",
            band.name
        );
        let help = "light is scattered often, so the mean over a band does not give the mean of the \
                        results: write several narrow bands and weight their results with the irradiance";
        let warning = Diagnostic::warning(path, message).help(help);
        resources.messages.report_once(warning);
    }
}

/// Returns whether a spectrum comes from a file, perhaps by way of names.
pub(super) fn reads_file(spectrum: &Spectrum, resources: &Resources) -> bool {
    matches!(named(spectrum, resources), Spectrum::Table(_))
}

/// Returns whether a spectrum is a function of wavelength, and no list of values of the scene's bands.
pub(super) fn has_wavelengths(spectrum: &Spectrum, resources: &Resources) -> bool {
    !matches!(named(spectrum, resources), Spectrum::Bands(_) | Spectrum::Named(_))
}

/// The spectrum that names lead to; a name that leads nowhere stays.
fn named<'a>(mut spectrum: &'a Spectrum, resources: &'a Resources) -> &'a Spectrum {
    // Names that go in a circle end after as many steps as there are names.
    for _ in 0..=resources.spectra.len() {
        let Spectrum::Named(name) = spectrum else { break };
        let Some(named) = resources.spectra.get(name.as_str()) else { break };
        spectrum = named;
    }
    spectrum
}

fn resolve(
    spectrum: &Spectrum,
    quantity: SpectrumQuantity,
    path: &ScenePath,
    visited: &mut BTreeSet<String>,
    resources: &mut Resources,
) -> Result<Vec<f64>, Box<Diagnostic>> {
    let bands = resources.bands.len();
    match spectrum {
        Spectrum::Constant(value) => Ok(vec![*value; bands]),
        Spectrum::Bands(values) => Ok(values.clone()),
        Spectrum::Points(points) => mean_over_bands(points, quantity, path, resources),
        Spectrum::Table(table) => table_means(table, quantity, path, resources),
        Spectrum::AstmG173 => solar_means(&ASTM_G173, quantity, path, resources),
        Spectrum::AstmE490 => solar_means(&ASTM_E490, quantity, path, resources),
        Spectrum::Library(name) => {
            // `document::check` knows the names.
            let points = library_spectrum(name).unwrap_or_default();
            reflectance_means(points, quantity, path, resources)
        }
        Spectrum::Soil(SoilMixture { dryness, brightness }) => {
            let points = soil_reflectance(*dryness, *brightness);
            reflectance_means(&points, quantity, path, resources)
        }
        Spectrum::Named(name) => {
            let Some(named) = resources.spectra.get(name.as_str()) else {
                let known = resources.spectra.keys().map(String::as_str);
                return Err(Box::new(unknown_name(path, "spectrum", name, known)));
            };
            if !visited.insert(name.to_string()) {
                let problem = Diagnostic::error(path, format!("spectrum `{name}` names itself"));
                let help = "give it values: Constant, Bands, Points, Table or Prospect";
                return Err(Box::new(problem.help(help)));
            }
            let named = named.clone();
            let path = ScenePath::from("spectra").name(name.as_str());
            resolve(&named, quantity, &path, visited, resources)
        }
        Spectrum::Prospect(leaf) => prospect_means(leaf, quantity, path, resources),
    }
}

/// Reflectance or transmittance of a leaf by PROSPECT in each band.
fn prospect_means(
    leaf: &Prospect,
    quantity: SpectrumQuantity,
    path: &ScenePath,
    resources: &mut Resources,
) -> Result<Vec<f64>, Box<Diagnostic>> {
    let chemistry = LeafChemistry {
        n: leaf.n,
        chlorophyll: leaf.chlorophyll_ug_cm2,
        carotenoid: leaf.carotenoid_ug_cm2,
        anthocyanin: leaf.anthocyanin_ug_cm2,
        brown: leaf.brown,
        water: leaf.water_cm,
        dry_matter: leaf.dry_matter_g_cm2,
        protein: leaf.protein_g_cm2,
        carbon: leaf.carbon_g_cm2,
    };
    let ranges: Vec<(f64, f64)> =
        resources.responses.all().iter().map(BandResponse::range).collect();
    let is_known = |last: &LastLeaf| last.chemistry == chemistry && last.ranges == ranges;
    let spectrum = match resources.last_leaf.take() {
        Some(last) if is_known(&last) => last.spectrum,
        _ => {
            // A band sees straight lines between whole nanometres.
            let is_seen =
                |nm: f64| ranges.iter().any(|(low, high)| (low - 1.0..=high + 1.0).contains(&nm));
            let leaf = leaf_spectrum_at(&chemistry, is_seen);
            leaf.map_err(|error| Box::new(problem(path, &error)))?
        }
    };
    let means = match quantity {
        SpectrumQuantity::Reflectance => {
            mean_over_bands(&spectrum.reflectance, quantity, path, resources)
        }
        SpectrumQuantity::Transmittance => {
            mean_over_bands(&spectrum.transmittance, quantity, path, resources)
        }
        SpectrumQuantity::Irradiance | SpectrumQuantity::Parameter { .. } => {
            let what = "Prospect gives reflectance and transmittance, no irradiance";
            let help = "write AstmG173, Constant, Bands, Points or Table";
            Err(Box::new(Diagnostic::error(path, what).help(help)))
        }
    };
    resources.last_leaf = Some(LastLeaf { chemistry, ranges, spectrum });
    means
}

/// The sun's irradiance in each band.
fn solar_means(
    sun: &SolarSpectrum,
    quantity: SpectrumQuantity,
    path: &ScenePath,
    resources: &mut Resources,
) -> Result<Vec<f64>, Box<Diagnostic>> {
    if quantity != SpectrumQuantity::Irradiance {
        let message = "a spectrum of the sun is an irradiance, no reflectance or transmittance";
        let help = "write Constant, Bands, Points, Table or Prospect";
        return Err(Box::new(Diagnostic::error(path, message).help(help)));
    }
    let mut beyond = Vec::new();
    let bands = resources.bands.iter().zip(resources.responses.all());
    let means = bands.map(|(band, response)| -> Result<f64, Box<Diagnostic>> {
        let mean = sun.mean(response).map_err(|error| {
            let message = format!("band `{}`: {error}", band.name);
            Box::new(
                Diagnostic::error(path, message)
                    .help("move the band, or write `irradiance` of the sun's own"),
            )
        })?;
        if band.reflects() && response.range().1 > sun.end_nm() {
            beyond.push(format!("{mean:.3e} in band `{}`", band.name));
        }
        Ok(mean)
    });
    let means = means.collect::<Result<Vec<f64>, _>>()?;
    if !beyond.is_empty() {
        let message = format!(
            "{} ends at {} nm: beyond it the sun is taken as a black body of 5772 K that joins it there, \
                 without the gases of the air: {} W m⁻² nm⁻¹",
            sun.name,
            sun.end_nm(),
            beyond.join(", ")
        );
        let help = "write `irradiance` where that is not good enough";
        resources.report(Diagnostic::warning(path, message).help(help));
    }
    Ok(means)
}

/// Mean in each band of a reflectance.
fn reflectance_means(
    points: &[(f64, f64)],
    quantity: SpectrumQuantity,
    path: &ScenePath,
    resources: &mut Resources,
) -> Result<Vec<f64>, Box<Diagnostic>> {
    if quantity == SpectrumQuantity::Irradiance {
        let message = "this is the reflectance of a surface, no light";
        let help = "write AstmG173, Constant, Bands, Points or Table";
        return Err(Box::new(Diagnostic::error(path, message).help(help)));
    }
    mean_over_bands(points, quantity, path, resources)
}

/// Mean in each band of a spectrum given by points.
fn mean_over_bands(
    points: &[(f64, f64)],
    quantity: SpectrumQuantity,
    path: &ScenePath,
    resources: &mut Resources,
) -> Result<Vec<f64>, Box<Diagnostic>> {
    if quantity.is_fraction() {
        warn_wide_bands(points, path, resources);
    }
    let bands = resources.bands.iter().zip(resources.responses.all());
    let means = bands.map(|(band, response)| {
        band_mean(response, points, quantity, resources).map_err(|error| {
            Box::new(Diagnostic::error(path, format!("band `{}`: {error}", band.name)))
        })
    });
    means.collect()
}

/// Mean of a spectrum over a band; of a fraction that which times the irradiance is what is reflected.
fn band_mean(
    response: &BandResponse,
    points: &[(f64, f64)],
    quantity: SpectrumQuantity,
    resources: &Resources,
) -> Result<f64, OutsideSpectrum> {
    if quantity.is_fraction() {
        response.mean_of_fraction(points, resources.responses.irradiance())
    } else {
        response.mean(points)
    }
}

/// Points (wavelength nm, value) of the sun's irradiance, if it has wavelengths.
pub(super) fn irradiance_points(
    spectrum: &Spectrum,
    resources: &mut Resources,
) -> Option<Vec<(f64, f64)>> {
    match named(spectrum, resources).clone() {
        Spectrum::AstmG173 => Some(ASTM_G173.points().to_vec()),
        Spectrum::AstmE490 => Some(ASTM_E490.points().to_vec()),
        Spectrum::Points(points) => Some(points),
        Spectrum::Table(table) => table_points(&table, resources),
        Spectrum::Constant(_)
        | Spectrum::Bands(_)
        | Spectrum::Named(_)
        | Spectrum::Library(_)
        | Spectrum::Soil(_)
        | Spectrum::Prospect(_) => None,
    }
}

/// The values, if they can be those of the quantity.
fn lawful(
    values: Vec<f64>,
    quantity: SpectrumQuantity,
    path: &ScenePath,
) -> Result<Vec<f64>, Box<Diagnostic>> {
    let error = match quantity {
        SpectrumQuantity::Reflectance | SpectrumQuantity::Transmittance => None,
        SpectrumQuantity::Irradiance => {
            let beyond = values.iter().find_map(|&value| IRRADIANCE.problem(value));
            beyond.map(|(message, help)| Diagnostic::error(path, message).help(help))
        }
        SpectrumQuantity::Parameter { least, most } => {
            let beyond = values.iter().find(|value| !(least..=most).contains(value));
            beyond.map(|value| {
                let message = format!("expected numbers from {least} to {most}, found {value}");
                Diagnostic::error(path, message)
            })
        }
    };
    error.map_or(Ok(values), |error| Err(Box::new(error)))
}

fn problem(path: &ScenePath, error: &dyn std::error::Error) -> Diagnostic {
    Diagnostic::error(path, error.to_string())
}
