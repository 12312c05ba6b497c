//! Report of a folder of results: a page beside them that tells what they are, and that goes when they are replaced.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

/// Name of the report in the folder of the results.
pub const REPORT: &str = "report.html";

/// First line of each report. A page that does not begin with it is somebody else's.
pub const REPORT_HEAD: &str = "<!DOCTYPE html><!-- sunfleck report -->\n";

/// Returns whether a file is a report that sunfleck wrote.
#[must_use]
pub fn is_report(file: &Path) -> bool {
    // Opening a pipe would wait for its writer.
    if !file.is_file() {
        return false;
    }
    let mut head = [0; REPORT_HEAD.len()];
    let read = File::open(file).and_then(|mut file| file.read_exact(&mut head));
    read.is_ok() && head == *REPORT_HEAD.as_bytes()
}
