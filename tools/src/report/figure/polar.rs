//! Values by direction, as seen from above.

use std::ops::Range;

use maud::{Markup, html};
use sunfleck::output::tick;

use super::px;
use crate::report::words::{cut, measured};

/// Size of the drawing.
const SIDE: (f64, f64) = (330.0, 372.0);
/// Centre, and radius of the horizon.
const CENTRE: (f64, f64) = (165.0, 172.0);
const HORIZON: f64 = 138.0;

/// Colours from low to high, of the same order in brightness.
///
/// Source: the colour map "viridis" of Smith and van der Walt (2015), CC0; eight of its colours.
const COLOURS: [[u8; 3]; 8] = [
    [68, 1, 84],
    [70, 50, 127],
    [54, 92, 141],
    [39, 127, 142],
    [31, 161, 135],
    [74, 194, 109],
    [159, 218, 58],
    [253, 231, 37],
];

/// A value towards a direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    /// Angle from the vertical, degrees.
    pub(crate) zenith: f64,
    /// Clockwise from north, degrees.
    pub(crate) azimuth: f64,
    pub(crate) value: f64,
    pub(crate) error: f64,
}

/// Values all over the hemisphere.
#[derive(Clone, Debug)]
pub(crate) struct Hemisphere {
    pub(crate) title: String,
    pub(crate) views: Vec<View>,
    /// Zenith angle and azimuth of the sun, degrees, if they are known.
    pub(crate) sun: Option<[f64; 2]>,
    /// True if the views are the middles of cells that cover the hemisphere.
    pub(crate) are_cells: bool,
}

/// A part of a ring about the zenith.
struct Sector {
    zenith: [f64; 2],
    azimuth: [f64; 2],
    view: View,
}

/// Fraction of a range that the values of a panel must fill at least to share its colours.
const FILLED: f64 = 1.0 / 3.0;

/// Range of values of several hemispheres that are legible with the same colours; `None` of others and of a single one.
pub(crate) fn common_range(all: &[Hemisphere]) -> Option<Range<f64>> {
    let ranges: Vec<Range<f64>> = all.iter().map(Hemisphere::range).collect();
    let low = ranges.iter().map(|range| range.start).fold(f64::INFINITY, f64::min);
    let high = ranges.iter().map(|range| range.end).fold(f64::NEG_INFINITY, f64::max);
    let is_legible = |range: &Range<f64>| range.end - range.start >= FILLED * (high - low);
    (all.len() > 1 && ranges.iter().all(is_legible)).then_some(low..high)
}

/// Colour bar of several hemispheres, with the quantity and its unit.
pub(crate) fn colour_bar(range: &Range<f64>, title: &str) -> Markup {
    html! {
        svg.bars viewBox="0 0 330 52" role="img" aria-label={ (cut(title, 200)) ", from " (tick(range.start)) " to " (tick(range.end)) } {
            text x="165" y="12" text-anchor="middle" { (cut(title, 44)) }
            (bar(range, 18.0))
        }
    }
}

impl Hemisphere {
    /// Range of its values, not empty.
    fn range(&self) -> Range<f64> {
        let finite = self.views.iter().map(|view| view.value).filter(|value| value.is_finite());
        let (low, high) =
            finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        if low < high {
            low..high
        } else if low.is_finite() {
            low - 0.5..high + 0.5
        } else {
            0.0..1.0
        }
    }

