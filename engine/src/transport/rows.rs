//! Sums of each randomisation, which go on along the same sequences for as long as one likes.

use std::io::{self, Read, Write};
use std::ops::Range;

use super::share::{restore_f64, restore_u64, save_f64, save_u64};
use super::{Film, RANDOMISATIONS, Share, Watch, blocks};
use crate::film::{Spread, Sums};

/// What samples of one randomisation are made of.
pub(super) trait Tracer: Sync {
    /// Cells and columns of each of its sums.
    fn shapes(&self) -> Vec<(usize, usize)>;

    /// Traces these samples of a randomisation; returns its sums and the number of rays.
    fn trace(&self, randomisation: u64, samples: Range<u64>) -> (Vec<Sums>, u64);

    /// Of the sums of a whole randomisation, the share of the energy that is not accounted for.
    fn imbalance(&self, _: &[Sums]) -> Option<f64> {
        None
    }
}

/// Memory that the sums of all randomisations may take, bytes.
const MOST_BYTES: u64 = 2 << 30;

/// Blocks whose results may wait in memory.
const BATCH: usize = 16;

/// Sums of each randomisation, all there are or folded.
#[expect(missing_debug_implementations, reason = "what it traces has no Debug")]
pub struct Rows<'a> {
    tracer: Box<dyn Tracer + 'a>,
    store: Store,
    /// Samples of each randomisation.
    done: u64,
    rays: u64,
    share: Share,
}

enum Store {
    /// All, shape `[randomisations, sums]`: these can grow.
    All(Vec<Vec<Sums>>),
    /// Each randomisation's once it is complete, and the largest imbalance.
    Folded(Vec<Spread>, Option<f64>),
}

impl<'a> Rows<'a> {
    /// None yet; those of a tracer with large sums are folded as they come, and cannot grow.
    pub(super) fn new(tracer: impl Tracer + 'a) -> Self {
        let shapes = tracer.shapes();
        let store = if bytes(&shapes) > MOST_BYTES {
            let spreads = shapes.iter().map(|(cells, columns)| Spread::new(cells * columns));
            Store::Folded(spreads.collect(), None)
        } else {
            Store::All((0..RANDOMISATIONS).map(|_| empty(&shapes)).collect())
        };
        Self { tracer: Box::new(tracer), store, done: 0, rays: 0, share: Share::ALL }
    }

    /// Sums of each randomisation; none of those that are folded.
    pub(super) fn rows(&self, of: usize) -> impl Iterator<Item = &Sums> {
        let rows = match &self.store {
            Store::All(rows) => rows.as_slice(),
            Store::Folded(..) => &[],
        };
        rows.iter().map(move |row| &row[of])
    }

    /// Spread over the randomisations of one of the sums, per sample.
    ///
    /// # Panics
    /// If there are not so many.
    #[must_use]
    pub fn spread(&self, of: usize) -> Spread {
        match &self.store {
            Store::All(rows) => {
                let mut spread = Spread::new(rows[0][of].values().len());
                for row in rows {
                    push(&mut spread, &row[of], self.done);
                }
                spread
            }
            Store::Folded(spreads, _) => spreads[of].clone(),
        }
    }

    /// Number of its sums.
    pub(super) fn count(&self) -> usize {
        match &self.store {
            Store::All(rows) => rows[0].len(),
            Store::Folded(spreads, _) => spreads.len(),
        }
    }
}

fn empty(shapes: &[(usize, usize)]) -> Vec<Sums> {
    shapes.iter().map(|&(cells, columns)| Sums::new(cells, columns)).collect()
}

/// Memory of the sums of all randomisations.
fn bytes(shapes: &[(usize, usize)]) -> u64 {
    let values: usize = shapes.iter().map(|(cells, columns)| cells * columns).sum();
    values as u64 * 8 * u64::from(RANDOMISATIONS)
}

fn push(spread: &mut Spread, sums: &Sums, samples: u64) {
    let means: Vec<f64> = sums.values().iter().map(|sum| sum / samples as f64).collect();
    spread.push(&means);
}

