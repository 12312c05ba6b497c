use crate::document::{self, Scene};
use crate::extract::{Rules, SceneOptics, Setting};
use crate::products::{BandSources, Context};
use crate::spectral::BandWindow;

/// Data of a scene that products are made with.
pub(super) fn context(scene: &Scene, optics: &SceneOptics) -> Context {
    Context {
        scenes: 1,
        bands: scene.bands.iter().map(|band| band.name.clone()).collect(),
        irradiance: optics.irradiance(),
        has_sky: optics.has_sky(),
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
        is_periodic: scene.boundary == document::Boundary::Periodic,
        rules: Rules {
            seed: transport.seed,
            roulette_after: transport.roulette.after_order,
            roulette_kill: transport.roulette.kill,
            max_order: transport.most_orders(),
        },
    }
}
