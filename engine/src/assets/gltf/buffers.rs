//! The bytes of buffers: in the GLB file, in `data:` URIs, in files beside the glTF file.

use std::io;
use std::path::Path;

use ::gltf::Document;
use ::gltf::buffer::Source;

use super::GltfError;
use crate::assets::error::excerpt;
use crate::assets::{AssetError, text};

/// The bytes of all buffers of a document; each has at least the length that it claims.
pub(super) struct Buffers(pub(super) Vec<Vec<u8>>);

impl Buffers {
    pub(super) fn load(
        document: &Document,
        mut blob: Option<Vec<u8>>,
        path: &Path,
    ) -> Result<Self, GltfError> {
        let mut all = Vec::new();
        for buffer in document.buffers() {
            let index = buffer.index();
            let bytes = match buffer.source() {
                Source::Bin => blob.take().unwrap_or_default(),
                Source::Uri(uri) => load_uri(uri, index, path)?,
            };
            let (claimed, found) = (buffer.length(), bytes.len());
            if found < claimed {
                return Err(GltfError::ShortBuffer { buffer: index, claimed, found });
            }
            all.push(bytes);
        }
        Ok(Self(all))
    }
}

fn load_uri(uri: &str, buffer: usize, path: &Path) -> Result<Vec<u8>, GltfError> {
    let bad_uri = || GltfError::BadUri { buffer, uri: excerpt(uri) };
    if let Some(data) = uri.strip_prefix("data:") {
        let (kind, data) = data.split_once(',').ok_or_else(bad_uri)?;
        let bytes = if kind.ends_with(";base64") { base64(data) } else { None };
        return bytes.ok_or_else(bad_uri);
    }
    // A colon belongs to a scheme such as https, a slash to a path that only one machine has.
    let name = percent_decoded(uri).filter(|name| !name.contains(':') && !name.starts_with('/'));
    let file = path.parent().unwrap_or(Path::new("")).join(name.ok_or_else(bad_uri)?);
    text::read(&file).map_err(|error| {
        let cause = match error {
            AssetError::Unreadable { cause, .. } => cause,
            _ => io::ErrorKind::IsADirectory.into(),
        };
        GltfError::BufferUnreadable { buffer, uri: excerpt(uri), cause }
    })
}

/// Bytes from base64 (RFC 4648, section 4); the padding may be missing.
fn base64(text: &str) -> Option<Vec<u8>> {
    let text = text.trim_end_matches('=').as_bytes();
    if text.len() % 4 == 1 {
        return None;
    }
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 2);
    for group in text.chunks(4) {
        let mut bits = 0_u32;
        for place in 0..4 {
            let digit = match group.get(place) {
                Some(&digit) => sextet(digit)?,
                None => 0,
            };
            bits = bits << 6 | u32::from(digit);
        }
        // n digits hold n - 1 whole bytes.
        bytes.extend_from_slice(&bits.to_be_bytes()[1..group.len()]);
    }
    Some(bytes)
}

fn sextet(digit: u8) -> Option<u8> {
    match digit {
        b'A'..=b'Z' => Some(digit - b'A'),
        b'a'..=b'z' => Some(digit - b'a' + 26),
        b'0'..=b'9' => Some(digit - b'0' + 52),
        b'+' => Some(62),
        b'/' => Some(63),
        _ => None,
    }
}

/// A URI's path with its `%20` and the like decoded.
fn percent_decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&byte, after)) = rest.split_first() {
        rest = after;
        if byte == b'%' {
            let (digits, after) = rest.split_at_checked(2)?;
            bytes.push(u8::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok()?);
            rest = after;
        } else {
            bytes.push(byte);
        }
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_gives_the_bytes_of_the_standard_examples() {
        // RFC 4648, section 10.
        for (text, bytes) in [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg==", "foob"),
            ("Zm9vYmE=", "fooba"),
            ("Zm9vYmFy", "foobar"),
            ("Zm9vYmE", "fooba"),
        ] {
            assert_eq!(base64(text).as_deref(), Some(bytes.as_bytes()), "{text}");
        }
        assert_eq!(base64("+/+/").as_deref(), Some(&[0xfb, 0xff, 0xbf][..]));
        assert_eq!(base64("A"), None);
        assert_eq!(base64("A*=="), None);
    }

    #[test]
    fn percent_signs_are_decoded() {
        assert_eq!(percent_decoded("a%20b.bin").as_deref(), Some("a b.bin"));
        assert_eq!(percent_decoded("a%2"), None);
        assert_eq!(percent_decoded("%zz"), None);
        assert_eq!(percent_decoded("%ff"), None);
    }
}
