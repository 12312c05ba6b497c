//! Drawings as SVG.

use std::fmt::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use glam::DVec2;

use super::drawing::{Anchor, Drawing, DrawnItem, Ink, Paint, PixelLayer};
use crate::output::{INK, escaped, png_bytes};

/// Text of the SVG.
pub(super) fn svg(drawing: &Drawing, title: &str) -> String {
    let Drawing { width, height, letters, frame: [low, high], clipped, over } = drawing;
    // Letters are 0.6 of the font's size wide, as in the fonts that are named.
    let size = letters.width() as f64 / 0.6;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"'DejaVu Sans Mono','Noto Sans Mono',Menlo,Consolas,monospace\" font-size=\"{size:.1}\">\n\
         <title>{}</title>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n",
        escaped(title)
    );
    let extent = *high - *low;
    // The name is unlikely to be taken on a page that holds several pictures.
    push(
        &mut out,
        format_args!(
            "<clipPath id=\"sunfleck-map-frame\"><rect x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\"/></clipPath>\n",
            low.x, low.y, extent.x, extent.y
        ),
    );
    out.push_str("<g clip-path=\"url(#sunfleck-map-frame)\">\n");
    for item in clipped {
        draw(item, &mut out);
    }
    out.push_str("</g>\n");
    for item in over {
        draw(item, &mut out);
    }
    out.push_str("</svg>\n");
    out
}

fn push(out: &mut String, text: std::fmt::Arguments<'_>) {
    out.write_fmt(text).expect("a string takes any text");
}

fn draw(item: &DrawnItem, out: &mut String) {
    match item {
        DrawnItem::Circle { centre, radius, paint } => {
            push(
                out,
                format_args!(
                    "<circle cx=\"{:.2}\" cy=\"{:.2}\" r=\"{radius:.2}\"",
                    centre.x, centre.y
                ),
            );
            attributes(paint, out);
            out.push_str("/>\n");
        }
        DrawnItem::Path { lines, is_closed, paint } => {
            out.push_str("<path d=\"");
            for line in lines {
                outline(line, *is_closed, out);
            }
            out.push('"');
            attributes(paint, out);
            out.push_str("/>\n");
        }
        DrawnItem::Pixels(layer) => pixels(layer, out),
        DrawnItem::Text { at, text, anchor } => {
            let anchor = match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            let [r, g, b] = INK;
            push(
                out,
                format_args!(
                    "<text x=\"{:.1}\" y=\"{:.1}\" dy=\"0.35em\" text-anchor=\"{anchor}\" fill=\"#{r:02x}{g:02x}{b:02x}\">{}</text>\n",
                    at.x,
                    at.y,
                    escaped(text)
                ),
            );
        }
    }
}

fn outline(line: &[DVec2], is_closed: bool, out: &mut String) {
    for (index, point) in line.iter().enumerate() {
        let command = if index == 0 { 'M' } else { 'L' };
        push(out, format_args!("{command}{:.1} {:.1}", point.x, point.y));
    }
    if is_closed {
        out.push('Z');
    }
}

fn attributes(paint: &Paint, out: &mut String) {
    let ink = |name: &str, ink: &Ink, out: &mut String| {
        let [r, g, b] = ink.colour;
        push(out, format_args!(" {name}=\"#{r:02x}{g:02x}{b:02x}\""));
        if ink.opacity < 1.0 {
            push(out, format_args!(" {name}-opacity=\"{:.2}\"", ink.opacity));
        }
    };
    match &paint.fill {
        Some(fill) => {
            ink("fill", fill, out);
            out.push_str(" fill-rule=\"evenodd\"");
        }
        None => out.push_str(" fill=\"none\""),
    }
    if let Some(stroke) = &paint.stroke {
        ink("stroke", &stroke.ink, out);
        push(out, format_args!(" stroke-width=\"{:.2}\"", stroke.width));
        if stroke.is_dashed {
            push(
                out,
                format_args!(
                    " stroke-dasharray=\"{:.1} {:.1}\"",
                    5.0 * stroke.width,
                    3.0 * stroke.width
                ),
            );
        }
    }
}

fn pixels(layer: &PixelLayer, out: &mut String) {
    let PixelLayer { corner, extent, columns, rows, rgba, is_smooth } = layer;
    let png = STANDARD.encode(png_bytes(*columns, *rows, rgba));
    let rendering = if *is_smooth { "auto" } else { "pixelated" };
    push(
        out,
        format_args!(
            "<image x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\" preserveAspectRatio=\"none\" \
         image-rendering=\"{rendering}\" href=\"data:image/png;base64,{png}\"/>\n",
            corner.x, corner.y, extent.x, extent.y
        ),
    );
}
