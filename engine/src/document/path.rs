//! Paths in the document.

/// A step of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step<'a> {
    /// A key of the language.
    Key(&'a str),
    /// A name that the author gave.
    Name(&'a str),
    /// Position in a list or a tuple, from 0.
    Index(usize),
}

/// Text of a path, such as `sensors.nadir.size_px[0]`.
pub(super) fn path_of(steps: &[Step<'_>]) -> String {
    let mut path = String::new();
    for step in steps {
        match step {
            Step::Key(name) | Step::Name(name) if path.is_empty() => path.push_str(name),
            Step::Key(name) | Step::Name(name) => path.extend([".", name]),
            Step::Index(index) => path.extend(["[", &index.to_string(), "]"]),
        }
    }
    path
}
