//! Comments at the end of a line.

/// Keywords that a name follows: in it, `#` starts a comment behind a space only, as in `g leaf#3 # crown`.
const NAMES: [&[u8]; 6] = [b"g", b"o", b"usemtl", b"mtllib", b"usemap", b"maplib"];

/// Returns whether a name follows the keyword of a line.
pub(super) fn is_name(line: &[u8]) -> bool {
    let end = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
    NAMES.contains(&&line[..end])
}

/// Returns the byte where the comment of a line starts, or else the line's length.
pub(super) fn comment(line: &[u8], is_name: bool) -> usize {
    let is_start = |place: usize| {
        line[place] == b'#' && (!is_name || place == 0 || line[place - 1].is_ascii_whitespace())
    };
    (0..line.len()).find(|&place| is_start(place)).unwrap_or(line.len())
}

/// Returns a line without its comment and the white space before it.
pub(super) fn without_comment(line: &[u8]) -> &[u8] {
    // Most lines have none.
    if !line.contains(&b'#') {
        return line;
    }
    line[..comment(line, is_name(line))].trim_ascii_end()
}
