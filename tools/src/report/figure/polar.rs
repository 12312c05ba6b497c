//! Values by direction, as seen from above.

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

impl Hemisphere {
    /// The drawing, with north at the top and east on the right: zenith angles are distances from the centre.
    pub(crate) fn draw(&self) -> Markup {
        let finite = self.views.iter().map(|view| view.value).filter(|value| value.is_finite());
        let (low, high) =
            finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = if low < high { (low, high) } else { (low - 0.5, low + 0.5) };
        let fraction = |value: f64| (value - low) / (high - low);
        let fill = |view: &View| {
            if view.value.is_finite() { colour(fraction(view.value)) } else { "none".to_owned() }
        };
        html! {
            svg.polar viewBox={ "0 0 " (SIDE.0) " " (SIDE.1) } role="img" aria-label={ (cut(&self.title, 200)) " by view direction, from " (tick(low)) " to " (tick(high)) } {
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
                (bar(low, high))
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
fn bar(low: f64, high: f64) -> Markup {
    const STEPS: usize = 40;
    let (left, width, top) = (35.0, 260.0, 334.0);
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
    fn east_is_on_the_right_and_north_at_the_top() {
        let (east, north) = (place(90.0, 90.0), place(90.0, 0.0));
        assert!(east.0 > CENTRE.0 + 100.0 && (east.1 - CENTRE.1).abs() < 1e-9);
        assert!(north.1 < CENTRE.1 - 100.0);
        assert_eq!([colour(0.0), colour(1.0)], ["#440154", "#fde725"]);
    }
}
