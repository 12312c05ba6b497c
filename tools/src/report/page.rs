//! The page around the sections.

use maud::{Markup, PreEscaped, html};
use sunfleck::output::REPORT_HEAD;

const STYLE: &str = include_str!("report.css");
const SCRIPT: &str = include_str!("report.js");

/// A page with its sections.
pub(super) struct Page {
    pub(super) title: String,
    /// What stands below the title.
    pub(super) head: Markup,
    pub(super) sections: Vec<Section>,
}

/// A section with a heading of its own.
pub(super) struct Section {
    /// Anchor, unique on the page.
    pub(super) id: &'static str,
    pub(super) title: &'static str,
    pub(super) body: Markup,
}

impl Page {
    /// HTML of the page.
    pub(super) fn render(&self) -> String {
        // The browser runs this script alone and loads nothing, whatever is on the page.
        let nonce = blake3::hash(SCRIPT.as_bytes()).to_hex();
        let policy = format!(
            "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'nonce-{nonce}'; base-uri 'none'; form-action 'none'"
        );
        let page = html! {
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta http-equiv="Content-Security-Policy" content=(policy);
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="color-scheme" content="light dark";
                    meta name="generator" content={ "sunfleck " (env!("CARGO_PKG_VERSION")) };
                    link rel="icon" href="data:,";
                    title { (self.title) }
                    style { (PreEscaped(STYLE)) }
                }
                body {
                    a.skip href="#main" { "To the results" }
                    header {
                        h1 { bdi { (self.title) } }
                        (self.head)
                        nav aria-label="Sections" {
                            ul { @for section in &self.sections { li { a href={ "#" (section.id) } { (section.title) } } } }
                        }
                    }
                    main id="main" {
                        @for section in &self.sections {
                            section id=(section.id) {
                                h2 { (section.title) }
                                (section.body)
                            }
                        }
                    }
                    script nonce=(nonce) { (PreEscaped(SCRIPT)) }
                }
            }
        };
        format!("{REPORT_HEAD}{}\n", page.into_string())
    }
}
