//! Types to text that the reader reads back as equal.

use std::fmt::Write as _;

use indexmap::IndexMap;

/// A line holds so many characters, where it can.
const WIDTH: usize = 100;

/// A type that can be written.
pub(super) trait Encode {
    fn encode(&self) -> Text;
}

/// Text before it is broken into lines.
#[derive(Debug)]
pub(super) enum Text {
    Leaf(String),
    Group { open: String, items: Vec<(String, Self)>, close: String },
}

impl Text {
    /// `Name(key: value)`; a name alone where nothing else is to be said.
    pub(super) fn record(name: &str, items: Vec<(String, Self)>) -> Self {
        if items.is_empty() && !name.is_empty() {
            return Self::Leaf(name.to_owned());
        }
        Self::Group { open: format!("{name}("), items, close: ")".to_owned() }
    }

    /// `Name(value)`.
    pub(super) fn newtype(name: &str, value: Self) -> Self {
        match value {
            Self::Leaf(leaf) => Self::Leaf(format!("{name}({leaf})")),
            Self::Group { open, items, close } => {
                Self::Group { open: format!("{name}({open}"), items, close: format!("{close})") }
            }
        }
    }

    /// As a file: the outermost group always one item a line.
    pub(super) fn into_file(self) -> String {
        let mut out = String::new();
        self.write_broken(0, &mut out);
        out.push('\n');
        out
    }

    fn write(&self, used: usize, indent: usize, out: &mut String) {
        // One more for the comma that follows.
        if self.width(WIDTH.saturating_sub(used + 1)).is_some() {
            self.write_flat(out);
        } else {
            self.write_broken(indent, out);
        }
    }

    /// Characters on one line, if at most `limit`.
    fn width(&self, limit: usize) -> Option<usize> {
        let within = |width: usize| (width <= limit).then_some(width);
        match self {
            Self::Leaf(leaf) => within(leaf.chars().count()),
            Self::Group { open, items, close } => {
                let mut width = open.chars().count() + close.chars().count();
                if open.ends_with('{') && !items.is_empty() {
                    width += 2;
                }
                for (index, (key, item)) in items.iter().enumerate() {
                    width += key.chars().count() + if index > 0 { 2 } else { 0 };
                    width += item.width(limit.checked_sub(width)?)?;
                }
                within(width)
            }
        }
    }

    fn write_flat(&self, out: &mut String) {
        match self {
            Self::Leaf(leaf) => out.push_str(leaf),
            Self::Group { open, items, close } => {
                let pad = if open.ends_with('{') && !items.is_empty() { " " } else { "" };
                out.push_str(open);
                out.push_str(pad);
                for (index, (key, item)) in items.iter().enumerate() {
                    if index > 0 {
                        out.push_str(", ");
                    }
                    out.push_str(key);
                    item.write_flat(out);
                }
                out.push_str(pad);
                out.push_str(close);
            }
        }
    }

    fn write_broken(&self, indent: usize, out: &mut String) {
        let Self::Group { open, items, close } = self else { return self.write_flat(out) };
        let inner = indent + 4;
        // Long lists of numbers fill their lines.
        let small = |(key, item): &(String, Self)| key.is_empty() && item.width(40).is_some();
        let fill = items.len() > 8 && items.iter().all(small);
        out.push_str(open);
        let mut column = WIDTH;
        for (key, item) in items {
            let width = item.width(40).unwrap_or(WIDTH) + 2;
            if fill && column + width <= WIDTH {
                out.push(' ');
                column += width;
            } else {
                out.push('\n');
                out.push_str(&" ".repeat(inner));
                column = inner + width;
            }
            out.push_str(key);
            item.write(inner + key.chars().count(), inner, out);
            out.push(',');
        }
        out.push('\n');
        out.push_str(&" ".repeat(indent));
        out.push_str(close);
    }
}

/// Whether a value is not its default; floats included, hence no `!=` where they are seen.
pub(super) fn differs<T: PartialEq>(value: &T, default: &T) -> bool {
    value != default
}

/// Text in quotes. A value that starts with `=` would be read as a formula: only where a key stands
/// may it stay as it is.
fn quoted(text: &str, is_key: bool) -> String {
    let mut out = String::from("\"");
    for (index, letter) in text.chars().enumerate() {
        match letter {
            '=' if index == 0 && !is_key => out.push_str("\\u{3D}"),
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\r' => out.push_str("\\r"),
            '\t' => out.push_str("\\t"),
            _ if letter.is_control() => {
                // Writing to a string cannot fail.
                let _infallible = write!(out, "\\u{{{:X}}}", u32::from(letter));
            }
            _ => out.push(letter),
        }
    }
    out.push('"');
    out
}

impl Encode for f64 {
    fn encode(&self) -> Text {
        // The shortest decimal that is read back as the same number.
        Text::Leaf(format!("{self:?}"))
    }
}

impl Encode for u32 {
    fn encode(&self) -> Text {
        Text::Leaf(self.to_string())
    }
}

impl Encode for u64 {
    fn encode(&self) -> Text {
        Text::Leaf(self.to_string())
    }
}

impl Encode for bool {
    fn encode(&self) -> Text {
        Text::Leaf(self.to_string())
    }
}

impl Encode for String {
    fn encode(&self) -> Text {
        Text::Leaf(quoted(self, false))
    }
}

impl<T: Encode> Encode for Option<T> {
    fn encode(&self) -> Text {
        self.as_ref().map_or_else(|| Text::Leaf("None".to_owned()), T::encode)
    }
}

impl<T: Encode> Encode for Vec<T> {
    fn encode(&self) -> Text {
        let items = self.iter().map(|item| (String::new(), item.encode())).collect();
        Text::Group { open: "[".to_owned(), items, close: "]".to_owned() }
    }
}

impl<T: Encode> Encode for IndexMap<String, T> {
    fn encode(&self) -> Text {
        let entry = |(key, value): (&String, &T)| (quoted(key, true) + ": ", value.encode());
        let items = self.iter().map(entry).collect();
        Text::Group { open: "{".to_owned(), items, close: "}".to_owned() }
    }
}

macro_rules! encode_tuple {
    ($($type:ident $index:tt),*) => {
        impl<$($type: Encode),*> Encode for ($($type,)*) {
            fn encode(&self) -> Text {
                Text::record("", vec![$((String::new(), self.$index.encode())),*])
            }
        }
    };
}

encode_tuple!(A 0, B 1);
encode_tuple!(A 0, B 1, C 2);
