//! What all sections of a report share.

use std::path::{Component, Path};

use super::figure::Link;
use super::quantity::Quantity;
use super::summary::Results;
use super::swept_scene::SweptScene;
use super::words::short;

/// A folder of results, and the way to it from the report.
pub(super) struct Context<'a> {
    pub(super) results: &'a Results,
    /// Address of the folder, relative to the report; ends with `/`.
    pub(super) address: String,
    /// Zenith angle and azimuth of the sun, degrees, if they are known.
    pub(super) sun: Option<[f64; 2]>,
    /// The scene at points of a sweep.
    pub(super) swept: SweptScene,
}

impl Context<'_> {
    /// Link to a file of the results.
    pub(super) fn link(&self, file: &str) -> Link {
        Link { address: format!("{}{}", self.address, encoded(file)), name: short(file) }
    }

    /// Link to the table of a product, if it has one.
    pub(super) fn table(&self, quantity: &Quantity) -> Option<Link> {
        quantity.table_file().map(|file| self.link(file))
    }

    /// Returns true if a file of the results is there.
    pub(super) fn has(&self, file: &str) -> bool {
        is_plain(file) && self.results.folder.join(file).is_file()
    }
}

/// Returns whether a name is that of a file in a folder and nowhere else.
pub(super) fn is_plain(name: &str) -> bool {
    let mut components = Path::new(name).components();
    matches!((components.next(), components.next()), (Some(Component::Normal(_)), None))
}

/// Address of a folder as seen from another one; both are absolute.
pub(super) fn address(from: &Path, to: &Path) -> String {
    let (from, to): (Vec<_>, Vec<_>) = (from.components().collect(), to.components().collect());
    let common = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let up = from[common..].iter().map(|_| "../".to_owned());
    let down = to[common..].iter().map(|part| encoded(&part.as_os_str().to_string_lossy()) + "/");
    format!("./{}", up.chain(down).collect::<String>())
}

/// A name as a part of an address.
fn encoded(name: &str) -> String {
    let part = |byte: u8| {
        if byte.is_ascii_alphanumeric() || b"-_.~,=+".contains(&byte) {
            char::from(byte).to_string()
        } else {
            format!("%{byte:02X}")
        }
    };
    name.bytes().map(part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_lead_from_the_report_to_the_results() {
        let to = Path::new("/a/b/out & <1>");
        assert_eq!(address(to, to), "./");
        assert_eq!(address(Path::new("/a/pages"), to), "./../b/out%20%26%20%3C1%3E/");
        assert_eq!(encoded("javascript:\"x\""), "javascript%3A%22x%22");
    }
}
