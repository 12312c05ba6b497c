//! Bands, spectra, and the materials that have them.

use std::collections::HashMap;

use super::super::diagnostic::suggestion;
use super::super::scene::{
    Band, Coating, Leaf, Material, Prospect, Response, Scene, SoilMixture, Spectrum,
    SurfaceQuantity,
};
use super::reflectance_map::check_reflectance_map;
use super::{Report, ScenePath};
use crate::counts::counted;
use crate::spectral::{SHORTEST_NM, library_names, library_spectrum};

/// A spectrum may name one that names one, and so on, so often.
const CHAIN: usize = 16;

/// Quantity of a spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum CheckedQuantity {
    /// Reflectance, transmittance or parameter of a surface.
    Surface(SurfaceQuantity),
    /// 0 or above.
    Irradiance,
    /// Any of these: the quantity of those who name it.
    Any,
}

pub(super) fn check_bands(scene: &Scene, report: &mut Report<'_>) {
    if scene.bands.is_empty() {
        let help = "write, for example, `bands: [(name: \"red\", center_nm: 660.0)]`";
        report.error("bands", "the scene has no band", help);
    }
    let mut names = HashMap::new();
    for (index, band) in scene.bands.iter().enumerate() {
        let path = ScenePath::from("bands").index(index);
        let name = &band.name;
        if name.is_empty() {
            let help = "outputs call the band by its name";
            report.error(path.key("name"), "this band has no name", help);
        } else if let Some(first) = names.insert(name, index) {
            let message = format!("a second band `{name}`");
            let help = format!("`bands[{first}]` has that name already");
            report.error(path.key("name"), message, help);
        }
        check_response(band, &path, report);
    }
}

fn check_response(band: &Band, path: &ScenePath, report: &mut Report<'_>) {
    let Band { center_nm, width_nm, response, .. } = band;
    let is_whole = |key: &'static str| report.is_whole(path.key(key));
    if !["center_nm", "width_nm", "response"].into_iter().all(is_whole) {
        return;
    }
    let center = center_nm.unwrap_or(f64::INFINITY);
    if center_nm.is_some() {
        report.above_zero(path.key("center_nm"), center);
    }
    if center > 0.0 && center < SHORTEST_NM {
        refuse_micrometres(center, *width_nm, &path.key("center_nm"), report);
        return;
    }
    report.at_least(path.key("width_nm"), *width_nm, 0.0);
    match response {
        Response::Box | Response::Gaussian if center_nm.is_none() => {
            band.known_response(path).err().into_iter().for_each(|problem| report.push(*problem));
        }
        Response::Box if center > 0.0 && *width_nm >= 2.0 * center => {
            let message =
                format!("a band of {width_nm} nm around {center} nm reaches to a wavelength of 0");
            report.error(path.key("width_nm"), message, "the width is that from edge to edge");
        }
        Response::Gaussian if !(*width_nm > 0.0 && *width_nm < 0.3 * center) => {
            let message = format!("a normal curve of {width_nm} nm around {center} nm is no band");
            let help = "write `width_nm`, its full width at half maximum, such as `width_nm: 10.0`";
            report.error(path.key("width_nm"), message, help);
        }
        Response::Table(_) | Response::Box | Response::Gaussian => {}
        Response::Points(_) | Response::Sensor(_) => {
            band.known_response(path).err().into_iter().for_each(|problem| report.push(*problem));
        }
    }
}

/// Refuses a band whose wavelengths are no light in nanometres.
fn refuse_micrometres(center: f64, width: f64, path: &ScenePath, report: &mut Report<'_>) {
    let message = format!("a wavelength of {center} nm is no light");
    let nanometres = |micrometres: f64| (1e6 * micrometres).round() / 1e3;
    let width = if width > 0.0 && width < center {
        format!(", and {width} µm is `width_nm: {:?}`", nanometres(width))
    } else {
        String::new()
    };
    let center = format!("{center} µm is `center_nm: {:?}`", nanometres(center));
    report.error(path, message, format!("wavelengths are in nm: {center}{width}"));
}

