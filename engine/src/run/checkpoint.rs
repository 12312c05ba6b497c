//! What a run has traced, in a file that is whole at any moment: it can be gone on with, and shares of
//! a run can be united.
//!
//! All numbers are little-endian. A file is
//!
//! | bytes | |
//! |---|---|
//! | 16 | `sunfleck traced` and a line feed |
//! | 4 | version of this format, 2 |
//! | 4, n | length and text of the version of sunfleck: another one may draw other numbers |
//! | 32 | hash of the scene without what says how long it is measured |
//! | 4, 4 | which share of the run this is, from 0, and of how many |
//! | 4 | number of sensors that have been begun; of each |
//! | 4, n | length and text of its name |
//! | 8, 8 | samples of each randomisation (u64) and seconds (f64) so far |
//! | 8, n | length of what its films hold, and that (`transport::Film::save`) |
//! | 32 | BLAKE3 of all bytes before |
//!
//! It is written under another name and renamed, so that a run that is killed leaves the last one.

use std::fs::File;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use super::Failure;
use crate::transport::Share;

const MAGIC: [u8; 16] = *b"sunfleck traced\n";
const VERSION: u32 = 2;

/// Where and how often a run writes down what it has traced.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// The file.
    pub file: PathBuf,
    /// Seconds between two writings.
    pub every: f64,
    /// Which share of the run is traced.
    pub share: Share,
}

/// What a sensor has traced so far.
#[derive(Clone)]
pub(super) struct Section {
    pub(super) name: String,
    /// Samples of each randomisation.
    pub(super) done: u64,
    pub(super) seconds: f64,
    pub(super) state: Arc<Vec<u8>>,
}

/// All that runs of a scene have traced, and the file that it goes to.
pub(super) struct Keeper {
    hash: [u8; 32],
    /// Shares that were read, each with its sections.
    read: Vec<(Share, Vec<Section>)>,
    to: Option<Checkpoint>,
    /// What the file is to hold.
    sections: Vec<Section>,
    written: Instant,
}

impl Keeper {
    /// Of a run that keeps nothing.
    pub(super) fn idle() -> Self {
        Self {
            hash: [0; 32],
            read: Vec::new(),
            to: None,
            sections: Vec::new(),
            written: Instant::now(),
        }
    }

    /// Of a run that goes on with a file, if it is there.
    ///
    /// # Errors
    /// If the file cannot be read, is damaged, or is of another scene or share.
    pub(super) fn open(to: &Checkpoint, hash: [u8; 32]) -> Result<Self, Failure> {
        let mut keeper = Self { hash, to: Some(to.clone()), ..Self::idle() };
        if to.file.try_exists().map_err(|source| unreadable(&to.file, source))? {
            let (share, sections) = load(&to.file, hash)?;
            if share != to.share {
                let found =
                    format!("holds {}, and {} is to be traced", part(share), part(to.share));
                return Err(wrong(&to.file, &found, "give each part a file of its own"));
            }
            keeper.sections.clone_from(&sections);
            keeper.read.push((share, sections));
        }
        Ok(keeper)
    }

    /// Of a run that unites all shares of another one.
    ///
    /// # Errors
    /// If one cannot be read, is damaged or of another scene, or if they are not all shares of one run.
    pub(super) fn unite(files: &[PathBuf], hash: [u8; 32]) -> Result<Self, Failure> {
        let mut read: Vec<(Share, Vec<Section>)> = Vec::new();
        for (index, file) in files.iter().enumerate() {
            let (share, sections) = load(file, hash)?;
            if let Some((first, others)) = read.first() {
                if share.of != first.of {
                    let found = format!(
                        "holds {}, and {} holds {}",
                        part(share),
                        files[0].display(),
                        part(*first)
                    );
                    return Err(wrong(file, &found, "unite parts of one division"));
                }
                let places = |sections: &[Section]| -> Vec<(String, u64)> {
                    sections.iter().map(|one| (one.name.clone(), one.done)).collect()
                };
                if places(&sections) != places(others) {
                    let found = format!("has not traced as much as {}", files[0].display());
                    return Err(wrong(file, &found, "go on with both to the same end first"));
                }
            }
            if let Some(twin) = read.iter().position(|(other, _)| *other == share) {
                let found = format!("holds {}, as {} does", part(share), files[twin].display());
                return Err(wrong(&files[index], &found, "give each part once"));
            }
            read.push((share, sections));
        }
        let of = read.first().map_or(1, |(share, _)| share.of);
        let missing: Vec<String> = (0..of)
            .map(|index| Share { index, of })
            .filter(|share| !read.iter().any(|(other, _)| other == share))
            .map(part)
            .collect();
        if let (false, Some(file)) = (missing.is_empty(), files.first()) {
            let found = format!("is one of {of}, and {} is missing", missing.join(", "));
            return Err(wrong(file, &found, "give the files of all parts"));
        }
        Ok(Self { hash, read, ..Self::idle() })
    }

