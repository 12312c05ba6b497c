//! Tables in columns.

/// Lays out rows in aligned columns; those in `left` are aligned to the left, the others to the right.
pub(crate) fn lay_out(rows: &[Vec<String>], left: &[bool]) -> String {
    let width = |text: &str| text.chars().count();
    let mut widths = vec![0; left.len()];
    for row in rows {
        for (widest, cell) in widths.iter_mut().zip(row) {
            *widest = width(cell).max(*widest);
        }
    }
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for ((cell, widest), left) in row.iter().zip(&widths).zip(left) {
            let padding = " ".repeat(widest - width(cell));
            let (before, after) = if *left { ("", padding.as_str()) } else { (&*padding, "") };
            for part in [before, cell, after, "  "] {
                line.push_str(part);
            }
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}
