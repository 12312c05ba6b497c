use super::{Counter, Event};
use crate::extract::Stage;
use crate::film::Sums;

/// Absorbed power by horizontal layer and surface; cells `[layers, surfaces]`, lowest layer first.
#[derive(Clone, Copy, Debug)]
pub struct LayerCounter {
    /// Height of the lowest layer's bottom, m.
    pub bottom: f64,
    /// Thickness of a layer, m.
    pub thickness: f64,
    /// Number of layers.
    pub layers: usize,
    /// Number of surfaces.
    pub surfaces: usize,
}

impl LayerCounter {
    /// Layers of this thickness from the ground to the top of the scene; whatever lies below the
    /// ground counts in the lowest.
    #[must_use]
    pub fn of(stage: &Stage, thickness: f64) -> Self {
        let height = stage.top() - stage.ground;
        let layers = (height / thickness).ceil().max(1.0) as usize;
        Self { bottom: stage.ground, thickness, layers, surfaces: stage.surfaces.len() }
    }
}

impl Counter for LayerCounter {
    fn cells(&self) -> usize {
        self.layers * self.surfaces
    }

    fn count(&self, stage: &Stage, event: &Event<'_>, sums: &mut Sums) -> u64 {
        if let Event::Arrival { hit, wo, weight, .. } = event {
            let layer = ((hit.point.z - self.bottom) / self.thickness) as usize;
            let cell = layer.min(self.layers - 1) * self.surfaces + hit.surface as usize;
            let scattered = stage.surface(hit).bsdf.scattered(hit.normal, *wo);
            sums.add_with(cell, |lane| {
                f64::from(weight[lane]) - f64::from(weight[lane] * scattered[lane])
            });
        }
        0
    }
}
