//! Quadrature of smooth functions, such as Planck's radiance, times a response.

use super::{CurveShape, Point};

/// Number of wavelengths of the rule for smooth functions in each panel.
const SMOOTH: usize = 16;

/// Largest ratio of the ends of a panel: Planck's radiance comes out to 1e-10 between them.
const PANEL: f64 = 1.5;

/// Rule for means of smooth functions.
pub(super) fn smooth_rule(shape: &CurveShape, nodes: &[f64]) -> Vec<Point> {
    let (low, high) = (nodes[0], nodes[nodes.len() - 1]);
    let panels = if low > 0.0 { ((high / low).ln() / PANEL.ln()).ceil().max(1.0) } else { 1.0 };
    let edge = |panel: f64| low * (high / low).powf(panel / panels);
    let mut rule = Vec::new();
    for panel in 0..panels as u32 {
        let from = if panel == 0 { low } else { edge(f64::from(panel)) };
        let to = if f64::from(panel) + 1.0 < panels { edge(f64::from(panel) + 1.0) } else { high };
        let within = nodes.iter().copied().filter(|node| (from..to).contains(node) && *node > from);
        let own: Vec<f64> = [from].into_iter().chain(within).chain([to]).collect();
        rule.extend(rule_of_panel(shape, &own));
    }
    let total: f64 = rule.iter().map(|(_, weight)| weight).sum();
    for (_, weight) in &mut rule {
        *weight /= total;
    }
    rule
}

/// Rule for integrals of smooth functions times the response: the function is replaced by the polynomial through its values
/// at Chebyshev's points of the range, whose integral is exact. Empty if there is no response.
fn rule_of_panel(shape: &CurveShape, nodes: &[f64]) -> Vec<Point> {
    let (low, high) = (nodes[0], nodes[nodes.len() - 1]);
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let angle = |index: usize| std::f64::consts::PI * (index as f64 + 0.5) / SMOOTH as f64;
    let points: Vec<f64> = (0..SMOOTH).map(|index| angle(index).cos()).collect();
    let sign = |index: usize| if index.is_multiple_of(2) { 1.0 } else { -1.0 };
    let barycentric: Vec<f64> = (0..SMOOTH).map(|index| sign(index) * angle(index).sin()).collect();
    let (mut weights, mut total) = ([0.0; SMOOTH], 0.0);
    shape.for_each_node(nodes, |at, part| {
        let x = (at - middle) / half;
        total += part;
        if let Some(hit) = points.iter().position(|point| (x - point).abs() < 1e-14) {
            weights[hit] += part;
            return;
        }
        let terms = || points.iter().zip(&barycentric).map(|(point, weight)| weight / (x - point));
        let sum: f64 = terms().sum();
        for (weight, term) in weights.iter_mut().zip(terms()) {
            *weight += part * term / sum;
        }
    });
    if total <= 0.0 {
        return Vec::new();
    }
    points.iter().zip(weights).map(|(x, weight)| (middle + half * x, weight)).collect()
}
