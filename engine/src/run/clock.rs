use std::time::Instant;

/// Wall time of stages. It is reported and does not affect any result.
pub(super) struct Clock {
    last: Instant,
    pub(super) laps: Vec<(String, f64)>,
}

impl Clock {
    pub(super) fn start() -> Self {
        Self { last: Instant::now(), laps: Vec::new() }
    }

    pub(super) fn lap(&mut self, name: &str) {
        let now = Instant::now();
        self.laps.push((name.to_owned(), (now - self.last).as_secs_f64()));
        self.last = now;
    }
}
