//! Column beside a map: the meaning of its colours and lines.

use glam::{DVec2, DVec3};

use super::crowns::{MeshClasses, MeshEntry};
use super::drawing::{Anchor, DrawnItem, Ink, Paint, Stroke};
use super::relief::DrawnRelief;
use super::sensors::{SensorMark, SensorShape};
use super::{INSIDE, MapContents, OUTSIDE, sky};
use crate::components::View;
use crate::counts::counted;
use crate::output::{INK, Letters, tick};

/// Letters of a line of the column.
const LETTERS: usize = 34;

/// Sensors that are listed.
const MOST_SENSORS: usize = 12;

/// Meaning of the colours and lines of a map.
pub(super) struct MapLegend {
    meshes: Vec<MeshEntry>,
    are_pixels: bool,
    lines: Vec<(Swatch, String)>,
    sensors: Vec<String>,
    sun: Option<DVec3>,
    views: Vec<View>,
}

/// Sample of a line or an area.
#[derive(Clone, Copy)]
enum Swatch {
    Border { is_dashed: bool },
    Contour,
    Hole,
    Inside,
    Outside,
}

impl MapLegend {
    pub(super) fn new(
        contents: &MapContents,
        classes: &MeshClasses,
        relief: &DrawnRelief,
        are_pixels: bool,
    ) -> Self {
        let size = contents.tile.size();
        let extent = format!("{} m x {} m", tick(size.x), tick(size.y));
        let is_dashed = contents.is_periodic;
        let border = if is_dashed { "periodic" } else { "ground" };
        let mut lines = vec![(Swatch::Border { is_dashed }, format!("{border}, {extent}"))];
        if let (Some(interval), Some([low, high])) = (relief.interval, contents.relief.range) {
            let z = contents.origin.z;
            let text =
                format!("every {} m, {} to {} m", tick(interval), tick(low + z), tick(high + z));
            lines.push((Swatch::Contour, text));
        }
        if relief.has_holes {
            lines.push((Swatch::Hole, "no ground".to_owned()));
        }
        if !contents.areas.inside.is_empty() {
            lines.push((Swatch::Inside, "stems stand inside".to_owned()));
        }
        if !contents.areas.outside.is_empty() {
            lines.push((Swatch::Outside, "no stems inside".to_owned()));
        }
        Self {
            meshes: classes.entries.clone(),
            are_pixels,
            lines,
            sensors: sensor_lines(&contents.sensors),
            sun: contents.sun,
            views: contents.sensors.iter().flat_map(|mark| mark.views.iter().copied()).collect(),
        }
    }

    /// Width of the column, pixels.
    pub(super) fn width(letters: Letters) -> f64 {
        (LETTERS * letters.width()) as f64
    }

    /// Contents of the map, a line each.
    pub(super) fn lines(&self) -> Vec<String> {
        let meshes = self.meshes.iter().map(mesh_line);
        let lines = self.lines.iter().map(|(swatch, text)| match swatch {
            Swatch::Contour => format!("contours {text}"),
            _ => text.clone(),
        });
        lines.chain(meshes).chain(self.sensors.iter().cloned()).chain([self.sun_line()]).collect()
    }

    fn sun_line(&self) -> String {
        self.sun.map_or_else(
            || "no sun".to_owned(),
            |sun| {
                let zenith = sun.z.clamp(-1.0, 1.0).acos().to_degrees();
                let azimuth = sun.x.atan2(sun.y).to_degrees().rem_euclid(360.0);
                format!("sun {zenith:.1}° from zenith, {azimuth:.1}°")
            },
        )
    }

    /// Draws the column with its upper left corner at a place; returns the height of its end on the page too.
    pub(super) fn draw(&self, at: DVec2, letters: Letters) -> (Vec<DrawnItem>, f64) {
        let line = 1.3 * letters.height() as f64;
        let mut column =
            Column { items: Vec::new(), at: at + DVec2::new(0.0, 0.5 * line), letters, line };
        for (swatch, text) in &self.lines {
            let sample = column.sample(*swatch);
            column.row(sample, text);
        }
        column.at.y += 0.5 * line;
        if self.meshes.is_empty() {
            column.row(Vec::new(), "no instances");
        }
        for mesh in &self.meshes {
            let sample = column.disc(mesh.colour);
            column.row(sample, &mesh_line(mesh));
        }
        if self.are_pixels {
            column.row(Vec::new(), "pixels show their mean");
        }
        column.at.y += 0.5 * line;
        for sensor in &self.sensors {
            column.text(sensor);
        }
        column.at.y += 0.5 * line;
        column.text(&self.sun_line());
        let radius = 4.2 * line;
        let centre =
            column.at + DVec2::new(radius + 2.0 * letters.width() as f64, radius + 0.7 * line);
        column.items.extend(sky::draw(centre, radius, self.sun, &self.views, letters));
        let mut end = centre.y + radius + 1.4 * line;
        column.at.y = end;
        let what = if self.views.is_empty() {
            "sky, zenith in the middle"
        } else {
            "sky: sun and views, zenith mid"
        };
        column.text(what);
        end += line;
        (column.items, end)
    }
}

