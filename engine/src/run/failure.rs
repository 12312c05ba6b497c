use std::path::PathBuf;

use crate::counts::counted;
use crate::document::{Diagnostic, Source, legible};
use crate::queries::{LeafAreaError, TooManyCells};

/// Reason for which a scene was not run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "each variant's message names its fields")]
pub enum Failure {
    /// The scene's text is wrong; rendered with its lines.
    #[error("{0}")]
    Scene(String),
    /// The scene is wrong, and there is no text to point into.
    #[error("{}", .0.iter().map(one_line).collect::<Vec<_>>().join("\n"))]
    Problems(Vec<Diagnostic>),
    /// The scene has no points to run at, or not these.
    #[error("{0}")]
    Sweep(String),
    /// A point of a sweep failed.
    #[error("at {point}: {}", without_severity(&source.to_string()))]
    Point { point: String, source: Box<Self> },
    #[error("{}: could not be read again: {source}", path.display())]
    Read { path: PathBuf, source: std::io::Error },
    #[error("the temporary file of an image: {0}")]
    Pixels(std::io::Error),
    #[error("{}: {what}; {help}", file.display())]
    Checkpoint { file: PathBuf, what: String, help: String },
    #[error("cancelled at sensor `{sensor}`, {:.1} % of which was done", 100.0 * done)]
    Cancelled {
        sensor: String,
        done: f64,
        /// Checkpoint that holds what was done.
        saved: Option<PathBuf>,
    },
    #[error("could not start {}: {reason}", counted(.threads, "thread"))]
    Threads { threads: usize, reason: String },
    #[error(transparent)]
    LeafArea(#[from] LeafAreaError),
    #[error(transparent)]
    HeightModel(#[from] TooManyCells),
}

impl Failure {
    /// Returns true if the run ended because it was [cancelled](super::Progress::is_cancelled).
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        match self {
            Self::Cancelled { .. } => true,
            Self::Point { source, .. } => source.is_cancelled(),
            _ => false,
        }
    }

    /// Failure with the lines of the scene that it is about.
    #[must_use]
    pub fn with_source(self, source: &Source) -> Self {
        match self {
            Self::Problems(problems) => Self::Scene(source.render(&problems)),
            other => other,
        }
    }
}

/// Rendered text without `error: ` at its start, which the program adds.
fn without_severity(text: &str) -> &str {
    text.strip_prefix("error: ").unwrap_or(text)
}

/// A problem without the line of text that it stands in.
pub(super) fn one_line(problem: &Diagnostic) -> String {
    let Diagnostic { path, message, help, .. } = problem;
    let help = help.as_ref().map_or_else(String::new, |help| format!(" ({help})"));
    let text = if path.is_root() { message.clone() } else { format!("{path}: {message}") };
    format!("{}{}", legible(&text), legible(&help))
}
