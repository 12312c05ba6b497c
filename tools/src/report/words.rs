//! Names, numbers and units as a reader sees them.

use maud::{Markup, html};
use sunfleck::counts::agreeing;
use sunfleck::output::{product_title, unit_text, value_axis_title};

/// Longest name that is shown, letters.
const LONGEST: usize = 120;

/// A name of the author, cut if it is very long. Letters that a page may not hold or that turn the direction of what
/// stands behind them become U+FFFD.
pub(super) fn short(text: &str) -> String {
    cut(text, LONGEST)
}

/// A text of at most so many letters, made harmless.
pub(super) fn cut(text: &str, most: usize) -> String {
    let mut letters = text.chars();
    let mut shown: String = letters.by_ref().take(most).map(harmless).collect();
    if letters.next().is_some() {
        shown.push('…');
    }
    shown
}

/// A text of at most so many letters, in which names between back-ticks are set as code.
pub(super) fn prose(text: &str, most: usize) -> Markup {
    let text = cut(text, most);
    let mut pieces = text.split('`').peekable();
    let mut shown: Vec<Markup> = Vec::new();
    let mut is_code = false;
    while let Some(piece) = pieces.next() {
        shown.push(match (is_code, pieces.peek()) {
            (true, Some(_)) => html! { code { (piece) } },
            // A back-tick without another one is a letter like others.
            (true, None) => html! { "`" (piece) },
            (false, _) => html! { (piece) },
        });
        is_code = !is_code;
    }
    html! { @for piece in &shown { (piece) } }
}

const fn harmless(letter: char) -> char {
    match letter {
        '\n' | '\t' => ' ',
        '\u{0}'..='\u{1f}'
        | '\u{7f}'..='\u{9f}'
        | '\u{200e}'
        | '\u{200f}'
        | '\u{202a}'..='\u{202e}'
        | '\u{2066}'..='\u{2069}'
        | '\u{fdd0}'..='\u{fdef}' => '\u{fffd}',
        // Not a character in any plane.
        _ if letter as u32 & 0xfffe == 0xfffe => '\u{fffd}',
        _ => letter,
    }
}

/// A name of the author in its own direction of writing.
pub(super) fn name(text: &str) -> Markup {
    html! { bdi { (short(text)) } }
}

/// A unit with raised exponents: `W m⁻² nm⁻¹`.
pub(super) fn unit(text: &str) -> String {
    unit_text(&short(text))
}

/// Title of an axis of a product's values: `albedo (–)`, `exitance (W m⁻² nm⁻¹)`.
pub(super) fn axis_of_values(product: &str, unit: &str) -> String {
    value_axis_title(&short(product), &short(unit))
}

/// Text about things that are drawn among more of them: `1 of 4 bands is drawn`.
pub(super) fn drawn(shown: usize, all: usize, things: &str) -> String {
    format!("{shown} of {all} {things} {} drawn", agreeing(shown, "is", "are"))
}

