//! Lines of `objects.txt`: an object and its components, each a file of its own.

use std::path::Path;

use anyhow::{Result, bail};

/// A component of an object.
#[derive(Debug, PartialEq)]
pub(super) struct Component {
    pub(super) file: String,
    pub(super) optics: String,
    pub(super) temperature: Option<String>,
    pub(super) has_colour: bool,
}

/// Splits a line into the name of its object and its components.
///
/// A name may hold spaces although LESS's manual forbids them: files of components are called
/// `object_group.obj`, which shows where the name ends.
pub(super) fn object(line: &str) -> (&str, &str) {
    let spaces = line.match_indices(char::is_whitespace);
    let named = spaces.clone().find(|&(at, _)| {
        let (name, rest) = (&line[..at], line[at..].trim_start());
        rest.strip_prefix(name).is_some_and(|rest| rest.starts_with('_'))
    });
    match named.or_else(|| spaces.clone().next()) {
        Some((at, _)) => (&line[..at], line[at..].trim_start()),
        None => (line, ""),
    }
}

/// Components of an object: `file.obj property temperature 0xcolour`, one behind the other. Names of
/// files may hold spaces.
pub(super) fn read(text: &str) -> Result<Vec<Component>> {
    let mut components = Vec::new();
    let mut file: Vec<&str> = Vec::new();
    let mut words = text.split_whitespace().peekable();
    while let Some(word) = words.next() {
        file.push(word);
        if !is_obj(word) {
            continue;
        }
        let name = file.join(" ");
        file.clear();
        let mut rest = Vec::new();
        // What follows belongs to this component unless it begins the name of the next file.
        while let Some(word) = words.peek() {
            if rest.len() == 3 || is_obj(word) || is_colour(rest.last()) {
                break;
            }
            rest.push(*word);
            words.next();
        }
        components.push(component(name, &rest)?);
    }
    if !file.is_empty() {
        bail!("{:?} is no `.obj` file", file.join(" "));
    }
    Ok(components)
}

fn component(file: String, rest: &[&str]) -> Result<Component> {
    let [optics, rest @ ..] = rest else { bail!("{file:?} has no optical property") };
    let (colours, temperatures): (Vec<&str>, Vec<&str>) =
        rest.iter().partition(|word| is_colour(Some(word)));
    if temperatures.len() > 1 {
        bail!("{file:?} {optics} {}: not `file.obj property temperature 0xcolour`", rest.join(" "));
    }
    Ok(Component {
        file,
        optics: (*optics).to_owned(),
        temperature: temperatures.first().map(|&name| name.to_owned()),
        has_colour: !colours.is_empty(),
    })
}

fn is_obj(word: &str) -> bool {
    Path::new(word).extension().is_some_and(|ext| ext.eq_ignore_ascii_case("obj"))
}

fn is_colour(word: Option<&&str>) -> bool {
    word.is_some_and(|word| word.starts_with("0x") || word.starts_with('#'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_may_hold_spaces() {
        let line = "Scots pine Scots pine_crown.obj leaf T300 0x00ff00 Scots pine_stem.obj bark";
        let (name, rest) = object(line);
        assert_eq!(name, "Scots pine");
        let components = read(rest).expect("two components");
        let files: Vec<_> = components.iter().map(|component| component.file.as_str()).collect();
        assert_eq!(files, ["Scots pine_crown.obj", "Scots pine_stem.obj"]);
        assert_eq!(components[0].temperature.as_deref(), Some("T300"));
        assert_eq!(components[1].optics, "bark");
    }

    #[test]
    fn an_object_without_components_is_a_name() {
        assert_eq!(object("pine"), ("pine", ""));
        assert_eq!(read("").expect("nothing"), []);
    }

    #[test]
    fn what_is_no_component_is_an_error() {
        for wrong in ["leaf", "a.obj", "a.obj leaf T300 T400"] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }
}
