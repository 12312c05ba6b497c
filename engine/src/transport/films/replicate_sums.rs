//! Sums of each randomisation, to which samples of the same sequences can always be added.

use std::io::{self, Read, Write};
use std::ops::Range;

use glam::UVec2;

use super::{Film, Partition, ReplicateRow, blocks};
use crate::scattering::SurfaceModels;
use crate::statistics::{Spread, Sums};
use crate::transport::coefficients::Coefficients;
use crate::transport::state::{restore_f64, restore_u64, save_f64, save_u64};
use crate::transport::{ProgressFn, RANDOMISATIONS};

/// Randomisations that an outcome is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Randomisations {
    /// All of them: means with their standard errors.
    All,
    /// The one with this number: its values, without errors.
    One(usize),
}

impl Randomisations {
    /// Each of them alone.
    pub fn each() -> impl Iterator<Item = Self> {
        (0..RANDOMISATIONS as usize).map(Self::One)
    }

    /// Returns whether the one with this number is among them.
    fn contain(self, number: usize) -> bool {
        match self {
            Self::All => true,
            Self::One(one) => one == number,
        }
    }
}

/// Traces the samples of a randomisation.
pub(in crate::transport) trait SampleTracer: Sync {
    /// Cells and columns of each of its sums.
    fn shapes(&self) -> Vec<(usize, usize)>;

    /// Sums of a randomisation without samples.
    fn empty_row(&self) -> ReplicateRow {
        let shapes = self.shapes().into_iter();
        let sums = shapes.map(|(cells, columns)| Sums::new(cells, columns)).collect();
        ReplicateRow { sums, coefficients: None }
    }

    /// Models that coefficients are evaluated with, if there are any.
    fn models(&self) -> Option<&SurfaceModels> {
        None
    }

    /// Prepares for tracing, once, before any sample is traced.
    fn prepare(&self) {}

    /// Frees what it has kept from block to block.
    fn finish(&self) {}

    /// Traces these samples of a randomisation; returns its sums and the number of rays.
    fn trace(&self, randomisation: u64, samples: Range<u64>) -> (ReplicateRow, u64);

    /// Maximum memory of the sums of this number of samples, bytes.
    fn block_bytes(&self, samples: u64) -> u64;

    /// Largest fraction of the energy that the first of the sums of a randomisation does not account for.
    fn imbalance(&self, _: &[&ReplicateRow]) -> Option<f64> {
        None
    }
}

/// Maximum memory of the sums of all randomisations, bytes.
const MAX_BYTES: u64 = 2 << 30;

/// Sums of each randomisation, kept or folded into their spread.
#[expect(missing_debug_implementations, reason = "what it traces has no Debug")]
pub struct ReplicateSums<'a> {
    tracer: Box<dyn SampleTracer + 'a>,
    store: Store,
    /// Samples of each randomisation.
    done: u64,
    rays: u64,
    partition: Partition,
}

enum Store {
    /// All, shape `[randomisations, sums]`, those of other partitions empty: these can grow.
    All(Vec<ReplicateRow>),
    /// The spread of each of the sums over complete randomisations, and the largest imbalance.
    Folded(Vec<Spread>, Option<f64>),
}

impl<'a> ReplicateSums<'a> {
    /// No samples yet. Large sums are folded as soon as they are complete, and cannot grow.
    pub(in crate::transport) fn new(tracer: impl SampleTracer + 'a) -> Self {
        let store = if bytes_of_all(&tracer.shapes()) > MAX_BYTES {
            Store::Folded(Vec::new(), None)
        } else {
            Store::All((0..RANDOMISATIONS).map(|_| ReplicateRow::default()).collect())
        };
        Self { tracer: Box::new(tracer), store, done: 0, rays: 0, partition: Partition::ALL }
    }

