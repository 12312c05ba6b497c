//! Texts of diagnostics that fit on one line, although they quote names of any length and content.

use std::borrow::Cow;

/// Largest number of characters of a quoted name that is shown whole.
pub(crate) const NAME: usize = 300;

/// Largest number of characters between two quoted names: lists of names stand there.
const LIST: usize = 4000;

/// Characters of a longer text that are shown of its start, and of its end.
const START: usize = 200;
const END: usize = 60;

/// Returns a text without line breaks and other control characters, with shortened names between backticks.
///
/// A scene may define a name of a million characters, or one with line breaks or terminal sequences in it.
pub(crate) fn legible(text: &str) -> Cow<'_, str> {
    let has_control = text.contains(char::is_control);
    if !has_control && text.len() <= NAME {
        return Cow::Borrowed(text);
    }
    let escaped: String = text
        .chars()
        .flat_map(|character| {
            let (escape, plain) = if character.is_control() {
                (Some(character.escape_default()), None)
            } else {
                (None, Some(character))
            };
            escape.into_iter().flatten().chain(plain)
        })
        .collect();
    let parts = escaped.split('`').enumerate();
    let parts =
        parts.map(|(index, part)| shortened(part, if index % 2 == 0 { LIST } else { NAME }));
    let parts: Vec<_> = parts.collect();
    Cow::Owned(parts.join("`"))
}

/// Returns a text of at most `most` characters, or the start and end of a longer one.
pub(crate) fn shortened(text: &str, most: usize) -> Cow<'_, str> {
    let count = text.chars().count();
    if count <= most {
        return Cow::Borrowed(text);
    }
    let start: String = text.chars().take(START).collect();
    let end: String = text.chars().skip(count - END).collect();
    Cow::Owned(format!("{start}… ({} characters) …{end}", count - START - END))
}

#[cfg(test)]
mod tests {
    use super::legible;

    #[test]
    fn a_message_keeps_to_its_line_whatever_name_it_quotes() {
        assert_eq!(legible("no material `laef`"), "no material `laef`");
        assert_eq!(legible("no material `a\n\tb\u{1b}[31m`"), "no material `a\\n\\tb\\u{1b}[31m`");
        let long = legible(&format!("no key `{}` here", "é".repeat(1_000_000))).into_owned();
        assert!(long.starts_with("no key `é") && long.ends_with("é` here"), "{long}");
        assert!(long.contains("(999740 characters)") && long.chars().count() < 350, "{long}");
    }
}
