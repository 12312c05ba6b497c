//! Values of arguments: transport systems, parameters, parts of a run, memory.

use sunfleck::document::{self, FileFormat, System, nearest};
use sunfleck::run::Partition;

/// A transport system by its name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SystemName(pub(super) System);

impl std::fmt::Display for SystemName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.0.name())
    }
}

/// All systems but the slow reference integrator.
pub(super) fn default_systems() -> Vec<SystemName> {
    let systems = System::ALL.into_iter().filter(|system| *system != System::Reference);
    systems.map(SystemName).collect()
}

pub(super) fn system(text: &str) -> Result<SystemName, String> {
    let system = System::ALL.into_iter().find(|system| system.name() == text);
    system.map(SystemName).ok_or_else(|| unknown(text, &System::ALL.map(System::name)))
}

/// A file format by its name; case does not matter.
pub(super) fn file_format(text: &str) -> Result<FileFormat, String> {
    let has_name = |format: &FileFormat| format.name().eq_ignore_ascii_case(text);
    let format = FileFormat::ALL.into_iter().find(has_name);
    format.ok_or_else(|| unknown(text, &FileFormat::ALL.map(FileFormat::name)))
}

/// Advice for a name that is none of these.
fn unknown(text: &str, names: &[&str]) -> String {
    let all = names.join(", ");
    match nearest(text, names.iter().copied()) {
        Some(near) => format!("did you mean `{near}`? There are: {all}"),
        None => format!("there are: {all}"),
    }
}

/// A number, or a text: that of digits behind a zero, `007`, is none that a formula would need.
fn param(text: &str) -> document::Param {
    let is_code = text.starts_with('0') && text[1..].starts_with(|c: char| c.is_ascii_digit());
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() && !is_code => number.into(),
        _ => text.into(),
    }
}

pub(super) fn setting(text: &str) -> Result<(String, document::Param), String> {
    let (name, value) = text.split_once('=').ok_or("write NAME=VALUE, such as sza=30")?;
    let name = name.trim();
    if name.is_empty() {
        return Err("the name before `=` is missing".to_owned());
    }
    match value.trim() {
        "" => Err("there is no value behind `=`".to_owned()),
        value => Ok((name.to_owned(), param(value))),
    }
}

/// Largest number of parts of a run; each randomisation belongs to one part.
const MOST_PARTS: u32 = 32;

pub(super) fn part(text: &str) -> Result<Partition, String> {
    let numbers = text.split_once('/').and_then(|(index, of)| {
        Some((index.trim().parse::<u32>().ok()?, of.trim().parse::<u32>().ok()?))
    });
    match numbers {
        Some((index, of)) if (1..=of).contains(&index) && of <= MOST_PARTS => {
            Ok(Partition { index: index - 1, count: of })
        }
        _ => Err(format!("write, for example, 2/4: the second of four, of at most {MOST_PARTS}")),
    }
}

pub(crate) fn memory(text: &str) -> Result<u64, String> {
    let text = text.trim();
    let end = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let power = match text[end..].trim() {
        "KiB" => 1,
        "MiB" => 2,
        "GiB" => 3,
        "TiB" => 4,
        _ => 0,
    };
    match text[..end].parse::<f64>() {
        Ok(number) if number > 0.0 && power > 0 => Ok((number * 1024_f64.powi(power)) as u64),
        _ => Err("write a number and KiB, MiB, GiB or TiB, such as 4GiB".to_owned()),
    }
}

pub(super) fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds.is_finite() && seconds > 0.0 => Ok(seconds),
        _ => Err("write a number of seconds above 0, such as 60".to_owned()),
    }
}

/// A length above 0, m.
pub(crate) fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(length) if length.is_finite() && length > 0.0 => Ok(length),
        _ => Err("write a length in metres above 0, such as 0.5".to_owned()),
    }
}

pub(super) fn quality(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(factor) if factor.is_finite() && factor > 0.0 => Ok(factor),
        _ => Err("write a number above 0, such as 0.05".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_a_number_with_a_unit() {
        assert_eq!(memory("4GiB"), Ok(4 << 30));
        assert_eq!(memory("1.5 MiB"), Ok(3 << 19));
        for wrong in ["4", "GiB", "0MiB", "-1GiB", "4GB", "1e3KiB", "1.2.3GiB"] {
            assert!(memory(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn settings_are_names_with_values() {
        assert_eq!(setting("sza=30"), Ok(("sza".to_owned(), 30.0.into())));
        assert_eq!(setting(" lai = -1e-3 "), Ok(("lai".to_owned(), (-1e-3).into())));
        assert_eq!(setting("plot=007"), Ok(("plot".to_owned(), "007".into())));
        assert_eq!(setting("soil=a=b.csv"), Ok(("soil".to_owned(), "a=b.csv".into())));
        for wrong in ["sza", "=3", "sza=", "sza= "] {
            assert!(setting(wrong).is_err(), "{wrong}");
        }
    }
}
