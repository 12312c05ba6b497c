use std::ops::Range;

use sunfleck::sampling::Key;

/// Largest file that is tried, bytes.
const LARGEST: usize = 1 << 18;

/// Numbers that mean trouble.
const NUMBERS: [&str; 30] = [
    "0",
    "-0",
    "-1",
    "1",
    "0.5",
    "1e-320",
    "1e-45",
    "1e30",
    "-1e38",
    "3.5e38",
    "1e300",
    "1.8e308",
    "-1e999",
    "NaN",
    "inf",
    "-inf",
    "65535",
    "65536",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967296",
    "67108864",
    "9007199254740993",
    "9223372036854775807",
    "-9223372036854775808",
    "18446744073709551615",
    "99999999999999999999999",
    "0x7fffffff",
    "1_000",
];

/// Pieces that mean something to some reader, and bytes that mean nothing to any.
const PIECES: [&str; 32] = [
    "(", ")", "[", "]", "{", "}", ",", ":", ";", "=", "\"", "'", "\\", "\\\n", "\n", "\r\n", "\r",
    "\t", " ", "#", "//", "/*", "*/", "r#\"", "\"#", "\u{feff}", "\0", "é", "😕", "../", "e", ".",
];

/// Whole numbers as binary files hold them.
const WHOLE: [u64; 16] = [
    0,
    1,
    2,
    4,
    5,
    8,
    16,
    0x7f,
    0xff,
    0x7fff,
    0xffff,
    0x10000,
    0x7fff_ffff,
    0xffff_ffff,
    0x1_0000_0000,
    u64::MAX,
];

/// Changes files at random; the same seed makes the same files of the same pool.
#[derive(Debug)]
pub struct Mutator {
    key: Key,
    drawn: u64,
    words: Vec<Vec<u8>>,
}

impl Mutator {
    /// A mutator whose vocabulary is that of the files.
    #[must_use]
    pub fn new(seed: u64, files: &[Vec<u8>]) -> Self {
        let mut words: Vec<Vec<u8>> = Vec::new();
        for file in files {
            words.extend(word_places(file).into_iter().map(|place| file[place].to_vec()));
        }
        words.sort_unstable();
        words.dedup();
        Self { key: Key::new(seed), drawn: 0, words }
    }

    /// A whole number below `end`; 0 if that is 0.
    pub fn below(&mut self, end: usize) -> usize {
        self.drawn += 1;
        (self.key.bits(self.drawn) % end.max(1) as u64) as usize
    }

    /// A file made of some of the pool, where the later half is as likely as all.
    ///
    /// # Panics
    /// If the pool is empty.
    pub fn mutant(&mut self, pool: &[Vec<u8>]) -> Vec<u8> {
        let mut bytes = self.pick(pool).to_vec();
        for _ in 0..1 << self.below(5) {
            self.change(&mut bytes, pool);
            bytes.truncate(LARGEST);
        }
        bytes
    }

    /// A text that most likely still parses, made of some of the pool: some of its numbers are other numbers,
    /// and values of some keys are those of the same keys elsewhere.
    ///
    /// # Panics
    /// If the pool is empty.
    pub fn variant(&mut self, pool: &[Vec<u8>]) -> Vec<u8> {
        let mut bytes = self.pick(pool).to_vec();
        for _ in 0..=self.below(4) {
            match self.below(8) {
                0..3 => self.replace_number(&mut bytes),
                3 => self
                    .replace_word(&mut bytes, |word| word[0].is_ascii_digit() || word[0] == b'-'),
                4..7 => {
                    let other = self.pick(pool).to_vec();
                    self.exchange_value(&mut bytes, &other);
                }
                _ => self.replace_word(&mut bytes, |word| word[0].is_ascii_uppercase()),
            }
            bytes.truncate(LARGEST);
        }
        bytes
    }

    /// A number becomes a multiple of itself, or one near it.
    fn replace_number(&mut self, bytes: &mut Vec<u8>) {
        let mut places = word_places(bytes);
        places.retain(|place| bytes[place.start].is_ascii_digit() || bytes[place.start] == b'-');
        if places.is_empty() {
            return;
        }
        let place = places.swap_remove(self.below(places.len()));
        let text = String::from_utf8_lossy(&bytes[place.clone()]).into_owned();
        let Ok(number) = text.parse::<f64>() else { return };
        let factors = [0.0, -1.0, 0.5, 0.999_999, 2.0, 10.0, 1e-3, 1e3, 1e-6, 1e6, 1e-12, 1e12];
        let changed = match self.below(factors.len() + 2) {
            0 => number + 1.0,
            1 => number - 1.0,
            factor => number * factors[factor - 2],
        };
        let is_whole = !text.contains(['.', 'e', 'E']);
        let new = if is_whole { format!("{}", changed.trunc()) } else { format!("{changed:?}") };
        bytes.splice(place, new.into_bytes());
    }

    /// The value of a key becomes that of the same key in another text.
    fn exchange_value(&mut self, bytes: &mut Vec<u8>, other: &[u8]) {
        let (own, theirs) = (values(bytes), values(other));
        if own.is_empty() {
            return;
        }
        let place = &own[self.below(own.len())];
        let key = &bytes[place.key.clone()];
        let alike: Vec<_> = theirs.iter().filter(|one| &other[one.key.clone()] == key).collect();
        if alike.is_empty() {
            return;
        }
        let value = alike[self.below(alike.len())].value.clone();
        bytes.splice(place.value.clone(), other[value].iter().copied());
    }

