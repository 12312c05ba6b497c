//! What is lawful and most likely not meant: trees beside the ground, meshes in centimetres, images
//! that look past the scene.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3, Vec2Swizzles as _, Vec3};

use super::Spawner;
use super::astray::{far_from, is_far};
use super::meshes::Prototype;
use super::plausible::TALLEST;
use crate::components::{Placement, TerrainPatch};
use crate::document::{Cover, Diagnostic, Mesh, Sensor, Terrain};
use crate::geometry::{PixelGrid, place_text};
use crate::terrain::Ground;

/// Ground that lies less below other ground is the same but for rounding, m.
const OVERHANG: f64 = 1e-3;

/// A mesh that a unit below a metre makes smaller than this, m, was most likely in metres.
const SMALLEST: f32 = 0.3;

impl Spawner<'_> {
    /// Refuses instances that stand so far from the ground that other coordinates must be meant, and
    /// warns of those that stand beside the ground of an isolated scene.
    pub(super) fn doubt_places(
        &mut self,
        placements: &[Placement],
        meshes: &BTreeMap<u32, Prototype>,
        ground: &Ground,
    ) {
        if self.refuse_far_places(placements, ground) || self.is_periodic() {
            return;
        }
        let (low, high) = (ground.corner(), ground.corner() + ground.size());
        let mut beside: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (instance, placement) in placements.iter().enumerate() {
            let at = placement.position.truncate();
            if at.cmplt(low).any() || at.cmpgt(high).any() {
                beside.entry(placement.prototype.0).or_default().push(instance);
            }
        }
        for (prototype, strays) in beside {
            let Some(prototype) = meshes.get(&prototype) else { continue };
            let message =
                format!("{} of `{}` stand beside the ground", strays.len(), prototype.name.0);
            let help = self.stray_help(placements, &strays, ground).unwrap_or_default();
            self.problems.push(Diagnostic::warning("instances", message).help(help));
        }
    }

    /// Refuses instances that are far from the ground's rectangle; returns whether there are any.
    fn refuse_far_places(&mut self, placements: &[Placement], ground: &Ground) -> bool {
        let is_far = |placement: &Placement| is_far(placement.position.truncate(), ground);
        let away: Vec<usize> =
            (0..).zip(placements).filter(|(_, p)| is_far(p)).map(|(i, _)| i).collect();
        let Some(&first) = away.first() else { return false };
        let (count, far) = (away.len(), far_from(ground));
        let message = match count {
            1 => format!("an instance stands more than {far:.0} m from the ground"),
            _ => format!("{count} instances stand more than {far:.0} m from the ground"),
        };
        let help = self.stray_help(placements, &away, ground).unwrap_or_default();
        let (path, _) = self.origins.place(self.scene, first);
        self.problems.push(Diagnostic::error(path, message).help(help));
        true
    }

    /// Advice for instances off the ground, by their numbers.
    fn stray_help(
        &self,
        placements: &[Placement],
        strays: &[usize],
        ground: &Ground,
    ) -> Option<String> {
        let first = *strays.first()?;
        let entry = self.entry_of(first)?;
        let is_of_entry =
            |stray: &&usize| self.entry_of(**stray).is_some_and(|other| std::ptr::eq(entry, other));
        let places: Vec<DVec3> =
            strays.iter().filter(is_of_entry).map(|&stray| placements[stray].position).collect();
        let (low, high) = (ground.corner(), ground.corner() + ground.size());
        let advice = self.other_coordinates(entry, &places, ground);
        let advice = advice.unwrap_or_else(|| "make it larger, or move them".to_owned());
        Some(format!(
            "one stands at {}, and the ground reaches from {} to {} m: {advice}",
            place_text(places.first()?.truncate()),
            place_text(low),
            place_text(high)
        ))
    }

    /// Warns of a mesh as ground of which triangles lie under others.
    pub(super) fn doubt_overhangs(&mut self, patch: &TerrainPatch, ground: &Ground) {
        let Terrain::Mesh { mesh, .. } = &self.scene.terrain else { return };
        let mut under = (0..patch.first_cut as usize).filter_map(|index| {
            let [a, b, c] = patch.mesh.corners(index).map(Vec3::as_dvec3);
            let middle = patch.origin() + (a + b + c) / 3.0 * patch.size.extend(patch.unit);
            let is_wall = (b - a).truncate().perp_dot((c - a).truncate()) == 0.0;
            let above = ground.height(middle.truncate())? - middle.z;
            (!is_wall && above > OVERHANG.max(1e-5 * patch.unit)).then_some(middle)
        });
        let Some(first) = under.next() else { return };
        let message = format!("{} triangles of `{mesh}` lie under others", 1 + under.count());
        let help = format!(
            "one lies at ({:.2}, {:.2}, {:.2}): what is placed there stands on the highest; of \
             overhangs that are not meant, or of closed bodies, keep the upper side alone",
            first.x, first.y, first.z
        );
        self.problems.push(Diagnostic::warning("terrain.mesh", message).help(help));
    }

    /// Warns of meshes from files that are larger than any plant.
    pub(super) fn doubt_sizes(&mut self, meshes: &BTreeMap<u32, Prototype>) {
        for prototype in meshes.values() {
            let name = &prototype.name.0;
            let unit = match self.scene.meshes.get(name.as_str()) {
                Some(Mesh::Obj { unit_m, .. }) => *unit_m,
                Some(Mesh::Gltf { .. } | Mesh::Discs { .. }) => 1.0,
                _ => continue,
            };
            let Some((low, high)) = prototype.mesh.bounds() else { continue };
            let size = (high - low).max_element();
            if unit < 1.0 && size < SMALLEST {
                let message = format!("`{name}` is {size:.3} m large, with a unit of {unit} m");
                let help = "if the coordinates of its file are in metres, leave `unit_m` out";
                let path = format!("meshes.{name}");
                self.problems.push(Diagnostic::warning(path, message).help(help));
            }
            if f64::from(size) > TALLEST {
                let message = format!("`{name}` is {size:.0} m large");
                let help = "if its file is in centimetres, write `unit_m: 0.01`; in millimetres, \
                            `unit_m: 0.001`";
                let path = format!("meshes.{name}");
                self.problems.push(Diagnostic::warning(path, message).help(help));
            }
        }
    }

    /// Warns of images whose middle lies beside the ground of an isolated scene, and of nadir images
    /// that reach beyond it.
    pub(super) fn doubt_images(&mut self) {
        if self.is_periodic() {
            return;
        }
        let (corner, size) = self.rectangle;
        let (low, high) = (corner, corner + size);
        for (name, sensor) in &self.scene.sensors {
            let Sensor::Orthographic {
                pixel_m,
                extent_m: Some(extent),
                cover: None::<Cover>,
                center_m,
                zenith_deg,
                azimuth_deg,
                ..
            } = sensor
            else {
                continue;
            };
            let center = center_m.map_or(corner + 0.5 * size, DVec2::from);
            let path = format!("sensors.{name}.extent_m");
            let ground =
                format!("the ground reaches from {} to {} m", place_text(low), place_text(high));
            if center.cmplt(low).any() || center.cmpgt(high).any() {
                let message = "the middle of the image lies beside the ground";
                let warning = Diagnostic::warning(path, message).help(ground);
                self.problems.push(warning);
                continue;
            }
            // Turned by anything else, or seen aslant, the image is no rectangle along the axes.
            let quarters = azimuth_deg / 90.0;
            if *zenith_deg != 0.0 || quarters.fract() != 0.0 {
                continue;
            }
            let extent = DVec2::from(*extent);
            let shown = pixel_m.map_or(extent, |side| PixelGrid::covering(extent, side).extent);
            let mut half = 0.5 * shown;
            if quarters % 2.0 != 0.0 {
                half = half.yx();
            }
            let seen = ((center + half).min(high) - (center - half).max(low)).max(DVec2::ZERO);
            let beyond = 1.0 - (seen / (2.0 * half)).element_product();
            // Not the rounding of the extent.
            if beyond > 1e-9 {
                let share = 100.0 * beyond;
                let message = format!("{share:.1} % of the image lies beside the ground");
                let help = format!("{ground}; what lies beside it holds no data");
                self.problems.push(Diagnostic::warning(path, message).help(help));
            }
        }
    }
}
