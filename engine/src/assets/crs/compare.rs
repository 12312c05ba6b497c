//! Comparison of two coordinate systems.

use super::{Axes, Crs};

/// Relation of two coordinate systems.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Agreement {
    /// Coordinates of both are the same within a metre or so.
    Same,
    /// They may differ, for this reason.
    MayDiffer(String),
    /// Equal coordinates are different places, for this reason.
    Differ(String),
}

/// Compares systems of projected coordinates.
pub(crate) fn compare(a: &Crs, b: &Crs) -> Agreement {
    if a.name == b.name || a.code.is_some() && a.code == b.code {
        return Agreement::Same;
    }
    match (a.utm, b.utm) {
        (Some(one), Some(other)) if one != other => {
            Agreement::Differ(format!("UTM zone {one} is not zone {other}"))
        }
        (Some(_), Some(_)) => match (&a.datum, &b.datum) {
            (Some(one), Some(other)) if !is_same_datum(one, other) => {
                Agreement::MayDiffer(format!(
                    "their zone of UTM is the same, but their datums are {one} and {other}, which lie \
                 from less than a metre to some hundred metres apart"
                ))
            }
            _ => Agreement::Same,
        },
        (Some(zone), None) | (None, Some(zone)) => {
            let other = if a.utm.is_some() { b } else { a };
            if other.code.is_some() && other.axes != Axes::Unknown {
                Agreement::Differ(format!("UTM zone {zone} is not {}", other.name))
            } else {
                Agreement::MayDiffer(format!("UTM zone {zone} may not be {}", other.name))
            }
        }
        (None, None) if plain(&a.name) == plain(&b.name) => Agreement::Same,
        (None, None) => Agreement::MayDiffer(format!("{} may not be {}", a.name, b.name)),
    }
}

/// Letters and digits of a name, in lower case.
pub(super) fn plain(name: &str) -> String {
    name.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_lowercase()
}

/// Returns whether two datums are the same within a metre, or one is a generation of the other.
fn is_same_datum(a: &str, b: &str) -> bool {
    datum(a) == datum(b)
}

/// One name for all that a datum has.
fn datum(name: &str) -> String {
    let plain = plain(name);
    let plain = plain.strip_prefix('d').filter(|_| name.starts_with("D_")).unwrap_or(&plain);
    let known = match plain {
        "wgs84"
        | "wgs1984"
        | "worldgeodeticsystem1984"
        | "etrs89"
        | "etrs1989"
        | "europeanterrestrialreferencesystem1989" => "wgs84",
        "nad83" | "northamerica1983" | "northamerican1983" | "northamericandatum1983" => "nad83",
        "nad27" | "northamerica1927" | "northamerican1927" | "northamericandatum1927" => "nad27",
        "ed50" | "european1950" | "europeandatum1950" => "ed50",
        "wgs72" | "wgs1972" | "worldgeodeticsystem1972" => "wgs72",
        other => {
            let is_wgs84 = [
                "wgs84",
                "wgs1984",
                "worldgeodeticsystem1984",
                "etrs89",
                "etrs1989",
                "europeanterrestrialreferencesystem1989",
            ];
            let found = is_wgs84.iter().any(|prefix| other.starts_with(prefix));
            if found { "wgs84" } else { other }
        }
    };
    known.to_owned()
}
