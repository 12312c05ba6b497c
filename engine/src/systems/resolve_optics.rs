use std::collections::BTreeMap;

use hecs::World;

use super::spectra::{SpectrumQuantity, reads_file, resolve_spectrum};
use super::{Resources, set_component};
use crate::components::{
    DirectionalOptics, EnergyGain, GlossyOptics, LambertianOptics, LeafCoating, MaterialId,
    RpvParameters, SoilspectParameters, SurfaceOptics,
};
use crate::document::{
    Diagnostic, Lambertian, Leaf, Material, Rpv, ScenePath, Spectrum, SurfaceQuantity,
};
use crate::scattering::{BandModel, ModelFault};

/// Resolves the spectra of used materials to bands, and checks the others as far as that takes no file. Reads
/// `document::Material` and the resources `spectra`, `bands` and `used_materials`; writes [`SurfaceOptics`] of all materials
/// but maps.
pub(super) fn resolve_optics(world: &mut World, resources: &mut Resources) {
    let materials: Vec<_> =
        resources.materials.iter().map(|(name, &entity)| (name.clone(), entity)).collect();
    for (index, (name, entity)) in materials.into_iter().enumerate() {
        let path = ScenePath::from("materials").name(&name);
        let is_used = resources.used_materials.contains_key(&MaterialId(index as u32));
        if !is_used {
            resources.messages.skip(format!("material `{name}`: nothing wears it"));
        }
        let optics = {
            let material = world.get::<&Material>(entity);
            let material = material.expect("`spawn` gives materials their source");
            if matches!(&*material, Material::ReflectanceMap(_)) {
                continue;
            }
            let reads_file =
                material.spectra().iter().any(|(_, spectrum, _)| reads_file(spectrum, resources));
            if is_used || !reads_file { optics(&material, &path, resources) } else { None }
        };
        set_component(world, entity, optics.filter(|_| is_used));
    }
}

/// Optics of a material; `None` after an error, and of maps, which `map_reflectance` reads.
pub(super) fn optics(
    material: &Material,
    path: &ScenePath,
    resources: &mut Resources,
) -> Option<SurfaceOptics> {
    match material {
        Material::Lambertian(Lambertian { reflectance, back_reflectance, .. }) => {
            let opaque = Spectrum::Constant(0.0);
            let sides =
                Sides { reflectance, back: back_reflectance.as_ref(), transmittance: &opaque };
            lambertian(&sides, path, resources).map(SurfaceOptics::BiLambertian)
        }
        Material::Leaf(Leaf { reflectance, transmittance, back_reflectance, coating, .. }) => {
            let sides = Sides { reflectance, back: back_reflectance.as_ref(), transmittance };
            let body = lambertian(&sides, path, resources)?;
            Some(match coating {
                None => SurfaceOptics::BiLambertian(body),
                Some(coating) => SurfaceOptics::GlossyLeaf(GlossyOptics {
                    body,
                    coating: LeafCoating::new(coating.refractive_index, coating.roughness),
                }),
            })
        }
        Material::Rpv(surface) => {
            let bands = rpv(surface, material, path, resources)?;
            let help = "lower `rho0`, or bring `k` nearer to 1";
            directional(bands, help, path, resources).map(SurfaceOptics::Rpv)
        }
        Material::Soilspect(_) => {
            let bands = soilspect(material, path, resources)?;
            let help = "lower `albedo`, or bring `b`, `c`, `b_prime` and `c_prime` nearer to 0";
            directional(bands, help, path, resources).map(SurfaceOptics::Soilspect)
        }
        Material::ReflectanceMap(_) => None,
    }
}

/// Spectra of a Lambertian surface.
struct Sides<'s> {
    reflectance: &'s Spectrum,
    back: Option<&'s Spectrum>,
    transmittance: &'s Spectrum,
}

