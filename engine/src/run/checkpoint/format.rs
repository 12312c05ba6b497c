//! Format of checkpoint files.
//!
//! All numbers are little-endian. A file is
//!
//! | bytes | |
//! |---|---|
//! | 16 | `sunfleck traced` and a line feed |
//! | 4 | version of this format, 5 |
//! | 4, n | length and text of the version of sunfleck: another one may draw other numbers |
//! | 32 | hash of the scene without what says how long it is measured |
//! | 4, 4 | which share of the run this is, from 0, and of how many |
//! | 4 | number of sensors that have been begun; of each |
//! | 4, n | length and text of its name |
//! | 8, 8 | samples of each randomisation (u64) and seconds (f64) so far |
//! | 8, n | length of what its films hold, and that (`transport::Film::save`) |
//! | 8, n | length of the spectra that decided the paths (`scattering::PathSpectra::save`), and these; none unless
//! coefficients are kept |
//! | 32 | BLAKE3 of all bytes before |

use std::fs::File;
use std::io::{self, Read, Write};
use std::path::Path;
use std::sync::Arc;

use super::{Checkpoint, FilmState, Section, is_in_memory, not_regular, unreadable, wrong};
use crate::output;
use crate::products::data_size;
use crate::run::Failure;
use crate::scratch::{RandomAccessFile, ScratchSpace};
use crate::transport::Partition;

const MAGIC: [u8; 16] = *b"sunfleck traced\n";
const VERSION: u32 = 5;

/// Writer that hashes what it writes.
struct HashingWriter<W> {
    inner: W,
    hasher: blake3::Hasher,
}

impl<W: Write> Write for HashingWriter<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.hasher.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

/// Writes a checkpoint.
pub(super) fn write(to: &Checkpoint, hash: [u8; 32], sections: &[Section]) -> io::Result<()> {
    output::replace_file(&to.file, |file| {
        write_into(io::BufWriter::new(file), to.share, hash, sections, &[])
    })
}

/// Writes the sections of a scene with this hash, and the spectra that decided its paths.
pub(super) fn write_into(
    inner: impl Write,
    share: Partition,
    hash: [u8; 32],
    sections: &[Section],
    spectra: &[u8],
) -> io::Result<()> {
    let mut out = HashingWriter { inner, hasher: blake3::Hasher::new() };
    out.write_all(&MAGIC)?;
    out.write_all(&VERSION.to_le_bytes())?;
    text(&mut out, env!("CARGO_PKG_VERSION"))?;
    out.write_all(&hash)?;
    out.write_all(&share.index.to_le_bytes())?;
    out.write_all(&share.count.to_le_bytes())?;
    out.write_all(&(sections.len() as u32).to_le_bytes())?;
    for section in sections {
        text(&mut out, &section.name)?;
        out.write_all(&section.samples.to_le_bytes())?;
        out.write_all(&section.seconds.to_le_bytes())?;
        out.write_all(&section.state.len().to_le_bytes())?;
        section.state.write(&mut out)?;
    }
    out.write_all(&(spectra.len() as u64).to_le_bytes())?;
    out.write_all(spectra)?;
    let sum = out.hasher.finalize();
    out.write_all(sum.as_bytes())?;
    out.flush()
}

fn text(out: &mut impl Write, text: &str) -> io::Result<()> {
    out.write_all(&(text.len() as u32).to_le_bytes())?;
    out.write_all(text.as_bytes())
}

/// Largest size of a checkpoint that is read, bytes: larger films do not fit into memory.
const LARGEST: u64 = 1 << 40;

/// Opens a checkpoint and checks its first bytes and its checksum; returns the file, and the number of bytes before the
/// checksum.
fn open(file: &Path) -> Result<(RandomAccessFile, u64), Failure> {
    let fail = |source| unreadable(file, source);
    let metadata = std::fs::metadata(file).map_err(fail)?;
    // Opening a pipe would wait for its writer, and a device may have no end.
    if !metadata.is_file() {
        return Err(not_regular(file));
    }
    if metadata.len() > LARGEST {
        let found = format!("holds {}", data_size(metadata.len()));
        return Err(wrong(
            file,
            &found,
            &format!("a checkpoint has {} at most", data_size(LARGEST)),
        ));
    }
    let mut input = File::open(file).map_err(fail)?;
    let mut start = Vec::new();
    Read::by_ref(&mut input).take(MAGIC.len() as u64).read_to_end(&mut start).map_err(fail)?;
    if start != MAGIC {
        // A file that starts otherwise is no checkpoint, unless it was cut off.
        let found = "is no checkpoint of sunfleck";
        return Err(wrong(file, found, "name another file; this one is left as it is"));
    }
    let damaged = || wrong(file, DAMAGED, START_AGAIN);
    let end = metadata.len().checked_sub(blake3::OUT_LEN as u64).ok_or_else(damaged)?;
    let input = RandomAccessFile::from(input);
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(input.reader(0..end)).map_err(fail)?;
    let mut sum = [0; blake3::OUT_LEN];
    input.read_at(&mut sum, end).map_err(fail)?;
    if hasher.finalize() == sum { Ok((input, end)) } else { Err(damaged()) }
}

