use hecs::World;

use super::Resources;
use super::resolve_bands::resolve_bands;
use super::resolve_optics::optics;
use super::spectra::has_wavelengths;
use crate::components::{MaterialId, SurfaceOptics};
use crate::document::{Band, Bands, Material, ScenePath};

/// Middles of the bands that colours are computed from, nm; each is 20 nm wide.
pub const VISIBLE_NM: [f64; 12] =
    [430.0, 450.0, 470.0, 490.0, 510.0, 530.0, 550.0, 570.0, 590.0, 610.0, 630.0, 660.0];

/// Optics of the used materials in visible bands ([`VISIBLE_NM`]), whatever the bands of the scene are, by [`MaterialId`].
///
/// Materials that are not used have none, nor those whose spectra have no wavelengths or end within the visible range.
#[must_use]
pub fn visible_optics(world: &World, resources: &Resources) -> Vec<Option<SurfaceOptics>> {
    let band = |&center: &f64| Band {
        center_nm: Some(center),
        width_nm: 20.0,
        ..Band::new(format!("{center} nm"))
    };
    // The messages of the copy are dropped: nobody has asked for these bands.
    let mut visible =
        Resources { bands: Bands(VISIBLE_NM.iter().map(band).collect()), ..resources.clone() };
    resolve_bands(&mut World::new(), &mut visible);
    let mut optics_of = |(index, (name, &entity)): (usize, (&String, &hecs::Entity))| {
        let material = world.get::<&Material>(entity).ok()?;
        let is_used = resources.used_materials.contains_key(&MaterialId(index as u32));
        let mut spectra = material.spectra().into_iter().map(|(_, spectrum, _)| spectrum);
        let is_known = is_used && spectra.all(|spectrum| has_wavelengths(spectrum, resources));
        let path = ScenePath::from("materials").name(name);
        is_known.then(|| optics(&material, &path, &mut visible)).flatten()
    };
    resources.materials.iter().enumerate().map(&mut optics_of).collect()
}
