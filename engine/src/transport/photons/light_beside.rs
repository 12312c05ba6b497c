use std::ops::Range;

use glam::DVec3;

use super::counters::{Counter, Event, Visited};
use super::packet_film::{PacketOptions, photon_film};
use super::record::Recorder;
use super::tally::WeightFactor;
use crate::extract::Stage;
use crate::sampling::Key;
use crate::transport::{LightSource, PhotonKind, ReferencePlane, RouletteThreshold};

/// Fractions of an isolated scene's light on lines beside its reference plane, by band.
///
/// Such light makes values per area of the plane surprising: a tree over the edge of the ground, or high above
/// it under a low sun, is lit and visible on lines that do not pass through the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct LightBeside {
    /// Fraction of the light of sun and sky that the scene intercepts, shape `[bands]`; 0 in a band without light.
    pub incoming: Vec<f64>,
    /// Fraction of the scattered light that leaves upwards, shape `[bands]`: no BRF or albedo holds it.
    pub outgoing: Vec<f64>,
}

/// Packets of each randomisation. The fractions decide a warning and no result.
const PILOT: u64 = 64;

impl LightBeside {
    /// Estimate from a pilot run of each sun, or of the sky alone; `None` for a periodic scene, which has no sides, and
    /// without light.
    #[must_use]
    pub fn from_pilot_run(stage: &Stage) -> Option<Self> {
        let is_lit = !stage.light.beams.is_empty() || stage.light.dome.is_some();
        if stage.periodic || !is_lit {
            return None;
        }
        // The sky lights bands without a sun too.
        let bands = |beam: usize| match &stage.light.beams[..] {
            [] | [_] => 0..stage.bands,
            beams => beams[beam].bands.clone(),
        };
        let mut all = Self { incoming: vec![0.0; stage.bands], outgoing: vec![0.0; stage.bands] };
        for beam in 0..stage.light.beams.len().max(1) {
            all.add_beam(stage, beam, &bands(beam));
        }
        Some(all)
    }

    /// Estimates the fractions in the bands of one of the beams.
    fn add_beam(&mut self, stage: &Stage, beam: usize, bands: &Range<usize>) {
        let plane = ReferencePlane::new(None, stage);
        let counter: Box<dyn Counter> = Box::new(BesideCounter { plane: plane.clone() });
        let kind = PhotonKind::Packet(RouletteThreshold::Low);
        let options = PacketOptions { source: LightSource::Reflected, beam, kind, plane };
        let mut film =
            photon_film(stage, options, [counter], Key::new(stage.rules.seed).path("beside"));
        film.trace_in_memory(PILOT, &|_| {});
        let spread = film.spread(1);
        let cell = |cell: usize| {
            &spread.mean()[cell * stage.bands..(cell + 1) * stage.bands][bands.clone()]
        };
        let fractions = |part: usize, whole: usize| {
            let fractions = cell(part).iter().zip(cell(whole)).map(|(part, whole)| part / whole);
            fractions.map(|fraction| if fraction.is_finite() { fraction } else { 0.0 })
        };
        let incoming = fractions(BesideCounter::INCOMING_BESIDE, BesideCounter::INCOMING);
        let outgoing = fractions(BesideCounter::OUTGOING_BESIDE, BesideCounter::OUTGOING);
        for ((band, incoming), outgoing) in bands.clone().zip(incoming).zip(outgoing) {
            (self.incoming[band], self.outgoing[band]) = (incoming, outgoing);
        }
    }
}

/// Power that arrives from outside and that leaves upwards, each in all and on lines beside a plane.
struct BesideCounter {
    plane: ReferencePlane,
}

impl BesideCounter {
    const INCOMING: usize = 0;
    const INCOMING_BESIDE: usize = 1;
    const OUTGOING: usize = 2;
    const OUTGOING_BESIDE: usize = 3;
    const CELLS: usize = 4;

    /// Returns whether a line through `point` passes beside the plane; `up` is its direction upwards.
    fn is_beside(&self, point: DVec3, up: DVec3) -> bool {
        !self.plane.is_left_by(point, up)
    }
}

impl Counter for BesideCounter {
    fn cells(&self) -> usize {
        Self::CELLS
    }

    fn count(&self, _: &Stage, event: &Event<'_>, recorder: &mut Recorder<'_>) {
        let (cells, is_beside) = match event {
            Event::Arrival { hit, surface, visited: Visited { order: 0, .. }, .. } => {
                ([Self::INCOMING, Self::INCOMING_BESIDE], self.is_beside(hit.point, surface.wo()))
            }
            Event::Escape { ray, visited: Visited { order: 1.., .. } } if ray.direction.z > 0.0 => {
                ([Self::OUTGOING, Self::OUTGOING_BESIDE], self.is_beside(ray.origin, ray.direction))
            }
            _ => return,
        };
        let [all, beside] = cells;
        recorder.add(all, WeightFactor::One, 1.0);
        if is_beside {
            recorder.add(beside, WeightFactor::One, 1.0);
        }
    }
}
