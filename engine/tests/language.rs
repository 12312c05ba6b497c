//! The scene language: what a scene file may say, and what a person reads where it says it wrong.

#[path = "language/advice.rs"]
mod advice;
#[path = "language/broken.rs"]
mod broken;
#[path = "language/crowns.rs"]
mod crowns;
#[path = "language/editing.rs"]
mod editing;
#[path = "language/formatting.rs"]
mod formatting;
#[path = "language/hostile.rs"]
mod hostile;
#[path = "language/include.rs"]
mod include;
#[path = "language/misread.rs"]
mod misread;
#[path = "language/reading.rs"]
mod reading;
#[path = "language/writing.rs"]
mod writing;
