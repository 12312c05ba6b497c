use std::collections::BTreeSet;
use std::path::PathBuf;

use crate::document::Diagnostic;

/// Messages of the systems about the scene, each system's apart: what a system said holds until it runs again.
#[derive(Clone, Debug, Default)]
pub struct Messages {
    systems: Vec<SystemMessages>,
    /// Place of the running system in the schedule.
    running: usize,
}

/// Messages of one system.
#[derive(Clone, Debug, Default)]
struct SystemMessages {
    files: Vec<PathBuf>,
    skipped: Vec<String>,
    notes: Vec<String>,
    diagnostics: Vec<Diagnostic>,
}

impl Messages {
    /// Forgets what the system at this place in the schedule said; it is the one that speaks from now on.
    pub fn begin(&mut self, system: usize) {
        self.running = system;
        if self.systems.len() <= system {
            self.systems.resize_with(system + 1, SystemMessages::default);
        }
        self.systems[system] = SystemMessages::default();
    }

    fn of_running(&mut self) -> &mut SystemMessages {
        if self.systems.is_empty() {
            self.begin(0);
        }
        &mut self.systems[self.running]
    }

    /// Adds an error or a warning.
    pub fn report(&mut self, diagnostic: Diagnostic) {
        self.of_running().diagnostics.push(diagnostic);
    }

    /// Adds a warning unless it is known.
    pub fn report_once(&mut self, diagnostic: Diagnostic) {
        if !self.systems.iter().any(|system| system.diagnostics.contains(&diagnostic)) {
            self.report(diagnostic);
        }
    }

    /// Adds a note on a choice that the scene does not write.
    pub fn note(&mut self, note: String) {
        self.of_running().notes.push(note);
    }

    /// Adds a definition that nothing uses and that was not built.
    pub fn skip(&mut self, definition: String) {
        self.of_running().skipped.push(definition);
    }

    /// Adds a file that was read.
    pub fn file(&mut self, path: PathBuf) {
        self.of_running().files.push(path);
    }

    /// Errors and warnings in the order of the schedule.
    pub fn diagnostics(&self) -> impl Iterator<Item = &Diagnostic> {
        self.systems.iter().flat_map(|system| &system.diagnostics)
    }

    /// Notes in the order of the schedule.
    pub fn notes(&self) -> impl Iterator<Item = &String> {
        self.systems.iter().flat_map(|system| &system.notes)
    }

    /// Definitions that nothing uses, in the order of the schedule.
    pub fn skipped(&self) -> impl Iterator<Item = &String> {
        self.systems.iter().flat_map(|system| &system.skipped)
    }

    /// Files that were read, without repetition, in the order of the schedule.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        let mut seen = BTreeSet::new();
        let files = self.systems.iter().flat_map(|system| &system.files);
        files.filter(|file| seen.insert(*file)).cloned().collect()
    }
}
