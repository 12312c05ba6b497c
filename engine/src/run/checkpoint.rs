//! What a run has traced, in a file that is whole at any moment: it can be gone on with, and shares of
//! a run can be united.
//!
//! All numbers are little-endian. A file is
//!
//! | bytes | |
//! |---|---|
//! | 16 | `sunfleck traced` and a line feed |
//! | 4 | version of this format, 3 |
//! | 4, n | length and text of the version of sunfleck: another one may draw other numbers |
//! | 32 | hash of the scene without what says how long it is measured |
//! | 4, 4 | which share of the run this is, from 0, and of how many |
//! | 4 | number of sensors that have been begun; of each |
//! | 4, n | length and text of its name |
//! | 8, 8 | samples of each randomisation (u64) and seconds (f64) so far |
//! | 8, n | length of what its films hold, and that (`transport::Film::save`) |
//! | 32 | BLAKE3 of all bytes before |
//!
//! It is written under a name of its own and renamed, so that a run that is killed leaves the last one.

use std::fs::File;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use super::Failure;
use crate::output;
use crate::products::data_size;
use crate::transport::Partition;

const MAGIC: [u8; 16] = *b"sunfleck traced\n";
const VERSION: u32 = 3;

/// Where and how often a run writes down what it has traced.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// The file.
    pub file: PathBuf,
    /// Seconds between two writings.
    pub every: f64,
    /// Which share of the run is traced.
    pub share: Partition,
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
    read: Vec<(Partition, Vec<Section>)>,
    to: Option<Checkpoint>,
    /// What the file is to hold.
    sections: Vec<Section>,
    written: Instant,
    /// Why the last writing failed.
    failed: Option<String>,
}

