use super::counters::{Counter, Event};
use super::tally::Tally;
use crate::extract::Stage;

/// Parts of what a scene reflects, as RAMI splits it; they sum to the whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScatteringOrder {
    /// Scattered once, by the ground: it has met no canopy on its way in or out.
    Uncollided,
    /// Scattered once, by anything but the ground.
    Single,
    /// Scattered more than once.
    Multiple,
}

impl ScatteringOrder {
    /// All, in the order of their cells.
    pub const ALL: [Self; 3] = [Self::Uncollided, Self::Single, Self::Multiple];

    /// Suffix that RAMI appends to a name.
    #[must_use]
    pub const fn suffix(self) -> &'static str {
        match self {
            Self::Uncollided => "uc",
            Self::Single => "co_sgl",
            Self::Multiple => "mlt",
        }
    }

    /// Part of the light with this number of scattering events, some of them at the ground or none.
    #[must_use]
    pub const fn from_order(order: u32, has_met_ground: bool) -> Self {
        match (order, has_met_ground) {
            (..=1, true) => Self::Uncollided,
            (..=1, false) => Self::Single,
            _ => Self::Multiple,
        }
    }
}

/// Number of spectra of a path: the whole and, on request, its parts.
#[must_use]
pub const fn spectra(separates_orders: bool) -> usize {
    if separates_orders { 1 + ScatteringOrder::ALL.len() } else { 1 }
}

/// A counter of the light of one part.
pub struct OrderCounter<'a> {
    /// The counter.
    pub counter: Box<dyn Counter + 'a>,
    /// The part that is counted.
    pub part: ScatteringOrder,
}

impl std::fmt::Debug for OrderCounter<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PartCounter").field("part", &self.part).finish_non_exhaustive()
    }
}

impl Counter for OrderCounter<'_> {
    fn cells(&self) -> usize {
        self.counter.cells()
    }

    fn prepare(&self, stage: &Stage) {
        self.counter.prepare(stage);
    }

    fn count(&self, stage: &Stage, event: &Event<'_>, tally: &mut Tally<'_>) -> u64 {
        let part = match event {
            Event::Escape { visited, .. } => {
                ScatteringOrder::from_order(visited.order, visited.has_met_ground)
            }
            // A virtual photon leaves after one more event.
            Event::Arrival { hit, visited, .. } => {
                ScatteringOrder::from_order(visited.order + 1, stage.is_ground(hit))
            }
            _ => return 0,
        };
        if part == self.part { self.counter.count(stage, event, tally) } else { 0 }
    }
}
