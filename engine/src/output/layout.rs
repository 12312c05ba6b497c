//! Parts of a figure around its picture: title, legend and scale.

use std::ops::Range;

use super::legend::{Bar, Entries, PictureLegend, common_bar};
use super::lettering::{Canvas, INK, Letters, PixelRectangle};
use super::picture::{GAMMA, byte};
use super::scale::tick;
use crate::products::{Class, Georeference};

/// Colours of the squares behind pixels without data.
pub(super) const NO_DATA: [[u8; 3]; 2] = [[240; 3], [215; 3]];

/// Text about ends of bars beyond which values lie.
const CLIPPED: &str = "≤ ≥: clipped at 1st and 99th percentile";

/// ``x 0 to 20 m, y 0 to 10 m``.
pub(super) fn extent(place: &Georeference, (width, height): (usize, usize)) -> String {
    let east = place.west + place.pixel_width * width as f64;
    let south = place.north - place.pixel_height * height as f64;
    let [west, east, south, north] = [place.west, east, south, place.north].map(metres);
    format!("x {west} to {east} m, y {south} to {north} m")
}

/// A coordinate in whole millimetres.
fn metres(length: f64) -> String {
    let text = format!("{length:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// A part of a figure, from its top to its bottom.
pub(super) enum Row {
    Text(String),
    Gap(usize),
    /// Room for the enlarged picture.
    Picture {
        width: usize,
        height: usize,
    },
    Scale {
        place: Georeference,
        zoom: usize,
        width: usize,
    },
    Ramp(Bar),
    Class(Class),
    NoData,
}

/// Rows of a figure.
pub(super) struct Layout {
    pub(super) letters: Letters,
    /// Width of the margin, pixels.
    pub(super) margin: usize,
    /// Width of the rows, pixels.
    pub(super) width: usize,
    pub(super) rows: Vec<Row>,
}

impl Layout {
    pub(super) fn text(&mut self, text: &str) {
        self.rows.push(Row::Text(self.letters.fitted(text, self.width)));
    }

    /// Leaves a part of a line free.
    pub(super) fn gap(&mut self, part: usize) {
        self.rows.push(Row::Gap(self.letters.height() / part));
    }

    pub(super) fn legend(&mut self, legend: &PictureLegend, unit: &str) {
        match &legend.entries {
            Entries::Bars(bars) => {
                let common = common_bar(bars);
                for bar in bars {
                    self.text(&heading(bar, bars.len(), unit));
                    if common.is_none() {
                        self.rows.push(Row::Ramp(bar.clone()));
                        self.gap(4);
                    }
                }
                if let Some(common) = common {
                    self.rows.push(Row::Ramp(common));
                    self.gap(4);
                }
                if bars.iter().any(|bar| bar.is_clipped.contains(&true)) {
                    self.text(CLIPPED);
                }
            }
            Entries::Classes(classes, how) => {
                self.text(how);
                self.rows.extend(classes.iter().cloned().map(Row::Class));
            }
            Entries::Text(lines) => lines.iter().for_each(|line| self.text(line)),
        }
        self.rows.extend(legend.zero.iter().cloned().map(Row::Class));
    }

    fn height(&self, row: &Row) -> usize {
        let line = self.letters.height();
        match row {
            Row::Text(_) | Row::Class(_) | Row::NoData => line + line / 4,
            Row::Gap(height) | Row::Picture { height, .. } => *height,
            Row::Scale { .. } => 2 * line,
            // The ramp, and its numbers below.
            Row::Ramp(_) => 2 * line + line / 4,
        }
    }

    /// Width of the figure, pixels.
    pub(super) const fn full_width(&self) -> usize {
        self.width + 2 * self.margin
    }

    /// Height of the figure, pixels.
    pub(super) fn full_height(&self) -> usize {
        self.rows.iter().map(|row| self.height(row)).sum::<usize>() + 2 * self.margin
    }

    /// Place of the picture.
    pub(super) fn picture(&self) -> PixelRectangle {
        let mut top = self.margin;
        for row in &self.rows {
            if let Row::Picture { width, height } = *row {
                // In the middle, if letters take more room.
                return PixelRectangle { left: self.left_of(width), top, width, height };
            }
            top += self.height(row);
        }
        PixelRectangle { left: self.margin, top, width: 0, height: 0 }
    }

    /// Left side of something as wide as the picture.
    const fn left_of(&self, width: usize) -> usize {
        self.margin + (self.width - width) / 2
    }

    /// Draws all that is between two rows of pixels, but no picture. No part of the figure lies in two such ranges.
    pub(super) fn draw(&self, pixels: Range<usize>) -> Canvas {
        let mut canvas = Canvas::new(self.full_width(), pixels.len());
        let mut top = self.margin;
        for row in &self.rows {
            if top >= pixels.start && top + self.height(row) <= pixels.end {
                self.draw_row(row, top - pixels.start, &mut canvas);
            }
            top += self.height(row);
        }
        canvas
    }

    fn draw_row(&self, row: &Row, top: usize, canvas: &mut Canvas) {
        let left = self.margin;
        match row {
            Row::Text(text) => canvas.write(text, (left, top), self.letters),
            Row::Gap(_) | Row::Picture { .. } => {}
            Row::Scale { place, zoom, width } => {
                let (left, width) = (self.left_of(*width), *width);
                let pixel = place.pixel_width / *zoom as f64;
                self.draw_scale(PixelRectangle { left, top, width, height: 0 }, pixel, canvas);
            }
            Row::Ramp(bar) => self.draw_ramp(bar, top, canvas),
            Row::Class(class) => {
                self.draw_swatch(&class.name, Swatch::Plain(class.colour), top, canvas);
            }
            Row::NoData => self.draw_swatch("no data", Swatch::NoData, top, canvas),
        }
    }

    /// A bar of a round length on the left, and an arrow to the north on the right.
    fn draw_scale(&self, row: PixelRectangle, pixel: f64, canvas: &mut Canvas) {
        let line = self.letters.height();
        let thickness = (line / 8).max(1);
        let length = round_length(pixel * 0.4 * row.width as f64);
        let width = ((length / pixel).round() as usize).max(1);
        let top = row.top + line / 2;
        let (left, height) = (row.left, 2 * thickness);
        canvas.fill(PixelRectangle { left, top, width, height }, INK);
        for end in [left, left + width.saturating_sub(thickness)] {
            let tooth = PixelRectangle {
                left: end,
                top: row.top + line / 4,
                width: thickness,
                height: line / 2,
            };
            canvas.fill(tooth, INK);
        }
        let text = format!("{} m", tick(length));
        canvas.write(&text, (left + width + self.letters.width(), row.top), self.letters);
        let tip = (row.left + row.width).saturating_sub(line);
        for step in 0..line {
            // A triangle that widens downwards, twice as high as wide.
            let half = step / 4;
            let left = tip - half.min(tip);
            let area = PixelRectangle { left, top: row.top + step, width: 2 * half + 1, height: 1 };
            canvas.fill(area, INK);
        }
        let shaft =
            PixelRectangle { left: tip, top: row.top, width: thickness, height: line + line / 2 };
        canvas.fill(shaft, INK);
        let name = (tip.saturating_sub(2 * self.letters.width()), row.top);
        canvas.write("N", name, self.letters);
    }

    /// A ramp of colours over the numbers of its ends and its middle.
    fn draw_ramp(&self, bar: &Bar, top: usize, canvas: &mut Canvas) {
        let (left, width, height) = (self.margin, self.width, self.letters.height());
        for x in 0..width {
            let part = x as f32 / (width.max(2) - 1) as f32;
            let level = byte(part.powf(GAMMA.recip()));
            let colour = bar.channels.map(|is_shown| if is_shown { level } else { 0 });
            canvas.fill(PixelRectangle { left: left + x, top, width: 1, height }, colour);
        }
        canvas.frame(PixelRectangle { left, top, width, height }, 1, INK);
        for (text, part) in bar.numbers().iter().zip([0.0, 0.5, 1.0]) {
            let room = width.saturating_sub(self.letters.width_of(text));
            let place = (left + (part * room as f64) as usize, top + height + height / 8);
            canvas.write(text, place, self.letters);
        }
    }

    /// A square and what its colour means.
    fn draw_swatch(&self, name: &str, swatch: Swatch, top: usize, canvas: &mut Canvas) {
        let (left, side) = (self.margin, self.letters.height());
        let area = PixelRectangle { left, top, width: 2 * side, height: side };
        match swatch {
            Swatch::Plain(colour) => canvas.fill(area, colour),
            Swatch::NoData => draw_no_data(area, self.letters, canvas),
        }
        canvas.frame(area, 1, INK);
        let text = self.letters.fitted(name, self.width.saturating_sub(3 * side));
        canvas.write(&text, (left + 2 * side + side / 2, top), self.letters);
    }
}

/// Fill of a square of a legend.
#[derive(Clone, Copy)]
enum Swatch {
    Plain([u8; 3]),
    NoData,
}

/// ``red: nir (865 nm), W m-2 sr-1 nm-1``.
fn heading(bar: &Bar, bars: usize, unit: &str) -> String {
    let channel = match bar.channels {
        _ if bars == 1 => "",
        [true, false, false] => "red: ",
        [false, true, false] => "green: ",
        [false, false, true] => "blue: ",
        [false, true, true] => "cyan: ",
        [true, false, true] => "magenta: ",
        [true, true, false] => "yellow: ",
        _ => "",
    };
    let wavelength = match bar.wavelength {
        Some(nm) if nm >= 3000.0 => format!(" ({} µm)", tick(nm / 1000.0)),
        Some(nm) => format!(" ({} nm)", tick(nm)),
        None => String::new(),
    };
    let unit = if unit == "1" { String::new() } else { format!(", {unit}") };
    format!("{channel}{}{wavelength}{unit}", bar.name)
}

/// The largest of 1, 2 and 5 times a power of ten that is not above a length.
fn round_length(most: f64) -> f64 {
    let power = 10_f64.powf(most.log10().floor());
    let factor = [5.0, 2.0].into_iter().find(|factor| factor * power <= most).unwrap_or(1.0);
    factor * power
}

/// Squares of two greys.
fn draw_no_data(area: PixelRectangle, letters: Letters, canvas: &mut Canvas) {
    let side = (letters.height() / 2).max(1);
    for y in area.top..area.top + area.height {
        for x in area.left..area.left + area.width {
            let is_odd = ((x - area.left) / side + (y - area.top) / side) % 2;
            canvas.mix((x, y), NO_DATA[is_odd], 255);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_round_and_fit() {
        let lengths = [0.07, 1.0, 1.9, 4.99, 37.0, 600.0].map(round_length);
        for (found, expected) in lengths.iter().zip([0.05, 1.0, 1.0, 2.0, 20.0, 500.0]) {
            assert!((found - expected).abs() < 1e-9 * expected, "{lengths:?}");
        }
    }
}
