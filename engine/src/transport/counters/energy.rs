use super::{Counter, Event};
use crate::extract::Stage;
use crate::film::Sums;

/// The energy of all packets: what came, what left through the top and elsewhere, what random
/// choices removed less what they added, and what each surface absorbed.
///
/// `incident = reflected + lost + roulette + Σ absorbed`, to the rounding of f64: each packet's
/// terms telescope.
#[derive(Clone, Copy, Debug)]
pub struct EnergyCounter {
    /// Number of surfaces.
    pub surfaces: usize,
}

impl EnergyCounter {
    /// Power of all packets when they start, from outside or from a surface.
    pub const INCIDENT: usize = 0;
    /// Power that is scattered out through the scene's rectangle at the top.
    pub const REFLECTED: usize = 1;
    /// Power that leaves an isolated scene elsewhere, or misses it.
    pub const LOST: usize = 2;
    /// What the choice of lobes, roulette and the limit of orders removed less what they added.
    pub const ROULETTE: usize = 3;
    /// First cell of what surfaces absorb, in their order.
    pub const ABSORBED: usize = 4;
}

impl Counter for EnergyCounter {
    fn cells(&self) -> usize {
        Self::ABSORBED + self.surfaces
    }

    fn count(&self, stage: &Stage, event: &Event<'_>, sums: &mut Sums) -> u64 {
        match event {
            Event::Start { weight, .. } | Event::Emission { weight, .. } => {
                sums.add(Self::INCIDENT, weight, 1.0);
            }
            Event::Arrival { hit, wo, weight, .. } => {
                let scattered = stage.surface(hit).bsdf.scattered(hit.normal, *wo);
                sums.add_with(Self::ABSORBED + hit.surface as usize, |lane| {
                    // The same product that goes on, so that the two sum to what came.
                    f64::from(weight[lane]) - f64::from(weight[lane] * scattered[lane])
                });
            }
            Event::Roulette { expected, kept } => sums
                .add_with(Self::ROULETTE, |lane| f64::from(expected[lane]) - f64::from(kept[lane])),
            Event::Escape { ray, order, weight, .. } => {
                let reflected = *order > 0 && stage.leaves_through_top(ray.origin, ray.direction);
                let cell = if reflected { Self::REFLECTED } else { Self::LOST };
                sums.add(cell, weight, 1.0);
            }
            Event::Flight { .. } => {}
        }
        0
    }
}
