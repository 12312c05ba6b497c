use super::{Counter, Event};
use crate::components::Layers;
use crate::extract::Stage;
use crate::film::Sums;
use crate::transport::ReferencePlane;

/// Absorbed power by horizontal layer and surface, and what reaches the ground, in the column below
/// the reference plane.
///
/// Cells: `[layers, surfaces]` with the lowest layer first; then the total of each surface; then
/// that of all but the ground; then the power that arrives at the ground, as [`GROUND_TERMS`].
#[derive(Clone, Debug)]
pub struct LayerCounter {
    /// Heights of the layers' borders, m, upwards.
    pub borders: Vec<f64>,
    /// Thickness of layers that are all alike, m: they hold whatever lies below or above them too.
    even: Option<f64>,
    /// Number of surfaces.
    pub surfaces: usize,
    /// What it counts lies below this.
    pub plane: ReferencePlane,
}

/// Transmission to the ground: all; without any scattering; after scattering by the canopy alone;
/// after the ground has scattered it before. The last three sum to the first.
pub const GROUND_TERMS: [&str; 4] = ["total", "uncollided", "collided", "bounces"];

impl LayerCounter {
    /// Layers of one thickness from the ground to the top of the scene, whatever lies below the
    /// ground counting in the lowest; or between given heights, m, and nothing beyond them.
    #[must_use]
    pub fn of(stage: &Stage, layers: &Layers, plane: ReferencePlane) -> Self {
        let surfaces = stage.surfaces.len();
        match layers {
            Layers::Thickness(thickness) => {
                let height = stage.top() - stage.ground;
                let count = (height / thickness).ceil().max(1.0) as usize;
                let border = |layer: usize| stage.ground + layer as f64 * thickness;
                let borders = (0..=count).map(border).collect();
                Self { borders, even: Some(*thickness), surfaces, plane }
            }
            Layers::Borders(borders) => {
                Self { borders: borders.clone(), even: None, surfaces, plane }
            }
        }
    }

    /// Number of layers.
    #[must_use]
    pub const fn layers(&self) -> usize {
        self.borders.len() - 1
    }

    /// First cell of the totals of the surfaces.
    #[must_use]
    pub const fn totals(&self) -> usize {
        self.layers() * self.surfaces
    }

    /// Cell of what all but the ground absorbs; those of the ground's terms follow.
    #[must_use]
    pub const fn vegetation(&self) -> usize {
        self.totals() + self.surfaces
    }

    fn layer(&self, height: f64) -> Option<usize> {
        if let Some(thickness) = self.even {
            let layer = ((height - self.borders[0]) / thickness) as usize;
            return Some(layer.min(self.layers() - 1));
        }
        let above = self.borders.partition_point(|border| *border <= height);
        (1..self.borders.len()).contains(&above).then(|| above - 1)
    }
}

impl Counter for LayerCounter {
    fn cells(&self) -> usize {
        self.vegetation() + 1 + GROUND_TERMS.len()
    }

    fn count(&self, stage: &Stage, event: &Event<'_>, sums: &mut Sums) -> u64 {
        let Event::Arrival { hit, wo, order, met_ground, weight, scattered, .. } = event else {
            return 0;
        };
        if !self.plane.is_above(hit.point) {
            return 0;
        }
        let surface = hit.surface as usize;
        let is_ground = stage.is_ground(hit);
        let layer = self.layer(hit.point.z).map(|layer| layer * self.surfaces + surface);
        let canopy = (!is_ground).then(|| self.vegetation());
        for cell in [layer, Some(self.totals() + surface), canopy].into_iter().flatten() {
            sums.add_with(cell, |lane| {
                f64::from(weight[lane]) - f64::from(weight[lane] * scattered[lane])
            });
        }
        if is_ground && hit.normal.dot(*wo) > 0.0 {
            let term = match (order, met_ground) {
                (0, _) => 1,
                (_, false) => 2,
                (_, true) => 3,
            };
            for term in [0, term] {
                sums.add(self.vegetation() + 1 + term, weight, 1.0);
            }
        }
        0
    }
}