pub(super) fn check_spectra(scene: &Scene, report: &mut Report<'_>) {
    report.own_names("spectra", "a spectrum", &scene.spectra);
    for (index, (name, spectrum)) in scene.spectra.iter().enumerate() {
        let path = ScenePath::from("spectra").name(name);
        check_spectrum(&path, spectrum, CheckedQuantity::Any, scene, report);
        check_chain(index, &path, scene, report);
    }
}

pub(super) fn check_materials(scene: &Scene, report: &mut Report<'_>) {
    report.own_names("materials", "a material", &scene.materials);
    for (name, material) in &scene.materials {
        if let Material::Leaf(Leaf { reflectance, transmittance, .. }) = material {
            warn_two_leaves(name, [reflectance, transmittance], scene, report);
        }
        for (key, spectrum, quantity) in material.spectra() {
            let path = ScenePath::from("materials").name(name).key(key);
            check_spectrum(&path, spectrum, CheckedQuantity::Surface(quantity), scene, report);
        }
        if let Material::Leaf(Leaf { coating: Some(coating), .. }) = material {
            check_coating(&ScenePath::from("materials").name(name).key("coating"), coating, report);
        }
        if let Material::ReflectanceMap(map) = material {
            check_reflectance_map(&ScenePath::from("materials").name(name), map, scene, report);
        }
    }
}

fn check_coating(path: &ScenePath, coating: &Coating, report: &mut Report<'_>) {
    let Coating { refractive_index, roughness } = *coating;
    if !(1.1..=2.0).contains(&refractive_index) {
        let message =
            format!("expected a refractive index from 1.1 to 2, found {refractive_index}");
        let help = "the wax of leaves has about 1.45";
        report.error(path.key("refractive_index"), message, help);
    }
    if !(0.05..=1.0).contains(&roughness) {
        let message = format!("expected a roughness from 0.05 to 1, found {roughness}");
        let help = "it is a slope: about 0.1 for glossy leaves, 0.5 for dull ones";
        report.error(path.key("roughness"), message, help);
    }
}

/// Warns of a leaf whose reflectance and transmittance follow from two leaves.
fn warn_two_leaves(name: &str, spectra: [&Spectrum; 2], scene: &Scene, report: &mut Report<'_>) {
    let [reflectance, transmittance] = spectra.map(|spectrum| match spectrum {
        Spectrum::Named(name) => resolve(name, scene),
        other => Some(other),
    });
    let are_leaves =
        [reflectance, transmittance].iter().all(|one| matches!(one, Some(Spectrum::Prospect(_))));
    if are_leaves && reflectance != transmittance {
        let message = "reflectance and transmittance are those of two different leaves";
        let help = "define the leaf once, `spectra: { \"leaf\": Prospect(..) }`, and write \
                    `Named(\"leaf\")` in both";
        report.warning(ScenePath::from("materials").name(name).key("transmittance"), message, help);
    }
}

