use super::{Counter, Event, Share, Tally};
use crate::extract::Stage;
use crate::film::Sums;
use crate::transport::ReferencePlane;

/// Energy balance of all packets: the power that enters, leaves through the reference plane and
/// elsewhere, is absorbed by each surface, and that random choices removed less what they added.
///
/// `incident = reflected + beside + missed + lost + roulette + Σ absorbed`, to the rounding of f64:
/// each packet's terms telescope.
#[derive(Clone, Debug)]
pub struct EnergyCounter {
    /// Number of surfaces.
    pub surfaces: usize,
    /// Where light counts as reflected.
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
    /// Power that the choice of lobes, roulette and the limit of orders removed less what they added.
    pub const ROULETTE: usize = 5;
    /// First cell of what surfaces absorb, in their order.
    pub const ABSORBED: usize = 6;

    /// Largest share over all bands of what came that the other terms do not account for.
    #[must_use]
    pub fn imbalance(sums: &Sums) -> f64 {
        let (incident, others) = sums.values().split_at(sums.bands());
        let shares = incident.iter().enumerate().map(|(band, &incident)| {
            let accounted: f64 = others.iter().skip(band).step_by(sums.bands()).sum();
            let share = (incident - accounted).abs() / incident.max(f64::MIN_POSITIVE);
            if share.is_nan() { f64::INFINITY } else { share }
        });
        shares.fold(0.0, f64::max)
    }
}

impl Counter for EnergyCounter {
    fn cells(&self) -> usize {
        Self::ABSORBED + self.surfaces
    }

    fn count<'a>(&self, _: &'a Stage, event: &Event<'_, 'a>, tally: &mut Tally<'a>) -> u64 {
        match event {
            Event::Start { .. } | Event::Emission { .. } => {
                tally.add(Self::INCIDENT, Share::Whole, 1.0);
            }
            Event::Arrival { hit, scattered, .. } => {
                let surface = Self::ABSORBED + hit.surface as usize;
                tally.add(surface, Share::ButFor(scattered), 1.0);
                tally.add(Self::ROULETTE, Share::Of(scattered), 1.0);
            }
            Event::Departure => tally.add(Self::ROULETTE, Share::Whole, -1.0),
            Event::Escape { ray, order, .. } => {
                let cell = match order {
                    0 => Self::MISSED,
                    _ if self.plane.is_left_by(ray.origin, ray.direction) => Self::REFLECTED,
                    _ if ray.direction.z > 0.0 => Self::BESIDE,
                    _ => Self::LOST,
                };
                tally.add(cell, Share::Whole, 1.0);
            }
            Event::Buried => tally.add(Self::LOST, Share::Whole, 1.0),
            Event::Flight { .. } => {}
        }
        0
    }
}
