//! Patterns that name instances.

/// Pattern of `hide` and `select`: `oak` (a mesh), `plot/*` (all meshes of some instances) or `plot/oak`, with `*`
/// for any characters.
#[derive(Clone, Debug)]
pub struct Pattern<'a> {
    instances: Option<&'a str>,
    mesh: &'a str,
}

impl<'a> Pattern<'a> {
    /// Parses a pattern.
    #[must_use]
    pub fn new(text: &'a str) -> Self {
        match text.split_once('/') {
            Some((instances, mesh)) => Self { instances: Some(instances), mesh },
            None => Self { instances: None, mesh: text },
        }
    }

    /// Returns whether the pattern names a mesh of some instances.
    #[must_use]
    pub fn matches(&self, instances: &str, mesh: &str) -> bool {
        self.instances.is_none_or(|pattern| is_like(pattern, instances)) && is_like(self.mesh, mesh)
    }
}

/// Returns whether a name matches a pattern with stars.
pub(crate) fn is_like(pattern: &str, name: &str) -> bool {
    let mut parts = pattern.split('*');
    let first = parts.next().unwrap_or_default();
    let Some(mut rest) = name.strip_prefix(first) else { return false };
    let Some(last) = parts.next_back() else { return rest.is_empty() };
    // Between the ends, the first place that fits leaves the most room for the others.
    for part in parts {
        match rest.find(part) {
            Some(at) => rest = &rest[at + part.len()..],
            None => return false,
        }
    }
    rest.ends_with(last)
}

#[cfg(test)]
mod tests {
    use super::{Pattern, is_like};

    #[test]
    fn stars_stand_for_any_letters() {
        for (pattern, name, expected) in [
            ("oak", "oak", true),
            ("oak", "oaks", false),
            ("oak*", "oaks", true),
            ("*", "", true),
            ("*k", "oak", true),
            ("o*k", "ok", true),
            ("o*o", "o", false),
            ("a*b*c", "a-bb-cc", true),
            ("a*b*c", "a-cc-bb", false),
            ("", "oak", false),
        ] {
            assert_eq!(is_like(pattern, name), expected, "{pattern} {name}");
        }
    }

    #[test]
    fn a_pattern_names_a_mesh_or_where_it_stands() {
        assert!(Pattern::new("oak").matches("plot 7", "oak"));
        assert!(Pattern::new("plot*/oak").matches("plot 7", "oak"));
        assert!(!Pattern::new("plot*/oak").matches("edge", "oak"));
        assert!(!Pattern::new("plot*/*").matches("edge", "oak"));
    }
}
