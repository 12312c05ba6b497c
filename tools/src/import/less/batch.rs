//! Batch files: lists of values for settings, zipped within a group, combined between groups.

use std::path::Path;
use sunfleck::counts::counted;

use anyhow::{Context as _, Result, bail};

use super::conf::{self, Node};
use super::report::Report;
use super::text;

/// Maximum number of points of a batch.
const MOST_POINTS: usize = 100_000;

/// Settings that a batch varies.
#[derive(Debug)]
pub(super) struct Batch {
    /// Name of the file.
    pub(super) name: String,
    groups: Vec<Vec<Axis>>,
}

/// A setting and its values.
#[derive(Debug)]
pub(super) struct Axis {
    pub(super) name: String,
    /// Items of the list, as they are written.
    items: Vec<String>,
    /// `file:line` of the list.
    pub(super) place: String,
    /// Path of its keys.
    path: String,
}

impl Axis {
    /// Reports the first value that is no number or has a fault.
    pub(super) fn check(&self, fault: impl Fn(f64) -> Option<String>) -> Result<()> {
        for item in &self.items {
            let fault = match conf::finite(item) {
                Some(number) => fault(number),
                None => Some(format!("{:?} is not a number", text::excerpt(item))),
            };
            if let Some(fault) = fault {
                bail!("{}: {}: {fault}", self.place, self.path);
            }
        }
        Ok(())
    }

    /// Values; `check` refuses those that are no numbers.
    fn values(&self) -> Vec<f64> {
        self.items.iter().filter_map(|item| conf::finite(item)).collect()
    }
}

/// Batches among the files of settings beside `input.conf`.
pub(super) fn read_all(folder: &Path, report: &Report) -> Result<Vec<Batch>> {
    let entries = folder.read_dir().with_context(|| format!("cannot read {}", folder.display()))?;
    let mut files: Vec<_> = entries.map(|entry| Ok(entry?.path())).collect::<Result<_>>()?;
    files.retain(|file| {
        let is_settings = file.extension().is_some_and(|ext| ext == "conf" || ext == "json");
        is_settings && file.is_file() && file.file_name().is_some_and(|name| name != "input.conf")
    });
    files.sort();
    let mut batches = Vec::new();
    for file in files {
        if holds_lists(&file) {
            batches.push(read(&file)?);
        } else {
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            report.left_out(&name, "", "not a batch: it holds no \"LIST:..\"");
        }
    }
    Ok(batches)
}

/// Mark of a list of values.
const LIST: &str = "LIST:";

/// Returns true if a file has the mark of batches; other files of a project have the same extensions.
fn holds_lists(file: &Path) -> bool {
    text::whole(file, conf::LARGEST).is_ok_and(|text| text.contains(LIST))
}

fn read(file: &Path) -> Result<Batch> {
    let root = Node::read(file)?;
    let mut groups = Vec::new();
    for (_, group) in root.entries() {
        let axes: Vec<Axis> =
            group.entries().iter().map(|(name, node)| axis(name, node)).collect::<Result<_>>()?;
        if let Some(other) = axes.iter().find(|axis| axis.items.len() != axes[0].items.len()) {
            let (first, m) = (&axes[0], other.items.len());
            return Err(group.wrong(&format!(
                "`{}` has {} and `{}` has {m}: those of a group go together",
                first.name,
                counted(first.items.len(), "value"),
                other.name
            )));
        }
        if axes.is_empty() {
            return Err(group.wrong("a group holds settings: {\"sun_zenith\": \"LIST:30,45\"}"));
        }
        groups.push(axes);
    }
    let points = groups.iter().map(|axes| axes[0].items.len());
    if points.fold(1_usize, usize::saturating_mul) > MOST_POINTS {
        return Err(root.wrong(&format!("the batch has more than {MOST_POINTS} points")));
    }
    let name = file.file_stem().unwrap_or_default().to_string_lossy();
    Ok(Batch { name: text::file_name(&name), groups })
}

fn axis(name: &str, node: &Node) -> Result<Axis> {
    let text = node.text()?;
    let list = text.strip_prefix(LIST).ok_or_else(|| {
        node.wrong(&format!("{:?} is no list: write \"LIST:30,45\"", text::excerpt(&text)))
    })?;
    let items = list.trim().trim_end_matches(',').split(',').map(|item| item.trim().to_owned());
    Ok(Axis {
        name: name.to_owned(),
        items: items.collect(),
        place: node.place.clone(),
        path: node.path.clone(),
    })
}

impl Batch {
    /// Settings that it varies.
    pub(super) fn axes(&self) -> impl Iterator<Item = &Axis> {
        self.groups.iter().flatten()
    }

    /// Leaves out settings that the scene does not follow.
    pub(super) fn keep(&mut self, is_kept: impl Fn(&str) -> bool) {
        for group in &mut self.groups {
            group.retain(|axis| is_kept(&axis.name));
        }
        self.groups.retain(|group| !group.is_empty());
    }

    /// The scene's `sweep`; none if nothing varies.
    pub(super) fn sweep(&self) -> Option<String> {
        let grid = self.groups.iter().all(|group| group.len() == 1);
        let (mut before, mut after) = (1, self.groups.iter().map(|g| g[0].items.len()).product());
        let mut axes = Vec::new();
        for group in &self.groups {
            let count = group[0].items.len();
            after /= count.max(1);
            for axis in group {
                let each = |&value: &f64| std::iter::repeat_n(value, after);
                let own = axis.values();
                let values: Vec<f64> = if grid || self.groups.len() == 1 {
                    own
                } else {
                    (0..before).flat_map(|_| own.iter().flat_map(each)).collect()
                };
                axes.push(format!("{}: {}", text::quoted(&axis.name), text::list(&values)));
            }
            before *= count;
        }
        let rule = if grid { "Grid" } else { "Zip" };
        (!axes.is_empty()).then(|| format!("{rule}({{ {} }})", axes.join(", ")))
    }
}
