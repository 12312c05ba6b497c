use super::counters::{Counter, Event};
use super::record::Recorder;
use crate::extract::Stage;
use crate::transport::ScatteringOrder;

/// A counter of the light of one part.
pub struct OrderCounter<'a> {
    /// The counter.
    pub counter: Box<dyn Counter + 'a>,
    /// The part that is counted.
    pub part: ScatteringOrder,
}

impl std::fmt::Debug for OrderCounter<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("OrderCounter").field("part", &self.part).finish_non_exhaustive()
    }
}

impl Counter for OrderCounter<'_> {
    fn cells(&self) -> usize {
        self.counter.cells()
    }

    fn prepare(&self, stage: &Stage) {
        self.counter.prepare(stage);
    }

    fn count(&self, stage: &Stage, event: &Event<'_>, recorder: &mut Recorder<'_>) {
        let part = match event {
            Event::Escape { visited, .. } => {
                ScatteringOrder::from_order(visited.order, visited.has_met_ground)
            }
            // A virtual photon leaves after one more event.
            Event::Arrival { hit, visited, .. } => {
                ScatteringOrder::from_order(visited.order + 1, stage.is_ground(hit))
            }
            _ => return,
        };
        if part == self.part {
            self.counter.count(stage, event, recorder);
        }
    }
}