    fn pick<'a>(&mut self, pool: &'a [Vec<u8>]) -> &'a [u8] {
        let first = if self.below(2) == 0 { 0 } else { pool.len() / 2 };
        &pool[first + self.below(pool.len() - first)]
    }

    /// A range of up to `most` bytes.
    fn range(&mut self, length: usize, most: usize) -> Range<usize> {
        let start = self.below(length + 1);
        let most = if self.below(4) == 0 { length } else { most };
        start..(start + self.below(most.min(length - start) + 1))
    }

    fn change(&mut self, bytes: &mut Vec<u8>, pool: &[Vec<u8>]) {
        let length = bytes.len();
        let at = self.below(length);
        match self.below(14) {
            0 if length > 0 => bytes[at] ^= 1 << self.below(8),
            1 if length > 0 => bytes[at] = self.below(256) as u8,
            2 => drop(bytes.drain(self.range(length, 40))),
            3 => {
                let piece = bytes[self.range(length, 200)].to_vec();
                insert(bytes, at, &piece);
            }
            4 => {
                let piece = PIECES[self.below(PIECES.len())];
                insert(bytes, at, piece.as_bytes());
            }
            5 | 6 => self.replace_word(bytes, |word| word[0].is_ascii_digit() || word[0] == b'-'),
            7 => self.replace_word(bytes, |_| true),
            8 => bytes.truncate(self.below(length + 1)),
            9 => {
                let other = self.pick(pool).to_vec();
                let piece = &other[self.range(other.len(), 400)];
                let place = self.range(length, 40);
                bytes.splice(place, piece.iter().copied());
            }
            10 => {
                let piece = bytes[self.range(length, 12)].to_vec();
                let times = 1 << self.below(14);
                let most = LARGEST / piece.len().max(1);
                insert(bytes, at, &piece.repeat(times.min(most)));
            }
            11 | 12 => self.overwrite(bytes),
            _ if length == 0 => {}
            _ => {
                // A line goes elsewhere.
                let mut lines: Vec<&[u8]> = bytes.split_inclusive(|&byte| byte == b'\n').collect();
                let line = lines.remove(self.below(lines.len()));
                lines.insert(self.below(lines.len() + 1), line);
                *bytes = lines.concat();
            }
        }
    }

    /// A word, such as `wanted` takes, becomes a number or a word of the vocabulary.
    fn replace_word(&mut self, bytes: &mut Vec<u8>, wanted: fn(&[u8]) -> bool) {
        let mut places = word_places(bytes);
        places.retain(|place| wanted(&bytes[place.clone()]));
        if places.is_empty() {
            return;
        }
        let place = places.swap_remove(self.below(places.len()));
        let is_number = self.words.is_empty() || self.below(2) == 0;
        let number = NUMBERS[self.below(NUMBERS.len())].as_bytes();
        let word = self.below(self.words.len());
        let word = if is_number { number } else { &self.words[word] };
        bytes.splice(place, word.iter().copied());
    }

    /// One or two to eight bytes become a number in either order of bytes.
    fn overwrite(&mut self, bytes: &mut [u8]) {
        let size = 1 << self.below(4);
        if bytes.len() < size {
            return;
        }
        let mut at = self.below(bytes.len() - size + 1);
        if self.below(2) == 0 {
            at -= at % size.min(2);
        }
        let place = &mut bytes[at..at + size];
        let mut number = [0; 8];
        number[..size].copy_from_slice(place);
        let old = u64::from_le_bytes(number);
        let step = self.below(32) as u64;
        let new = match self.below(4) {
            0 => old.wrapping_add(step),
            1 => old.wrapping_sub(step),
            _ => WHOLE[self.below(WHOLE.len())],
        };
        place.copy_from_slice(&new.to_le_bytes()[..size]);
        if self.below(2) == 0 {
            place.reverse();
        }
    }
}

fn insert(bytes: &mut Vec<u8>, at: usize, piece: &[u8]) {
    bytes.splice(at..at, piece.iter().copied());
}

/// Where the words and numbers of a text are.
fn word_places(bytes: &[u8]) -> Vec<Range<usize>> {
    let is_part = |byte: u8| byte.is_ascii_alphanumeric() || b"_.+-".contains(&byte);
    let mut places = Vec::new();
    let mut start = None;
    for (at, &byte) in bytes.iter().chain(b" ").enumerate() {
        match (start, is_part(byte)) {
            (None, true) => start = Some(at),
            (Some(first), false) => {
                places.push(first..at);
                start = None;
            }
            _ => {}
        }
    }
    places
}

/// A key of a text and its value.
struct Entry {
    key: Range<usize>,
    value: Range<usize>,
}

/// All `key: value` of a text, from the outermost to the innermost.
fn values(bytes: &[u8]) -> Vec<Entry> {
    let mut entries = Vec::new();
    for key in word_places(bytes) {
        if bytes.get(key.end) != Some(&b':') {
            continue;
        }
        let start = key.end + 1;
        let (mut depth, mut is_quoted, mut end) = (0_u32, false, start);
        for &byte in &bytes[start..] {
            match byte {
                b'"' => is_quoted = !is_quoted,
                _ if is_quoted => {}
                b'(' | b'[' | b'{' => depth += 1,
                b')' | b']' | b'}' | b',' if depth == 0 => break,
                b')' | b']' | b'}' => depth -= 1,
                _ => {}
            }
            end += 1;
        }
        entries.push(Entry { key, value: start..end });
    }
    entries
}