fn mesh_line(mesh: &MeshEntry) -> String {
    format!("{}: {}", mesh.name, grouped(mesh.instances))
}

/// `1 234 567`.
fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) && digits.len() > 4 {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

fn sensor_lines(sensors: &[SensorMark]) -> Vec<String> {
    let line = |(index, mark): (usize, &SensorMark)| {
        let place = if mark.shape == SensorShape::Whole { ", all" } else { "" };
        format!("{} {} ({}{place})", index + 1, mark.name, mark.kind)
    };
    let mut lines: Vec<String> = sensors.iter().enumerate().map(line).collect();
    if lines.len() > MOST_SENSORS {
        let more = lines.len() - (MOST_SENSORS - 1);
        lines.truncate(MOST_SENSORS - 1);
        lines.push(format!("and {}", counted(more, "more sensor")));
    }
    lines
}

/// Rows of the column from its top to its bottom.
struct Column {
    items: Vec<DrawnItem>,
    /// Place of the next row: its left end and the middle of its height.
    at: DVec2,
    letters: Letters,
    line: f64,
}

impl Column {
    /// Room for a sample.
    const SAMPLE: f64 = 22.0;

    fn row(&mut self, sample: Vec<DrawnItem>, text: &str) {
        self.items.extend(sample);
        let start = self.at + DVec2::new(Self::SAMPLE + 8.0, 0.0);
        let letters = LETTERS - (Self::SAMPLE as usize + 8).div_ceil(self.letters.width());
        let text = self.letters.fitted(text, letters * self.letters.width());
        self.items.push(DrawnItem::text(start, text, Anchor::Start));
        self.at.y += self.line;
    }

    fn text(&mut self, text: &str) {
        let text = self.letters.fitted(text, LETTERS * self.letters.width());
        self.items.push(DrawnItem::text(self.at, text, Anchor::Start));
        self.at.y += self.line;
    }

    fn disc(&self, colour: [u8; 3]) -> Vec<DrawnItem> {
        let dark = colour.map(|channel| (u16::from(channel) * 3 / 5) as u8);
        let paint = Paint {
            fill: Some(Ink::solid(colour)),
            stroke: Some(Stroke { ink: Ink::solid(dark), width: 0.8, is_dashed: false }),
        };
        let centre = self.at + DVec2::new(0.5 * Self::SAMPLE, 0.0);
        vec![DrawnItem::Circle { centre, radius: 6.0, paint }]
    }

    fn sample(&self, swatch: Swatch) -> Vec<DrawnItem> {
        let (left, right) = (self.at, self.at + DVec2::new(Self::SAMPLE, 0.0));
        let half = DVec2::new(0.0, 6.0);
        match swatch {
            Swatch::Border { is_dashed: true } => {
                vec![DrawnItem::line(left, right, Paint::dashes(Ink::solid(INK), 2.0))]
            }
            Swatch::Border { is_dashed: false } => {
                vec![DrawnItem::line(left, right, Paint::line(Ink::solid(INK), 1.2))]
            }
            Swatch::Contour => {
                vec![DrawnItem::line(left, right, Paint::line(Ink::solid([120, 90, 50]), 1.2))]
            }
            Swatch::Hole => {
                vec![DrawnItem::rectangle(
                    left - half,
                    right + half,
                    Paint::fill(Ink::solid([205, 205, 215])),
                )]
            }
            Swatch::Inside => {
                vec![DrawnItem::rectangle(
                    left - half,
                    right + half,
                    Paint::line(Ink::solid(INSIDE), 1.6),
                )]
            }
            Swatch::Outside => {
                let paint = Paint {
                    fill: Some(Ink::with_opacity(OUTSIDE, 0.12)),
                    ..Paint::line(Ink::solid(OUTSIDE), 1.6)
                };
                vec![DrawnItem::rectangle(left - half, right + half, paint)]
            }
        }
    }
}
