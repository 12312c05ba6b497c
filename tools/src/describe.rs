//! Contents of a scene, as `sunfleck check` prints them.

use sunfleck::counts::noun_of;
use sunfleck::run::{SceneFacts, SunFacts};

/// A scene's facts and warnings as JSON.
pub(crate) fn json(facts: Option<&SceneFacts>, warnings: &[String]) -> anyhow::Result<String> {
    let value = serde_json::json!({ "scene": facts, "warnings": warnings });
    Ok(serde_json::to_string_pretty(&value)? + "\n")
}

/// A scene's facts for a person.
pub(crate) fn text(facts: &SceneFacts) -> String {
    let mut text = String::new();
    if !facts.title.is_empty() {
        text.push_str(&facts.title);
        text.push('\n');
    }
    text.push_str(&aligned(&summary(facts), &[]));
    for table in [meshes(facts), bands(facts), sensors(facts)] {
        if table.len() > 1 {
            text.push('\n');
            text.push_str(&aligned(&table, &[0]));
        }
    }
    text.push('\n');
    text
}

/// Plants, their sizes and numbers, for a person.
pub(crate) fn statistics(facts: &SceneFacts) -> String {
    let mut text = String::new();
    if !facts.title.is_empty() {
        text.push_str(&facts.title);
        text.push('\n');
    }
    let mut rows = summary(facts);
    // The sun is no matter of plants.
    rows.truncate(rows.len().saturating_sub(1));
    if facts.instances > 0 {
        let area = facts.ground.size_m[0] * facts.ground.size_m[1];
        let leaves = format!(
            "{} m² of leaves on {} m², {} stems per ha",
            number(facts.leaf_area_index * area),
            number(area),
            number(facts.meshes.iter().map(|mesh| mesh.per_hectare).sum())
        );
        rows.push(row("stand", leaves));
    }
    if let Some(heights) = &facts.heights {
        let span = [heights.lowest_m, heights.mean_m, heights.highest_m].map(number);
        let [lowest, mean, highest] = span;
        rows.push(row("heights", format!("{lowest} to {highest} m, mean {mean} m")));
    }
    text.push_str(&aligned(&rows, &[]));
    for table in [plants(facts), histogram(facts)] {
        if table.len() > 1 {
            text.push('\n');
            text.push_str(&aligned(&table, &[0]));
        }
    }
    text
}

fn plants(facts: &SceneFacts) -> Vec<Vec<String>> {
    let mut rows = vec![header(&[
        "mesh",
        "instances",
        "per ha",
        "lowest (m)",
        "mean (m)",
        "highest (m)",
        "leaf area (m²)",
        "adds to LAI",
        "triangles",
        "discs",
    ])];
    rows.extend(facts.meshes.iter().map(|mesh| {
        vec![
            mesh.name.clone(),
            grouped(mesh.instances),
            number(mesh.per_hectare),
            number(mesh.lowest_m),
            number(mesh.height_m),
            number(mesh.highest_m),
            number(mesh.leaf_area_m2),
            number(mesh.leaf_area_index),
            grouped(mesh.triangles),
            grouped(mesh.discs),
        ]
    }));
    rows
}

/// Number of plants by height, with a bar each.
fn histogram(facts: &SceneFacts) -> Vec<Vec<String>> {
    /// Letters of the longest bar.
    const LONGEST: f64 = 40.0;
    let Some(heights) = &facts.heights else { return Vec::new() };
    let most = heights.counts.iter().copied().max().unwrap_or(1).max(1);
    let mut rows = vec![header(&["height (m)", "plants", ""])];
    for (class, &count) in heights.counts.iter().enumerate() {
        let low = heights.first_class_m + class as f64 * heights.class_m;
        let letters = (LONGEST * count as f64 / most as f64).ceil() as usize;
        let range = format!("{} to {}", number(low), number(low + heights.class_m));
        rows.push(vec![range, grouped(count), "#".repeat(letters)]);
    }
    rows
}

