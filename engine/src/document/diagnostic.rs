//! Diagnostics of a scene: errors and warnings with their place and advice.

use super::path::{ScenePath, Step};
use super::ron_text::Span;

/// Severity of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The scene cannot run.
    Error,
    /// The scene can run, but may be wrong.
    Warning,
}

/// Place in the text of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Name of the file, as it was given to the reader.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Bytes of the text.
    pub span: Span,
}

/// Error or warning, with its place and advice.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Error or warning.
    pub severity: Severity,
    /// Path in the document.
    pub path: ScenePath,
    /// Description of the problem.
    pub message: String,
    /// Advice: text to write instead.
    pub help: Option<String>,
    /// True if the key at the end of the path is wrong, not its value.
    pub is_of_key: bool,
    /// Place in the text; if absent, [`super::Source::place`] finds it from `path`.
    pub place: Option<Place>,
}

impl Diagnostic {
    /// Creates an error at a path in the document.
    pub fn error(path: impl Into<ScenePath>, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            path: path.into(),
            message: message.into(),
            help: None,
            is_of_key: false,
            place: None,
        }
    }

    /// Creates a warning at a path in the document.
    pub fn warning(path: impl Into<ScenePath>, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(path, message) }
    }

    /// Returns the diagnostic with advice.
    #[must_use]
    pub fn help(self, help: impl Into<String>) -> Self {
        Self { help: Some(help.into()), ..self }
    }

    /// Returns the diagnostic with a place.
    #[must_use]
    pub(super) fn at(self, place: Place) -> Self {
        Self { place: Some(place), ..self }
    }

    /// Returns whether the diagnostic is an error, not a warning.
    #[must_use]
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// Returns the known name that is most like a wrong one, unless all differ too much.
pub fn nearest<'a>(wrong: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let lower = wrong.to_lowercase();
    let scored = known.into_iter().filter(|name| *name != wrong).map(|name| {
        let candidate = name.to_lowercase();
        let edits = strsim::damerau_levenshtein(&lower, &candidate);
        let length = lower.chars().count().max(candidate.chars().count());
        // Two letters in five may be wrong; a name that the other starts with is near as well.
        let shortened = lower.chars().count() >= 3
            && candidate.chars().count() >= 3
            && (candidate.starts_with(&lower) || lower.starts_with(&candidate));
        let plausible = edits * 5 <= length * 2 || shortened;
        (plausible, edits, name)
    });
    // `min_by_key` keeps the first of equals: document order decides.
    scored.filter(|&(plausible, ..)| plausible).min_by_key(|&(_, edits, _)| edits).map(|s| s.2)
}

/// Creates the error of an unknown name: ``no material `laef`; did you mean `leaf`? this scene defines: leaf, bark``.
pub fn unknown_name<'a>(
    path: impl Into<ScenePath>,
    kind: &str,
    name: &str,
    known: impl IntoIterator<Item = &'a str>,
) -> Diagnostic {
    let known: Vec<_> = known.into_iter().collect();
    let help = if known.is_empty() {
        format!("this scene defines no {kind}")
    } else {
        suggestion(name, &known, "this scene defines")
    };
    let error = Diagnostic::error(path, format!("no {kind} `{name}`")).help(help);
    let is_of_key = matches!(error.path.steps().last(), Some(Step::Name(last)) if last == name);
    Diagnostic { is_of_key, ..error }
}

/// Returns advice for an unknown name: ``did you mean `leaf`? this scene defines: leaf, bark``.
pub(crate) fn suggestion(wrong: &str, known: &[&str], introduction: &str) -> String {
    const SHOWN: usize = 20;
    let list = known.iter().take(SHOWN).copied().collect::<Vec<_>>().join(", ");
    let more = match known.len() {
        count if count > SHOWN => format!(", and {} more", count - SHOWN),
        _ => String::new(),
    };
    let list = format!("{introduction}: {list}{more}");
    if let Some(parameter) = wrong.strip_prefix('=') {
        return format!("`={parameter}` is no formula here: write the name itself; {list}");
    }
    match nearest(wrong, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`? {list}"),
        None => list,
    }
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn the_nearest_name_is_found_only_if_it_is_plausible() {
        assert_eq!(nearest("laef", ["bark", "leaf"]), Some("leaf"));
        assert_eq!(nearest("zenit_deg", ["azimuth_deg", "zenith_deg"]), Some("zenith_deg"));
        assert_eq!(nearest("leaf_front", ["bark", "leaf"]), Some("leaf"));
        assert_eq!(nearest("Leaf", ["bark", "leaf"]), Some("leaf"));
        assert_eq!(nearest("granite", ["bark", "leaf"]), None);
        assert_eq!(nearest("", ["bark", "leaf"]), None);
        assert_eq!(nearest("x", []), None);
    }
}
