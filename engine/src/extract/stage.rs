use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{Inventory, Light, Thermal};
use crate::accel;
use crate::scattering::{Interaction, SurfaceId, SurfaceModels};

/// Flat, immutable scene: everything that transport reads.
#[derive(Debug)]
pub struct Stage {
    /// Number of spectral bands.
    pub bands: usize,
    /// Rules by which paths are traced.
    pub rules: Rules,
    /// South-west corner of the scene's rectangle, m.
    pub corner: DVec2,
    /// Extent of the scene's rectangle to the east and to the north, m.
    pub size: DVec2,
    /// Height of the lowest ground, m.
    pub ground: f64,
    /// Mean height of the ground over the scene's rectangle, m.
    pub mean_ground: f64,
    /// True if the ground leaves out some of the scene's rectangle.
    pub has_holes: bool,
    /// First of the ground's triangles that are no ground but the faces along which an isolated one
    /// is cut out of the earth.
    pub first_cut: u32,
    /// True if the rectangle repeats without end.
    pub periodic: bool,
    /// Models of the surfaces, by the id that hits carry, and all spectra; those of the ground come first.
    pub models: SurfaceModels,
    /// Names of the surfaces' materials, which their absorption is reported under.
    pub surface_names: Vec<String>,
    /// Sun and sky.
    pub light: Light,
    /// Emission of surfaces and the sky, where a sensor measures it.
    pub thermal: Option<Thermal>,
    /// Instances and their faces, where a sensor reports each.
    pub inventory: Option<Arc<Inventory>>,
    /// True if films of packets keep coefficients of products of spectra, however few bands there are.
    pub keeps_coefficients: bool,
    /// Geometry that rays are traced through.
    pub geometry: Arc<accel::TwoLevelBvh>,
}

/// Rules by which paths are traced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// Seed of all random streams.
    pub seed: u64,
    /// Orders of scattering before the constant roulette starts.
    pub roulette_after: u32,
    /// Probability of the constant roulette to end a path, where survivors do not exceed their initial
    /// throughput.
    pub roulette_kill: f64,
    /// Highest order of scattering that counts.
    pub max_order: u32,
}

impl Stage {
    /// Area of the scene's rectangle, m².
    #[must_use]
    pub fn area(&self) -> f64 {
        self.size.x * self.size.y
    }

    /// Height of the highest point of the scene, m.
    #[must_use]
    pub fn top(&self) -> f64 {
        self.geometry.top().max(self.ground)
    }

    /// Returns whether the ground is anything but a level plain.
    #[must_use]
    pub fn has_relief(&self) -> bool {
        self.mean_ground > self.ground
    }

    /// The surface at a hit, seen from the direction `wo`.
    #[must_use]
    pub fn interaction(&self, hit: &accel::Hit, wo: DVec3) -> Interaction<'_> {
        self.models.at(SurfaceId(hit.surface), hit.normal, wo).at_place(hit.point.truncate())
    }

    /// Returns whether a hit lies on the ground: the first instance of every stage.
    #[must_use]
    pub fn is_ground(&self, hit: &accel::Hit) -> bool {
        hit.instance == 0
    }

    /// Returns whether a hit lies on a face along which an isolated ground is cut out of the earth: light ends
    /// there, and nothing is visible.
    #[must_use]
    pub fn is_cut(&self, hit: &accel::Hit) -> bool {
        self.is_ground(hit) && hit.primitive >= self.first_cut
    }

    /// Height of the ground at a horizontal position, m; the lowest one beside the terrain.
    #[must_use]
    pub fn ground_at(&self, at: DVec2) -> f64 {
        let above = at.extend(self.top() + 1.0);
        let mut ray = accel::Ray { origin: above, direction: DVec3::NEG_Z, from: None };
        while let Some(hit) = self.geometry.closest(&ray) {
            if self.is_ground(&hit) && !self.is_cut(&hit) {
                return hit.point.z;
            }
            ray = hit.leave(DVec3::NEG_Z);
        }
        self.ground
    }
}
