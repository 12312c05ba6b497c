//! Days in a sweep: points that differ in the hour of the sun's clock, and their weights in sums over it.

use std::collections::HashMap;

use crate::document::{Param, Sun};
use crate::products::{Day, SweepPoint};

/// Days of a grid of points: one for each combination of the parameters that do not move the sun's clock.
/// Points whose suns differ in more than the time of day, or not at all, are no day.
pub(super) fn days(points: &[SweepPoint], suns: &[Option<Sun>]) -> Vec<Day> {
    let Some(first) = points.first() else { return Vec::new() };
    let clock: Vec<bool> = (0..first.params.len()).map(|at| is_clock(at, points, suns)).collect();
    if !clock.contains(&true) {
        return Vec::new();
    }
    let others = |point: &SweepPoint| -> Vec<(String, Param)> {
        let kept = point.params.iter().zip(&clock).filter(|(_, is_clock)| !**is_clock);
        kept.map(|(param, _)| param.clone()).collect()
    };
    let groups = grouped((0..points.len()).map(|index| (others(&points[index]), index)));
    groups.into_iter().filter_map(|(params, group)| day(params, &group, points, suns)).collect()
}

/// Returns whether a parameter moves the time of day of the sun's position, and neither date nor place.
fn is_clock(at: usize, points: &[SweepPoint], suns: &[Option<Sun>]) -> bool {
    let others = |point: &SweepPoint| {
        let mut params = point.params.clone();
        params.remove(at);
        params
    };
    let groups = grouped((0..points.len()).map(|index| (others(&points[index]), index)));
    let mut moves = false;
    for (_, group) in &groups {
        for pair in group.windows(2) {
            let (Some(a), Some(b)) = (&suns[pair[0]], &suns[pair[1]]) else { return false };
            if !is_same_day(a, b) {
                return false;
            }
            moves |= a.hour() != b.hour();
        }
    }
    moves
}

/// Returns whether two suns are at the same date and place.
fn is_same_day(a: &Sun, b: &Sun) -> bool {
    a.position.is_some() && a.at_hour(0.0).position == b.at_hour(0.0).position
}

/// Values of parameters, and the points that have them.
type Group = (Vec<(String, Param)>, Vec<usize>);

/// Points of equal parameters, in the order in which they occur.
fn grouped(members: impl Iterator<Item = (Vec<(String, Param)>, usize)>) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    let mut places: HashMap<String, usize> = HashMap::new();
    for (params, member) in members {
        let place = *places.entry(format!("{params:?}")).or_insert(groups.len());
        if place == groups.len() {
            groups.push((params, Vec::new()));
        }
        groups[place].1.push(member);
    }
    groups
}

/// The weights of points of one day; `None` of points that are not at different times of one day.
fn day(
    params: Vec<(String, Param)>,
    group: &[usize],
    points: &[SweepPoint],
    suns: &[Option<Sun>],
) -> Option<Day> {
    let mut moments: Vec<Moment<'_>> = Vec::with_capacity(group.len());
    for &index in group {
        let sun = suns[index].as_ref()?;
        let is_dark = points[index].darkness().is_some();
        moments.push(Moment { index, hour: sun.hour()?, is_dark, sun });
    }
    moments.sort_by(|a, b| a.hour.total_cmp(&b.hour));
    let apart =
        |pair: &[Moment<'_>]| pair[0].hour < pair[1].hour && is_same_day(pair[0].sun, pair[1].sun);
    let (first, last) = (moments.first()?, moments.last()?);
    if moments.len() < 2 || !moments.windows(2).all(apart) {
        return None;
    }
    let span_h = (first.hour, last.hour);
    let weights = weights_h(&moments);
    let traced = moments.iter().zip(weights).filter(|(moment, _)| !moment.is_dark);
    let weights_h = traced.map(|(moment, weight)| (moment.index, weight)).collect();
    Some(Day { params, span_h, weights_h })
}

/// A point at its time of day.
struct Moment<'a> {
    index: usize,
    hour: f64,
    is_dark: bool,
    sun: &'a Sun,
}

/// Weights of the trapezoidal rule, h. Between a dark point and one that is not, the value starts from 0
/// at sunrise, or ends with 0 at sunset.
fn weights_h(moments: &[Moment<'_>]) -> Vec<f64> {
    let mut weights = vec![0.0; moments.len()];
    for (at, pair) in moments.windows(2).enumerate() {
        let [early, late] = pair else { continue };
        let (start, end) = match (early.is_dark, late.is_dark) {
            (true, true) => continue,
            (true, false) => (late.sun.hour_of_horizon(early.hour, late.hour), late.hour),
            (false, true) => (early.hour, early.sun.hour_of_horizon(early.hour, late.hour)),
            (false, false) => (early.hour, late.hour),
        };
        let half = 0.5 * (end - start);
        weights[at] += if early.is_dark { 0.0 } else { half };
        weights[at + 1] += if late.is_dark { 0.0 } else { half };
    }
    weights
}
