//! Names and units of products as a reader of figures sees them.

/// Name of a product for a person: `four_components` as `four components`, `hdrf_co_sgl` as `HDRF, scattered once`.
#[must_use]
pub fn product_title(product: &str) -> String {
    let plain = match product {
        "brf" => "BRF",
        "hdrf" => "HDRF",
        "fapar" => "fAPAR by layer",
        "fapar_material" => "fAPAR by material",
        "fapar_vegetation" => "fAPAR of the vegetation",
        "ftran" => "transmittance to the ground",
        "lai_beer" => "LAI (Beer)",
        "lai_miller" => "LAI (Miller)",
        "lai_2000" => "LAI (LAI-2000)",
        _ => "",
    };
    if !plain.is_empty() {
        return plain.to_owned();
    }
    let (stem, denoised) = match product.strip_suffix("_denoised") {
        Some(stem) => (stem, ", denoised"),
        None => (product, ""),
    };
    let parts = [
        ("_uc", ", uncollided"),
        ("_co_sgl", ", scattered once"),
        ("_mlt", ", scattered more often"),
    ];
    let (stem, part) = parts
        .iter()
        .find_map(|(end, text)| Some((stem.strip_suffix(end)?, *text)))
        .unwrap_or((stem, ""));
    let (stem, place) = PLACES
        .iter()
        .find_map(|(end, text)| Some((stem.strip_suffix(end)?, *text)))
        .unwrap_or((stem, ""));
    let stem = match stem {
        "brf" => "BRF".to_owned(),
        "hdrf" => "HDRF".to_owned(),
        other => other.replace('_', " "),
    };
    format!("{stem}{place}{part}{denoised}")
}

/// Endings of products by the place where they are measured, and what a title says of them.
const PLACES: [(&str, &str); 3] =
    [("_cells", " in cells"), ("_views", " towards views"), ("_cones", " in cones")];

/// Title of an axis of a product's values, with the unit: `BRF (–)`, `exitance (W m⁻² nm⁻¹)`. The place where it is
/// measured is no part of it.
#[must_use]
pub fn value_axis_title(product: &str, unit: &str) -> String {
    let title = product_title(product);
    let quantity = PLACES.iter().fold(title, |title, (_, place)| title.replace(place, ""));
    format!("{quantity} ({})", unit_text(unit))
}

/// A unit with raised exponents: `W m-2 nm-1` as `W m⁻² nm⁻¹`, that of a fraction (`1`) as `–`.
#[must_use]
pub fn unit_text(unit: &str) -> String {
    if unit == "1" || unit.is_empty() {
        return "–".to_owned();
    }
    let factor = |factor: &str| {
        let end = factor.trim_end_matches(|letter: char| letter.is_ascii_digit()).len();
        let (symbol, digits) = factor.split_at(end);
        let (symbol, sign) = match symbol.strip_suffix('-') {
            Some(symbol) => (symbol, "⁻"),
            None => (symbol, ""),
        };
        if symbol.is_empty() || digits.is_empty() {
            return factor.to_owned();
        }
        format!("{symbol}{sign}{}", digits.chars().map(raised).collect::<String>())
    };
    unit.split(' ').map(factor).collect::<Vec<_>>().join(" ")
}

/// A digit as an exponent.
fn raised(digit: char) -> char {
    match digit {
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        _ => digit.to_digit(10).and_then(|digit| char::from_u32(0x2070 + digit)).unwrap_or(digit),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_the_quantity_and_its_unit() {
        assert_eq!(value_axis_title("brf", "1"), "BRF (–)");
        assert_eq!(value_axis_title("hdrf_views_co_sgl", "1"), "HDRF, scattered once (–)");
        assert_eq!(value_axis_title("radiance", "W m-2 sr-1 nm-1"), "radiance (W m⁻² sr⁻¹ nm⁻¹)");
        assert_eq!(value_axis_title("leaf_area_density", "m2 m-3"), "leaf area density (m² m⁻³)");
        assert_eq!(value_axis_title("height", "m"), "height (m)");
    }

    #[test]
    fn products_have_titles() {
        assert_eq!(product_title("hdrf_co_sgl"), "HDRF, scattered once");
        assert_eq!(
            product_title("brightness_temperature_views"),
            "brightness temperature towards views"
        );
    }
}
