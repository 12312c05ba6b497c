//! Facts about coordinate reference systems by their number, from `epsg.txt`.
//!
//! A section is a line in brackets and the numbers below it, as `first-last`:
//!
//! | section | its numbers |
//! |---|---|
//! | `geographic`, `geocentric`, `projected`, `vertical`, `compound` | systems of that kind |
//! | `unit m name` | projected systems in another unit than the metre, and its length |
//! | `world` | projected systems that cover the world and are nowhere near true to scale |
//! | `utm datum` | `first-last:zone`, the zone of the first; they count upwards |
//! | `vertical unit m name` | vertical systems in another unit than the metre |
//! | `depth` | vertical systems that count downwards |
//! | `compound` | `code:horizontal+vertical` |

use super::{Axes, Crs, Heights, Length, UtmZone};

const FACTS: &str = include_str!("epsg.txt");

/// Sections that hold a number: the title and the entry.
fn entries(code: u32) -> impl Iterator<Item = (&'static str, &'static str)> {
    let mut title = "";
    FACTS
        .lines()
        .filter(|line| !line.starts_with('#'))
        .filter_map(move |line| {
            if let Some(next) = line.strip_prefix('[').and_then(|line| line.strip_suffix(']')) {
                title = next;
                return None;
            }
            Some((title, line))
        })
        .flat_map(|(title, line)| line.split(' ').map(move |entry| (title, entry)))
        .filter(move |(_, entry)| {
            let range = entry.split(':').next().unwrap_or(entry);
            let (first, last) = range.split_once('-').unwrap_or((range, range));
            let (first, last) = (first.parse(), last.parse());
            matches!((first, last), (Ok(first), Ok(last)) if (first..=last).contains(&code))
        })
}

/// The system of a number, of EPSG or of Esri; `None` if there is no such system.
#[must_use]
pub(crate) fn from_code(code: u32) -> Option<Crs> {
    let mut crs = Crs { code: Some(code), ..Crs::named(format!("EPSG:{code}")) };
    let mut is_known = false;
    for (title, entry) in entries(code) {
        is_known = true;
        match title.split_once(' ') {
            None => match title {
                "geographic" => crs.axes = Axes::Degrees,
                "geocentric" => crs.axes = Axes::Geocentric,
                "projected" if crs.axes == Axes::Unknown => crs.axes = Axes::Metres,
                "world" => crs.axes = Axes::World,
                "vertical" => {
                    crs.heights.get_or_insert(Heights::metres());
                }
                "depth" => crs.heights.get_or_insert(Heights::metres()).is_depth = true,
                "compound" => return compound(code, entry),
                _ => {}
            },
            Some(("unit", rest)) => crs.axes = length(rest).map_or(Axes::Unknown, Axes::Length),
            Some(("utm", datum)) => {
                crs.datum = Some(datum.to_owned());
                crs.utm = zone(code, entry);
            }
            Some(("vertical", rest)) => {
                if let Some(unit) = rest.strip_prefix("unit ").and_then(length) {
                    crs.heights.get_or_insert(Heights::metres()).unit = unit;
                }
            }
            Some(_) => {}
        }
    }
    is_known.then_some(crs)
}

/// `0.3048 foot`.
fn length(text: &str) -> Option<Length> {
    let (metres, name) = text.split_once(' ')?;
    Some(Length { name: name.to_owned(), metres: metres.parse().ok()? })
}

/// Zone of a code from an entry such as `32601-32660:1N`.
fn zone(code: u32, entry: &str) -> Option<UtmZone> {
    let (range, zone) = entry.split_once(':')?;
    let first: u32 = range.split('-').next()?.parse().ok()?;
    let number: u8 = zone.trim_end_matches(['N', 'S']).parse().ok()?;
    let number = number + u8::try_from(code - first).ok()?;
    Some(UtmZone { number, is_south: zone.ends_with('S') })
}

/// The parts of an entry such as `5555:25832+5783` as one system.
fn compound(code: u32, entry: &str) -> Option<Crs> {
    let (horizontal, vertical) = entry.split_once(':')?.1.split_once('+')?;
    let horizontal = from_code(horizontal.parse().ok()?)?;
    let heights = from_code(vertical.parse().ok()?).and_then(|crs| crs.heights);
    let name = format!("EPSG:{code} ({})", horizontal.name);
    Some(Crs { name, heights, ..horizontal })
}

impl Heights {
    pub(super) fn metres() -> Self {
        Self { unit: Length::metre(), is_depth: false }
    }
}
