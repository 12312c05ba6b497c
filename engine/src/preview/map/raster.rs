//! Drawings as pixels.

use glam::DVec2;
use tiny_skia::{
    Color, FillRule, FilterQuality, Mask, Paint as SkiaPaint, Path, PathBuilder, Pattern, Pixmap,
    Rect, Shader, SpreadMode, Stroke as SkiaStroke, StrokeDash, Transform,
};

use super::drawing::{Anchor, Drawing, DrawnItem, Ink, Paint, PixelLayer};
use crate::output::Canvas;

/// Pixels of a drawing, red, green and blue, shape `[rows, columns, 3]`; `None` if there is no memory for so many.
pub(super) fn rgb(drawing: &Drawing) -> Option<Vec<u8>> {
    let mut page = Pixmap::new(drawing.width as u32, drawing.height as u32)?;
    page.fill(Color::WHITE);
    let mut mask = Mask::new(drawing.width as u32, drawing.height as u32)?;
    let [low, high] = drawing.frame.map(DVec2::as_vec2);
    let frame = PathBuilder::from_rect(Rect::from_ltrb(low.x, low.y, high.x, high.y)?);
    mask.fill_path(&frame, FillRule::Winding, true, Transform::identity());
    drawing.clipped.iter().for_each(|item| draw(item, &mut page, Some(&mask)));
    drawing.over.iter().for_each(|item| draw(item, &mut page, None));
    // The page is opaque, so that its colours are not multiplied by anything.
    let rgb = page.pixels().iter().flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]);
    let mut canvas = Canvas { width: drawing.width, height: drawing.height, rgb: rgb.collect() };
    for item in drawing.clipped.iter().chain(&drawing.over) {
        write(item, drawing, &mut canvas);
    }
    Some(canvas.rgb)
}

fn draw(item: &DrawnItem, page: &mut Pixmap, mask: Option<&Mask>) {
    match item {
        DrawnItem::Circle { centre, radius, paint } => {
            let mut path = PathBuilder::new();
            path.push_circle(centre.x as f32, centre.y as f32, *radius as f32);
            path.finish().iter().for_each(|path| stroke_and_fill(path, paint, page, mask));
        }
        DrawnItem::Path { lines, is_closed, paint } => {
            let mut path = PathBuilder::new();
            for line in lines {
                for (index, point) in line.iter().enumerate() {
                    let (x, y) = (point.x as f32, point.y as f32);
                    if index == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
                }
                if *is_closed && !line.is_empty() {
                    path.close();
                }
            }
            path.finish().iter().for_each(|path| stroke_and_fill(path, paint, page, mask));
        }
        DrawnItem::Pixels(layer) => drop(pixels(layer, page, mask)),
        DrawnItem::Text { .. } => {}
    }
}

fn inked(ink: Ink) -> SkiaPaint<'static> {
    let [r, g, b] = ink.colour;
    let mut paint = SkiaPaint { anti_alias: true, ..SkiaPaint::default() };
    paint.set_color_rgba8(r, g, b, (255.0 * ink.opacity).round() as u8);
    paint
}

fn stroke_and_fill(path: &Path, paint: &Paint, page: &mut Pixmap, mask: Option<&Mask>) {
    if let Some(fill) = paint.fill {
        page.fill_path(path, &inked(fill), FillRule::EvenOdd, Transform::identity(), mask);
    }
    if let Some(stroke) = paint.stroke {
        let width = stroke.width as f32;
        let dash = if stroke.is_dashed {
            StrokeDash::new(vec![5.0 * width, 3.0 * width], 0.0)
        } else {
            None
        };
        let outline = SkiaStroke { width, dash, ..SkiaStroke::default() };
        page.stroke_path(path, &inked(stroke.ink), &outline, Transform::identity(), mask);
    }
}

/// Draws a layer of pixels; `None` if it has none.
fn pixels(layer: &PixelLayer, page: &mut Pixmap, mask: Option<&Mask>) -> Option<()> {
    let mut source = Pixmap::new(layer.columns as u32, layer.rows as u32)?;
    for (pixel, rgba) in source.pixels_mut().iter_mut().zip(layer.rgba.chunks_exact(4)) {
        *pixel = tiny_skia::ColorU8::from_rgba(rgba[0], rgba[1], rgba[2], rgba[3]).premultiply();
    }
    let (corner, high) = (layer.corner.as_vec2(), (layer.corner + layer.extent).as_vec2());
    let area = Rect::from_ltrb(corner.x, corner.y, high.x, high.y)?;
    let scale = (layer.extent / DVec2::new(layer.columns as f64, layer.rows as f64)).as_vec2();
    let quality = if layer.is_smooth { FilterQuality::Bilinear } else { FilterQuality::Nearest };
    let place = Transform::from_row(scale.x, 0.0, 0.0, scale.y, corner.x, corner.y);
    let shader: Shader<'_> = Pattern::new(source.as_ref(), SpreadMode::Pad, quality, 1.0, place);
    let paint = SkiaPaint { shader, anti_alias: false, ..SkiaPaint::default() };
    page.fill_rect(area, &paint, Transform::identity(), mask);
    Some(())
}

fn write(item: &DrawnItem, drawing: &Drawing, canvas: &mut Canvas) {
    let DrawnItem::Text { at, text, anchor } = item else { return };
    let letters = drawing.letters;
    let width = letters.width_of(text) as f64;
    let left = match anchor {
        Anchor::Start => at.x,
        Anchor::Middle => at.x - 0.5 * width,
        Anchor::End => at.x - width,
    };
    let top = at.y - 0.5 * letters.height() as f64;
    canvas.write(text, (left.round().max(0.0) as usize, top.round().max(0.0) as usize), letters);
}
