//! Reader of a file whose lines and header may be longer than any that is lawful.

use std::io::{self, BufRead, Read};

/// Longest header and longest line, bytes.
const LONGEST: usize = 1 << 20;

/// Content that a reader is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Content {
    Header,
    Lines,
    Binary,
}

/// Reader that fails where a header or a line does not end: what would fill the memory otherwise.
pub(super) struct Guarded<R> {
    inner: R,
    content: Content,
    /// Bytes since the beginning of the header or of the line.
    used: usize,
}

impl<R> Guarded<R> {
    pub(super) fn new(inner: R) -> Self {
        Self { inner, content: Content::Header, used: 0 }
    }

    /// Tells what follows.
    pub(super) fn set_content(&mut self, content: Content) {
        (self.content, self.used) = (content, 0);
    }
}

impl<R: BufRead> BufRead for Guarded<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.used > LONGEST {
            let what = if self.content == Content::Header { "its header" } else { "a line" };
            let message = format!("{what} is longer than {LONGEST} bytes");
            return Err(io::Error::new(io::ErrorKind::InvalidData, message));
        }
        self.inner.fill_buf()
    }

    fn consume(&mut self, amount: usize) {
        match self.content {
            Content::Header => self.used += amount,
            Content::Binary => {}
            Content::Lines => {
                // The buffer still holds what was filled, so that this reads nothing.
                let filled = self.inner.fill_buf().unwrap_or_default();
                let taken = &filled[..amount.min(filled.len())];
                match taken.iter().rposition(|&byte| byte == b'\n') {
                    Some(end) => self.used = taken.len() - end - 1,
                    None => self.used += amount,
                }
            }
        }
        self.inner.consume(amount);
    }
}

impl<R: BufRead> Read for Guarded<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.content == Content::Binary {
            return self.inner.read(buffer);
        }
        let available = self.fill_buf()?;
        let count = available.len().min(buffer.len());
        buffer[..count].copy_from_slice(&available[..count]);
        self.consume(count);
        Ok(count)
    }
}
