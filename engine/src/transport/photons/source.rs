use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use crate::accel::Ray;
use crate::extract::{Stage, SunDisc};
use crate::sampling::{Sampler, cosine_hemisphere};
use crate::scattering::{Lobe, SpectrumId};

/// Source of photon packets of sun and sky, which light every point of the scene as in the open.
///
/// Periodic scenes are lit through their top plane. An isolated scene is lit through the faces of
/// its bounding box: exactly its silhouette towards the sun, its flanks included.
#[derive(Clone, Debug)]
pub(super) struct PacketSource {
    faces: Vec<Face>,
    /// Power through all faces over that through the reference plane, per source.
    sun_gain: f64,
    sky_gain: f64,
    /// Probability that a packet is the sun's.
    sun_chance: f64,
    /// Weight of a packet over its gain and probability.
    sun_share: SpectrumId,
    sky_share: SpectrumId,
    sun: DVec3,
    disc: Option<SunDisc>,
    /// Area of the scene's rectangle, m².
    area: f64,
    /// Distance before its face at which a ray starts, m.
    back_off: f64,
}

/// A face of the box.
#[derive(Clone, Copy, Debug)]
struct Face {
    corner: DVec3,
    u: DVec3,
    v: DVec3,
    /// Unit normal into the box.
    inward: DVec3,
    /// Sum of probabilities up to and including this face.
    sun_until: f64,
    sky_until: f64,
}

impl PacketSource {
    /// Light of one of the beams of a stage, if it has any, and of the sky.
    #[must_use]
    pub(super) fn new(stage: &Stage, beam: usize) -> Self {
        let beam = stage.light.beams.get(beam);
        let (low, high) = lit_box(stage);
        let size = high - low;
        let (x, y, z) = (DVec3::X * size.x, DVec3::Y * size.y, DVec3::Z * size.z);
        let top = Face {
            corner: DVec3::new(low.x, low.y, high.z),
            u: x,
            v: y,
            inward: -DVec3::Z,
            sun_until: 0.0,
            sky_until: 0.0,
        };
        let mut faces = vec![top];
        if !stage.periodic {
            let side = |corner, along, inward| Face { corner, u: along, v: z, inward, ..top };
            faces.push(side(low, y, DVec3::X));
            faces.push(side(low + x, y, -DVec3::X));
            faces.push(side(low, x, DVec3::Y));
            faces.push(side(low + y, x, -DVec3::Y));
        }
        let sun = beam.map_or(DVec3::Z, |beam| beam.direction);
        let (mut sun_power, mut sky_power) = (0.0, 0.0);
        for face in &mut faces {
            let area = face.u.cross(face.v).length();
            sun_power += area * (-sun).dot(face.inward).max(0.0);
            // A vertical face sees half of the sky.
            sky_power += area * if face.inward.z < 0.0 { 1.0 } else { 0.5 };
            (face.sun_until, face.sky_until) = (sun_power, sky_power);
        }
        for face in &mut faces {
            face.sun_until /= sun_power;
            face.sky_until /= sky_power;
        }
        let sun_share = beam.map_or(SpectrumId::ZERO, |beam| beam.share);
        let sky_share = stage.light.dome.as_ref().map_or(SpectrumId::ZERO, |dome| dome.share);
        let sun_gain = sun_power / (stage.area() * sun.z);
        let sky_gain = sky_power / stage.area();
        // Packets go where the power is, summed over the bands.
        let power = |share: SpectrumId, gain| {
            f64::from(stage.models.spectra.lanes(share).iter().sum::<f32>()) * gain
        };
        let (from_sun, from_sky) = (power(sun_share, sun_gain), power(sky_share, sky_gain));
        // Where neither shines, packets of weight 0 come from the sun.
        let all = from_sun + from_sky;
        let sun_chance = if all > 0.0 { from_sun / all } else { 1.0 };
        Self {
            faces,
            sun_gain,
            sky_gain,
            sun_chance,
            sun_share,
            sky_share,
            sun,
            disc: beam.and_then(|beam| beam.disc),
            area: stage.area(),
            back_off: 0.01 * size.max_element(),
        }
    }

