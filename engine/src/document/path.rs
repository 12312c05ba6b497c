//! Paths in the document.

use std::borrow::Cow;
use std::fmt;

/// Step of a path from a value of the document to one of its parts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// A key of the language.
    Key(Cow<'static, str>),
    /// A name that the author gave.
    Name(String),
    /// Position in a list or a tuple, from 0.
    Index(usize),
}

impl From<&'static str> for Step {
    fn from(key: &'static str) -> Self {
        Self::Key(key.into())
    }
}

/// Path to a value of the document; displayed as `sensors.nadir.size_px[0]`, empty for all of it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ScenePath(Vec<Step>);

impl ScenePath {
    /// Path to the whole document.
    #[must_use]
    pub const fn root() -> Self {
        Self(Vec::new())
    }

    /// Path to the value of a key below this one.
    #[must_use]
    pub fn key(&self, key: &'static str) -> Self {
        self.with(key.into())
    }

    /// Path to the value under a name that the author gave, below this one.
    #[must_use]
    pub fn name(&self, name: impl Into<String>) -> Self {
        self.with(Step::Name(name.into()))
    }

    /// Path to an element of a list or a tuple, numbered from 0.
    #[must_use]
    pub fn index(&self, index: usize) -> Self {
        self.with(Step::Index(index))
    }

    fn with(&self, step: Step) -> Self {
        Self([&self.0[..], &[step]].concat())
    }

    /// Steps from the whole document to the value.
    #[must_use]
    pub fn steps(&self) -> &[Step] {
        &self.0
    }

    /// Returns whether this is the path to the whole document.
    #[must_use]
    pub fn is_root(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns whether the value is the one at another path or a part of it.
    #[must_use]
    pub fn is_within(&self, ancestor: &Self) -> bool {
        self.0.starts_with(&ancestor.0)
    }

    pub(super) fn push(&mut self, step: Step) {
        self.0.push(step);
    }

    pub(super) fn pop(&mut self) {
        self.0.pop();
    }
}

/// Path to the value of one key of the scene.
impl From<&'static str> for ScenePath {
    fn from(key: &'static str) -> Self {
        Self::root().key(key)
    }
}

/// Path to the value at the last of these keys, each below the one before.
impl<const N: usize> From<[&'static str; N]> for ScenePath {
    fn from(keys: [&'static str; N]) -> Self {
        Self(keys.map(Step::from).to_vec())
    }
}

impl From<&Self> for ScenePath {
    fn from(path: &Self) -> Self {
        path.clone()
    }
}

impl fmt::Display for ScenePath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (depth, step) in self.0.iter().enumerate() {
            let dot = if depth == 0 { "" } else { "." };
            match step {
                Step::Key(key) => write!(f, "{dot}{key}")?,
                Step::Name(name) => write!(f, "{dot}{name}")?,
                Step::Index(index) => write!(f, "[{index}]")?,
            }
        }
        Ok(())
    }
}
