//! Pictures with title, legend and scale around the pixels.

use std::io::{self, Write};

use super::layout::{Layout, NO_DATA, Row, extent};
use super::lettering::{Canvas, INK, Letters, PixelRectangle};
use super::picture::{PicturePainter, ShownPixels, encode_png};
use crate::products::Georeference;

/// Larger side that small pictures are enlarged to, by whole numbers, pixels.
const SMALLEST: usize = 320;
/// Letters that a line has room for at least.
const LETTERS: usize = 44;

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
pub(super) struct Figure<'a> {
    picture: &'a PicturePainter<'a>,
    layout: Layout,
    zoom: usize,
}

impl<'a> Figure<'a> {
    /// The picture of an image, of which these pixels show something.
    pub(super) fn new(
        picture: &'a PicturePainter<'a>,
        shown: ShownPixels,
        place: Option<Georeference>,
        caption: &Caption<'_>,
    ) -> Self {
        let (width, height) = picture.size();
        let zoom = SMALLEST.div_ceil(width.max(height).max(1)).max(1);
        let letters = Letters::for_width(zoom * width);
        let margin = letters.height();
        let line = (zoom * width).max(LETTERS * letters.width());
        let mut layout = Layout { letters, margin, width: line, rows: Vec::new() };
        layout.text(&caption.title);
        if !caption.scene.is_empty() {
            layout.text(caption.scene);
        }
        layout.gap(4);
        layout.rows.push(Row::Picture { width: zoom * width, height: zoom * height });
        layout.gap(2);
        if let Some(place) = place {
            layout.rows.push(Row::Scale { place, zoom, width: zoom * width });
            layout.text(&extent(&place, picture.size()));
            layout.gap(2);
        }
        layout.legend(&picture.legend, caption.unit);
        if shown.is_blank {
            layout.text("no pixel shows anything of the scene");
        } else if shown.has_holes {
            layout.rows.push(Row::NoData);
        }
        if !picture.legend.dark.is_empty() {
            layout.text(&format!("not shown, without light: {}", picture.legend.dark.join(", ")));
        }
        Self { picture, layout, zoom }
    }

    /// Columns and rows.
    fn size(&self) -> (usize, usize) {
        (self.layout.full_width(), self.layout.full_height())
    }

    /// Writes a PNG with `texts` (keyword, text) as its metadata.
    ///
    /// # Errors
    /// If `file` cannot be written, or the pixels cannot be read.
    pub(super) fn encode(&self, texts: &[(&str, String)], file: &mut impl Write) -> io::Result<()> {
        let compression = png::Compression::Balanced;
        encode_png(self.size(), png::ColorType::Rgb, texts, compression, file, |out| {
            self.paint(out)
        })
    }

    /// Writes all rows of pixels from top to bottom: first those above the picture, with its frame, then the picture a
    /// block at a time, then those below it.
    fn paint(&self, out: &mut dyn Write) -> io::Result<()> {
        let PixelRectangle { top, left, width, height } = self.layout.picture();
        let frame = |canvas: &mut Canvas, from: usize| {
            // A canvas holds rows of the figure from `from` on.
            let line = |top: usize| PixelRectangle {
                left: left - 1,
                top: top - from,
                width: width + 2,
                height: 1,
            };
            canvas.fill(line(if from == 0 { top - 1 } else { top + height }), INK);
        };
        let mut head = self.layout.draw(0..top);
        frame(&mut head, 0);
        out.write_all(&head.rgb)?;
        for rows in self.picture.blocks() {
            let rgba = self.picture.paint(rows.clone())?;
            for (row, pixels) in rows.zip(rgba.chunks_exact(4 * self.picture.size().0)) {
                for part in 0..self.zoom {
                    let mut canvas = Canvas::new(self.layout.full_width(), 1);
                    let side = |left| PixelRectangle { left, top: 0, width: 1, height: 1 };
                    self.paint_row(self.zoom * row + part, pixels, left, &mut canvas);
                    canvas.fill(side(left - 1), INK);
                    canvas.fill(side(left + width), INK);
                    out.write_all(&canvas.rgb)?;
                }
            }
        }
        let bottom = top + height;
        let mut foot = self.layout.draw(bottom..self.layout.full_height());
        frame(&mut foot, bottom);
        out.write_all(&foot.rgb)
    }

    /// Draws a row of the enlarged picture.
    fn paint_row(&self, y: usize, pixels: &[u8], left: usize, canvas: &mut Canvas) {
        let side = (self.layout.letters.height() / 2).max(1);
        for x in 0..self.zoom * self.picture.size().0 {
            let [r, g, b, opacity] = pixels.as_chunks().0[x / self.zoom];
            canvas.mix((left + x, 0), NO_DATA[(x / side + y / side) % 2], 255);
            canvas.mix((left + x, 0), [r, g, b], opacity);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::picture_input::tests::{image, in_rows_of, input};
    use crate::products::Image;

    /// Pixels of a figure, shape `[rows, columns, 3]`.
    fn painted(image: &Image, caption: &Caption<'_>) -> (usize, Vec<u8>) {
        let input = input(image, &[660.0]);
        let picture = PicturePainter::new(&input).expect("a picture");
        let shown = picture.encode(&[], &mut Vec::new()).expect("a file in memory");
        let figure = Figure::new(&picture, shown, image.georeference, caption);
        let mut rgb = Vec::new();
        figure.paint(&mut rgb).expect("memory");
        assert_eq!(rgb.len(), 3 * figure.size().0 * figure.size().1);
        (figure.size().0, rgb)
    }

    /// Two pixels, one without data: enlarged, framed, and with room for a legend and its letters.
    #[test]
    fn small_pictures_are_enlarged_within_their_frame() {
        let georeference =
            Some(Georeference { west: 0.0, north: 1.0, pixel_width: 1.0, pixel_height: 1.0 });
        let image = Image { georeference, ..image(&["red"], vec![0.3, f32::NAN]) };
        let caption = Caption { title: "a: brf".to_owned(), scene: "", unit: "1" };
        let (width, rgb) = painted(&image, &caption);
        let letters = Letters::for_width(320);
        assert_eq!(width, (LETTERS * letters.width()).max(320) + 2 * letters.height());
        let count = |colour: [u8; 3]| rgb.chunks_exact(3).filter(|one| *one == colour).count();
        assert!(count([186; 3]) >= 160 * 160, "the pixel");
        // The pixel and its key; the soft edges of letters have some of these greys too.
        let squares = 160 * 160 + 2 * 16 * 16;
        assert!((squares..squares + 400).contains(&(count(NO_DATA[0]) + count(NO_DATA[1]))));
        // The frame is around the picture: a line above its first row and below its last one.
        let is_line = |row: &[u8]| row.chunks_exact(3).filter(|one| *one == INK).count() >= 322;
        let lines: Vec<usize> = (0..rgb.len() / 3 / width)
            .filter(|row| is_line(&rgb[3 * width * row..3 * width * (row + 1)]))
            .collect();
        assert_eq!(lines[1] - lines[0], 161, "{lines:?}");
    }

    #[test]
    fn every_size_of_picture_has_a_figure() {
        for (width, height) in [(1, 1), (1, 400), (400, 1), (37, 999), (1500, 20)] {
            let image = in_rows_of(width, image(&["x"], vec![f32::NAN; width * height]));
            let caption = Caption { title: "t".repeat(900), scene: "ä", unit: "K" };
            let (columns, rgb) = painted(&image, &caption);
            assert!(columns >= width && rgb.len() > 3 * columns * height);
        }
    }
}
