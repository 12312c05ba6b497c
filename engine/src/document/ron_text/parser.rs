//! Tokens to a tree.

use super::lexer::{Kind, Lexer, SyntaxError, Token};
use super::strange::{bracket_advice, decimal_advice};
use super::{Field, Named, Node, Span, Value};

type Result<T> = std::result::Result<T, SyntaxError>;

/// Brackets may nest so deep; no scene comes near it, and the stack holds.
const DEPTH: usize = 128;

/// The tree of a whole text.
///
/// # Errors
/// The first place where the text is not RON.
pub(in super::super) fn parse(text: &str) -> Result<Node> {
    let mut lexer = Lexer::new(text);
    lexer.skip_headers()?;
    let mut parser = Parser { text, lexer, open: Vec::new(), long_string: None };
    let node = parser.value()?;
    let after = parser.lexer.next()?;
    match after.kind {
        Kind::End => Ok(node),
        _ => Err(parser.unexpected(&after, "the end of the file")),
    }
}

struct Parser<'a> {
    text: &'a str,
    lexer: Lexer<'a>,
    /// Places of the brackets that are still open.
    open: Vec<(char, usize)>,
    /// The last string, if it runs over several lines: its end may be another string's start.
    long_string: Option<usize>,
}

impl Parser<'_> {
    fn value(&mut self) -> Result<Node> {
        let token = self.lexer.next()?;
        if matches!(token.kind, Kind::Text(_) | Kind::Formula(_)) {
            let is_long = self.text[token.span.range()].contains('\n');
            self.long_string = is_long.then_some(token.span.start as usize);
        }
        let value = match token.kind {
            Kind::Integer { negative, magnitude } => Value::Integer { negative, magnitude },
            Kind::Float(value) => Value::Float(value),
            Kind::Text(text) => Value::Text(text),
            Kind::Formula(formula) => Value::Formula(formula),
            Kind::Word(word) if word == "true" => Value::Bool(true),
            Kind::Word(word) if word == "false" => Value::Bool(false),
            Kind::Word(name) => return self.named(name, token.span),
            Kind::Mark('(') => return self.parentheses(token.span),
            Kind::Mark('[') => return self.list(token.span),
            Kind::Mark('{') => return self.map(token.span),
            ref other => match other.bad_number() {
                Some(bad) => Value::BadNumber(bad),
                None => return Err(self.unexpected(&token, "a value")),
            },
        };
        Ok(Node { span: token.span, value })
    }

    fn named(&mut self, name: String, name_span: Span) -> Result<Node> {
        let body = match self.lexer.first()? {
            Some('(') => {
                let open = self.lexer.next()?;
                Some(self.parentheses(open.span)?)
            }
            Some(bracket @ ('{' | '[')) => {
                let token = self.lexer.next()?;
                let message = format!("expected `(` after `{name}`, found `{bracket}`");
                let error = SyntaxError::new(token.span, message);
                return Err(match bracket_advice(&name, bracket) {
                    Some(advice) => error.help(advice),
                    None => error,
                });
            }
            _ => None,
        };
        let end = body.as_ref().map_or(name_span.end, |body| body.span.end);
        let span = Span { start: name_span.start, end };
        Ok(Node { span, value: Value::Named(Box::new(Named { name, name_span, body })) })
    }

    /// After `(`: a record if a word and a colon follow, else a tuple.
    fn parentheses(&mut self, open: Span) -> Result<Node> {
        let may_be_key = |c: char| c == '_' || c == '"' || c.is_alphabetic();
        let starts_like_a_key = self.lexer.first()?.is_some_and(may_be_key);
        let mut ahead = self.lexer;
        let is_record = starts_like_a_key
            && matches!(ahead.next()?.kind, Kind::Word(_) | Kind::Text(_))
            && ahead.next().is_ok_and(|token| token.kind == Kind::Mark(':'));
        if is_record {
            let (fields, span) = self.items(open, '(', ')', Self::field)?;
            return Ok(Node { span, value: Value::Record(fields) });
        }
        let (items, span) = self.items(open, '(', ')', Self::value)?;
        Ok(Node { span, value: Value::Tuple(items) })
    }

    fn field(&mut self) -> Result<Field> {
        let token = self.lexer.next()?;
        let name = match token.kind {
            Kind::Word(word) => word,
            Kind::Text(text) => {
                return Err(SyntaxError::new(token.span, "keys in parentheses have no quotes")
                    .help(format!("write `{text}: ..`, or `{{ \"{text}\": .. }}` for a map")));
            }
            _ => {
                let error = self.unexpected(&token, "a key");
                return Err(match decimal_advice(self.text, token.span.start as usize) {
                    Some(advice) => error.help(advice),
                    None => error,
                });
            }
        };
        self.colon(&name)?;
        Ok(Field { name, name_span: token.span, value: self.value()? })
    }

    fn list(&mut self, open: Span) -> Result<Node> {
        let (items, span) = self.items(open, '[', ']', Self::value)?;
        Ok(Node { span, value: Value::List(items) })
    }

    fn map(&mut self, open: Span) -> Result<Node> {
        let (items, span) = self.items(open, '{', '}', |parser| {
            let mut key = parser.value()?;
            if let Value::Formula(text) = key.value {
                // A name is a name, whatever it starts with.
                key.value = Value::Text(format!("={text}"));
            }
            parser.colon("this key").map_err(|error| {
                match decimal_advice(parser.text, key.span.start as usize) {
                    Some(advice) => error.help(advice),
                    None => error,
                }
            })?;
            Ok((key, parser.value()?))
        })?;
        Ok(Node { span, value: Value::Map(items) })
    }

    fn colon(&mut self, key: &str) -> Result<()> {
        let token = self.lexer.next()?;
        match token.kind {
            Kind::Mark(':') => Ok(()),
            _ => Err(self.unexpected(&token, &format!("`:` after `{key}`"))),
        }
    }

    /// Items with commas between them and maybe after the last, up to the closing bracket.
    fn items<T>(
        &mut self,
        open: Span,
        bracket: char,
        close: char,
        mut item: impl FnMut(&mut Self) -> Result<T>,
    ) -> Result<(Vec<T>, Span)> {
        if self.open.len() == DEPTH {
            return Err(SyntaxError::new(
                open,
                format!("more than {DEPTH} brackets are open here"),
            )
            .help("close some: a scene never nests so deep"));
        }
        self.open.push((bracket, open.start as usize));
        let mut items = Vec::new();
        loop {
            if self.lexer.first()? != Some(close) {
                items.push(item(self)?);
            }
            let token = self.lexer.next()?;
            match token.kind {
                Kind::Mark(',') => {}
                Kind::Mark(mark) if mark == close => {
                    self.open.pop();
                    return Ok((items, Span { start: open.start, end: token.span.end }));
                }
                _ => return Err(self.unexpected(&token, &format!("`,` or `{close}`"))),
            }
        }
    }

    fn unexpected(&self, token: &Token, wanted: &str) -> SyntaxError {
        let opened = self.open.last().map(|&(bracket, at)| {
            let (line, column) = line_and_column(self.text, at);
            (bracket, at, format!("the `{bracket}` of line {line}, column {column}"))
        });
        let found = match &token.kind {
            Kind::End => match opened {
                Some((_, at, opened)) => {
                    return SyntaxError::new(
                        Span::new(at, at + 1),
                        format!("the file ends before {opened} is closed"),
                    )
                    .help("is the file complete? close every bracket that is opened");
                }
                None => "the end of the file".to_owned(),
            },
            Kind::Mark(mark) => format!("`{mark}`"),
            Kind::Word(word) => format!("`{word}`"),
            Kind::Text(_) | Kind::Formula(_) => "a string".to_owned(),
            _ => "a number".to_owned(),
        };
        let error = SyntaxError::new(token.span, format!("expected {wanted}, found {found}"));
        if let Some(start) = self.long_string {
            let (line, column) = line_and_column(self.text, start);
            return error.help(format!(
                "the string of line {line}, column {column} runs over several lines: \
                 does it lack its `\"`?"
            ));
        }
        match opened {
            Some((_, _, opened)) => error.help(format!("{opened} is still open here")),
            None => error,
        }
    }
}

/// Line and column of a byte, each from 1; columns count characters.
fn line_and_column(text: &str, at: usize) -> (usize, usize) {
    let before = &text[..at];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}