impl Film for Rows<'_> {
    fn trace(&mut self, to: u64, watch: Watch<'_>) {
        let from = self.done;
        assert_eq!(blocks::last_end(from), from, "a block that ended too early ends a run");
        let Self { tracer, store, rays, share, .. } = self;
        if let Store::Folded(spreads, _) = store {
            assert_eq!(from, 0, "what is folded cannot grow");
            spreads.iter_mut().for_each(Spread::clear);
        }
        let jobs = (0..u64::from(RANDOMISATIONS))
            .filter(|row| share.owns(*row as usize))
            .flat_map(|row| blocks::of(from..to).map(move |samples| (row, samples)));
        let (mut traced, all) = (0, (to - from) * u64::from(RANDOMISATIONS));
        let mut current = Vec::new();
        blocks::in_order(
            jobs,
            BATCH,
            |(row, samples)| (row, samples.clone(), tracer.trace(row, samples)),
            |(row, samples, (sums, traced_rays))| {
                *rays += traced_rays;
                let into = match store {
                    Store::All(rows) => &mut rows[row as usize],
                    Store::Folded(..) if current.is_empty() => {
                        current = empty(&tracer.shapes());
                        &mut current
                    }
                    Store::Folded(..) => &mut current,
                };
                for (total, part) in into.iter_mut().zip(&sums) {
                    total.merge(part);
                }
                if let Store::Folded(spreads, imbalance) = store
                    && samples.end == to
                {
                    let off = tracer.imbalance(&current);
                    *imbalance = most(*imbalance, off);
                    for (spread, sums) in spreads.iter_mut().zip(&current) {
                        push(spread, sums, to);
                    }
                    current.clear();
                }
                traced += samples.end - samples.start;
                watch(traced as f64 / all as f64);
            },
        );
        self.done = to;
    }

    fn restrict(&mut self, share: Share) {
        self.share = share;
    }

    fn save(&self, out: &mut dyn Write) -> io::Result<()> {
        save_u64(out, &[self.rays])?;
        let Store::All(rows) = &self.store else { return Ok(()) };
        let own = rows.iter().enumerate().filter(|(row, _)| self.share.owns(*row));
        own.flat_map(|(_, row)| row).try_for_each(|sums| save_f64(out, sums.values()))
    }

    fn restore(&mut self, share: Share, done: u64, input: &mut dyn Read) -> io::Result<()> {
        let mut rays = [0];
        restore_u64(input, &mut rays)?;
        self.rays += rays[0];
        self.done = done;
        let Store::All(rows) = &mut self.store else { return Ok(()) };
        let own = rows.iter_mut().enumerate().filter(|(row, _)| share.owns(*row));
        own.flat_map(|(_, row)| row).try_for_each(|sums| restore_f64(input, sums.values_mut()))
    }

    fn can_grow(&self) -> Result<(), u64> {
        match &self.store {
            Store::All(_) => Ok(()),
            Store::Folded(..) => Err(bytes(&self.tracer.shapes())),
        }
    }

    fn bytes(&self) -> u64 {
        let all = bytes(&self.tracer.shapes());
        match &self.store {
            Store::All(_) => all,
            // Mean and squares, and those of the randomisation that is being traced.
            Store::Folded(..) => 3 * all / u64::from(RANDOMISATIONS),
        }
    }

    fn samples(&self) -> u64 {
        self.done * u64::from(RANDOMISATIONS)
    }

    fn rays(&self) -> u64 {
        self.rays
    }

    fn imbalance(&self) -> Option<f64> {
        match &self.store {
            Store::All(rows) => rows.iter().map(|row| self.tracer.imbalance(row)).fold(None, most),
            Store::Folded(_, imbalance) => *imbalance,
        }
    }
}

/// The larger of the two, of those that are there.
fn most(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    a.zip(b).map(|(a, b)| a.max(b)).or(a).or(b)
}
