use super::emission::Emission;
use super::forward::Packet;
use crate::extract::{Stage, Thermal};
use crate::sampling::Sampler;

/// Photon packets that surfaces and the sky emit, in absolute units.
///
/// Lines of uniform measure cross the scene from above, each standing for the étendue
/// `π A g / N`, with `g` the power of a sky through all faces of the scene over that through its
/// rectangle `A`. Along a line the sky sends its radiance down; at every point where the line
/// crosses a surface, either side sends `(1 - ρ - τ) B(T)` away from it along the line. A line of
/// uniform measure meets an element of area in proportion to the cosine at which it does: so points
/// are emitted from in proportion to their area, in directions after Lambert's law, and no surface's
/// area need be known.
///
/// Weights are radiance times `π g`: their sum over the number of lines is a flux density over the
/// rectangle, W m⁻² nm⁻¹.
///
/// Source: Santaló (1976), "Integral geometry and geometric probability": the measure of lines through
/// an element of area.
#[derive(Clone, Debug)]
pub(super) struct Glow<'a> {
    thermal: &'a Thermal,
    emission: &'a Emission,
    /// Flux density of a radiance of 1.
    scale: f32,
}

impl<'a> Glow<'a> {
    /// Of a stage; `None` where nothing emits.
    pub(super) fn of(stage: &'a Stage, emission: &'a Emission) -> Option<Self> {
        let thermal = stage.thermal.as_ref()?;
        Some(Self { thermal, emission, scale: emission.sky_etendue() as f32 })
    }

    /// Weight of a packet from the warmest black body, in the band where it radiates most.
    pub(super) fn full_weight(&self) -> f32 {
        let surfaces =
            self.thermal.surfaces.iter().flat_map(|warmth| [&warmth.sunlit, &warmth.shaded]);
        let radiance = surfaces.chain([&self.thermal.sky]).flat_map(|radiance| radiance.iter());
        radiance.copied().fold(f32::MIN_POSITIVE, f32::max) * self.scale
    }

    /// Follows all packets that start along one line.
    pub(super) fn trace(&self, packet: &mut Packet<'a>, sampler: &mut Sampler) {
        let stage = packet.stage;
        let mut line = self.emission.start_anywhere(sampler);
        let (bands, sky) = (&self.thermal.bands, &self.thermal.sky);
        packet.arrive(line, &[(bands, 1.0), (sky, self.scale)], sampler);
        loop {
            packet.rays += 1;
            let Some(hit) = stage.geometry.closest(&line) else { return };
            if stage.is_cut(&hit) {
                // The line crosses more of the ground beyond it.
                line = hit.leave(line.direction);
                continue;
            }
            let (black, rays) = self.thermal.black_body(stage, &hit, sampler);
            packet.rays += rays;
            let bsdf = &stage.surface(&hit).bsdf;
            for direction in [-line.direction, line.direction] {
                // Nothing is below the ground.
                let is_above = (hit.normal.dot(direction) >= 0.0) == (hit.normal.z >= 0.0);
                if stage.is_ground(&hit) && !is_above {
                    continue;
                }
                let emitted = bsdf.absorbed(hit.normal, direction);
                let weight = [(bands, 1.0), (black, 1.0), (emitted, self.scale)];
                packet.emerge(&hit, hit.leave(direction), &weight, sampler);
            }
            line = hit.leave(line.direction);
        }
    }
}
