//! The report of an import: every setting that the scene does not hold just as the project does.

use std::cell::RefCell;
use std::fmt::Write as _;

/// Kinds of remarks, in the order in which they are printed.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Remark {
    Differs,
    Default,
    LeftOut,
    Unneeded,
}

impl Remark {
    const ALL: [(Self, &'static str); 4] = [
        (Self::Differs, "what is not as in"),
        (Self::Default, "what the project does not say, and the defaults that were taken:"),
        (Self::LeftOut, "what has no counterpart in sunfleck and was left out:"),
        (Self::Unneeded, "what sunfleck does not need:"),
    ];
}

/// A remark about one setting: the setting, its value, and a note on its conversion.
#[derive(Debug, PartialEq)]
struct Row {
    remark: Remark,
    cells: [String; 3],
}

/// Remarks about the settings of a project.
#[derive(Debug)]
pub(super) struct Report {
    /// Name of the program whose scene it is.
    program: &'static str,
    rows: RefCell<Vec<Row>>,
}

impl Report {
    /// A report without remarks on a scene of a program.
    pub(super) const fn new(program: &'static str) -> Self {
        Self { program, rows: RefCell::new(Vec::new()) }
    }

    /// The setting is imported, and means something else than in the program.
    pub(super) fn differs(&self, setting: &str, value: &str, what: impl Into<String>) {
        self.add(Remark::Differs, setting, value, what);
    }

    /// The project has no value for the setting.
    pub(super) fn assumed(&self, setting: &str, lack: &str, what: impl Into<String>) {
        self.add(Remark::Default, setting, lack, what);
    }

    /// The setting is not imported.
    pub(super) fn left_out(&self, setting: &str, value: &str, what: impl Into<String>) {
        self.add(Remark::LeftOut, setting, value, what);
    }

    /// The setting has no influence on results.
    pub(super) fn unneeded(&self, setting: &str, value: &str, what: impl Into<String>) {
        self.add(Remark::Unneeded, setting, value, what);
    }

    fn add(&self, remark: Remark, setting: &str, value: &str, what: impl Into<String>) {
        let row = Row { remark, cells: [setting.to_owned(), value.to_owned(), what.into()] };
        let mut rows = self.rows.borrow_mut();
        if !rows.contains(&row) {
            rows.push(row);
        }
    }

    /// A heading for each kind of remark and a line for each setting, in columns.
    pub(super) fn lines(&self) -> Vec<String> {
        let rows = self.rows.borrow();
        let width = |column: usize| {
            rows.iter().map(|row| row.cells[column].chars().count()).max().unwrap_or(0)
        };
        let (first, second) = (width(0), width(1));
        let mut lines = Vec::new();
        for (remark, heading) in Remark::ALL {
            let mut rows = rows.iter().filter(|row| row.remark == remark).peekable();
            if rows.peek().is_some() {
                let is_of_program = remark == Remark::Differs;
                let program =
                    if is_of_program { format!(" {}:", self.program) } else { String::new() };
                lines.push(format!("{heading}{program}"));
            }
            for Row { cells: [setting, value, what], .. } in rows {
                lines.push(format!("  {setting:first$}  {value:second$}  {what}"));
            }
        }
        lines
    }

    /// The table for a terminal.
    pub(super) fn table(&self) -> String {
        let mut text = String::new();
        for line in self.lines() {
            // Writing to a string cannot fail.
            let _infallible = writeln!(text, "{line}");
        }
        text
    }
}