    /// The drawing, with north at the top and east on the right: zenith angles are distances from the centre.
    ///
    /// - `common`: range of the colours of all panels, which have one bar then; without it, the panel has its own bar
    pub(crate) fn draw(&self, common: Option<&Range<f64>>) -> Markup {
        let range = common.cloned().unwrap_or_else(|| self.range());
        let (low, high) = (range.start, range.end);
        let height = if common.is_some() { SIDE.1 - 42.0 } else { SIDE.1 };
        let fraction = |value: f64| (value - low) / (high - low);
        let fill = |view: &View| {
            if view.value.is_finite() { colour(fraction(view.value)) } else { "none".to_owned() }
        };
        html! {
            svg.polar viewBox={ "0 0 " (SIDE.0) " " (height) } role="img" aria-label={ (cut(&self.title, 200)) " by view direction, from " (tick(low)) " to " (tick(high)) } {
                text.head x="8" y="16" { (cut(&self.title, 44)) }
                @if self.are_cells {
                    @for sector in self.sectors() {
                        path.cell d=(sector.outline()) fill=(fill(&sector.view)) { title { (tooltip(&sector.view)) } }
                    }
                } @else {
                    @for view in &self.views {
                        @let (x, y) = place(view.zenith, view.azimuth);
                        circle.cell cx=(px(x)) cy=(px(y)) r="6" fill=(fill(view)) { title { (tooltip(view)) } }
                    }
                }
                @for zenith in [30.0, 60.0, 90.0] {
                    circle.ring cx=(CENTRE.0) cy=(CENTRE.1) r=(px(radius(zenith))) {}
                    @let (x, y) = place(zenith, 68.0);
                    text.halo x=(px(x)) y=(px(y + 4.0)) text-anchor="middle" { (zenith) "°" }
                }
                @for (name, azimuth) in [("N", 0.0), ("E", 90.0), ("S", 180.0), ("W", 270.0)] {
                    @let (x, y) = place(98.0, azimuth);
                    text x=(px(x)) y=(px(y + 4.0)) text-anchor="middle" { (name) }
                }
                @if let Some([zenith, azimuth]) = self.sun { (sun(zenith, azimuth)) }
                @if common.is_none() { (bar(&range, 334.0)) }
            }
        }
    }

    /// Cells about their middles: rings of equal zenith angle, cut into equal parts.
    fn sectors(&self) -> Vec<Sector> {
        let mut sectors = Vec::new();
        // The cosine of a ring's middle is the mean of those of its bounds.
        let mut upper: f64 = 1.0;
        let mut views = self.views.clone();
        views.sort_by(|a, b| a.zenith.total_cmp(&b.zenith));
        for ring in views.chunk_by(|a, b| (a.zenith - b.zenith).abs() < 1e-6) {
            let middle = ring[0].zenith.to_radians().cos();
            let lower = (2.0 * middle - upper).clamp(-1.0, 1.0);
            let zenith = [upper, lower].map(|cosine| cosine.acos().to_degrees());
            let half = 180.0 / ring.len() as f64;
            sectors.extend(ring.iter().map(|view| Sector {
                zenith,
                azimuth: [view.azimuth - half, view.azimuth + half],
                view: *view,
            }));
            upper = lower;
        }
        sectors
    }
}

impl Sector {
    fn outline(&self) -> String {
        let [inner, outer] = self.zenith.map(radius);
        let [from, to] = self.azimuth;
        if to - from > 359.9 {
            let (x, y) = CENTRE;
            return format!(
                "M{} {y}a{r} {r} 0 1 0 {d} 0a{r} {r} 0 1 0 -{d} 0z",
                px(x - outer),
                r = px(outer),
                d = px(2.0 * outer)
            );
        }
        let corner = |zenith: f64, azimuth: f64| {
            let (x, y) = place(zenith, azimuth);
            format!("{} {}", px(x), px(y))
        };
        let large = u8::from(to - from > 180.0);
        format!(
            "M{}A{r} {r} 0 {large} 1 {}L{}A{s} {s} 0 {large} 0 {}z",
            corner(self.zenith[1], from),
            corner(self.zenith[1], to),
            corner(self.zenith[0], to),
            corner(self.zenith[0], from),
            r = px(outer),
            s = px(inner),
        )
    }
}

fn radius(zenith: f64) -> f64 {
    HORIZON * zenith / 90.0
}

fn place(zenith: f64, azimuth: f64) -> (f64, f64) {
    let (sin, cos) = azimuth.to_radians().sin_cos();
    (CENTRE.0 + radius(zenith) * sin, CENTRE.1 - radius(zenith) * cos)
}

fn tooltip(view: &View) -> String {
    format!(
        "zenith {}°, azimuth {}°: {}",
        tick(view.zenith),
        tick(view.azimuth),
        measured(view.value, view.error)
    )
}

/// Where a sensor has the sun behind it.
fn sun(zenith: f64, azimuth: f64) -> Markup {
    let (x, y) = place(zenith.abs(), azimuth);
    html! {
        g.sun {
            title { "direction of the sun: hot spot at zenith " (tick(zenith)) "°, azimuth " (tick(azimuth)) "°" }
            circle.outer cx=(px(x)) cy=(px(y)) r="6.5" {}
            circle.inner cx=(px(x)) cy=(px(y)) r="1.8" {}
        }
    }
}

