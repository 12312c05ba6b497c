use std::time::Instant;

/// Wall time of stages. It is reported and does not affect any result.
pub(super) struct Clock {
    start: Instant,
    last: Instant,
    pub(super) laps: Vec<(String, f64)>,
}

impl Clock {
    pub(super) fn start() -> Self {
        let start = Instant::now();
        Self { start, last: start, laps: Vec::new() }
    }

    /// Time since the start, s.
    pub(super) fn seconds(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    pub(super) fn lap(&mut self, name: &str) {
        let now = Instant::now();
        self.laps.push((name.to_owned(), (now - self.last).as_secs_f64()));
        self.last = now;
    }
}
