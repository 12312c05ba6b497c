use crate::document::{self, Scene};
use crate::extract::{Rules, Setting, Stage};
use crate::products::{BandSources, Context};
use crate::spectral::BandWindow;

/// Data of a scene that products are made with.
pub(super) fn context(scene: &Scene, stage: &Stage) -> Context {
    Context {
        bands: scene.bands.iter().map(|band| band.name.clone()).collect(),
        irradiance: stage.light.irradiance.clone(),
        has_sky: stage.light.dome.is_some(),
        origin: (scene.frame.origin_m.0, scene.frame.origin_m.1),
        sources: scene.bands.iter().map(sources).collect(),
    }
}

/// Sources of the radiance in a band.
fn sources(band: &document::Band) -> BandSources {
    let window = BandWindow { center: band.center_nm, width: band.width_nm };
    BandSources { window, emits: band.emits(), reflects: band.reflects() }
}

/// Settings of a stage.
pub(super) fn setting(scene: &Scene) -> Setting {
    let transport = &scene.transport;
    Setting {
        bands: scene.bands.len(),
        is_periodic: scene.boundary == document::Boundary::Periodic,
        rules: Rules {
            seed: transport.seed,
            roulette_after: transport.roulette.after_order,
            roulette_kill: transport.roulette.kill,
            max_order: transport.most_orders(),
        },
    }
}
