use super::packet::{Packet, SurfaceEmission};
use super::source::PacketSource;
use crate::extract::{Stage, Thermal};
use crate::sampling::Sampler;
use crate::scattering::Lobe;

/// Photon packets that surfaces and the sky emit, in absolute units.
///
/// Lines of uniform measure cross the scene from above, each with the étendue
/// `π A g / N`, where `g` is the power of a sky through all faces of the scene over that through its
/// rectangle `A`. Along a line the sky sends its radiance down; at every point where the line
/// crosses a surface, either side sends `(1 - ρ - τ) B(T)` away from it along the line. A line of
/// uniform measure meets an element of area in proportion to its cosine: so the density of points
/// of emission is even over area, directions follow Lambert's law, and no surface's area need be known.
///
/// Weights are radiance times `π g`: their sum over the number of lines is a flux density over the
/// rectangle, W m⁻² nm⁻¹.
///
/// Source: Santaló (1976), "Integral geometry and geometric probability": the measure of lines through
/// an element of area.
#[derive(Clone, Debug)]
pub(super) struct ThermalEmission<'a> {
    stage: &'a Stage,
    thermal: &'a Thermal,
    source: &'a PacketSource,
    /// Flux density of a radiance of 1.
    scale: f32,
}

impl<'a> ThermalEmission<'a> {
    /// Emission of a stage; `None` where nothing emits.
    pub(super) fn new(stage: &'a Stage, source: &'a PacketSource) -> Option<Self> {
        let thermal = stage.thermal.as_ref()?;
        Some(Self { stage, thermal, source, scale: source.sky_etendue() as f32 })
    }

    /// Weight of a packet from the warmest black body, in the band of its largest radiance.
    pub(super) fn largest_weight(&self) -> f32 {
        let surfaces = self.thermal.surfaces.iter().flat_map(|body| [body.sunlit, body.shaded]);
        let spectra = &self.stage.models.spectra;
        let largest = surfaces.chain([self.thermal.sky]).map(|radiance| spectra.largest(radiance));
        largest.fold(f32::MIN_POSITIVE, f32::max) * self.scale
    }

    /// Traces all packets that start along one line.
    pub(super) fn trace(&self, packet: &mut Packet<'a>, sampler: &mut Sampler) {
        let stage = self.stage;
        let mut line = self.source.start_anywhere(sampler);
        let (bands, sky) = (Lobe::from(self.thermal.bands), Lobe::from(self.thermal.sky));
        packet.trace_from_outside(line, &[bands, sky.scaled(self.scale)], sampler);
        loop {
            packet.rays += 1;
            let Some(hit) = stage.geometry.closest(&line) else { return };
            if stage.is_cut(&hit) {
                // The line crosses more of the ground beyond it.
                line = hit.leave(line.direction);
                continue;
            }
            let (black_body, rays) = self.thermal.black_body(stage, &hit, sampler);
            packet.rays += rays;
            for direction in [-line.direction, line.direction] {
                // Nothing is below the ground.
                let is_above = (hit.normal.dot(direction) >= 0.0) == (hit.normal.z >= 0.0);
                if stage.is_ground(&hit) && !is_above {
                    continue;
                }
                let emission = SurfaceEmission {
                    hit: &hit,
                    ray: hit.leave(direction),
                    emitted: stage.interaction(&hit, direction).absorbed_fraction(),
                    scale: self.scale,
                };
                packet.trace_from_surface(&emission, [bands, black_body.into()], sampler);
            }
            line = hit.leave(line.direction);
        }
    }
}
