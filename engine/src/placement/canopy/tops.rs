//! Tops of trees in a canopy height model: local maxima in a window that grows with height.

use std::cmp::Ordering;

use glam::DVec2;
use rayon::prelude::*;

use crate::terrain::Cells;

/// Expected diameter of a tree's crown: `a + b h²`, m, for a height h in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Width of the lowest crowns, m.
    pub a: f64,
    /// Growth, m⁻¹.
    pub b: f64,
}

/// Cells of all tops of at least `least` m, ascending: no cell within half a window is higher, and of
/// equal ones the first counts.
///
/// What is level and higher than all cells around it is one top, at the cell nearest to its centre.
///
/// Source: the variable window is that of Popescu and Wynne (2004), Photogramm. Eng. Remote Sens.
/// 70, 589–604.
pub(super) fn tops(model: &Cells<f64>, window: Window, least: f64) -> Vec<usize> {
    let offsets = Offsets::new(model, window);
    let candidates = plateaus(model, least);
    let highest: Vec<usize> = candidates
        .into_par_iter()
        .filter(|&cell| {
            let height = model.values[cell];
            !offsets.near(model, window, cell).any(|other| model.values[other] > height)
        })
        .collect();
    let mut is_top = vec![false; model.values.len()];
    let mut tops: Vec<usize> = Vec::new();
    for cell in highest {
        let height = model.values[cell];
        let is_equal = |other: usize| {
            is_top[other] && model.values[other].total_cmp(&height) == Ordering::Equal
        };
        if !offsets.near(model, window, cell).any(is_equal) {
            is_top[cell] = true;
            tops.push(cell);
        }
    }
    tops
}

/// One cell of each level group of cells that no neighbour of theirs exceeds, ascending.
fn plateaus(model: &Cells<f64>, least: f64) -> Vec<usize> {
    let mut seen = vec![false; model.values.len()];
    let mut found = Vec::new();
    for start in 0..model.values.len() {
        let height = model.values[start];
        if seen[start] || height.is_nan() || height < least {
            continue;
        }
        seen[start] = true;
        let (mut group, mut next, mut is_exceeded) = (vec![start], 0, false);
        while let Some(&cell) = group.get(next) {
            next += 1;
            for other in model.around(cell) {
                is_exceeded |= model.values[other] > height;
                let is_level = model.values[other].total_cmp(&height) == Ordering::Equal;
                if is_level && !seen[other] {
                    seen[other] = true;
                    group.push(other);
                }
            }
        }
        if !is_exceeded {
            let sum: DVec2 = group.iter().map(|&cell| model.center(cell)).sum();
            let center = sum / group.len() as f64;
            let distance = |cell: usize| model.center(cell).distance_squared(center);
            found.extend(
                group
                    .into_iter()
                    .min_by(|&a, &b| distance(a).total_cmp(&distance(b)).then(a.cmp(&b))),
            );
        }
    }
    found.sort_unstable();
    found
}

/// Steps to the cells of the widest window, nearest first: what is higher is most often near.
struct Offsets(Vec<(i32, i32, f64)>);

impl Offsets {
    fn new(model: &Cells<f64>, window: Window) -> Self {
        let highest = model.values.iter().copied().filter(|h| h.is_finite()).fold(0.0, f64::max);
        let reach = 0.5 * (window.a + window.b * highest * highest);
        // Beyond the model there are no cells.
        let steps = |cell: f64, count: usize| (reach / cell).min(count as f64) as i32;
        let (x, y) = (steps(model.cell().x, model.columns), steps(model.cell().y, model.rows));
        let mut offsets = Vec::new();
        for dy in -y..=y {
            for dx in -x..=x {
                let step = DVec2::new(f64::from(dx), f64::from(dy)) * model.cell();
                let distance = step.length();
                if distance <= reach && (dx, dy) != (0, 0) {
                    offsets.push((dx, dy, distance));
                }
            }
        }
        offsets.sort_by(|a, b| a.2.total_cmp(&b.2));
        Self(offsets)
    }

    /// The cells in the window of one.
    fn near(&self, model: &Cells<f64>, window: Window, cell: usize) -> impl Iterator<Item = usize> {
        let height = model.values[cell];
        let reach = 0.5 * (window.a + window.b * height * height);
        let (columns, rows) = (model.columns as i64, model.rows as i64);
        let (column, row) = (cell as i64 % columns, cell as i64 / columns);
        self.0.iter().take_while(move |(.., distance)| *distance <= reach).filter_map(
            move |&(dx, dy, _)| {
                let (c, r) = (column + i64::from(dx), row + i64::from(dy));
                let is_within = (0..columns).contains(&c) && (0..rows).contains(&r);
                is_within.then_some((r * columns + c) as usize)
            },
        )
    }
}