    /// Starts a packet: its ray, and its weight in units of the power that falls on the scene's rectangle over
    /// the number of packets.
    pub(super) fn start(&self, sampler: &mut Sampler) -> (Ray, Lobe) {
        let [pick, u, v, _] = sampler.next_4d();
        let (direction, face, share, factor);
        if pick < self.sun_chance {
            let pick = pick / self.sun_chance;
            let (sun, lit, gain) = self.sun(pick, sampler);
            direction = -sun;
            face = lit;
            share = self.sun_share;
            factor = gain / self.sun_chance;
        } else {
            let pick = (pick - self.sun_chance) / (1.0 - self.sun_chance);
            (face, direction) = self.sky(pick, sampler);
            share = self.sky_share;
            factor = self.sky_gain / (1.0 - self.sun_chance);
        }
        let weight = Lobe::from(share).scaled(factor as f32);
        (self.ray(face, direction, DVec2::new(u, v)), weight)
    }

    /// A ray of isotropic sky light: such rays are lines of uniform measure among all that cross the scene.
    pub(super) fn start_anywhere(&self, sampler: &mut Sampler) -> Ray {
        let [pick, u, v, _] = sampler.next_4d();
        let (face, direction) = self.sky(pick, sampler);
        self.ray(face, direction, DVec2::new(u, v))
    }

    /// Flux density over the scene's rectangle through all faces from a sky of radiance 1.
    pub(super) const fn sky_etendue(&self) -> f64 {
        PI * self.sky_gain
    }

    fn ray(&self, face: &Face, direction: DVec3, at: DVec2) -> Ray {
        let origin = face.corner + face.u * at.x + face.v * at.y - direction * self.back_off;
        Ray { origin, direction, from: None }
    }

    /// The face that light of the sky comes through, and its direction.
    fn sky(&self, pick: f64, sampler: &mut Sampler) -> (&Face, DVec3) {
        let face = self.face(pick, |face| face.sky_until);
        let [u, v, ..] = sampler.next_4d();
        (face, face.sky_light(cosine_hemisphere(u, v)))
    }

    /// Direction towards a point of the sun, the face that its light comes through, and the power
    /// through all faces from there over that through the reference plane.
    fn sun(&self, pick: f64, sampler: &mut Sampler) -> (DVec3, &Face, f64) {
        let Some(disc) = &self.disc else {
            return (self.sun, self.face(pick, |face| face.sun_until), self.sun_gain);
        };
        let [u, v, ..] = sampler.next_4d();
        let sun = disc.direction(u, v);
        let power = |face: &Face| face.u.cross(face.v).length() * (-sun).dot(face.inward).max(0.0);
        let total: f64 = self.faces.iter().map(power).sum();
        let mut left = pick * total;
        let lit = self.faces.iter().position(|face| {
            left -= power(face);
            left < 0.0
        });
        // The top is the first face, and no sun is below the horizon.
        (sun, &self.faces[lit.unwrap_or(0)], total / (self.area * sun.z))
    }

    fn face(&self, pick: f64, until: impl Fn(&Face) -> f64) -> &Face {
        let index = self.faces.partition_point(|face| until(face) <= pick);
        &self.faces[index.min(self.faces.len() - 1)]
    }
}

impl Face {
    /// Direction of sky light through this face, from one about z with a cosine density. Light from
    /// below the horizon is mirrored up: the sky is isotropic, so the flux is that of its half.
    fn sky_light(&self, local: DVec3) -> DVec3 {
        let tangent = if self.inward.z < 0.0 { DVec3::X } else { DVec3::Z };
        let bitangent = self.inward.cross(tangent);
        let direction = tangent * local.x + bitangent * local.y + self.inward * local.z;
        // Light comes down; a horizontal ray would never end in a flat scene.
        DVec3::new(direction.x, direction.y, -direction.z.abs().max(f64::MIN_POSITIVE))
    }
}

/// Box of all that light can reach: the scene's rectangle and, of an isolated scene, whatever stands
/// out of it.
fn lit_box(stage: &Stage) -> (DVec3, DVec3) {
    let (low, high) = stage.geometry.bounds();
    let corner = stage.corner.extend(stage.ground);
    let far = (stage.corner + stage.size).extend(stage.ground);
    if stage.periodic {
        (corner, far.truncate().extend(stage.top()))
    } else {
        (low.min(corner), high.max(far))
    }
}
