use hecs::World;

use super::spectra::irradiance_points;
use super::{Changes, Resources};
use crate::document::Sun;
use crate::spectral::BandResponse;

/// Finds the irradiance that reflectances and transmittances are weighted with, where some band is a curve. Reads
/// `document::Sun` and the resources `responses` and `spectra`; writes that of the resource `responses`, and marks it as
/// changed only where it is.
pub(super) fn resolve_weights(world: &mut World, resources: &mut Resources) {
    let is_curve = |response: &BandResponse| matches!(response, BandResponse::Curve(_));
    let has_curves = resources.responses.all().iter().any(is_curve);
    let sun = world.get::<&Sun>(resources.sun).ok().filter(|_| has_curves);
    let irradiance = sun.and_then(|sun| irradiance_points(&sun.irradiance, resources));
    if irradiance != resources.responses.irradiance {
        resources.responses.irradiance = irradiance;
        resources.changes |= Changes::RESPONSES;
    }
}