    /// Which share is traced.
    pub(super) fn share(&self) -> Share {
        self.to.as_ref().map_or(Share::ALL, |to| to.share)
    }

    /// Whether anything is kept.
    pub(super) const fn keeps(&self) -> bool {
        self.to.is_some()
    }

    /// What was traced before for a sensor, by share.
    pub(super) fn before(&self, name: &str) -> Vec<(Share, Section)> {
        let of = |(share, sections): &(Share, Vec<Section>)| {
            Some((*share, sections.iter().find(|section| section.name == name)?.clone()))
        };
        self.read.iter().filter_map(of).collect()
    }

    /// Whether it is time to write.
    pub(super) fn is_due(&self) -> bool {
        self.to.as_ref().is_some_and(|to| self.written.elapsed().as_secs_f64() >= to.every)
    }

    /// Keeps what a sensor has traced, in place of what was kept of it.
    pub(super) fn hold(&mut self, section: Section) {
        match self.sections.iter_mut().find(|other| other.name == section.name) {
            Some(other) => *other = section,
            None => self.sections.push(section),
        }
    }

    /// Writes all that is kept.
    ///
    /// # Errors
    /// If the file cannot be written; the one before it is still there.
    pub(super) fn write(&mut self) -> Result<(), Failure> {
        let Some(to) = &self.to else { return Ok(()) };
        store(to, self.hash, &self.sections).map_err(|source| Failure::Checkpoint {
            file: to.file.clone(),
            what: format!("could not be written: {source}"),
            help: "the results are not lost: free some space, or write it elsewhere".to_owned(),
        })?;
        self.written = Instant::now();
        Ok(())
    }

    /// Seconds that a round may take.
    pub(super) fn round(&self) -> f64 {
        self.to.as_ref().map_or(f64::INFINITY, |to| 0.5 * to.every)
    }
}

/// `part 2/4`.
fn part(share: Share) -> String {
    match share {
        Share::ALL => "a whole run".to_owned(),
        Share { index, of } => format!("part {}/{of}", index + 1),
    }
}

fn wrong(file: &Path, what: &str, help: &str) -> Failure {
    Failure::Checkpoint { file: file.to_owned(), what: what.to_owned(), help: help.to_owned() }
}

fn unreadable(file: &Path, source: io::Error) -> Failure {
    Failure::Read { path: file.to_owned(), source }
}

/// Writes and hashes.
struct Hashed<W> {
    inner: W,
    hasher: blake3::Hasher,
}

impl<W: Write> Write for Hashed<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.hasher.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

fn store(to: &Checkpoint, hash: [u8; 32], sections: &[Section]) -> io::Result<()> {
    let mut partial = to.file.clone().into_os_string();
    partial.push(".partial");
    let file = File::create(&partial)?;
    let mut out = Hashed { inner: io::BufWriter::new(file), hasher: blake3::Hasher::new() };
    out.write_all(&MAGIC)?;
    out.write_all(&VERSION.to_le_bytes())?;
    text(&mut out, env!("CARGO_PKG_VERSION"))?;
    out.write_all(&hash)?;
    out.write_all(&to.share.index.to_le_bytes())?;
    out.write_all(&to.share.of.to_le_bytes())?;
    out.write_all(&(sections.len() as u32).to_le_bytes())?;
    for section in sections {
        text(&mut out, &section.name)?;
        out.write_all(&section.done.to_le_bytes())?;
        out.write_all(&section.seconds.to_le_bytes())?;
        out.write_all(&(section.state.len() as u64).to_le_bytes())?;
        out.write_all(&section.state)?;
    }
    let sum = out.hasher.finalize();
    out.write_all(sum.as_bytes())?;
    out.inner.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()?;
    std::fs::rename(&partial, &to.file)?;
    // The new name is on the disk when the folder is; where folders cannot be opened, it is the
    // system that sees to that.
    let folder = to.file.parent().filter(|folder| !folder.as_os_str().is_empty());
    if let Ok(folder) = File::open(folder.unwrap_or(Path::new("."))) {
        folder.sync_all().or_else(|error| match error.kind() {
            io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported => Ok(()),
            _ => Err(error),
        })?;
    }
    Ok(())
}

