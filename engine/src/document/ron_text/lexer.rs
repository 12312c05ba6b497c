//! Text to tokens.

use super::strange::advice_for;
use super::{BadNumber, Span};

/// A token and where it stands.
#[derive(Clone, Debug)]
pub(super) struct Token {
    pub(super) span: Span,
    pub(super) kind: Kind,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    /// `( ) [ ] { } , :`.
    Mark(char),
    Word(String),
    Text(String),
    /// Text that starts with `=`, without it.
    Formula(String),
    Integer {
        negative: bool,
        magnitude: u64,
    },
    Float(f64),
    BadNumber,
    TooLarge,
    End,
}

impl Kind {
    pub(super) fn bad_number(&self) -> Option<BadNumber> {
        match self {
            Self::BadNumber => Some(BadNumber::NotFinite),
            Self::TooLarge => Some(BadNumber::TooLarge),
            _ => None,
        }
    }
}

/// Reason why the text is not RON.
#[derive(Clone, Debug)]
pub(in super::super) struct SyntaxError {
    pub(in super::super) span: Span,
    pub(in super::super) message: String,
    pub(in super::super) help: Option<String>,
}

impl SyntaxError {
    pub(super) fn new(span: Span, message: impl Into<String>) -> Self {
        Self { span, message: message.into(), help: None }
    }

    pub(super) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

type Result<T> = std::result::Result<T, SyntaxError>;

/// State of the lexer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lexer<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Lexer<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        let at = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
        Self { text, at }
    }

    /// The next token; [`Kind::End`] for ever after the last.
    pub(super) fn next(&mut self) -> Result<Token> {
        self.skip_blank()?;
        let start = self.at;
        let Some(first) = self.peek() else {
            return Ok(Token { span: Span::new(start, start), kind: Kind::End });
        };
        let kind = match first {
            '(' | ')' | '[' | ']' | '{' | '}' | ',' | ':' => {
                self.at += 1;
                Kind::Mark(first)
            }
            '"' => self.string()?,
            'r' if self.rest().starts_with("r\"") || self.rest().starts_with("r#\"") => {
                self.raw_string()?
            }
            'r' if self.rest().starts_with("r##") => self.raw_string()?,
            'r' if self.rest().starts_with("r#") => {
                self.at += 2;
                self.word()
            }
            '0'..='9' | '+' | '-' | '.' => self.number()?,
            _ if first == '_' || first.is_alphabetic() => match self.word() {
                Kind::Word(word) if word == "NaN" || word == "inf" => Kind::BadNumber,
                word => word,
            },
            '\'' => {
                self.at += 1;
                return Err(SyntaxError::new(Span::new(start, self.at), "unexpected `'`")
                    .help("write strings in double quotes: \"leaf\""));
            }
            _ => {
                self.at += first.len_utf8();
                let shown = first.escape_debug();
                let message = format!("unexpected character `{shown}`");
                let error = SyntaxError::new(Span::new(start, self.at), message);
                return Err(match advice_for(first) {
                    Some(advice) => error.help(advice),
                    None => error,
                });
            }
        };
        Ok(Token { span: Span::new(start, self.at), kind })
    }

    /// The first character of the next token.
    pub(super) fn first(&mut self) -> Result<Option<char>> {
        self.skip_blank()?;
        Ok(self.peek())
    }

    /// Skips a header such as `#![enable(implicit_some)]`.
    pub(super) fn skip_headers(&mut self) -> Result<()> {
        loop {
            self.skip_blank()?;
            if !self.rest().starts_with("#!") {
                return Ok(());
            }
            let start = self.at;
            match self.rest().find(']') {
                Some(length) => self.at += length + 1,
                None => {
                    return Err(SyntaxError::new(
                        Span::new(start, start + 2),
                        "this header has no closing `]`",
                    ));
                }
            }
        }
    }

    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn skip_while(&mut self, keep: impl Fn(char) -> bool) {
        let rest = self.rest();
        self.at += rest.find(|c| !keep(c)).unwrap_or(rest.len());
    }

    fn skip_blank(&mut self) -> Result<()> {
        loop {
            self.skip_while(char::is_whitespace);
            let rest = self.rest();
            if rest.starts_with("//") {
                self.at += rest.find('\n').unwrap_or(rest.len());
            } else if rest.starts_with("/*") {
                self.skip_block_comment()?;
            } else {
                return Ok(());
            }
        }
    }

    /// Comments `/* */` nest; they are counted, not recursed into.
    fn skip_block_comment(&mut self) -> Result<()> {
        let start = self.at;
        let bytes = self.text.as_bytes();
        let mut depth = 0_usize;
        while let Some(pair) = bytes.get(self.at..self.at + 2) {
            match pair {
                b"/*" => depth += 1,
                b"*/" => depth -= 1,
                _ => {
                    self.at += 1;
                    continue;
                }
            }
            self.at += 2;
            if depth == 0 {
                return Ok(());
            }
        }
        Err(SyntaxError::new(Span::new(start, start + 2), "this comment is never closed")
            .help("end it with `*/`; each `/*` inside it needs its own `*/`"))
    }

    fn word(&mut self) -> Kind {
        let start = self.at;
        self.skip_while(|c| c == '_' || c.is_alphanumeric());
        Kind::Word(self.text[start..self.at].to_owned())
    }

    fn string(&mut self) -> Result<Kind> {
        let start = self.at;
        self.at += 1;
        let formula = self.rest().starts_with('=');
        if formula {
            self.at += 1;
        }
        let mut value = String::new();
        loop {
            let rest = self.rest();
            let Some(length) = rest.find(['"', '\\']) else {
                return Err(unclosed_string(self.text, start));
            };
            value.push_str(&rest[..length]);
            self.at += length + 1;
            if rest[length..].starts_with('"') {
                return Ok(if formula { Kind::Formula(value) } else { Kind::Text(value) });
            }
            self.escape(&mut value)?;
        }
    }

    /// After a backslash.
    fn escape(&mut self, value: &mut String) -> Result<()> {
        let start = self.at - 1;
        let Some(letter) = self.peek() else {
            return Err(unclosed_string(self.text, start));
        };
        self.at += letter.len_utf8();
        let code = match letter {
            'n' => Some('\n'),
            'r' => Some('\r'),
            't' => Some('\t'),
            '0' => Some('\0'),
            '"' | '\\' | '\'' | '/' => Some(letter),
            'x' => {
                let digits = self.rest().get(..2);
                self.at += digits.map_or(0, str::len);
                digits.and_then(hexadecimal).and_then(char::from_u32)
            }
            'u' => {
                let digits = self.rest().strip_prefix('{').and_then(|rest| rest.split_once('}'));
                let digits = digits.map(|(digits, _)| digits).filter(|d| d.len() <= 6);
                self.at += digits.map_or(0, |digits| digits.len() + 2);
                digits.and_then(hexadecimal).and_then(char::from_u32)
            }
            '\n' | '\r' => {
                self.skip_while(char::is_whitespace);
                return Ok(());
            }
            _ => None,
        };
        match code {
            Some(code) => {
                value.push(code);
                Ok(())
            }
            None => Err(SyntaxError::new(
                Span::new(start, self.at),
                format!("unknown escape `\\{}` in a string", letter.escape_debug()),
            )
            .help("write a backslash as `\\\\`; in file names use `/`")),
        }
    }

    fn raw_string(&mut self) -> Result<Kind> {
        let start = self.at;
        self.at += 1;
        let hashes = self.rest().bytes().take_while(|&byte| byte == b'#').count();
        self.at += hashes;
        if !self.rest().starts_with('"') {
            return Err(SyntaxError::new(
                Span::new(start, self.at),
                "a raw string starts with `r\"` or `r#\"`",
            ));
        }
        self.at += 1;
        let end = format!("\"{}", "#".repeat(hashes));
        let Some(length) = self.rest().find(&end) else {
            return Err(unclosed_string(self.text, start));
        };
        let value = &self.rest()[..length];
        self.at += length + end.len();
        Ok(match value.strip_prefix('=') {
            Some(formula) => Kind::Formula(formula.to_owned()),
            None => Kind::Text(value.to_owned()),
        })
    }

    fn number(&mut self) -> Result<Kind> {
        let start = self.at;
        let negative = self.rest().starts_with('-');
        if self.rest().starts_with(['+', '-']) {
            self.at += 1;
        }
        if self.rest().starts_with("inf") || self.rest().starts_with("NaN") {
            self.at += 3;
            return Ok(Kind::BadNumber);
        }
        let mut before = ' ';
        loop {
            match self.peek() {
                Some(c) if c == '_' || c == '.' || c.is_alphanumeric() => before = c,
                Some(c @ ('+' | '-')) if matches!(before, 'e' | 'E') => before = c,
                _ => break,
            }
            self.at += before.len_utf8();
        }
        let literal = &self.text[start..self.at];
        number_value(literal, negative).ok_or_else(|| {
            SyntaxError::new(Span::new(start, self.at), format!("`{literal}` is not a number"))
        })
    }
}

