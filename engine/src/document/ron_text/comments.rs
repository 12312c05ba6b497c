//! Places of the comments of a text.

use super::lexer::{Kind, Lexer};

/// Bytes of a comment, its marks included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) struct Comment {
    pub(in super::super) start: usize,
    pub(in super::super) end: usize,
}

/// Headers such as `#![enable(implicit_some)]`, and all comments, of a text that is RON.
pub(in super::super) fn comments(text: &str) -> (Vec<Comment>, Vec<Comment>) {
    let (mut headers, mut found) = (Vec::new(), Vec::new());
    let mut at = 0;
    loop {
        let rest = &text[at..];
        let start = at + rest.len() - rest.trim_start_matches(is_blank).len();
        let rest = &text[start..];
        let of = if rest.starts_with("#!") {
            at = start + rest.find(']').map_or(rest.len(), |end| end + 1);
            &mut headers
        } else if rest.starts_with('/') {
            at = start + length(rest);
            &mut found
        } else {
            break;
        };
        of.push(Comment { start, end: at });
    }
    let mut lexer = Lexer::new(text);
    if lexer.skip_headers().is_err() {
        return (headers, found);
    }
    let mut last = None;
    while let Ok(token) = lexer.next() {
        if let Some(last) = last {
            within(text, last, token.span.start as usize, &mut found);
        }
        last = Some(token.span.end as usize);
        if token.kind == Kind::End {
            break;
        }
    }
    (headers, found)
}

fn is_blank(c: char) -> bool {
    c == '\u{feff}' || c.is_whitespace()
}

/// Comments among blanks.
fn within(text: &str, mut at: usize, end: usize, found: &mut Vec<Comment>) {
    while let Some(offset) = text.get(at..end).and_then(|gap| gap.find('/')) {
        let start = at + offset;
        at = start + length(&text[start..end]);
        found.push(Comment { start, end: at });
    }
}

/// Length of the comment that a text starts with.
fn length(text: &str) -> usize {
    if text.starts_with("//") {
        return text.find('\n').unwrap_or(text.len());
    }
    let (mut at, mut depth) = (0, 0_usize);
    while let Some(pair) = text.as_bytes().get(at..at + 2) {
        match pair {
            b"/*" => depth += 1,
            b"*/" => depth -= 1,
            _ => {
                at += 1;
                continue;
            }
        }
        at += 2;
        if depth == 0 {
            return at;
        }
    }
    text.len()
}
