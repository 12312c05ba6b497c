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

    /// Does once, before any sample is traced, what all of them need.
    fn prepare(&self) {}

    /// Traces these samples of a randomisation; returns its sums and the number of rays.
    fn trace(&self, randomisation: u64, samples: Range<u64>) -> (Vec<Sums>, u64);

    /// The most memory of the sums of so many samples, bytes.
    fn block_bytes(&self, samples: u64) -> u64;

    /// Of the sums of a whole randomisation, the share of the energy that is not accounted for.
    fn imbalance(&self, _: &[Sums]) -> Option<f64> {
        None
    }
}

/// Memory that the sums of all randomisations may take, bytes.
const MOST_BYTES: u64 = 2 << 30;

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
    /// All, shape `[randomisations, sums]`, without those of other shares: these can grow.
    All(Vec<Vec<Sums>>),
    /// Each randomisation's once it is complete, and the largest imbalance.
    Folded(Vec<Spread>, Option<f64>),
}

impl<'a> Rows<'a> {
    /// None yet; those of a tracer with large sums are folded as they come, and cannot grow.
    pub(super) fn new(tracer: impl Tracer + 'a) -> Self {
        let store = if of_all(&tracer.shapes()) > MOST_BYTES {
            Store::Folded(Vec::new(), None)
        } else {
            Store::All((0..RANDOMISATIONS).map(|_| Vec::new()).collect())
        };
        Self { tracer: Box::new(tracer), store, done: 0, rays: 0, share: Share::ALL }
    }

    /// Takes the memory that a share needs: what is never traced does without.
    fn set_up(&mut self, share: Share) {
        let shapes = self.tracer.shapes();
        match &mut self.store {
            Store::All(rows) => {
                let own = rows.iter_mut().enumerate().filter(|(row, _)| share.owns(*row));
                let missing = own.filter(|(_, row)| row.is_empty());
                missing.for_each(|(_, row)| *row = empty(&shapes));
            }
            Store::Folded(spreads, _) => {
                let empty = |(cells, columns): &(usize, usize)| Spread::new(cells * columns);
                *spreads = shapes.iter().map(empty).collect();
            }
        }
    }

    /// Sums of each randomisation; none of those that are folded.
    pub(super) fn rows(&self, of: usize) -> impl Iterator<Item = &Sums> {
        let rows = match &self.store {
            Store::All(rows) => rows.as_slice(),
            Store::Folded(..) => &[],
        };
        rows.iter().filter_map(move |row| row.get(of))
    }

    /// Spread over the randomisations of one of the sums, per sample.
    ///
    /// # Panics
    /// If there are not so many.
    #[must_use]
    pub fn spread(&self, of: usize) -> Spread {
        match &self.store {
            Store::All(_) => {
                let (cells, columns) = self.tracer.shapes()[of];
                let mut spread = Spread::new(cells * columns);
                self.rows(of).for_each(|sums| push(&mut spread, sums, self.done));
                spread
            }
            Store::Folded(spreads, _) => spreads[of].clone(),
        }
    }

    /// Number of its sums.
    pub(super) fn count(&self) -> usize {
        self.tracer.shapes().len()
    }
}

fn empty(shapes: &[(usize, usize)]) -> Vec<Sums> {
    shapes.iter().map(|&(cells, columns)| Sums::new(cells, columns)).collect()
}

/// Memory of the sums of one randomisation, bytes.
fn of_one(shapes: &[(usize, usize)]) -> u64 {
    let bytes = shapes.iter().map(|&(cells, columns)| Sums::bytes(cells, columns));
    bytes.fold(0, u64::saturating_add)
}

/// Memory of those of all.
fn of_all(shapes: &[(usize, usize)]) -> u64 {
    of_one(shapes).saturating_mul(RANDOMISATIONS.into())
}

fn push(spread: &mut Spread, sums: &Sums, samples: u64) {
    let means: Vec<f64> = sums.values().iter().map(|sum| sum / samples as f64).collect();
    spread.push(&means);
}

impl Film for Rows<'_> {
    fn trace(&mut self, to: u64, watch: Watch<'_>) {
        let from = self.done;
        assert_eq!(blocks::last_end(from), from, "a block that ended too early ends a run");
        assert!(from == 0 || self.can_grow().is_ok(), "what is folded cannot grow");
        self.set_up(self.share);
        self.tracer.prepare();
        let Self { tracer, store, rays, share, .. } = self;
        let own = (0..u64::from(RANDOMISATIONS)).filter(|row| share.owns(*row as usize));
        let (mut traced, all) = (0, (to - from) * own.clone().count() as u64);
        let jobs = own.flat_map(|row| blocks::of(from..to).map(move |samples| (row, samples)));
        let mut current = Vec::new();
        blocks::in_order(
            jobs,
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
        self.set_up(share);
        let Store::All(rows) = &mut self.store else { return Ok(()) };
        let own = rows.iter_mut().enumerate().filter(|(row, _)| share.owns(*row));
        own.flat_map(|(_, row)| row).try_for_each(|sums| restore_f64(input, sums.values_mut()))
    }

    fn can_grow(&self) -> Result<(), u64> {
        match &self.store {
            Store::All(_) => Ok(()),
            Store::Folded(..) => Err(of_all(&self.tracer.shapes())),
        }
    }

    fn bytes(&self) -> u64 {
        let rows = match &self.store {
            Store::All(rows) => (0..rows.len()).filter(|row| self.share.owns(*row)).count() as u64,
            // Mean and squares.
            Store::Folded(..) => 2,
        };
        let shapes = self.tracer.shapes();
        let each = (shapes.len() * size_of::<Sums>()) as u64;
        of_one(&shapes).saturating_add(each).saturating_mul(rows)
    }

    fn bytes_beside(&self) -> u64 {
        let one = of_one(&self.tracer.shapes());
        let waiting =
            self.tracer.block_bytes(blocks::LARGEST).saturating_mul(blocks::ahead() as u64);
        let tracing = match &self.store {
            Store::All(_) => waiting,
            // The randomisation that is being traced, and its means.
            Store::Folded(..) => waiting.saturating_add(one.saturating_mul(2)),
        };
        // Mean, squares and error, and what mean and error are scaled to.
        tracing.max(one.saturating_mul(5))
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
