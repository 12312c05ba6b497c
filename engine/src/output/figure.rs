//! Pictures with title, legend and scale around the pixels.

use std::io::{self, Write};

use super::legend::{Bar, Entries, Legend};
use super::lettering::{Area, Canvas, INK, Letters};
use super::picture::{GAMMA, Pixels, RgbaPicture, byte, encode_png};
use super::scale::tick;
use crate::products::{Class, Georeference, Image};

/// Larger side that small pictures are enlarged to, by whole numbers, pixels.
const SMALLEST: usize = 320;
/// Letters that a line has room for at least.
const LETTERS: usize = 44;
/// Colours of the squares behind pixels without data.
const NO_DATA: [[u8; 3]; 2] = [[240; 3], [215; 3]];

/// Caption above a picture.
#[derive(Clone, Debug)]
pub(super) struct Caption<'a> {
    /// Sensor and measured quantity.
    pub(super) title: String,
    /// Title of the scene.
    pub(super) scene: &'a str,
    /// Unit of the values; `1` of a fraction.
    pub(super) unit: &'a str,
}

/// A picture with title, legend and scale around it.
#[derive(Debug)]
pub(super) struct Figure {
    canvas: Canvas,
}

impl Figure {
    /// The picture of `image`, read by `legend`.
    pub(super) fn new(
        (picture, legend): (&RgbaPicture, &Legend),
        image: &Image,
        caption: &Caption<'_>,
    ) -> Self {
        let zoom = SMALLEST.div_ceil(picture.width.max(picture.height).max(1)).max(1);
        let letters = Letters::for_width(zoom * picture.width);
        let margin = letters.height();
        let width = (zoom * picture.width).max(LETTERS * letters.width());
        let mut layout = Layout { letters, margin, width, rows: Vec::new() };
        layout.text(&caption.title);
        if !caption.scene.is_empty() {
            layout.text(caption.scene);
        }
        layout.gap(4);
        layout.rows.push(Row::Picture { zoom });
        layout.gap(2);
        if let Some(place) = image.georeference {
            layout.rows.push(Row::Scale { place, zoom });
            layout.text(&extent(&place, picture));
            layout.gap(2);
        }
        let has_holes = picture.rgba.chunks_exact(4).any(|pixel| pixel[3] == 0);
        let is_blank = picture.rgba.chunks_exact(4).all(|pixel| pixel[3] == 0);
        layout.legend(legend, caption.unit);
        if is_blank {
            layout.text("no pixel shows anything of the scene");
        } else if has_holes {
            layout.rows.push(Row::NoData);
        }
        if !legend.dark.is_empty() {
            layout.text(&format!("not shown, without light: {}", legend.dark.join(", ")));
        }
        Self { canvas: layout.draw(picture) }
    }

    /// Writes a PNG with `texts` (keyword, text) as its metadata.
    ///
    /// # Errors
    /// If `file` cannot be written.
    pub(super) fn encode(&self, texts: &[(&str, String)], file: &mut impl Write) -> io::Result<()> {
        let Canvas { width, height, rgb } = &self.canvas;
        let size = (*width, *height);
        encode_png(&Pixels { size, colour: png::ColorType::Rgb, bytes: rgb }, texts, file)
    }
}

