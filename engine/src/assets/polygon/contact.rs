//! Outlines that touch themselves.

use std::f64::consts::TAU;

use glam::DVec2;

use super::turn;

/// Share of its extent below which an excursion of the outline has no width.
const NARROW: f64 = 2e-12;

/// Returns whether triangles that cover each point as often as the outline runs around it cover none twice. False also for
/// outlines that merely touch themselves.
pub(super) fn covers_once(flat: &[DVec2]) -> bool {
    // Four corners cannot run around anything twice.
    flat.len() <= 4 || is_convex(flat) || !touches_itself(flat)
}

fn is_convex(flat: &[DVec2]) -> bool {
    let count = flat.len();
    let edges = (0..count).map(|i| flat[(i + 1) % count] - flat[i]);
    let edges: Vec<DVec2> = edges.filter(|edge| *edge != DVec2::ZERO).collect();
    let mut turned = 0.0;
    for (i, &edge) in edges.iter().enumerate() {
        let next = edges[(i + 1) % edges.len()];
        let turn = edge.perp_dot(next);
        if turn < 0.0 || (turn == 0.0 && edge.dot(next) < 0.0) {
            return false;
        }
        turned += edge.angle_to(next);
    }
    (turned - TAU).abs() < 1.0
}

/// Returns whether edges meet anywhere but in the corner that neighbours share.
fn touches_itself(flat: &[DVec2]) -> bool {
    let count = flat.len();
    let edge = |i: usize| [flat[i], flat[(i + 1) % count]];
    for i in 0..count {
        let [a, b] = edge(i);
        let [_, c] = edge((i + 1) % count);
        let is_folded = turn([a, b, c]) == 0.0 && (a - b).dot(c - b) >= 0.0;
        let others = i + 2..count.min(count + i - 1);
        if is_folded || others.into_iter().any(|j| meet([a, b], edge(j))) {
            return true;
        }
    }
    false
}

/// Returns whether two edges have a point in common; true also for some on one line that have none.
fn meet([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let is_apart = (a.max(b)).cmplt(c.min(d)).any() || (c.max(d)).cmplt(a.min(b)).any();
    !is_apart
        && turn([a, b, c]) * turn([a, b, d]) <= 0.0
        && turn([c, d, a]) * turn([c, d, b]) <= 0.0
}

/// Places of the corners that remain when excursions of zero width, and corners in the place of the one before, are
/// taken off.
pub(super) fn without_spikes(flat: &[DVec2]) -> Vec<usize> {
    let (low, high) = flat
        .iter()
        .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)));
    let narrow = NARROW * (high - low).max_element();
    let is_same = |a: usize, b: usize| flat[a].distance(flat[b]) <= narrow;
    // Whether the outline turns back at b.
    let is_tip = |a: usize, b: usize, c: usize| {
        let (back, on) = (flat[a] - flat[b], flat[c] - flat[b]);
        back.dot(on) > 0.0 && back.perp_dot(on).abs() <= narrow * back.length().max(on.length())
    };
    let mut ring: Vec<usize> = Vec::new();
    for corner in 0..flat.len() {
        ring.push(corner);
        loop {
            match *ring.as_slice() {
                [.., a, b] if is_same(a, b) => drop(ring.pop()),
                [.., a, b, c] if is_tip(a, b, c) => drop(ring.remove(ring.len() - 2)),
                _ => break,
            }
        }
    }
    // The same where the outline closes.
    loop {
        match *ring.as_slice() {
            [first, .., last] if is_same(first, last) => drop(ring.pop()),
            [first, .., before, last] if is_tip(before, last, first) => drop(ring.pop()),
            [first, second, .., last] if is_tip(last, first, second) => drop(ring.remove(0)),
            _ => return ring,
        }
    }
}