    /// Adds samples as [`Film::trace`] does.
    pub(in crate::transport) fn trace_in_memory(&mut self, to: u64, progress: ProgressFn<'_>) {
        let from = self.done;
        assert_eq!(blocks::last_end(from), from, "a block that ended too early ends a run");
        assert!(from == 0 || self.can_grow().is_ok(), "what is folded cannot grow");
        self.set_up(self.partition);
        self.tracer.prepare();
        let Self { tracer, store, rays, partition, .. } = self;
        let owned = (0..u64::from(RANDOMISATIONS)).filter(|row| partition.owns(*row as usize));
        let (mut traced, all) = (0, (to - from) * owned.clone().count() as u64);
        let jobs = owned.flat_map(|row| blocks::of(from..to).map(move |samples| (row, samples)));
        let mut current: Option<ReplicateRow> = None;
        blocks::in_order(
            jobs,
            |(row, samples)| (row, samples.clone(), tracer.trace(row, samples)),
            |(row, samples, (part, traced_rays))| {
                *rays += traced_rays;
                let into = match store {
                    Store::All(rows) => &mut rows[row as usize],
                    Store::Folded(..) => current.get_or_insert_with(|| tracer.empty_row()),
                };
                into.merge(&part, tracer.models());
                if let Store::Folded(spreads, imbalance) = store
                    && samples.end == to
                    && let Some(mut row) = current.take()
                {
                    row.evaluate(tracer.models());
                    *imbalance = max_of(*imbalance, tracer.imbalance(&[&row]));
                    for (spread, sums) in spreads.iter_mut().zip(&row.sums) {
                        spread.push_sums(&[sums], to);
                    }
                }
                traced += samples.end - samples.start;
                progress(traced as f64 / all as f64);
            },
        );
        self.tracer.finish();
        self.done = to;
    }

    /// Allocates the memory of a partition, as late as possible: films that are never traced need none.
    fn set_up(&mut self, partition: Partition) {
        match &mut self.store {
            Store::All(rows) => {
                let owned = rows.iter_mut().enumerate().filter(|(row, _)| partition.owns(*row));
                let missing = owned.filter(|(_, row)| row.sums.is_empty());
                missing.for_each(|(_, row)| *row = self.tracer.empty_row());
            }
            Store::Folded(spreads, _) => {
                let empty = |(cells, columns): &(usize, usize)| Spread::new(cells * columns);
                *spreads = self.tracer.shapes().iter().map(empty).collect();
            }
        }
    }

    /// One of the sums of each randomisation, of a measurement without coefficients; none if they are folded.
    pub(in crate::transport) fn rows(&self, index: usize) -> impl Iterator<Item = &Sums> {
        let rows = match &self.store {
            Store::All(rows) => rows.as_slice(),
            Store::Folded(..) => &[],
        };
        rows.iter().filter_map(move |row| row.sums.get(index))
    }

    /// Spread over the randomisations of one of the sums, per sample.
    ///
    /// # Panics
    /// If there is no such sum.
    #[must_use]
    pub fn spread(&self, index: usize) -> Spread {
        self.spread_of(index, Randomisations::All)
    }

    /// Spread over some of the randomisations; of sums that are folded, that over all.
    ///
    /// # Panics
    /// If there is no such sum.
    #[must_use]
    pub fn spread_of(&self, index: usize, of: Randomisations) -> Spread {
        match &self.store {
            Store::All(rows) => {
                let (cells, columns) = self.tracer.shapes()[index];
                let mut spread = Spread::new(cells * columns);
                let rows = rows.iter().enumerate().filter(|(number, _)| of.contain(*number));
                let rows = rows.map(|(_, row)| row).filter(|row| !row.sums.is_empty());
                let rows: Vec<&ReplicateRow> = rows.collect();
                let sums = ReplicateRow::evaluated(&rows, index, self.tracer.models());
                spread.push_sums(&sums.iter().map(AsRef::as_ref).collect::<Vec<_>>(), self.done);
                spread
            }
            Store::Folded(spreads, _) => spreads[index].clone(),
        }
    }

    /// Number of its sums.
    pub(in crate::transport) fn count(&self) -> usize {
        self.tracer.shapes().len()
    }
}

/// Memory of the sums of one randomisation, bytes.
fn bytes_of_one(shapes: &[(usize, usize)]) -> u64 {
    let bytes = shapes.iter().map(|&(cells, columns)| Sums::bytes(cells, columns));
    bytes.fold(0, u64::saturating_add)
}

/// Memory of the sums of all randomisations, bytes.
fn bytes_of_all(shapes: &[(usize, usize)]) -> u64 {
    bytes_of_one(shapes).saturating_mul(RANDOMISATIONS.into())
}