fn lambertian(
    sides: &Sides<'_>,
    path: &ScenePath,
    resources: &mut Resources,
) -> Option<LambertianOptics> {
    let Sides { reflectance, back, transmittance } = sides;
    let mut resolve =
        |spectrum, quantity, key| resolve_spectrum(spectrum, quantity, &path.key(key), resources);
    let front = resolve(reflectance, SpectrumQuantity::Reflectance, "reflectance");
    let back = match back {
        Some(back) => resolve(back, SpectrumQuantity::Reflectance, "back_reflectance"),
        None => front.clone(),
    };
    let through = resolve(transmittance, SpectrumQuantity::Transmittance, "transmittance");
    let EnergyGain { band, reflectance, transmittance } =
        match LambertianOptics::new(&front?, &back?, &through?) {
            Ok(optics) => return Some(optics),
            Err(gain) => gain,
        };
    let band = &resources.bands[band].name;
    // As many digits as tell the sum from 1, without the rounding of the sum itself.
    let sum = format!("{:.12}", reflectance + transmittance);
    let sum = sum.trim_end_matches('0').trim_end_matches('.');
    let message = format!(
        "in band `{band}` reflectance {reflectance} and transmittance {transmittance} sum to {sum}: \
         a surface cannot send out more light than it receives"
    );
    let help = "lower one of them so that they sum to at most 1";
    resources.messages.report(Diagnostic::error(path, message).help(help));
    None
}

/// Parameters of a material by their keys, each of shape `[bands]`; `None` after an error.
fn parameters(
    material: &Material,
    path: &ScenePath,
    resources: &mut Resources,
) -> Option<BTreeMap<&'static str, Vec<f64>>> {
    let mut found = BTreeMap::new();
    let spectra = material.spectra();
    for &(key, spectrum, quantity) in &spectra {
        let quantity = match quantity {
            SurfaceQuantity::Fraction => SpectrumQuantity::Reflectance,
            SurfaceQuantity::Parameter { least, most } => {
                SpectrumQuantity::Parameter { least, most }
            }
        };
        let values = resolve_spectrum(spectrum, quantity, &path.key(key), resources);
        found.extend(values.map(|values| (key, values)));
    }
    (found.len() == spectra.len()).then_some(found)
}

/// Parameter of a material in a band.
fn parameter(values: &BTreeMap<&'static str, Vec<f64>>, key: &str, band: usize) -> f32 {
    values.get(key).expect("`Material::spectra` lists every parameter of a model")[band] as f32
}

fn rpv(
    surface: &Rpv,
    material: &Material,
    path: &ScenePath,
    resources: &mut Resources,
) -> Option<Vec<RpvParameters>> {
    let values = parameters(material, path, resources)?;
    let rho_c = if surface.rho_c.is_some() { "rho_c" } else { "rho0" };
    let band = |band: usize| {
        let value = |key: &str| parameter(&values, key, band);
        RpvParameters {
            rho0: value("rho0"),
            k: value("k"),
            asymmetry: value("asymmetry"),
            hot_spot: value(rho_c),
        }
    };
    Some((0..resources.bands.len()).map(band).collect())
}

fn soilspect(
    material: &Material,
    path: &ScenePath,
    resources: &mut Resources,
) -> Option<Vec<SoilspectParameters>> {
    let values = parameters(material, path, resources)?;
    let band = |band: usize| {
        let value = |key: &str| parameter(&values, key, band);
        SoilspectParameters {
            albedo: value("albedo"),
            roughness: value("roughness"),
            hot_spot: value("hot_spot"),
            backward: [value("b"), value("c")],
            forward: [value("b_prime"), value("c_prime")],
        }
    };
    Some((0..resources.bands.len()).map(band).collect())
}

/// Optics of a model that depends on both directions, if it keeps energy in every band.
fn directional<B: BandModel>(
    bands: Vec<B>,
    help: &str,
    path: &ScenePath,
    resources: &mut Resources,
) -> Option<DirectionalOptics<B>> {
    let ModelFault { band, zenith, dhr } = match DirectionalOptics::new(bands) {
        Ok(optics) => return Some(optics),
        Err(fault) => fault,
    };
    let message = format!(
        "in band `{}` this surface would reflect {:.1} % of the light from a zenith angle of {:.0}°: \
         a surface cannot send out more light than it receives",
        resources.bands[band].name,
        100.0 * dhr,
        zenith.to_degrees()
    );
    resources.messages.report(Diagnostic::error(path, message).help(help));
    None
}
