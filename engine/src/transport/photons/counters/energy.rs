use super::{Counter, Event, Recorder, WeightFactor};
use crate::extract::Stage;
use crate::statistics::Sums;
use crate::transport::ReferencePlane;

/// Energy balance of all packets: the power that enters, leaves through the reference plane or
/// elsewhere, is absorbed by each surface, and the net power that random choices removed.
///
/// `incident = reflected + beside + missed + lost + roulette + Σ absorbed`, to the rounding of f64:
/// each packet's terms telescope.
#[derive(Clone, Debug)]
pub struct EnergyCounter {
    /// Number of surfaces.
    pub surfaces: usize,
    /// Plane through which light counts as reflected.
    pub plane: ReferencePlane,
}

impl EnergyCounter {
    /// Power of all packets when they start, from outside or from a surface.
    pub const INCIDENT: usize = 0;
    /// Power that is scattered out through the reference plane.
    pub const REFLECTED: usize = 1;
    /// Power that is scattered upwards on lines beside the reference plane.
    pub const BESIDE: usize = 2;
    /// Power that passes the scene without meeting anything.
    pub const MISSED: usize = 3;
    /// Power that leaves downwards, or ends where an isolated ground is cut out of the earth.
    pub const LOST: usize = 4;
    /// Net power that sampling of directions, roulette and the limit of orders removed.
    pub const ROULETTE: usize = 5;
    /// First cell of the power that surfaces absorb, in their order.
    pub const ABSORBED: usize = 6;

    /// Weights of a cell in the energy balance: in the incident power, and in that of it which is not accounted for.
    #[must_use]
    pub fn balance_weights(cell: usize) -> impl IntoIterator<Item = (usize, f64)> {
        let is_incident = cell == Self::INCIDENT;
        let incident = is_incident.then_some((0, 1.0));
        incident.into_iter().chain([(1, if is_incident { 1.0 } else { -1.0 })])
    }

    /// Largest fraction over all bands of the incident power that is not accounted for, from an energy balance.
    #[must_use]
    pub fn imbalance(balance: &Sums) -> f64 {
        let (incident, missing) = balance.values().split_at(balance.bands());
        let fractions = incident.iter().zip(missing).map(|(incident, missing)| {
            let fraction = missing.abs() / incident.max(f64::MIN_POSITIVE);
            if fraction.is_nan() { f64::INFINITY } else { fraction }
        });
        fractions.fold(0.0, f64::max)
    }
}

impl Counter for EnergyCounter {
    fn cells(&self) -> usize {
        Self::ABSORBED + self.surfaces
    }

    fn count(&self, _: &Stage, event: &Event<'_>, recorder: &mut Recorder<'_>) {
        match event {
            Event::Start { .. } => recorder.add(Self::INCIDENT, WeightFactor::One, 1.0),
            Event::Emission { emitted, .. } => {
                recorder.add(Self::INCIDENT, WeightFactor::Lobe(*emitted), 1.0);
            }
            Event::Arrival { hit, scattered, .. } => {
                let surface = Self::ABSORBED + hit.surface as usize;
                recorder.add(surface, WeightFactor::Complement(*scattered), 1.0);
                recorder.add(Self::ROULETTE, WeightFactor::Lobe(*scattered), 1.0);
            }
            Event::Departure => recorder.add(Self::ROULETTE, WeightFactor::One, -1.0),
            Event::Escape { ray, visited } => {
                let cell = match visited.order {
                    0 => Self::MISSED,
                    _ if self.plane.is_left_by(ray.origin, ray.direction) => Self::REFLECTED,
                    _ if ray.direction.z > 0.0 => Self::BESIDE,
                    _ => Self::LOST,
                };
                recorder.add(cell, WeightFactor::One, 1.0);
            }
            Event::Buried => recorder.add(Self::LOST, WeightFactor::One, 1.0),
            Event::Flight { .. } => {}
        }
    }
}