/// A number with so many significant digits.
pub(super) fn number(value: f64, digits: i32) -> String {
    if !value.is_finite() {
        return "no data".to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let power = value.abs().log10().floor() as i32;
    if (-4..7).contains(&power) {
        let decimals = usize::try_from(digits - 1 - power).unwrap_or(0);
        return format!("{value:.decimals$}");
    }
    let decimals = usize::try_from(digits - 1).unwrap_or(0);
    format!("{:.decimals$} × 10{}", value / 10_f64.powi(power), raised(power))
}

/// A value with its standard error to two digits: `0.28111 ± 0.00023`.
pub(super) fn measured(value: f64, error: f64) -> String {
    if !value.is_finite() {
        return "no data".to_owned();
    }
    if !(error.is_finite() && error > 0.0) {
        return number(value, 5);
    }
    // Two digits of an error are enough, and more of a value than its error has are noise.
    let power = value.abs().max(error).log10().floor() as i32;
    let decimals = |error: f64| (1 - error.log10().floor() as i32).clamp(0, 12) as usize;
    if (-4..7).contains(&power) {
        let decimals = decimals(error);
        return format!("{value:.decimals$} ± {error:.decimals$}");
    }
    let scale = 10_f64.powi(power);
    let (value, error) = (value / scale, error / scale);
    let decimals = decimals(error);
    format!("({value:.decimals$} ± {error:.decimals$}) × 10{}", raised(power))
}

fn raised(power: i32) -> String {
    let digit = |letter: char| match letter {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        _ => letter.to_digit(10).and_then(|digit| char::from_u32(0x2070 + digit)).unwrap_or(letter),
    };
    power.to_string().chars().map(digit).collect()
}

/// A time for a person: `0.06 s`, `12.3 s`, `2 min 7 s`, `3 h 5 min`.
pub(super) fn duration(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    match seconds {
        _ if !seconds.is_finite() => "unknown".to_owned(),
        s if s < 0.001 => format!("{:.0} µs", s * 1e6),
        s if s < 1.0 => format!("{s:.3} s"),
        s if s < 100.0 => format!("{s:.1} s"),
        s if s < 6000.0 => format!("{} min {} s", whole / 60, whole % 60),
        _ => format!("{} h {} min", whole / 3600, whole % 3600 / 60),
    }
}

/// A product's name for a person: `four_components` as `four components`.
pub(super) fn title(product: &str) -> String {
    product_title(&short(product))
}

/// Definition of a product in one sentence; `None` of one whose name says it.
pub(super) fn definition(product: &str) -> Option<&'static str> {
    let stem = ["_denoised", "_uc", "_co_sgl", "_mlt", "_cells", "_views", "_cones"]
        .iter()
        .fold(product, |stem, end| stem.strip_suffix(end).unwrap_or(stem));
    Some(match stem {
        "brf" => {
            "π L / E: radiance over that of an ideal white Lambertian surface in the same sunlight."
        }
        "hdrf" => {
            "π L / E under sun and sky: radiance over that of an ideal white Lambertian surface in the same light."
        }
        "radiance" => "Light towards the sensor, per area, solid angle and wavelength.",
        "brightness_temperature" => {
            "Temperature of the black body with the same mean radiance over the band."
        }
        "albedo" => "Reflected over incident power.",
        "exitance" => "Flux density that leaves the scene upwards.",
        "four_components" => {
            "Fractions of sunlit and shaded ground and canopy in what is seen first."
        }
        "dominant_component" => "Number of the largest of the four components.",
        "gap_fraction" => {
            "Fraction of what is seen that is ground, or sky for a camera that looks up."
        }
        "lai_beer" | "lai_miller" | "lai_2000" => {
            "Effective leaf area index that follows from the gap fraction."
        }
        "fapar" => "Fraction of the incident light that each material absorbs in each layer.",
        "fapar_material" => "Fraction of the incident light that each material absorbs.",
        "fapar_vegetation" => "Fraction of the incident light that all but the terrain absorbs.",
        "ftran" => "Fraction of the incident light that arrives at the ground.",
        "absorbed_by_instance" => "Power that each instance absorbs.",
        "absorbed_by_triangle" => {
            "Absorbed power over one-sided area; here the mean over all triangles."
        }
        _ if stem.starts_with("downwelling") => "Flux density downwards.",
        _ if stem.starts_with("upwelling") => "Flux density upwards.",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_the_digits_that_their_errors_leave() {
        assert_eq!(measured(0.281_110_5, 0.000_231), "0.28111 ± 0.00023");
        assert_eq!(measured(311.6255, 0.006_05), "311.6255 ± 0.0060");
        assert_eq!(measured(0.25, 0.0), "0.25000");
        assert_eq!(measured(f64::NAN, 0.1), "no data");
        assert_eq!(measured(1.5e-7, 2.5e-9), "(1.500 ± 0.025) × 10⁻⁷");
        assert_eq!(number(1_234_567_890.0, 3), "1.23 × 10⁹");
    }

    #[test]
    fn names_are_cut_and_made_harmless() {
        assert_eq!(short(&"x".repeat(10_000)).chars().count(), LONGEST + 1);
        assert_eq!(short("a\u{202e}b\u{0}c"), "a\u{fffd}b\u{fffd}c");
        assert_eq!(name("<b>&\"").into_string(), "<bdi>&lt;b&gt;&amp;&quot;</bdi>");
    }

    #[test]
    fn names_between_back_ticks_are_code_and_no_markup() {
        let shown = |text| prose(text, 600).into_string();
        assert_eq!(
            shown("`frame.origin_m`: write `<b>` & ``, or ` alone"),
            "<code>frame.origin_m</code>: write <code>&lt;b&gt;</code> &amp; <code></code>, or ` alone"
        );
        assert_eq!(prose("of `a_long_name`", 7).into_string(), "of `a_l…");
    }

    #[test]
    fn parts_of_products_have_their_definition() {
        assert!(definition("brf_cells_uc").is_some());
    }
}