fn text(out: &mut impl Write, text: &str) -> io::Result<()> {
    out.write_all(&(text.len() as u32).to_le_bytes())?;
    out.write_all(text.as_bytes())
}

/// Reads a checkpoint of a scene.
fn load(file: &Path, hash: [u8; 32]) -> Result<(Share, Vec<Section>), Failure> {
    let bytes = std::fs::read(file).map_err(|source| unreadable(file, source))?;
    let start_again = "take the file away to trace from the start";
    let damaged =
        || wrong(file, "is damaged: its checksum is not that of what it holds", start_again);
    if bytes.len() < MAGIC.len() || bytes[..MAGIC.len()] != MAGIC {
        // What starts otherwise was never one, unless it was cut off.
        let found = "is no checkpoint of sunfleck";
        return Err(wrong(file, found, "name another file; this one is left as it is"));
    }
    let (all, sum) = bytes.split_last_chunk::<32>().ok_or_else(damaged)?;
    if blake3::hash(all) != *sum {
        return Err(damaged());
    }
    let mut rest = &all[MAGIC.len()..];
    let version = number(&mut rest).map_err(|_short| damaged())?;
    if version != VERSION {
        let found = format!("has format {version}, and this version reads format {VERSION}");
        return Err(wrong(file, &found, start_again));
    }
    let sunfleck = string(&mut rest).map_err(|_short| damaged())?;
    if sunfleck != env!("CARGO_PKG_VERSION") {
        let found = format!(
            "was written by sunfleck {sunfleck}, and this is {}, which may draw other numbers",
            env!("CARGO_PKG_VERSION")
        );
        return Err(wrong(file, &found, start_again));
    }
    let body = (|| -> io::Result<([u8; 32], Share, Vec<Section>)> {
        let scene = array(&mut rest)?;
        let share = Share { index: number(&mut rest)?, of: number(&mut rest)? };
        let count = number(&mut rest)?;
        let sections = (0..count).map(|_| section(&mut rest)).collect::<io::Result<_>>()?;
        Ok((scene, share, sections))
    })();
    let (scene, share, sections) = body.map_err(|_short| damaged())?;
    if scene != hash {
        let found = "is of another scene: only `until`, `samples_per_px`, `samples_per_m2`, `per_m2` and \
                     the quality may differ";
        return Err(wrong(file, found, start_again));
    }
    if share.index >= share.of {
        return Err(damaged());
    }
    Ok((share, sections))
}

fn section(input: &mut &[u8]) -> io::Result<Section> {
    let name = string(input)?;
    let done = u64::from_le_bytes(array(input)?);
    let seconds = f64::from_le_bytes(array(input)?);
    let length = u64::from_le_bytes(array(input)?);
    let length = usize::try_from(length).ok().filter(|length| *length <= input.len());
    let (state, rest) = input.split_at(length.ok_or(io::ErrorKind::UnexpectedEof)?);
    *input = rest;
    Ok(Section { name, done, seconds, state: Arc::new(state.to_vec()) })
}

fn array<const N: usize>(input: &mut &[u8]) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    input.read_exact(&mut bytes)?;
    Ok(bytes)
}

fn number(input: &mut &[u8]) -> io::Result<u32> {
    Ok(u32::from_le_bytes(array(input)?))
}

fn string(input: &mut &[u8]) -> io::Result<String> {
    let length = number(input)? as usize;
    let (bytes, rest) = input.split_at_checked(length).ok_or(io::ErrorKind::UnexpectedEof)?;
    *input = rest;
    String::from_utf8(bytes.to_vec())
        .map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
}