/// ``x 0 to 20 m, y 0 to 10 m``.
fn extent(place: &Georeference, picture: &RgbaPicture) -> String {
    let east = place.west + place.pixel_width * picture.width as f64;
    let south = place.north - place.pixel_height * picture.height as f64;
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
enum Row {
    Text(String),
    Gap(usize),
    Picture { zoom: usize },
    Scale { place: Georeference, zoom: usize },
    Ramp(Bar),
    Class(Class),
    NoData,
}

/// Rows of a figure.
struct Layout {
    letters: Letters,
    /// Width of the margin, pixels.
    margin: usize,
    /// Width of the rows, pixels.
    width: usize,
    rows: Vec<Row>,
}

impl Layout {
    fn text(&mut self, text: &str) {
        self.rows.push(Row::Text(self.letters.fitted(text, self.width)));
    }

    /// Leaves a part of a line free.
    fn gap(&mut self, part: usize) {
        self.rows.push(Row::Gap(self.letters.height() / part));
    }

    fn legend(&mut self, legend: &Legend, unit: &str) {
        match &legend.entries {
            Entries::Bars(bars) => {
                for bar in bars {
                    self.text(&heading(bar, bars.len(), unit));
                    self.rows.push(Row::Ramp(bar.clone()));
                    self.gap(4);
                }
            }
            Entries::Classes(classes, how) => {
                self.text(how);
                self.rows.extend(classes.iter().cloned().map(Row::Class));
            }
            Entries::Text(lines) => lines.iter().for_each(|line| self.text(line)),
        }
    }

    fn height(&self, row: &Row, picture: &RgbaPicture) -> usize {
        let line = self.letters.height();
        match row {
            Row::Text(_) | Row::Class(_) | Row::NoData => line + line / 4,
            Row::Gap(height) => *height,
            Row::Picture { zoom } => zoom * picture.height,
            Row::Scale { .. } => 2 * line,
            // The ramp, and its numbers below.
            Row::Ramp(_) => 2 * line + line / 4,
        }
    }

    fn draw(&self, picture: &RgbaPicture) -> Canvas {
        let rows: usize = self.rows.iter().map(|row| self.height(row, picture)).sum();
        let mut canvas = Canvas::new(self.width + 2 * self.margin, rows + 2 * self.margin);
        let mut top = self.margin;
        for row in &self.rows {
            self.draw_row(row, top, picture, &mut canvas);
            top += self.height(row, picture);
        }
        canvas
    }

    fn draw_row(&self, row: &Row, top: usize, picture: &RgbaPicture, canvas: &mut Canvas) {
        let left = self.margin;
        match row {
            Row::Text(text) => canvas.write(text, (left, top), self.letters),
            Row::Gap(_) => {}
            Row::Picture { zoom } => {
                // In the middle, if letters take more room.
                let left = left + (self.width - zoom * picture.width) / 2;
                draw_picture(picture, *zoom, (left, top), self.letters, canvas);
            }
            Row::Scale { place, zoom } => {
                let left = left + (self.width - zoom * picture.width) / 2;
                let width = zoom * picture.width;
                let pixel = place.pixel_width / *zoom as f64;
                self.draw_scale(Area { left, top, width, height: 0 }, pixel, canvas);
            }
            Row::Ramp(bar) => self.draw_ramp(bar, top, canvas),
            Row::Class(class) => {
                self.draw_swatch(&class.name, Swatch::Plain(class.colour), top, canvas);
            }
            Row::NoData => self.draw_swatch("no data", Swatch::NoData, top, canvas),
        }
    }

    /// A bar of a round length on the left, and an arrow to the north on the right.
    fn draw_scale(&self, row: Area, pixel: f64, canvas: &mut Canvas) {
        let line = self.letters.height();
        let thickness = (line / 8).max(1);
        let length = round_length(pixel * 0.4 * row.width as f64);
        let width = ((length / pixel).round() as usize).max(1);
        let top = row.top + line / 2;
        let (left, height) = (row.left, 2 * thickness);
        canvas.fill(Area { left, top, width, height }, INK);
        for end in [left, left + width.saturating_sub(thickness)] {
            let tooth =
                Area { left: end, top: row.top + line / 4, width: thickness, height: line / 2 };
            canvas.fill(tooth, INK);
        }
        let text = format!("{} m", tick(length));
        canvas.write(&text, (left + width + self.letters.width(), row.top), self.letters);
        let tip = (row.left + row.width).saturating_sub(line);
        for step in 0..line {
            // A triangle that widens downwards, twice as high as wide.
            let half = step / 4;
            let left = tip - half.min(tip);
            let area = Area { left, top: row.top + step, width: 2 * half + 1, height: 1 };
            canvas.fill(area, INK);
        }
        let shaft = Area { left: tip, top: row.top, width: thickness, height: line + line / 2 };
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
            canvas.fill(Area { left: left + x, top, width: 1, height }, colour);
        }
        canvas.frame(Area { left, top, width, height }, 1, INK);
        let numbers =
            [bar.low, 0.5 * (bar.low + bar.high), bar.high].map(|value| tick(value.into()));
        for (text, part) in numbers.iter().zip([0.0, 0.5, 1.0]) {
            let room = width.saturating_sub(self.letters.width_of(text));
            let place = (left + (part * room as f64) as usize, top + height + height / 8);
            canvas.write(text, place, self.letters);
        }
    }

    /// A square and what its colour means.
    fn draw_swatch(&self, name: &str, swatch: Swatch, top: usize, canvas: &mut Canvas) {
        let (left, side) = (self.margin, self.letters.height());
        let area = Area { left, top, width: 2 * side, height: side };
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
fn draw_no_data(area: Area, letters: Letters, canvas: &mut Canvas) {
    let side = (letters.height() / 2).max(1);
    for y in area.top..area.top + area.height {
        for x in area.left..area.left + area.width {
            let is_odd = ((x - area.left) / side + (y - area.top) / side) % 2;
            canvas.mix((x, y), NO_DATA[is_odd], 255);
        }
    }
}

fn draw_picture(
    picture: &RgbaPicture,
    zoom: usize,
    (left, top): (usize, usize),
    letters: Letters,
    canvas: &mut Canvas,
) {
    let (width, height) = (zoom * picture.width, zoom * picture.height);
    let area = Area { left, top, width, height };
    draw_no_data(area, letters, canvas);
    for y in 0..height {
        for x in 0..width {
            let at = 4 * (y / zoom * picture.width + x / zoom);
            let [r, g, b, opacity] = [0, 1, 2, 3].map(|channel| picture.rgba[at + channel]);
            canvas.mix((left + x, top + y), [r, g, b], opacity);
        }
    }
    canvas.frame(area, 1, INK);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::products::Rendering;

    #[test]
    fn lengths_are_round_and_fit() {
        let lengths = [0.07, 1.0, 1.9, 4.99, 37.0, 600.0].map(round_length);
        for (found, expected) in lengths.iter().zip([0.05, 1.0, 1.0, 2.0, 20.0, 500.0]) {
            assert!((found - expected).abs() < 1e-9 * expected, "{lengths:?}");
        }
    }

    /// Two pixels, one without data: enlarged, framed, and with room for a legend and its letters.
    #[test]
    fn small_pictures_are_enlarged_within_their_frame() {
        let image = Image {
            width: 2,
            height: 1,
            bands: vec!["red".to_owned()],
            values: vec![0.3, f32::NAN],
            standard_error: vec![f32::NAN; 2],
            coverage: vec![1.0, 0.0],
            rendering: Rendering::Quicklook,
            georeference: Some(Georeference {
                west: 0.0,
                north: 1.0,
                pixel_width: 1.0,
                pixel_height: 1.0,
            }),
        };
        let (picture, legend) = RgbaPicture::with_legend(&image, &[660.0]);
        let caption = Caption { title: "a: brf".to_owned(), scene: "", unit: "1" };
        let Figure { canvas } = Figure::new((&picture, &legend), &image, &caption);
        let letters = Letters::for_width(320);
        assert_eq!(canvas.width, (LETTERS * letters.width()).max(320) + 2 * letters.height());
        assert_eq!(canvas.rgb.len(), 3 * canvas.width * canvas.height);
        let count =
            |colour: [u8; 3]| canvas.rgb.chunks_exact(3).filter(|one| *one == colour).count();
        assert!(count([186; 3]) >= 160 * 160, "the pixel");
        // The pixel and its key; the soft edges of letters have some of these greys too.
        let squares = 160 * 160 + 2 * 16 * 16;
        assert!((squares..squares + 400).contains(&(count(NO_DATA[0]) + count(NO_DATA[1]))));
    }

    #[test]
    fn every_size_of_picture_has_a_figure() {
        for (width, height) in [(1, 1), (1, 400), (400, 1), (37, 999), (1500, 20)] {
            let picture = RgbaPicture { width, height, rgba: vec![0; 4 * width * height] };
            let legend = Legend { entries: Entries::Bars(Vec::new()), dark: vec!["x".repeat(500)] };
            let image = Image {
                width,
                height,
                bands: vec!["x".to_owned()],
                values: vec![f32::NAN; width * height],
                standard_error: Vec::new(),
                coverage: Vec::new(),
                rendering: Rendering::Quicklook,
                georeference: None,
            };
            let caption = Caption { title: "t".repeat(900), scene: "ä", unit: "K" };
            let Figure { canvas } = Figure::new((&picture, &legend), &image, &caption);
            assert!(canvas.width >= width && canvas.height > height);
        }
    }
}
