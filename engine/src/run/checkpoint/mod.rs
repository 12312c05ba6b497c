//! State of a run in a file that is complete at any moment: a run can be resumed from it, and the parts of a run can be
//! united. The file is written under a name of its own and renamed, so that a run that is killed leaves the last one.

mod format;
mod section;

use std::path::{Path, PathBuf};
use std::time::Instant;
use std::{fs, io};

use super::Failure;
use crate::output;
use crate::scattering::PathSpectra;
use crate::scratch::ScratchSpace;
use crate::transport::Partition;

use format::Contents;
pub(super) use section::{FilmState, Section, is_in_memory};

/// File that a run saves its state to and resumes from.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// The file.
    pub file: PathBuf,
    /// Rule for when the run saves its state.
    pub saves: SaveRule,
    /// Part of the run that is traced.
    pub share: Partition,
}

/// Rule for when a run saves its state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SaveRule {
    /// At intervals of so many seconds and at its end. The run is resumed from the file if that exists.
    Every(f64),
    /// When it is cancelled, and never else: what the file holds is not read, and nothing is written in a run that ends.
    WhenCancelled,
}

/// State of the measurements of a run, and the file that it is saved to.
pub(super) struct CheckpointStore {
    hash: [u8; 32],
    /// Place of states that take too much memory.
    scratch: ScratchSpace,
    /// Parts of the run that were read, each with its sections.
    read: Vec<(Partition, Vec<Section>)>,
    to: Option<Checkpoint>,
    /// True if the sections of measurements that have coefficients alone are collected, and nothing is saved.
    collects: bool,
    /// True if measurements end with what was read.
    is_complete: bool,
    /// Sections that the file will hold.
    sections: Vec<Section>,
    written: Instant,
    /// Error of the last save.
    failed: Option<String>,
}

impl Checkpoint {
    /// Checks that the file can be written, before anything is traced; changes nothing.
    ///
    /// # Errors
    /// If it cannot be written.
    pub(super) fn try_file(&self) -> Result<(), Failure> {
        if self.saves == SaveRule::WhenCancelled {
            return Ok(());
        }
        let unwritable = |source: io::Error| {
            let what = format!("cannot be written: {source}");
            wrong(&self.file, &what, "name a file in a folder that exists and may be written to")
        };
        match fs::metadata(&self.file) {
            Ok(metadata) if !metadata.is_file() => Err(not_regular(&self.file)),
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(unwritable(error)),
            _ => output::try_file(&self.file).map_err(unwritable),
        }
    }
}

impl CheckpointStore {
    /// Store of a run that saves nothing.
    pub(super) fn disabled() -> Self {
        Self {
            hash: [0; 32],
            scratch: ScratchSpace::default(),
            read: Vec::new(),
            to: None,
            collects: false,
            is_complete: false,
            sections: Vec::new(),
            written: Instant::now(),
            failed: None,
        }
    }

    /// Store of a run that is resumed from a file, if the file exists.
    ///
    /// # Errors
    /// If the file cannot be read, is damaged, or is of another scene or share.
    pub(super) fn open(
        to: &Checkpoint,
        hash: [u8; 32],
        scratch: &ScratchSpace,
    ) -> Result<Self, Failure> {
        let scratch = scratch.clone();
        let mut store = Self { hash, scratch, to: Some(to.clone()), ..Self::disabled() };
        if to.saves == SaveRule::WhenCancelled {
            return Ok(store);
        }
        if to.file.try_exists().map_err(|source| unreadable(&to.file, source))? {
            let (share, sections) = format::read_of_scene(&to.file, hash, &store.scratch)?;
            if share != to.share {
                let found =
                    format!("holds {}, and {} is to be traced", part(share), part(to.share));
                return Err(wrong(&to.file, &found, "give each part a file of its own"));
            }
            store.sections.clone_from(&sections);
            store.read.push((share, sections));
        }
        Ok(store)
    }

