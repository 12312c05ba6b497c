//! Contributions of the packets of one sample, recorded while their rays are traced with those of other samples.

use super::tally::{Tally, WeightFactor};
use crate::accel::Ray;
use crate::scattering::Lobe;
use crate::transport::ray_queue::RayQueue;

/// Weights and contributions of the packets of one sample, in order. The record is replayed into the [`Tally`] when
/// all samples before it are: so sums do not depend on which packets are traced together.
#[derive(Clone, Debug, Default)]
pub(super) struct PacketRecord {
    entries: Vec<RecordEntry>,
    /// Results of the shadow rays, in the order in which they were queued; those of the last round are pending.
    occluded: Vec<bool>,
    /// Number of shadow rays that were queued.
    shadow_rays: u32,
}

#[derive(Clone, Copy, Debug)]
enum RecordEntry {
    /// A packet starts with a weight of 1.
    Start,
    /// The weight is multiplied by a lobe.
    Scatter(Lobe),
    Contribution(Contribution),
    /// A packet ends.
    End,
    /// A photon of this band ends.
    EndPhoton(usize),
}

/// Fraction of the packet's weight that is added to a cell, unless a shadow ray is occluded.
#[derive(Clone, Copy, Debug)]
struct Contribution {
    factor: WeightFactor,
    scale: f64,
    cell: usize,
    sums: u32,
    shadow_ray: Option<ShadowRay>,
}

/// Number of a shadow ray among those of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ShadowRay(u32);

impl PacketRecord {
    /// Removes all entries.
    pub(super) fn clear(&mut self) {
        self.entries.clear();
        self.occluded.clear();
        self.shadow_rays = 0;
    }

    /// Starts a packet with a weight of 1 in every band.
    pub(super) fn start(&mut self) {
        self.entries.push(RecordEntry::Start);
    }

    /// Multiplies the packet's weight by a lobe.
    pub(super) fn scatter(&mut self, lobe: Lobe) {
        self.entries.push(RecordEntry::Scatter(lobe));
    }

    /// Ends a packet or a photon of one band.
    pub(super) fn end(&mut self, photon_band: Option<usize>) {
        self.entries.push(photon_band.map_or(RecordEntry::End, RecordEntry::EndPhoton));
    }

    /// Takes the results of the shadow rays of a round.
    pub(super) fn take_results(&mut self, occluded: &[bool]) {
        self.occluded.extend_from_slice(occluded);
    }

    /// Queues a shadow ray.
    pub(super) fn push_shadow(&mut self, ray: Ray, queue: &mut RayQueue) -> ShadowRay {
        queue.push_shadow(ray);
        self.shadow_rays += 1;
        ShadowRay(self.shadow_rays - 1)
    }

    /// Returns whether a shadow ray of an earlier round is occluded.
    pub(super) fn is_occluded(&self, ShadowRay(number): ShadowRay) -> bool {
        self.occluded[number as usize]
    }

    /// Adds all contributions to a tally of stages with this number of bands.
    pub(super) fn replay(&self, tally: &mut Tally<'_>, bands: usize) {
        for entry in &self.entries {
            match *entry {
                RecordEntry::Start => tally.start(),
                RecordEntry::Scatter(lobe) => tally.scatter(lobe),
                RecordEntry::Contribution(contribution) => {
                    let Contribution { factor, scale, cell, sums, shadow_ray } = contribution;
                    if !shadow_ray.is_some_and(|ray| self.is_occluded(ray)) {
                        tally.add(sums as usize, cell, factor, scale);
                    }
                }
                RecordEntry::End => tally.make_room(0..bands),
                RecordEntry::EndPhoton(band) => tally.flush(band..band + 1),
            }
        }
    }
}

/// Recorder of what a counter adds to its sums for an event.
#[derive(Debug)]
pub struct Recorder<'r> {
    record: &'r mut PacketRecord,
    queue: &'r mut RayQueue,
    /// Index of the counter's sums.
    sums: u32,
}

impl<'r> Recorder<'r> {
    /// A recorder for the counter of these sums.
    pub(super) fn new(record: &'r mut PacketRecord, queue: &'r mut RayQueue, sums: usize) -> Self {
        Self { record, queue, sums: sums as u32 }
    }

    /// Adds a fraction of the packet's weight, times a scale, to a cell.
    pub(super) fn add(&mut self, cell: usize, factor: WeightFactor, scale: f64) {
        self.push(None, cell, factor, scale);
    }

    /// Queues a shadow ray.
    pub(super) fn push_shadow(&mut self, ray: Ray) -> ShadowRay {
        self.record.push_shadow(ray, self.queue)
    }

    /// Adds a fraction of the packet's weight, times a scale, to a cell, unless a shadow ray is occluded.
    pub(super) fn add_unless_occluded(
        &mut self,
        shadow_ray: ShadowRay,
        cell: usize,
        factor: WeightFactor,
        scale: f64,
    ) {
        self.push(Some(shadow_ray), cell, factor, scale);
    }

    fn push(
        &mut self,
        shadow_ray: Option<ShadowRay>,
        cell: usize,
        factor: WeightFactor,
        scale: f64,
    ) {
        let contribution = Contribution { factor, scale, cell, sums: self.sums, shadow_ray };
        self.record.entries.push(RecordEntry::Contribution(contribution));
    }
}
