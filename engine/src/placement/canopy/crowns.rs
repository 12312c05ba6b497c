//! Crowns of trees in a canopy height model: a watershed that is flooded from the tops.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::f64::consts::PI;

use glam::DVec2;

use super::Window;
use super::tops::tops;
use crate::terrain::Cells;

/// A tree as a canopy height model shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crown {
    /// Its highest cell's centre, m.
    pub place: DVec2,
    /// Height above the ground, m.
    pub height: f64,
    /// Diameter of the circle of its area, m.
    pub diameter: f64,
}

/// A cell that waits to be flooded: the highest first, of equal ones the one that came first.
#[derive(PartialEq)]
struct Waiting {
    level: f64,
    order: u64,
    cell: usize,
}

impl Eq for Waiting {}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        self.level.total_cmp(&other.level).then(other.order.cmp(&self.order))
    }
}

/// The trees of a canopy of at least `least` m, in the order of their tops from north to south and
/// west to east.
///
/// From each top the model is flooded downwards, cell by cell from high to low, until the floods meet
/// (watershed from markers). A tree stands at the highest cell of its own.
///
/// Source: Meyer (1994), "Topographic distance and watershed lines", Signal Processing 38, 113–125.
#[must_use]
pub fn crowns(model: &Cells<f64>, window: Window, least: f64) -> Vec<Crown> {
    const NONE: u32 = u32::MAX;
    let tops = tops(model, window, least);
    let mut owners = vec![NONE; model.values.len()];
    let mut waiting = BinaryHeap::new();
    let mut order = 0;
    let mut wait = |waiting: &mut BinaryHeap<Waiting>, level: f64, cell: usize| {
        waiting.push(Waiting { level, order, cell });
        order += 1;
    };
    for (tree, &cell) in (0..).zip(&tops) {
        owners[cell] = tree;
        wait(&mut waiting, model.values[cell], cell);
    }
    while let Some(Waiting { level, cell, .. }) = waiting.pop() {
        for other in model.around(cell) {
            let height = model.values[other];
            if owners[other] == NONE && height >= least {
                owners[other] = owners[cell];
                wait(&mut waiting, height.min(level), other);
            }
        }
    }
    let mut highest = tops;
    let mut counts = vec![0_u32; highest.len()];
    for (cell, &owner) in owners.iter().enumerate().filter(|&(_, &owner)| owner != NONE) {
        counts[owner as usize] += 1;
        let top = &mut highest[owner as usize];
        if model.values[cell] > model.values[*top] {
            *top = cell;
        }
    }
    let area = model.cell().x * model.cell().y;
    let crown = |(top, count): (usize, u32)| Crown {
        place: model.center(top),
        height: model.values[top],
        diameter: 2.0 * (f64::from(count) * area / PI).sqrt(),
    };
    highest.into_iter().zip(counts).map(crown).collect()
}
