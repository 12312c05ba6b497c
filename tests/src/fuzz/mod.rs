//! Readers under hostile files: whatever a file says, the answer is a value or an error, soon and in
//! little memory.
//!
//! `cargo run --release -p sunfleck-tests --bin fuzz -- READER --seconds 600 --seed 1` looks for
//! files that break this; `tests/corpus/READER` keeps what it found, and the test
//! `corpus` reads all of that again.

mod mutation;
mod pipeline;
mod readers;

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use cpu_time::ProcessTime;
use peak_alloc::PeakAlloc;

pub use mutation::Mutator;
pub use readers::{READERS, Reader, reader};

/// What it may ask for beyond that for each byte of the file.
const BYTES_PER_BYTE: usize = 100;

/// What the last panic said, and where.
static LAST_PANIC: Mutex<String> = Mutex::new(String::new());

/// Whether a reader is at work, whose panics are findings.
static IS_READING: AtomicBool = AtomicBool::new(false);

/// What a reader made of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answer {
    /// What a person reads of it, without the file's folder.
    pub text: String,
    /// What kinds of things were said: two files that share them are alike.
    pub kinds: Vec<String>,
}

/// What no reader may do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fault {
    /// It panicked, or its value breaks a promise: message and place.
    Panic(String),
    /// It took so much processor time.
    Slow(Duration),
    /// It asked for so many bytes.
    Fat(usize),
}

impl Fault {
    /// Name of the kind of fault; faults of one panic share it.
    #[must_use]
    pub fn kind(&self) -> String {
        match self {
            Self::Panic(message) => kind_of(message),
            Self::Slow(_) => "slow".to_owned(),
            Self::Fat(_) => "fat".to_owned(),
        }
    }
}

/// Keeps panics of readers from being printed: [`judge`] returns them.
pub fn hush() {
    let usual = take_hook();
    set_hook(Box::new(move |info| {
        if !IS_READING.load(Ordering::Relaxed) {
            return usual(info);
        }
        let payload = info.payload();
        let text = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
        let text = text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_default();
        let place = info.location().map_or_else(String::new, ToString::to_string);
        *LAST_PANIC.lock().unwrap_or_else(PoisonError::into_inner) = format!("{place}: {text}");
    }));
}

/// What a reader makes of a file of the folder `folder`.
///
/// # Errors
/// What it must not do. Memory is counted where [`PeakAlloc`] is the global allocator.
///
/// # Panics
/// If the file cannot be read at all.
pub fn judge(reader: &Reader, folder: &Path, file: &Path) -> Result<Answer, Fault> {
    let length = fs::metadata(file).expect("the file can be read").len() as usize;
    PeakAlloc.reset_peak_usage();
    let before = PeakAlloc.current_usage();
    // Other programs may have the processor: only the time of this one counts.
    let start = ProcessTime::now();
    IS_READING.store(true, Ordering::Relaxed);
    let answer = catch_unwind(AssertUnwindSafe(|| (reader.read)(file)));
    IS_READING.store(false, Ordering::Relaxed);
    let seconds = start.elapsed();
    let peak = PeakAlloc.peak_usage().saturating_sub(before);
    let Ok((text, mut kinds)) = answer else {
        let message = LAST_PANIC.lock().unwrap_or_else(PoisonError::into_inner).clone();
        return Err(Fault::Panic(message));
    };
    if peak > reader.free_bytes + BYTES_PER_BYTE * length {
        return Err(Fault::Fat(peak));
    }
    if seconds.as_secs_f64() > reader.most_seconds {
        return Err(Fault::Slow(seconds));
    }
    let text = text.replace(&format!("{}/", folder.display()), "");
    for kind in &mut kinds {
        *kind = kind_of(&kind.replace(&format!("{}/", folder.display()), ""));
    }
    Ok(Answer { text, kinds })
}

/// The first line of a message without its numbers and what it quotes.
fn kind_of(message: &str) -> String {
    let mut kind = String::new();
    let mut quote = None;
    let mut characters = message.lines().next().unwrap_or_default().chars();
    while let Some(character) = characters.next() {
        match quote {
            Some(_) if character == '\\' => drop(characters.next()),
            Some(open) if character == open => quote = None,
            Some(_) => {}
            None if "`\"".contains(character) => quote = Some(character),
            None if character.is_ascii_digit() && kind.ends_with('0') => {}
            None if character.is_ascii_digit() => kind.push('0'),
            None => kind.push(character),
        }
    }
    kind.truncate(kind.floor_char_boundary(120));
    kind
}

/// All files of a folder and the folders below it whose names end so, sorted.
///
/// # Panics
/// If the folder cannot be listed.
#[must_use]
pub fn files_below(folder: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let extension = path.extension().and_then(|extension| extension.to_str());
            if path.is_dir() {
                folders.push(path);
            } else if extension.is_some_and(|extension| extensions.contains(&extension)) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The project's folder.
#[must_use]
pub fn project() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}