    /// Store of a run that unites all parts of another one.
    ///
    /// # Errors
    /// If one cannot be read, is damaged or of another scene, or if they are not all shares of one run.
    pub(super) fn unite(
        files: &[PathBuf],
        hash: [u8; 32],
        scratch: &ScratchSpace,
    ) -> Result<Self, Failure> {
        let mut read: Vec<(Partition, Vec<Section>)> = Vec::new();
        for (index, file) in files.iter().enumerate() {
            let (share, sections) = format::read_of_scene(file, hash, scratch)?;
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
                    sections.iter().map(|one| (one.name.clone(), one.samples)).collect()
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
        Ok(Self { hash, scratch: scratch.clone(), read, ..Self::disabled() })
    }

    /// Store that collects the coefficients of a run whose paths have this hash.
    pub(super) fn of_coefficients(hash: [u8; 32]) -> Self {
        Self { hash, collects: true, ..Self::disabled() }
    }

    /// The coefficients that were collected, as a file; `None` if there are none.
    pub(super) fn coefficients(&self, spectra: &PathSpectra) -> Option<Vec<u8>> {
        if !self.collects || self.sections.is_empty() {
            return None;
        }
        let (mut bytes, mut of_paths) = (Vec::new(), Vec::new());
        let written = spectra.save(&mut of_paths).and_then(|()| {
            format::write_into(&mut bytes, Partition::ALL, self.hash, &self.sections, &of_paths)
        });
        // Sections that are in a temporary file may be unreadable.
        written.ok().map(|()| bytes)
    }

    /// Store of a run that evaluates the coefficients in a file, and the spectra that decided their paths. `hash` is
    /// that of the paths of the scene.
    ///
    /// # Errors
    /// If the file cannot be read, is damaged, or has coefficients of other paths.
    pub(super) fn evaluating(file: &Path, hash: [u8; 32]) -> Result<(Self, PathSpectra), Failure> {
        let Contents { scene, share, sections, spectra } =
            format::read(file, &ScratchSpace::default())?;
        let again = "run the scene again with `--keep-coefficients`";
        let spectra = PathSpectra::restore(&mut spectra.as_slice())
            .map_err(|_none| wrong(file, "holds no coefficients", again))?;
        if scene != hash {
            let found = "has coefficients of other paths: only spectra, irradiances, the share of the sky and bands \
                         may differ";
            return Err(wrong(file, found, again));
        }
        let read = vec![(share, sections)];
        Ok((Self { hash, read, is_complete: true, ..Self::disabled() }, spectra))
    }

    /// Names of the sensors that were read.
    pub(super) fn sensors(&self) -> impl Iterator<Item = &str> {
        self.read.iter().flat_map(|(_, sections)| sections).map(|section| &*section.name)
    }

    /// Names of the sensors whose coefficients were collected.
    pub(super) fn collected(&self) -> impl Iterator<Item = &str> {
        self.sections.iter().map(|section| &*section.name)
    }

    /// Returns whether measurements end with what was read.
    pub(super) const fn is_complete(&self) -> bool {
        self.is_complete
    }

    /// Returns whether coefficients are collected at the end of each measurement.
    pub(super) const fn collects(&self) -> bool {
        self.collects
    }

    /// Names of the sensors in a checkpoint, if it is of another scene than that with this hash.
    ///
    /// # Errors
    /// If it cannot be read or is damaged.
    pub(super) fn other_sensors(
        file: &Path,
        hash: [u8; 32],
        scratch: &ScratchSpace,
    ) -> Result<Vec<String>, Failure> {
        let Contents { scene, sections, .. } = format::read(file, scratch)?;
        if scene == hash {
            return Ok(Vec::new());
        }
        Ok(sections.into_iter().map(|section| section.name).collect())
    }

    /// Part of the run that is traced.
    pub(super) fn share(&self) -> Partition {
        self.to.as_ref().map_or(Partition::ALL, |to| to.share)
    }

    /// Place of states that take too much memory.
    pub(super) const fn scratch(&self) -> &ScratchSpace {
        &self.scratch
    }

    /// Rule for when the run saves its state; `None` if it never does.
    pub(super) fn saves(&self) -> Option<SaveRule> {
        self.to.as_ref().map(|to| to.saves)
    }

    /// Returns whether the run saves its state while it goes on.
    pub(super) fn is_enabled(&self) -> bool {
        matches!(self.saves(), Some(SaveRule::Every(_)))
    }

    /// Sections of a sensor that were read, by part of the run.
    pub(super) fn restored(&self, name: &str) -> Vec<(Partition, Section)> {
        let of = |(share, sections): &(Partition, Vec<Section>)| {
            Some((*share, sections.iter().find(|section| section.name == name)?.clone()))
        };
        self.read.iter().filter_map(of).collect()
    }

    /// Returns whether it is time to save.
    pub(super) fn is_due(&self) -> bool {
        let Some(SaveRule::Every(seconds)) = self.saves() else { return false };
        self.written.elapsed().as_secs_f64() >= seconds
    }

    /// Sets the section of a sensor.
    pub(super) fn set_section(&mut self, section: Section) {
        match self.sections.iter_mut().find(|other| other.name == section.name) {
            Some(other) => *other = section,
            None => self.sections.push(section),
        }
    }

    /// Saves the state in the middle of a run. If that fails, the run goes on, because nothing is lost and the next
    /// save may succeed; returns a warning.
    pub(super) fn save(&mut self) -> Option<String> {
        let to = self.to.as_ref()?;
        let saved = format::write(to, self.hash, &self.sections);
        self.written = Instant::now();
        self.failed = saved.err().map(|source| {
            let file = to.file.display();
            let old = if to.file.exists() { ", which holds what it held before" } else { "" };
            format!("cannot write the checkpoint {file}{old}: {source}; the run goes on")
        });
        self.failed.clone()
    }

    /// Saves the state of a run that is cancelled; returns the file, `None` if there is nothing to save.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub(super) fn save_cancelled(&mut self) -> Result<Option<PathBuf>, Failure> {
        let Some(to) = self.to.as_ref().filter(|_| !self.sections.is_empty()) else {
            return Ok(None);
        };
        let folder = to.file.parent().unwrap_or(Path::new(""));
        let made = fs::create_dir_all(folder);
        match made.and_then(|()| format::write(to, self.hash, &self.sections)) {
            Ok(()) => Ok(Some(to.file.clone())),
            Err(source) => {
                let what = format!("cannot be written: {source}; what was traced is lost");
                Err(wrong(&to.file, &what, "name another file with `--checkpoint`"))
            }
        }
    }

