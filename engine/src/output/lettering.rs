//! Text in pictures of pixels.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// An opaque picture that text and rectangles are drawn on, red, green and blue, shape `[rows, columns, 3]`.
#[derive(Clone, Debug)]
pub(crate) struct Canvas {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) rgb: Vec<u8>,
}

/// Letters of one height; all are equally wide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Letters {
    /// Pixels for each of the font.
    scale: usize,
    is_large: bool,
}

/// Colour of text and lines.
pub(crate) const INK: [u8; 3] = [40, 40, 40];

impl Letters {
    /// Letters that are legible in a picture of this width: about 60 fit into a line or more.
    pub(crate) const fn for_width(width: usize) -> Self {
        if width < 1000 {
            Self { scale: 1, is_large: false }
        } else {
            let scale = width / 1400;
            Self { scale: if scale == 0 { 1 } else { scale }, is_large: true }
        }
    }

    const fn raster(self) -> RasterHeight {
        if self.is_large { RasterHeight::Size24 } else { RasterHeight::Size16 }
    }

    /// Height of a line, pixels.
    pub(crate) const fn height(self) -> usize {
        self.scale * self.raster().val()
    }

    /// Width of a letter, pixels.
    pub(crate) const fn width(self) -> usize {
        self.scale * get_raster_width(FontWeight::Regular, self.raster())
    }

    /// Width of a text, pixels.
    pub(crate) fn width_of(self, text: &str) -> usize {
        self.width() * text.chars().count()
    }

    /// Cuts a text to a width, with a mark where it was cut.
    pub(crate) fn fitted(self, text: &str, width: usize) -> String {
        let letters = width / self.width();
        if text.chars().count() <= letters {
            return text.to_owned();
        }
        let kept: String = text.chars().take(letters.saturating_sub(2)).collect();
        format!("{}..", kept.trim_end())
    }
}

impl Canvas {
    /// A white one.
    pub(crate) fn new(width: usize, height: usize) -> Self {
        Self { width, height, rgb: vec![255; 3 * width * height] }
    }

    /// Mixes a colour into a pixel; nothing beside the canvas.
    pub(crate) fn mix(&mut self, (x, y): (usize, usize), colour: [u8; 3], opacity: u8) {
        if x >= self.width || y >= self.height {
            return;
        }
        let at = 3 * (y * self.width + x);
        for (pixel, colour) in self.rgb[at..at + 3].iter_mut().zip(colour) {
            let (old, new, part) = (u32::from(*pixel), u32::from(colour), u32::from(opacity));
            *pixel = ((old * (255 - part) + new * part + 127) / 255) as u8;
        }
    }

    /// Fills a rectangle.
    pub(crate) fn fill(&mut self, area: PixelRectangle, colour: [u8; 3]) {
        for y in area.top..area.top + area.height {
            for x in area.left..area.left + area.width {
                self.mix((x, y), colour, 255);
            }
        }
    }

    /// Draws the outline of a rectangle, outside of it.
    pub(crate) fn frame(&mut self, area: PixelRectangle, thickness: usize, colour: [u8; 3]) {
        let left = area.left.saturating_sub(thickness);
        let top = area.top.saturating_sub(thickness);
        let (width, height) = (area.width + 2 * thickness, area.height + 2 * thickness);
        self.fill(PixelRectangle { left, top, width, height: thickness }, colour);
        self.fill(
            PixelRectangle { left, top: area.top + area.height, width, height: thickness },
            colour,
        );
        self.fill(PixelRectangle { left, top, width: thickness, height }, colour);
        self.fill(
            PixelRectangle { left: area.left + area.width, top, width: thickness, height },
            colour,
        );
    }

    /// Writes a line of text with its upper left corner at a place; letters that the font lacks are `?`,
    /// but for `≤` and `≥`, which are underlined `<` and `>`.
    pub(crate) fn write(&mut self, text: &str, (left, top): (usize, usize), letters: Letters) {
        for (index, letter) in text.chars().enumerate() {
            let raster = |letter| get_raster(letter, FontWeight::Regular, letters.raster());
            let (letter, is_underlined) = match letter {
                '≤' => ('<', true),
                '≥' => ('>', true),
                other => (other, false),
            };
            let Some(raster) = raster(letter).or_else(|| raster('?')) else { continue };
            let start = left + index * letters.width();
            if is_underlined {
                let lowest = raster.rows().rposition(|pixels| pixels.iter().any(|&one| one > 0));
                let row = lowest.unwrap_or(0) + letters.raster().val() / 8;
                for column in 1..raster.width() - 1 {
                    self.dot((start, top), (column, row), letters.scale, u8::MAX);
                }
            }
            for (row, pixels) in raster.rows().enumerate() {
                for (column, &opacity) in pixels.iter().enumerate() {
                    if opacity > 0 {
                        self.dot((start, top), (column, row), letters.scale, opacity);
                    }
                }
            }
        }
    }

    /// A square of a scaled letter.
    fn dot(
        &mut self,
        (left, top): (usize, usize),
        (column, row): (usize, usize),
        scale: usize,
        opacity: u8,
    ) {
        for y in 0..scale {
            for x in 0..scale {
                self.mix((left + column * scale + x, top + row * scale + y), INK, opacity);
            }
        }
    }
}

/// A rectangle of a canvas, pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PixelRectangle {
    pub(crate) left: usize,
    pub(crate) top: usize,
    pub(crate) width: usize,
    pub(crate) height: usize,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_stays_within_its_width_and_on_the_canvas() {
        let letters = Letters::for_width(300);
        assert_eq!(letters.fitted("brightness", letters.width_of("brightness")), "brightness");
        assert_eq!(letters.fitted("brightness", letters.width_of("bright")), "brig..");
        let mut canvas = Canvas::new(letters.width_of("ab"), letters.height());
        canvas.write("abc", (0, 0), letters);
        assert!(canvas.rgb.iter().any(|&byte| byte < 128), "ink");
        let is_white =
            |x: usize| (0..canvas.height).all(|y| canvas.rgb[3 * (y * canvas.width + x)] == 255);
        assert!(!(0..canvas.width).all(is_white));
    }

    #[test]
    fn bounds_are_signs_with_a_line_below() {
        let letters = Letters::for_width(300);
        let written = |text| {
            let mut canvas = Canvas::new(letters.width(), letters.height());
            canvas.write(text, (0, 0), letters);
            canvas.rgb
        };
        let dark = |text| written(text).iter().filter(|&&byte| byte < 128).count();
        let line = 3 * (letters.width() - 2);
        assert_eq!([dark("≤"), dark("≥")], [dark("<") + line, dark(">") + line]);
        assert_eq!(written("∑"), written("?"));
    }

    #[test]
    fn letters_grow_with_the_picture() {
        let heights = [100, 999, 1000, 3000, 8000].map(|width| Letters::for_width(width).height());
        assert_eq!(heights, [16, 16, 24, 48, 120]);
    }
}