/// Contents of a checkpoint.
pub(super) struct Contents {
    /// Hash of the scene.
    pub(super) scene: [u8; 32],
    pub(super) share: Partition,
    pub(super) sections: Vec<Section>,
    /// Spectra that decided the paths; empty unless coefficients are kept.
    pub(super) spectra: Vec<u8>,
}

/// Reads a checkpoint of a scene.
pub(super) fn read_of_scene(
    file: &Path,
    hash: [u8; 32],
    scratch: &ScratchSpace,
) -> Result<(Partition, Vec<Section>), Failure> {
    let Contents { scene, share, sections, .. } = read(file, scratch)?;
    if scene != hash {
        let found = "is of another scene or of other sensors: only `until`, `samples_per_px`, `samples_per_m2`, \
                     `per_m2` and the quality may differ";
        return Err(wrong(file, found, START_AGAIN));
    }
    Ok((share, sections))
}

const START_AGAIN: &str = "take the file away to trace from the start";

const DAMAGED: &str = "is damaged: its checksum is not that of what it holds";

/// Reads a checkpoint; states that take much memory stay in the file.
pub(super) fn read(file: &Path, scratch: &ScratchSpace) -> Result<Contents, Failure> {
    let (input, end) = open(file)?;
    let input = Arc::new(input);
    let damaged = |_short: io::Error| wrong(file, DAMAGED, START_AGAIN);
    let mut rest = input.reader(MAGIC.len() as u64..end);
    let version = number(&mut rest).map_err(damaged)?;
    if version != VERSION {
        let found = format!("has format {version}, and this version reads format {VERSION}");
        return Err(wrong(file, &found, START_AGAIN));
    }
    let sunfleck = string(&mut rest, end).map_err(damaged)?;
    if sunfleck != env!("CARGO_PKG_VERSION") {
        let found = format!(
            "was written by sunfleck {sunfleck}, and this is {}, which may draw other numbers",
            env!("CARGO_PKG_VERSION")
        );
        return Err(wrong(file, &found, START_AGAIN));
    }
    let body = (|| -> io::Result<Contents> {
        let scene = array(&mut rest)?;
        let share = Partition { index: number(&mut rest)?, count: number(&mut rest)? };
        let (mut place, count) = (rest.place(), number(&mut rest)?);
        place += u64::from(u32::BITS / 8);
        let mut sections = Vec::new();
        for _ in 0..count {
            sections.push(section(&input, &mut place, end, scratch)?);
        }
        let mut rest = input.reader(place..end);
        let length = u64::from_le_bytes(array(&mut rest)?);
        if length > end - rest.place() {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        let mut spectra = vec![0; length as usize];
        rest.read_exact(&mut spectra)?;
        Ok(Contents { scene, share, sections, spectra })
    })();
    let contents = body.map_err(damaged)?;
    if contents.share.index >= contents.share.count {
        return Err(wrong(file, DAMAGED, START_AGAIN));
    }
    Ok(contents)
}

/// Reads a section from a place on, which moves behind it.
fn section(
    file: &Arc<RandomAccessFile>,
    place: &mut u64,
    end: u64,
    scratch: &ScratchSpace,
) -> io::Result<Section> {
    let mut input = file.reader(*place..end);
    let name = string(&mut input, end)?;
    let samples = u64::from_le_bytes(array(&mut input)?);
    let seconds = f64::from_le_bytes(array(&mut input)?);
    let length = u64::from_le_bytes(array(&mut input)?);
    let start = input.place();
    if length > end - start {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    *place = start + length;
    let state = if is_in_memory(length, scratch) {
        let mut bytes = vec![0; length as usize];
        input.read_exact(&mut bytes)?;
        FilmState::Memory(Arc::new(bytes))
    } else {
        FilmState::File { file: Arc::clone(file), place: start, length }
    };
    Ok(Section { name, samples, seconds, state })
}

fn array<const N: usize>(input: &mut impl Read) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    input.read_exact(&mut bytes)?;
    Ok(bytes)
}

fn number(input: &mut impl Read) -> io::Result<u32> {
    Ok(u32::from_le_bytes(array(input)?))
}

/// Reads a text that is not longer than a file.
fn string(input: &mut impl Read, longest: u64) -> io::Result<String> {
    let length = number(input)?;
    if u64::from(length) > longest {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    let mut bytes = vec![0; length as usize];
    input.read_exact(&mut bytes)?;
    String::from_utf8(bytes).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
}