    /// Saves the state at the end of a run; returns a warning if that fails.
    ///
    /// # Errors
    /// If the file cannot be written and is the only result of this run.
    pub(super) fn finish(&mut self) -> Result<Option<String>, Failure> {
        if !self.is_enabled() {
            return Ok(None);
        }
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

    /// Longest time of the next round of a measurement that has taken `seconds`, s.
    pub(super) fn longest_round(&self, seconds: f64) -> f64 {
        // A run that is cancelled ends soon, and rounds stay few.
        let until_cancelled = (0.1 * seconds).clamp(2.0, 10.0);
        match self.saves() {
            None => f64::INFINITY,
            Some(SaveRule::Every(interval)) => until_cancelled.min(0.5 * interval),
            Some(SaveRule::WhenCancelled) => until_cancelled,
        }
    }
}

/// `part 2/4`.
fn part(share: Partition) -> String {
    match share {
        Partition::ALL => "a whole run".to_owned(),
        Partition { index, count } => format!("part {}/{count}", index + 1),
    }
}

fn wrong(file: &Path, what: &str, help: &str) -> Failure {
    Failure::Checkpoint { file: file.to_owned(), what: what.to_owned(), help: help.to_owned() }
}

fn unreadable(file: &Path, source: io::Error) -> Failure {
    Failure::Read { path: file.to_owned(), source }
}

fn not_regular(file: &Path) -> Failure {
    wrong(file, "is no regular file but a folder, a pipe or a device", "name a file")
}