impl Checkpoint {
    /// Tries whether the file can be written, before anything is traced; leaves everything as it was.
    ///
    /// # Errors
    /// If it cannot.
    pub(super) fn try_file(&self) -> Result<(), Failure> {
        let unwritable = |source: io::Error| {
            let what = format!("cannot be written: {source}");
            wrong(&self.file, &what, "name a file in a folder that exists and may be written to")
        };
        match std::fs::metadata(&self.file) {
            Ok(metadata) if !metadata.is_file() => Err(no_file(&self.file)),
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(unwritable(error)),
            _ => output::try_file(&self.file).map_err(unwritable),
        }
    }
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
            failed: None,
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
        let mut read: Vec<(Partition, Vec<Section>)> = Vec::new();
        for (index, file) in files.iter().enumerate() {
            let (share, sections) = load(file, hash)?;
            if let Some((first, others)) = read.first() {
                if share.count != first.count {
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
        let of = read.first().map_or(1, |(share, _)| share.count);
        let missing: Vec<String> = (0..of)
            .map(|index| Partition { index, count: of })
            .filter(|share| !read.iter().any(|(other, _)| other == share))
            .map(part)
            .collect();
        if let (false, Some(file)) = (missing.is_empty(), files.first()) {
            let found = format!("is one of {of}, and {} is missing", missing.join(", "));
            return Err(wrong(file, &found, "give the files of all parts"));
        }
        Ok(Self { hash, read, ..Self::idle() })
    }

    /// Names of the sensors that a checkpoint holds, if it is of another scene than that with this hash.
    ///
    /// # Errors
    /// If it cannot be read or is damaged.
    pub(super) fn other_sensors(file: &Path, hash: [u8; 32]) -> Result<Vec<String>, Failure> {
        let Traced { scene, sections, .. } = read(file)?;
        if scene == hash {
            return Ok(Vec::new());
        }
        Ok(sections.into_iter().map(|section| section.name).collect())
    }

    /// Which share is traced.
    pub(super) fn share(&self) -> Partition {
        self.to.as_ref().map_or(Partition::ALL, |to| to.share)
    }

    /// Whether anything is kept.
    pub(super) const fn keeps(&self) -> bool {
        self.to.is_some()
    }

    /// What was traced before for a sensor, by share.
    pub(super) fn before(&self, name: &str) -> Vec<(Partition, Section)> {
        let of = |(share, sections): &(Partition, Vec<Section>)| {
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

    /// Writes all that is kept, in the middle of a run. If that fails, the run goes on: what it traces
    /// is not lost, and the next time may be better. Returns what to warn of.
    pub(super) fn save(&mut self) -> Option<String> {
        let to = self.to.as_ref()?;
        let stored = store(to, self.hash, &self.sections);
        self.written = Instant::now();
        self.failed = stored.err().map(|source| {
            let file = to.file.display();
            let old = if to.file.exists() { ", which holds what it held before" } else { "" };
            format!("cannot write the checkpoint {file}{old}: {source}; the run goes on")
        });
        self.failed.clone()
    }

    /// Writes all that is kept, at the end of a run; returns what to warn of.
    ///
    /// # Errors
    /// If the file cannot be written and is all that this run leaves.
    pub(super) fn finish(&mut self) -> Result<Option<String>, Failure> {
        let Some(warning) = self.save() else { return Ok(None) };
        match &self.to {
            Some(to) if to.share != Partition::ALL => Err(Failure::Checkpoint {
                file: to.file.clone(),
                what: "could not be written, and what was traced of this part is lost".to_owned(),
                help: warning,
            }),
            _ => Ok(Some(warning)),
        }
    }

    /// Seconds that a round may take.
    pub(super) fn round(&self) -> f64 {
        self.to.as_ref().map_or(f64::INFINITY, |to| 0.5 * to.every)
    }
}

/// `part 2/4`.
fn part(share: Partition) -> String {
    match share {
        Partition::ALL => "a whole run".to_owned(),
        Partition { index, count: of } => format!("part {}/{of}", index + 1),
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
    output::replace_file(&to.file, |file| {
        let mut out = Hashed { inner: io::BufWriter::new(file), hasher: blake3::Hasher::new() };
        out.write_all(&MAGIC)?;
        out.write_all(&VERSION.to_le_bytes())?;
        text(&mut out, env!("CARGO_PKG_VERSION"))?;
        out.write_all(&hash)?;
        out.write_all(&to.share.index.to_le_bytes())?;
        out.write_all(&to.share.count.to_le_bytes())?;
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
        out.flush()
    })
}

fn text(out: &mut impl Write, text: &str) -> io::Result<()> {
    out.write_all(&(text.len() as u32).to_le_bytes())?;
    out.write_all(text.as_bytes())
}

/// Largest checkpoint that is read, bytes: films of more take more memory than machines have.
const LARGEST: u64 = 1 << 40;

/// What a checkpoint holds; of another file no more is read than its start.
fn bytes_of(file: &Path) -> Result<Vec<u8>, Failure> {
    let fail = |source| unreadable(file, source);
    let metadata = std::fs::metadata(file).map_err(fail)?;
    // Opening a pipe would wait for its writer, and a device may have no end.
    if !metadata.is_file() {
        return Err(no_file(file));
    }
    if metadata.len() > LARGEST {
        let found = format!("holds {}", data_size(metadata.len()));
        return Err(wrong(
            file,
            &found,
            &format!("a checkpoint has {} at most", data_size(LARGEST)),
        ));
    }
    let mut input = File::open(file).map_err(fail)?;
    let mut bytes = Vec::new();
    Read::by_ref(&mut input).take(MAGIC.len() as u64).read_to_end(&mut bytes).map_err(fail)?;
    if bytes != MAGIC {
        // What starts otherwise was never one, unless it was cut off.
        let found = "is no checkpoint of sunfleck";
        return Err(wrong(file, found, "name another file; this one is left as it is"));
    }
    input.take(metadata.len()).read_to_end(&mut bytes).map_err(fail)?;
    Ok(bytes)
}

fn no_file(file: &Path) -> Failure {
    wrong(file, "is no regular file but a folder, a pipe or a device", "name a file")
}

/// All that a checkpoint holds.
struct Traced {
    /// Hash of the scene.
    scene: [u8; 32],
    share: Partition,
    sections: Vec<Section>,
}

/// Reads a checkpoint of a scene.
fn load(file: &Path, hash: [u8; 32]) -> Result<(Partition, Vec<Section>), Failure> {
    let Traced { scene, share, sections } = read(file)?;
    if scene != hash {
        let found = "is of another scene or of other sensors: only `until`, `samples_per_px`, `samples_per_m2`, \
                     `per_m2` and the quality may differ";
        return Err(wrong(file, found, START_AGAIN));
    }
    Ok((share, sections))
}

const START_AGAIN: &str = "take the file away to trace from the start";

/// Reads a checkpoint.
fn read(file: &Path) -> Result<Traced, Failure> {
    let bytes = bytes_of(file)?;
    let damaged =
        || wrong(file, "is damaged: its checksum is not that of what it holds", START_AGAIN);
    let (all, sum) = bytes.split_last_chunk::<32>().ok_or_else(damaged)?;
    if blake3::hash(all) != *sum {
        return Err(damaged());
    }
    let mut rest = &all[MAGIC.len()..];
    let version = number(&mut rest).map_err(|_short| damaged())?;
    if version != VERSION {
        let found = format!("has format {version}, and this version reads format {VERSION}");
        return Err(wrong(file, &found, START_AGAIN));
    }
    let sunfleck = string(&mut rest).map_err(|_short| damaged())?;
    if sunfleck != env!("CARGO_PKG_VERSION") {
        let found = format!(
            "was written by sunfleck {sunfleck}, and this is {}, which may draw other numbers",
            env!("CARGO_PKG_VERSION")
        );
        return Err(wrong(file, &found, START_AGAIN));
    }
    let body = (|| -> io::Result<([u8; 32], Partition, Vec<Section>)> {
        let scene = array(&mut rest)?;
        let share = Partition { index: number(&mut rest)?, count: number(&mut rest)? };
        let count = number(&mut rest)?;
        let sections = (0..count).map(|_| section(&mut rest)).collect::<io::Result<_>>()?;
        Ok((scene, share, sections))
    })();
    let (scene, share, sections) = body.map_err(|_short| damaged())?;
    if share.index >= share.count {
        return Err(damaged());
    }
    Ok(Traced { scene, share, sections })
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
