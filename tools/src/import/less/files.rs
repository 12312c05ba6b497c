//! Files of a project by the names that its settings give them.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};

use super::project::Project;

impl Project {
    /// The file that a name means, in `Parameters` or where the name says.
    ///
    /// Projects come from other machines: for a path of Windows or a folder that does not exist, the last name counts,
    /// in upper or lower case.
    pub(super) fn locate(&self, name: &str) -> Result<PathBuf> {
        let name = name.trim().trim_matches('"');
        let portable = name.replace('\\', "/");
        for candidate in [name, &portable] {
            let path = self.parameters.join(candidate);
            if path.is_file() {
                return Ok(path);
            }
        }
        let last = portable.rsplit('/').next().unwrap_or_default();
        match self.named(last) {
            Some(path) => {
                if last != name {
                    let what = format!("found as {}", path.display());
                    self.report.differs("file", name, what);
                }
                Ok(path)
            }
            None => bail!("there is no file {}", self.parameters.join(&portable).display()),
        }
    }

    /// A file in `Parameters` by its name in any case of letters.
    fn named(&self, name: &str) -> Option<PathBuf> {
        let exact = self.parameters.join(name);
        if exact.is_file() {
            return Some(exact);
        }
        let wanted = name.to_lowercase();
        let mut entries: Vec<_> =
            self.parameters.read_dir().ok()?.filter_map(|entry| Some(entry.ok()?.path())).collect();
        entries.sort();
        let is_wanted = |path: &PathBuf| {
            let own = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
            own == wanted && Path::is_file(path)
        };
        entries.into_iter().find(is_wanted).filter(|_| !name.is_empty())
    }
}
