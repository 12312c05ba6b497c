use crate::document::{self, Scene};
use crate::extract::{Rules, SceneOptics, Setting};
use crate::products::{BandSources, Context};
use crate::spectral::BandResponse;

/// Data of a scene that products are made with.
pub(super) fn context(scene: &Scene, responses: &[BandResponse], optics: &SceneOptics) -> Context {
    Context {
        scenes: 1,
        bands: scene.bands.iter().map(|band| band.name.clone()).collect(),
        irradiance: optics.irradiance(),
        has_sky: optics.has_sky(),
        origin: (scene.frame.origin_m.0, scene.frame.origin_m.1),
        formats: scene.output.clone(),
        sources: scene.bands.iter().zip(responses).map(sources).collect(),
    }
}

/// Wavelengths of a band, and sources of its radiance.
fn sources((band, response): (&document::Band, &BandResponse)) -> BandSources {
    BandSources {
        center_nm: band.nominal_nm().unwrap_or_else(|| response.center()),
        response: response.clone(),
        emits: band.emits(),
        reflects: band.reflects(),
    }
}

/// Settings of a stage.
pub(super) fn setting(scene: &Scene) -> Setting {
    let transport = &scene.transport;
    Setting {
        is_periodic: scene.boundary == document::Boundary::Periodic,
        rules: Rules {
            seed: transport.seed,
            roulette_after: transport.roulette.after_order,
            roulette_kill: transport.roulette.kill,
            max_order: transport.most_orders(),
        },
    }
}