impl Film for ReplicateSums<'_> {
    fn trace(&mut self, to: u64, progress: ProgressFn<'_>) -> io::Result<()> {
        self.trace_in_memory(to, progress);
        Ok(())
    }

    fn restrict(&mut self, partition: Partition) {
        self.partition = partition;
    }

    fn units(&self) -> UVec2 {
        UVec2::new(1, RANDOMISATIONS)
    }

    fn save(&self, out: &mut dyn Write) -> io::Result<()> {
        save_u64(out, &[self.rays])?;
        let Store::All(rows) = &self.store else { return Ok(()) };
        let owned = rows.iter().enumerate().filter(|(row, _)| self.partition.owns(*row));
        for (_, row) in owned {
            // Terms alone can be restored with another number of bands.
            let saved = if row.has_sums() { &*row.sums } else { &[] };
            save_u64(out, &[saved.len() as u64])?;
            for sums in saved {
                let (ordered, mut buffer) = (sums.ordered(), Vec::new());
                for cells in chunks(sums) {
                    save_f64(out, ordered.values(cells, &mut buffer))?;
                }
            }
            save_u64(out, &[row.coefficients.is_some().into()])?;
            if let (Some(terms), Some(models)) = (&row.coefficients, self.tracer.models()) {
                terms.save(models, out)?;
            }
        }
        Ok(())
    }

    fn restore(&mut self, partition: Partition, done: u64, input: &mut dyn Read) -> io::Result<()> {
        let mut rays = [0];
        restore_u64(input, &mut rays)?;
        self.rays += rays[0];
        self.done = done;
        if let Store::All(rows) = &mut self.store {
            let owned = rows.iter_mut().enumerate().filter(|(row, _)| partition.owns(*row));
            owned.for_each(|(_, row)| *row = ReplicateRow::default());
        }
        self.set_up(partition);
        let Self { tracer, store: Store::All(rows), .. } = self else { return Ok(()) };
        let owned = rows.iter_mut().enumerate().filter(|(row, _)| partition.owns(*row));
        for (_, row) in owned {
            let mut saved = [0];
            restore_u64(input, &mut saved)?;
            for sums in row.sums.iter_mut().take(saved[0] as usize) {
                let mut values = vec![0.0; sums.bands()];
                for cell in 0..sums.cells() {
                    restore_f64(input, &mut values)?;
                    if values.iter().any(|value| value.to_bits() > 0) {
                        sums.cell_mut(cell).copy_from_slice(&values);
                    }
                }
            }
            let mut has_terms = [0];
            restore_u64(input, &mut has_terms)?;
            if let ([1], Some(models)) = (has_terms, tracer.models()) {
                row.coefficients = Some(Coefficients::restore(models, input)?);
            }
        }
        Ok(())
    }

    fn can_grow(&self) -> Result<(), u64> {
        match &self.store {
            Store::All(_) => Ok(()),
            Store::Folded(..) => Err(bytes_of_all(&self.tracer.shapes())),
        }
    }

    fn bytes(&self) -> u64 {
        let rows = match &self.store {
            Store::All(rows) => {
                (0..rows.len()).filter(|row| self.partition.owns(*row)).count() as u64
            }
            // Mean and squares.
            Store::Folded(..) => 2,
        };
        let shapes = self.tracer.shapes();
        let each = (shapes.len() * size_of::<Sums>()) as u64;
        bytes_of_one(&shapes).saturating_add(each).saturating_mul(rows)
    }

    fn bytes_beside(&self) -> u64 {
        let one = bytes_of_one(&self.tracer.shapes());
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

    fn has_coefficients_alone(&self) -> bool {
        let Store::All(rows) = &self.store else { return false };
        rows.iter().all(|row| row.coefficients.is_some() && !row.has_sums())
    }

    fn samples(&self) -> u64 {
        self.done * u64::from(RANDOMISATIONS)
    }

    fn rays(&self) -> u64 {
        self.rays
    }

    fn imbalance(&self) -> Option<f64> {
        match &self.store {
            Store::All(rows) => {
                let rows: Vec<&ReplicateRow> =
                    rows.iter().filter(|row| !row.sums.is_empty()).collect();
                self.tracer.imbalance(&rows)
            }
            Store::Folded(_, imbalance) => *imbalance,
        }
    }
}

/// Ranges of cells that are written at a time.
fn chunks(sums: &Sums) -> impl Iterator<Item = Range<usize>> {
    let cells = sums.cells();
    (0..cells).step_by(CHUNK).map(move |first| first..(first + CHUNK).min(cells))
}

/// Number of cells that are written at a time.
const CHUNK: usize = 1 << 10;

/// The larger of two values, if there are any.
fn max_of(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    a.zip(b).map(|(a, b)| a.max(b)).or(a).or(b)
}