fn number_value(literal: &str, negative: bool) -> Option<Kind> {
    let digits = literal.trim_start_matches(['+', '-']);
    if digits.len() + 1 < literal.len() || !digits.contains(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let plain = digits.replace('_', "");
    let radix = match plain.get(..2) {
        Some("0x" | "0X") => 16,
        Some("0o" | "0O") => 8,
        Some("0b" | "0B") => 2,
        _ => 10,
    };
    if radix != 10 {
        return integer(&plain[2..], radix, negative);
    }
    if plain.bytes().all(|byte| byte.is_ascii_digit()) {
        return integer(&plain, 10, negative);
    }
    if !plain.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'.' | b'e' | b'E' | b'+' | b'-')) {
        return None;
    }
    let value: f64 = plain.parse().ok()?;
    let value = if negative { -value } else { value };
    Some(if value.is_finite() { Kind::Float(value) } else { Kind::TooLarge })
}

fn integer(digits: &str, radix: u32, negative: bool) -> Option<Kind> {
    if digits.is_empty() || !digits.chars().all(|c| c.is_digit(radix)) {
        return None;
    }
    Some(match u64::from_str_radix(digits, radix) {
        Ok(magnitude) => Kind::Integer { negative, magnitude },
        Err(_) => match digits.parse::<f64>() {
            // Beyond the integers, but where a number is wanted it is one.
            Ok(value) if radix == 10 && value.is_finite() => {
                Kind::Float(if negative { -value } else { value })
            }
            _ => Kind::TooLarge,
        },
    })
}

fn hexadecimal(digits: &str) -> Option<u32> {
    let lawful = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_hexdigit());
    if lawful { u32::from_str_radix(digits, 16).ok() } else { None }
}

fn unclosed_string(text: &str, start: usize) -> SyntaxError {
    let line = text[start..].find('\n').unwrap_or(text.len() - start);
    SyntaxError::new(Span::new(start, start + line), "this string is never closed")
        .help("end it with `\"`")
}