/// Colour bar with the numbers of its ends and its middle.
fn bar(range: &Range<f64>, top: f64) -> Markup {
    const STEPS: usize = 40;
    let (left, width) = (35.0, 260.0);
    let (low, high) = (range.start, range.end);
    let step = width / STEPS as f64;
    html! {
        @for number in 0..STEPS {
            rect x=(px(left + number as f64 * step)) y=(top) width=(step + 0.4) height="12" fill=(colour((number as f64 + 0.5) / STEPS as f64)) {}
        }
        @for (value, fraction, anchor) in [(low, 0.0, "start"), (0.5 * (low + high), 0.5, "middle"), (high, 1.0, "end")] {
            text x=(px(left + fraction * width)) y=(px(top + 26.0)) text-anchor=(anchor) { (tick(value)) }
        }
    }
}

/// Colour of a fraction from 0 to 1.
pub(super) fn colour(fraction: f64) -> String {
    let place = fraction.clamp(0.0, 1.0) * (COLOURS.len() - 1) as f64;
    let below = (place as usize).min(COLOURS.len() - 2);
    let part = place - below as f64;
    let mixed: Vec<String> = (0..3)
        .map(|channel| {
            let [low, high] = [below, below + 1].map(|at| f64::from(COLOURS[at][channel]));
            format!("{:02x}", (low + part * (high - low)).round() as u8)
        })
        .collect();
    format!("#{}", mixed.concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(zenith: f64, azimuth: f64) -> View {
        View { zenith, azimuth, value: 0.0, error: 0.0 }
    }

    #[test]
    fn cells_of_rings_touch_each_other_and_reach_the_horizon() {
        // A cap of a quarter of the hemisphere and a ring of three parts, all of the same solid angle.
        let ring =
            |number: i32| view(0.375_f64.acos().to_degrees(), 60.0 + 120.0 * f64::from(number));
        let cap = view(0.875_f64.acos().to_degrees(), 180.0);
        let views = (0..3).map(ring).chain([cap]).collect();
        let hemisphere = Hemisphere { title: String::new(), views, sun: None, are_cells: true };
        let sectors = hemisphere.sectors();
        assert_eq!(sectors.len(), 4);
        assert!(sectors[0].zenith[0].abs() < 1e-6);
        assert!((sectors[0].zenith[1].to_radians().cos() - 0.75).abs() < 1e-9);
        assert!((sectors[1].zenith[1] - 90.0).abs() < 1e-6);
        assert!(
            (sectors[1].azimuth[0]).abs() < 1e-9 && (sectors[3].azimuth[1] - 360.0).abs() < 1e-9
        );
    }

    #[test]
    fn panels_share_a_bar_if_each_fills_a_third_of_it() {
        let of = |low: f64, high: f64| {
            let views = [low, high].map(|value| View { value, ..view(10.0, 0.0) }).to_vec();
            Hemisphere { title: String::new(), views, sun: None, are_cells: false }
        };
        assert_eq!(common_range(&[of(0.1, 0.3), of(0.2, 0.4)]), Some(0.1..0.4));
        assert_eq!(common_range(&[of(0.01, 0.03), of(0.2, 0.4)]), None, "red and near infrared");
        assert_eq!(common_range(&[of(0.1, 0.3)]), None, "a single panel has its own");
        let bars = |common: Option<&Range<f64>>| {
            of(0.1, 0.3).draw(common).into_string().matches("<rect").count()
        };
        assert_eq!([bars(None), bars(Some(&(0.1..0.4)))], [40, 0]);
        assert_eq!(colour_bar(&(0.1..0.4), "BRF (–)").into_string().matches("<rect").count(), 40);
    }

    #[test]
    fn east_is_on_the_right_and_north_at_the_top() {
        let (east, north) = (place(90.0, 90.0), place(90.0, 0.0));
        assert!(east.0 > CENTRE.0 + 100.0 && (east.1 - CENTRE.1).abs() < 1e-9);
        assert!(north.1 < CENTRE.1 - 100.0);
        assert_eq!([colour(0.0), colour(1.0)], ["#440154", "#fde725"]);
    }
}
