//! Description of a folder of results: its scene, and the files that are results.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::BufReader;
use std::path::{Component, Path, PathBuf};

use serde::Deserialize;

use super::web_page::{REPORT, is_report};

/// File that holds the manifest.
pub(super) const SUMMARY: &str = "summary.json";

/// The part of `summary.json` that describes the origin of results.
#[derive(Clone, Debug, Deserialize, PartialEq)]
pub(super) struct Manifest {
    /// Title of the scene.
    scene: String,
    command: Option<String>,
    /// Path of the scene, relative to the folder.
    scene_file: Option<String>,
    #[serde(default)]
    files: Vec<String>,
    /// Versions before 0.2 named the files of each product alone.
    #[serde(default)]
    sensors: BTreeMap<String, BTreeMap<String, Product>>,
    pub(super) variant: Option<String>,
    #[serde(default)]
    pub(super) set: BTreeMap<String, serde_json::Value>,
    pub(super) quality: Option<f64>,
}

#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
struct Product {
    #[serde(default)]
    files: Vec<String>,
}

impl Manifest {
    /// Reads the manifest of a folder; `None` if it holds no results.
    pub(super) fn read(folder: &Path) -> Option<Self> {
        let path = folder.join(SUMMARY);
        // Opening a pipe would wait for its writer.
        fs::metadata(&path).ok().filter(fs::Metadata::is_file)?;
        let manifest: Self =
            serde_json::from_reader(BufReader::new(File::open(path).ok()?)).ok()?;
        Some(manifest.with_report(folder))
    }

    /// Adds the report to the results if the folder holds one.
    pub(super) fn with_report(mut self, folder: &Path) -> Self {
        if is_report(&folder.join(REPORT)) {
            self.files.push(REPORT.to_owned());
        }
        self
    }

    /// Names of the files that are results.
    pub(super) fn files(&self) -> BTreeSet<&str> {
        let products = self.sensors.values().flat_map(BTreeMap::values);
        let names = self.files.iter().chain(products.flat_map(|product| &product.files));
        // A name that leads out of the folder is none of ours.
        let mut names: BTreeSet<&str> =
            names.map(String::as_str).filter(|name| is_plain(name)).collect();
        names.insert(SUMMARY);
        names
    }

    /// The command and the scene that made the results in `folder`, for a person.
    pub(super) fn described(&self, folder: &Path) -> String {
        let scene = match self.scene_file(folder) {
            Some(file) => file.display().to_string(),
            None if self.scene.is_empty() => "a scene that is not known".to_owned(),
            None => format!("a scene \"{}\" whose file is not known", self.scene),
        };
        match &self.command {
            Some(command) => format!("`sunfleck {command}` of {scene}"),
            None => scene,
        }
    }

    /// Returns whether results in `folder` are those of a command for a scene.
    pub(super) fn is_of(&self, folder: &Path, command: &str, scene: &Path) -> bool {
        self.command.as_deref() == Some(command)
            && self.scene_file(folder).is_some_and(|file| file == scene)
    }

    /// Absolute path of the scene of the results in `folder`.
    pub(super) fn scene_file(&self, folder: &Path) -> Option<PathBuf> {
        let mut path = folder.to_owned();
        for component in Path::new(self.scene_file.as_ref()?).components() {
            match component {
                Component::CurDir => {}
                Component::ParentDir => drop(path.pop()),
                other => path.push(other),
            }
        }
        Some(path)
    }
}

/// Returns whether a name is that of a file in a folder and nowhere else.
fn is_plain(name: &str) -> bool {
    let mut components = Path::new(name).components();
    matches!((components.next(), components.next()), (Some(Component::Normal(_)), None))
        && !name.contains(['/', '\\'])
}

/// The way from a folder to a file, both absolute; with `/` between names, as JSON shall be the same
/// everywhere.
pub(super) fn relative(folder: &Path, file: &Path) -> String {
    let (from, to): (Vec<_>, Vec<_>) = (folder.components().collect(), file.components().collect());
    let common = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    if common == 0 {
        // Another drive of Windows.
        return file.display().to_string();
    }
    let up = from[common..].iter().map(|_| "..".to_owned());
    let down = to[common..].iter().map(|part| part.as_os_str().to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<_>>().join("/")
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests {
    use super::*;

    fn parse(text: &str) -> Manifest {
        serde_json::from_str(text).unwrap()
    }

    #[test]
    fn names_that_lead_elsewhere_are_no_results() {
        let manifest = parse(
            r#"{"scene": "", "files": ["a.csv", "../b.csv", "/etc/passwd", "c/d", "..", ".", "", "e\\f"]}"#,
        );
        assert_eq!(Vec::from_iter(manifest.files()), ["a.csv", SUMMARY]);
        let before = parse(r#"{"scene": "", "sensors": {"top": {"brf": {"files": ["x.hdr"]}}}}"#);
        assert_eq!(Vec::from_iter(before.files()), [SUMMARY, "x.hdr"]);
    }

    #[test]
    fn a_scene_is_the_same_wherever_its_project_is_moved_to() {
        let (scene, folder) =
            (Path::new("/home/u/wood/a/plot.ron"), Path::new("/home/u/wood/out/plot"));
        let way = relative(folder, scene);
        assert_eq!(way, "../../a/plot.ron");
        let manifest =
            parse(&format!(r#"{{"scene": "", "command": "run", "scene_file": "{way}"}}"#));
        assert!(manifest.is_of(folder, "run", scene));
        assert!(manifest.is_of(Path::new("/mnt/out/plot"), "run", Path::new("/mnt/a/plot.ron")));
        assert!(!manifest.is_of(folder, "run", Path::new("/home/u/wood/b/plot.ron")));
        assert!(!manifest.is_of(folder, "sweep", scene));
    }
}