/// Name and text of each fact about the scene as a whole.
pub(crate) fn summary(facts: &SceneFacts) -> Vec<Vec<String>> {
    let ground = &facts.ground;
    let [x, y] = ground.corner_m;
    let [width, depth] = ground.size_m;
    let heights = if ground.highest_m - ground.lowest_m > 1e-6 {
        format!("{} to {} m high", number(ground.lowest_m), number(ground.highest_m))
    } else {
        format!("level, {} m high", number(ground.lowest_m))
    };
    let kind = if ground.periodic { "periodic" } else { "isolated" };
    let mut rows = vec![row(
        "ground",
        format!(
            "{} m x {} m, x {} to {} m, y {} to {} m, {heights}, {kind}, {}",
            number(width),
            number(depth),
            number(x),
            number(x + width),
            number(y),
            number(y + depth),
            counted(ground.triangles, "triangle")
        ),
    )];
    let [east, north, height] = ground.origin_m;
    if ground.projection.is_some() || ground.origin_m.iter().any(|one| one.abs() > 0.0) {
        let projection = ground.projection.as_deref().unwrap_or("no coordinate system is named");
        let origin = format!(
            "the local frame starts at {} m E, {} m N, {} m high; {projection}",
            number(east),
            number(north),
            number(height)
        );
        rows.push(row("map", origin));
    }
    if facts.instances > 0 {
        let canopy = format!(
            "leaf area index {}, cover {:.1} % ± {:.1} %, highest point {} m ({} m above the lowest ground)",
            number(facts.leaf_area_index),
            100.0 * facts.canopy_cover,
            100.0 * facts.canopy_cover_error,
            number(facts.highest_m),
            number(facts.highest_m - ground.lowest_m)
        );
        rows.push(row("canopy", canopy));
    }
    let geometry = format!(
        "{}, {} in all, {} in memory ({})",
        counted(facts.instances, "instance"),
        counted(facts.faces, "triangle or disc"),
        grouped(facts.unique_faces),
        bytes(facts.geometry_bytes)
    );
    rows.push(row("geometry", geometry));
    rows.push(row("sun", facts.sun.as_ref().map_or_else(|| "none".to_owned(), sun)));
    rows
}

/// Note about a scene that the sun lights alone; `None` of others.
pub(crate) fn note_without_sky(facts: &SceneFacts) -> Option<String> {
    let mut lit = facts.bands.iter().filter(|band| band.irradiance > 0.0).peekable();
    let is_sunlit = facts.sun.is_some() && lit.peek().is_some();
    (is_sunlit && lit.all(|band| band.diffuse_fraction <= 0.0)).then(|| {
        "note: sky: none is given, so that shadows receive no light of the sky; `sunfleck keys sky` shows how to write one"
            .to_owned()
    })
}

fn sun(sun: &SunFacts) -> String {
    let source = if sun.from_place_and_time { ", from place and time" } else { "" };
    format!(
        "zenith {:.2}°, azimuth {:.2}° (elevation {:.2}°){source}",
        sun.zenith_deg,
        sun.azimuth_deg,
        90.0 - sun.zenith_deg
    )
}

/// Header, and a row for each mesh.
pub(crate) fn meshes(facts: &SceneFacts) -> Vec<Vec<String>> {
    let mut rows = vec![header(&[
        "mesh",
        "instances",
        "per ha",
        "height (m)",
        "leaf area (m²)",
        "adds to LAI",
        "faces of one",
    ])];
    rows.extend(facts.meshes.iter().map(|mesh| {
        vec![
            mesh.name.clone(),
            grouped(mesh.instances),
            number(mesh.per_hectare),
            number(mesh.height_m),
            number(mesh.leaf_area_m2),
            number(mesh.leaf_area_index),
            grouped(mesh.faces),
        ]
    }));
    rows
}

/// Header, and a row for each band, or for some of many.
pub(crate) fn bands(facts: &SceneFacts) -> Vec<Vec<String>> {
    /// Bands that are listed; of more, the first and the last.
    const SHOWN: usize = 12;
    let mut rows = vec![header(&[
        "band",
        "centre (nm)",
        "width (nm)",
        "irradiance (W m⁻² nm⁻¹)",
        "diffuse (%)",
        "source",
    ])];
    let count = facts.bands.len();
    for (index, band) in facts.bands.iter().enumerate() {
        if count > SHOWN && (SHOWN / 2..count - SHOWN / 2).contains(&index) {
            if index == SHOWN / 2 {
                rows.push(vec![format!(".. {} more", count - SHOWN)]);
            }
            continue;
        }
        let is_lit = band.irradiance > 0.0;
        let source = match band.diffuse_fraction {
            _ if band.emits => "emission",
            _ if !is_lit => "none: dark",
            diffuse if diffuse <= 0.0 => "sun",
            diffuse if diffuse >= 1.0 => "sky",
            _ => "sun and sky",
        };
        rows.push(vec![
            band.name.clone(),
            number(band.center_nm),
            number(band.width_nm),
            number(band.irradiance),
            if is_lit { format!("{:.1}", 100.0 * band.diffuse_fraction) } else { "-".to_owned() },
            source.to_owned(),
        ]);
    }
    rows
}

