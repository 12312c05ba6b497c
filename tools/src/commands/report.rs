//! `report`: a page about a folder of results.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::bail;
use clap::Args;
use serde_json::json;

use crate::console::Console;
use crate::describe::bytes;
use crate::report;

/// Arguments of the command.
#[derive(Args, Debug)]
pub(crate) struct Report {
    /// Folders with results of `run`, `sweep` or `compare`
    #[arg(value_name = "RESULTS", required = true)]
    folders: Vec<PathBuf>,

    /// File of the report [default: report.html in the folder of the results]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,

    /// Show the report in the browser
    #[arg(long)]
    open: bool,

    #[command(flatten)]
    console: Console,
}

impl Report {
    /// Writes a report for each folder.
    pub(super) fn execute(&self) -> anyhow::Result<()> {
        if self.out.is_some() && self.folders.len() > 1 {
            bail!(
                "--out names one file, and there are {} folders: leave it out, and each gets its report.html",
                self.folders.len()
            );
        }
        for folder in &self.folders {
            let observer = self.console.observer();
            let written = report::report(folder, self.out.as_deref(), &observer);
            observer.clear();
            let report::Written { file, bytes: size } = written?;
            self.console.event(&json!({ "event": "written", "folder": folder, "files": [&file] }));
            self.console.say(&format!("{}: {}\n", file.display(), bytes(size as u64)))?;
            if self.open {
                self.show(&file);
            }
        }
        Ok(())
    }

    /// Shows a file with the program that the desktop has for it; warns if there is none.
    fn show(&self, file: &Path) {
        let program = if cfg!(target_os = "macos") {
            "open"
        } else if cfg!(windows) {
            "explorer"
        } else {
            "xdg-open"
        };
        let mut command = Command::new(program);
        command.arg(file).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        if command.spawn().is_err() {
            let text = format!(
                "there is no `{program}` to show {} with: open it in a browser",
                file.display()
            );
            self.console.warn(&[text]);
        }
    }
}