pub(super) fn check_spectrum(
    path: &ScenePath,
    spectrum: &Spectrum,
    quantity: CheckedQuantity,
    scene: &Scene,
    report: &mut Report<'_>,
) {
    let value = |report: &mut Report<'_>, path: &ScenePath, value: f64| match quantity {
        CheckedQuantity::Surface(SurfaceQuantity::Fraction) => report.fraction(path, value),
        CheckedQuantity::Surface(SurfaceQuantity::Parameter { least, most }) => {
            report.within(path, value, least, most);
        }
        CheckedQuantity::Irradiance | CheckedQuantity::Any => report.at_least(path, value, 0.0),
    };
    match spectrum {
        Spectrum::Constant(constant) => value(report, path, *constant),
        Spectrum::Bands(values) => {
            check_band_count(path, "Bands", values.len(), scene, report);
            for (index, one) in values.iter().enumerate() {
                value(report, &path.index(index), *one);
            }
        }
        Spectrum::Points(points) => {
            check_wavelengths(path, points, report);
            for (index, (_, one)) in points.iter().enumerate() {
                value(report, &path.index(index).index(1), *one);
            }
        }
        Spectrum::Table(table) => report.above_zero(path.key("scale"), table.scale),
        Spectrum::AstmG173 | Spectrum::AstmE490 => {
            if matches!(quantity, CheckedQuantity::Surface(_)) {
                let message =
                    "a spectrum of the sun is an irradiance, no reflectance or transmittance";
                let help = "write `Constant(..)`, `Bands(..)`, `Points(..)`, `Table(..)` or `Prospect(..)`";
                report.error(path, message, help);
            }
        }
        Spectrum::Library(name) => {
            if library_spectrum(name).is_none() {
                let known: Vec<&str> = library_names().collect();
                let message = format!("no spectrum `{name}` comes with sunfleck");
                report.error(path, message, suggestion(name, &known, "these do"));
            }
            refuse_surface_as_light(path, quantity, report);
        }
        Spectrum::Soil(SoilMixture { dryness, brightness }) => {
            for (key, value, most) in [("dryness", *dryness, 1.0), ("brightness", *brightness, 2.0)]
            {
                if !(0.0..=most).contains(&value) {
                    let message = format!("expected a number from 0 to {most}, found {value}");
                    report.error(path.key(key), message, "1 is the soil as it was measured");
                }
            }
            refuse_surface_as_light(path, quantity, report);
        }
        Spectrum::Named(name) => {
            let is_leaf = matches!(resolve(name, scene), Some(Spectrum::Prospect(_)));
            if quantity == CheckedQuantity::Irradiance && is_leaf {
                refuse_leaf_as_light(path, report);
            }
        }
        Spectrum::Prospect(leaf) => {
            check_prospect(path, leaf, report);
            match quantity {
                CheckedQuantity::Irradiance => refuse_leaf_as_light(path, report),
                CheckedQuantity::Surface(SurfaceQuantity::Parameter { .. }) => {
                    let message = "`Prospect` is the spectrum of a leaf, no parameter of a model";
                    let help = "write `Constant(..)`, `Bands(..)`, `Points(..)` or `Table(..)`";
                    report.error(path, message, help);
                }
                CheckedQuantity::Surface(SurfaceQuantity::Fraction) | CheckedQuantity::Any => {}
            }
        }
    }
}

/// Checks that there are as many values as bands.
pub(super) fn check_band_count(
    path: &ScenePath,
    what: &str,
    values: usize,
    scene: &Scene,
    report: &mut Report<'_>,
) {
    let bands = scene.bands.len();
    if values == bands || bands == 0 || !report.is_readable("bands") {
        return;
    }
    let (values, shown) = (counted(values, "value"), counted(bands, "band"));
    let message = format!("`{what}` has {values}, but the scene has {shown}");
    let names: Vec<_> = scene.bands.iter().take(20).map(|band| band.name.as_str()).collect();
    let more = if bands > names.len() { ", .." } else { "" };
    let help = format!("write one value for each of: {}{more}", names.join(", "));
    report.error(path, message, help);
}

fn check_wavelengths(path: &ScenePath, points: &[(f64, f64)], report: &mut Report<'_>) {
    if points.is_empty() {
        let help = "write, for example, `Points([(400.0, 0.05), (800.0, 0.3)])`";
        report.error(path, "`Points` has no point", help);
    }
    let mut before = 0.0;
    for (index, &(wavelength, _)) in points.iter().enumerate() {
        let at = path.index(index).index(0);
        if index == 0 {
            report.above_zero(at, wavelength);
        } else if !(wavelength > before && wavelength.is_finite()) {
            let message = format!("wavelength {wavelength} nm follows {before} nm");
            report.error(at, message, "sort the points: wavelengths must rise");
        }
        before = wavelength;
    }
}

fn refuse_surface_as_light(path: &ScenePath, quantity: CheckedQuantity, report: &mut Report<'_>) {
    if quantity == CheckedQuantity::Irradiance {
        let help = "write `AstmG173`, `Constant(..)`, `Bands(..)`, `Points(..)` or `Table(..)`";
        report.error(path, "this is the reflectance of a surface, no light", help);
    }
}

fn refuse_leaf_as_light(path: &ScenePath, report: &mut Report<'_>) {
    let help = "write `Constant(..)`, `Bands(..)`, `Points(..)` or `Table(..)`";
    report.error(path, "`Prospect` is the spectrum of a leaf, not of light", help);
}