/// Header, and a row for each sensor.
pub(crate) fn sensors(facts: &SceneFacts) -> Vec<Vec<String>> {
    let titles = ["sensor", "kind", "pixels or views", "paths", "memory", "ends at", "measures"];
    let mut rows = vec![header(&titles)];
    let or_dash = |count: Option<u64>| count.map_or_else(|| "-".to_owned(), grouped);
    rows.extend(facts.sensors.iter().map(|sensor| {
        vec![
            sensor.name.clone(),
            sensor.kind.to_owned(),
            or_dash(sensor.pixels),
            or_dash(sensor.samples),
            bytes(sensor.memory_bytes),
            sensor.ends.clone(),
            sensor.measures.join(", "),
        ]
    }));
    rows
}

fn row(name: &str, text: String) -> Vec<String> {
    vec![name.to_owned(), text]
}

fn header(titles: &[&str]) -> Vec<String> {
    titles.iter().map(|&title| title.to_owned()).collect()
}

/// Rows with their columns below each other; numbers end together.
fn aligned(rows: &[Vec<String>], left: &[usize]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width_of = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width_of).collect();
    let is_text = |column: usize| {
        left.contains(&column)
            || left.is_empty()
            || rows.iter().skip(1).filter_map(|row| row.get(column)).any(|cell| {
                !cell.starts_with(|letter: char| letter.is_ascii_digit() || letter == '-')
            })
    };
    let text: Vec<bool> = (0..columns).map(is_text).collect();
    let mut out = String::new();
    for row in rows {
        let mut line = String::new();
        for (column, cell) in row.iter().enumerate() {
            let room = " ".repeat(widths[column] - cell.chars().count());
            let (first, second) = if text[column] { (cell, &room) } else { (&room, cell) };
            line.push_str(first);
            line.push_str(second);
            line.push_str("  ");
        }
        out.push_str(line.trim_end());
        out.push('\n');
    }
    out
}

/// A number with three digits after the point at most, and four digits if it is small.
fn number(value: f64) -> String {
    let size = value.abs();
    if size > 0.0 && !(1e-3..1e9).contains(&size) {
        return format!("{value:.3e}");
    }
    let digits = if size >= 100.0 { 2 } else { 3 };
    let text = format!("{value:.digits$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// `1 234 567`.
pub(crate) fn grouped(count: u64) -> String {
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

/// `1 instance`, `2 instances`.
fn counted(count: u64, noun: &str) -> String {
    format!("{} {}", grouped(count), noun_of(count, noun))
}

/// `1.5 MiB`.
pub(crate) fn bytes(count: u64) -> String {
    const UNITS: [(&str, f64); 3] =
        [("GiB", 1_073_741_824.0), ("MiB", 1_048_576.0), ("KiB", 1024.0)];
    let size = count as f64;
    let unit = UNITS.into_iter().find(|(_, unit)| size >= *unit);
    unit.map_or_else(|| format!("{count} B"), |(name, unit)| format!("{:.1} {name}", size / unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_counts_are_short() {
        assert_eq!(
            [0.0, 0.3, 62.125, 1234.567, 1e-5, -0.0].map(number),
            ["0", "0.3", "62.125", "1234.57", "1.000e-5", "0"]
        );
        assert_eq!([5, 1234, 12_345, 1_234_567].map(grouped), ["5", "1234", "12 345", "1 234 567"]);
        assert_eq!([512, 2048, 3 << 20].map(bytes), ["512 B", "2.0 KiB", "3.0 MiB"]);
    }

    #[test]
    fn numbers_end_together_and_texts_start_together() {
        let rows = [["mesh", "count"], ["tree", "5"], ["a", "1234"]];
        let rows: Vec<Vec<String>> = rows.iter().map(|row| header(row)).collect();
        assert_eq!(aligned(&rows, &[0]), "mesh  count\ntree      5\na      1234\n");
    }
}
