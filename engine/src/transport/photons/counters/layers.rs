use super::{Counter, Event, Recorder, WeightFactor};
use crate::components::Layers;
use crate::extract::Stage;
use crate::transport::ReferencePlane;

/// Absorbed power by horizontal layer and surface, and power that reaches the ground, in the column below
/// the reference plane.
///
/// Cells: `[layers, surfaces]` with the lowest layer first; then the total of each surface; then
/// that of all but the ground; then the power that arrives at the ground, as [`GROUND_TERMS`].
#[derive(Clone, Debug)]
pub struct LayerCounter {
    layers: Borders,
    /// Number of surfaces.
    pub surfaces: usize,
    /// Plane below which absorption counts.
    pub plane: ReferencePlane,
}

/// Heights of the borders of layers, m.
#[derive(Clone, Debug)]
enum Borders {
    /// Layers of one thickness above a height; the outer ones hold whatever lies below or above them too.
    Even { lowest: f64, thickness: f64, count: usize },
    /// Given borders, upwards.
    Given(Vec<f64>),
}

/// Maximum number of layers: more than any memory holds, and few enough to compute with.
const MAX_LAYERS: f64 = 1e12;

/// Transmission to the ground: all; without any scattering; after scattering by the canopy alone;
/// after the ground has scattered it before. The last three sum to the first.
pub const GROUND_TERMS: [&str; 4] = ["total", "uncollided", "collided", "bounces"];

impl LayerCounter {
    /// Layers of one thickness from the ground to the top of the scene, of which the lowest holds whatever lies
    /// below the ground; or layers between given heights, m, and nothing beyond them.
    #[must_use]
    pub fn new(stage: &Stage, layers: &Layers, plane: ReferencePlane) -> Self {
        let surfaces = stage.models.surface_count();
        let layers = match layers {
            Layers::Thickness(thickness) => {
                let height = stage.top() - stage.ground;
                let count = (height / thickness).ceil().clamp(1.0, MAX_LAYERS) as usize;
                Borders::Even { lowest: stage.ground, thickness: *thickness, count }
            }
            Layers::Borders(borders) => Borders::Given(borders.clone()),
        };
        Self { layers, surfaces, plane }
    }

    /// Heights of the layers' borders, m, upwards.
    #[must_use]
    pub fn borders(&self) -> Vec<f64> {
        match &self.layers {
            Borders::Even { lowest, thickness, count } => {
                (0..=*count).map(|layer| lowest + layer as f64 * thickness).collect()
            }
            Borders::Given(borders) => borders.clone(),
        }
    }

    /// Number of layers.
    #[must_use]
    pub const fn layers(&self) -> usize {
        match &self.layers {
            Borders::Even { count, .. } => *count,
            Borders::Given(borders) => borders.len() - 1,
        }
    }

    /// First cell of the totals of the surfaces.
    #[must_use]
    pub const fn totals(&self) -> usize {
        self.layers() * self.surfaces
    }

    /// Cell of the power that all surfaces but the ground absorb; cells of the ground's terms follow.
    #[must_use]
    pub const fn vegetation(&self) -> usize {
        self.totals() + self.surfaces
    }

    fn layer(&self, height: f64) -> Option<usize> {
        match &self.layers {
            Borders::Even { lowest, thickness, count } => {
                Some((((height - lowest) / thickness) as usize).min(count - 1))
            }
            Borders::Given(borders) => {
                let above = borders.partition_point(|border| *border <= height);
                (1..borders.len()).contains(&above).then(|| above - 1)
            }
        }
    }
}

impl Counter for LayerCounter {
    fn cells(&self) -> usize {
        self.vegetation() + 1 + GROUND_TERMS.len()
    }

    fn count(&self, stage: &Stage, event: &Event<'_>, recorder: &mut Recorder<'_>) {
        let Event::Arrival { hit, surface, visited, scattered, .. } = event else {
            return;
        };
        if !self.plane.is_above(hit.point) {
            return;
        }
        let material = hit.surface as usize;
        let is_ground = stage.is_ground(hit);
        let layer = self.layer(hit.point.z).map(|layer| layer * self.surfaces + material);
        let canopy = (!is_ground).then(|| self.vegetation());
        for cell in [layer, Some(self.totals() + material), canopy].into_iter().flatten() {
            recorder.add(cell, WeightFactor::Complement(*scattered), 1.0);
        }
        if is_ground && hit.normal.dot(surface.wo()) > 0.0 {
            let term = match (visited.order, visited.has_met_ground) {
                (0, _) => 1,
                (_, false) => 2,
                (_, true) => 3,
            };
            for term in [0, term] {
                recorder.add(self.vegetation() + 1 + term, WeightFactor::One, 1.0);
            }
        }
    }
}