fn check_prospect(path: &ScenePath, leaf: &Prospect, report: &mut Report<'_>) {
    let Prospect {
        n,
        chlorophyll_ug_cm2,
        carotenoid_ug_cm2,
        anthocyanin_ug_cm2,
        brown,
        water_cm,
        dry_matter_g_cm2,
        protein_g_cm2,
        carbon_g_cm2,
    } = leaf;
    report.at_least(path.key("n"), *n, 1.0);
    let contents = [
        ("chlorophyll_ug_cm2", chlorophyll_ug_cm2),
        ("carotenoid_ug_cm2", carotenoid_ug_cm2),
        ("anthocyanin_ug_cm2", anthocyanin_ug_cm2),
        ("brown", brown),
        ("water_cm", water_cm),
        ("dry_matter_g_cm2", dry_matter_g_cm2),
        ("protein_g_cm2", protein_g_cm2),
        ("carbon_g_cm2", carbon_g_cm2),
    ];
    for (key, content) in contents {
        report.at_least(path.key(key), *content, 0.0);
    }
    if *n >= 1.0 {
        let help = "it is the number of layers of a leaf, without a unit";
        report.warn_implausible(path, "n", *n, 1.0, 4.0, help);
    }
    let plausible = [
        (contents[0], 1.0, 150.0, "it is in µg cm⁻²: mg m⁻² divided by 10"),
        (contents[1], 0.0, 50.0, "it is in µg cm⁻²: mg m⁻² divided by 10"),
        (contents[2], 0.0, 60.0, "it is in µg cm⁻²: mg m⁻² divided by 10"),
        (contents[3], 0.0, 10.0, "it has an arbitrary unit, and is mostly below 1"),
        (contents[4], 0.0, 0.1, "it is in cm, which is g cm⁻²: g m⁻² divided by 10000"),
        (contents[5], 0.0, 0.05, "it is in g cm⁻²: g m⁻² divided by 10000"),
        (contents[6], 0.0, 0.01, "it is in g cm⁻²: g m⁻² divided by 10000"),
        (contents[7], 0.0, 0.05, "it is in g cm⁻²: g m⁻² divided by 10000"),
    ];
    for ((key, content), low, high, unit) in plausible {
        report.warn_implausible(path, key, *content, low, high, unit);
    }
    if *dry_matter_g_cm2 > 0.0 && (*protein_g_cm2 > 0.0 || *carbon_g_cm2 > 0.0) {
        let message = "dry matter would count twice: proteins and other carbon are parts of it";
        let help = "write `dry_matter_g_cm2: 0.0` beside `protein_g_cm2` and `carbon_g_cm2`";
        report.error(path, message, help);
    }
}

/// The spectrum at the end of a chain of names.
fn resolve<'a>(name: &str, scene: &'a Scene) -> Option<&'a Spectrum> {
    let mut spectrum = scene.spectra.get(name)?;
    for _ in 0..CHAIN {
        match spectrum {
            Spectrum::Named(next) => spectrum = next.find(scene)?,
            _ => return Some(spectrum),
        }
    }
    None
}

/// Names that lead back to where they started, reported once, at the first of them.
fn check_chain(start: usize, path: &ScenePath, scene: &Scene, report: &mut Report<'_>) {
    let mut chain = Vec::new();
    let mut at = start;
    while let Some((name, Spectrum::Named(next))) = scene.spectra.get_index(at) {
        chain.push(format!("`{name}`"));
        let help = "give one of them values of its own";
        match scene.spectra.get_index_of(next.as_str()) {
            Some(next) if next == start => {
                let message = match chain.as_slice() {
                    [own] => format!("the spectrum {own} names itself"),
                    _ => format!("the spectra {} name each other in a circle", chain.join(", ")),
                };
                return report.error(path, message, help);
            }
            // Who comes earlier in the document has reported it.
            Some(next) if next < start => return,
            Some(_) if chain.len() == CHAIN => {
                let message = format!("more than {CHAIN} spectra name one another from here");
                return report.error(path, message, help);
            }
            Some(next) => at = next,
            None => return,
        }
    }
}
