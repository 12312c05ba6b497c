//! Recipes as text out of each format, which is known by its first bytes.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read as _, Seek as _};
use std::path::{Path, PathBuf};

use ::exr::meta::MetaData;
use serde::Deserialize;
use serde_json::Value;
use serde_json::value::RawValue;
use tiff::decoder::{Decoder, Limits};
use tiff::tags::Tag;

use super::RECIPE;
use super::record::MOST;
use crate::files;
use crate::output::{names, netcdf};

/// Recipe of a file as text, or what is there instead.
pub(super) enum Extracted {
    Recipe(String),
    /// The summary of another command than `run`.
    OtherCommand(String),
    /// A file of this kind without a recipe.
    Nothing(&'static str),
    NotAResult,
}

impl Extracted {
    fn of(kind: &'static str, recipe: Option<String>) -> Self {
        recipe.map_or(Self::Nothing(kind), Self::Recipe)
    }
}

/// Longest text that is searched for a recipe, bytes.
const LONGEST: u64 = 4 << 20;

/// Finds the recipe of a file or of a Zarr store.
///
/// # Errors
/// If it cannot be read; of the kind `InvalidData` if it is damaged.
pub(super) fn recipe_of(path: &Path) -> io::Result<Extracted> {
    if path.join(".zattrs").is_file() {
        return of_json("a Zarr store", files::open(&path.join(".zattrs"))?);
    }
    // Pixels of ENVI say nothing: their header stands beside them.
    let header = PathBuf::from(names::header(&path.to_string_lossy()));
    let path = if header.is_file() { &header } else { path };
    let mut file = files::open(path)?;
    let mut start = Vec::new();
    (&file).take(8).read_to_end(&mut start)?;
    file.rewind()?;
    match &start[..] {
        [0x89, b'P', b'N', b'G', ..] => of_png(file),
        [0x76, 0x2f, 0x31, 0x01, ..] => of_exr(file),
        [b'I', b'I', 42 | 43, 0, ..] => of_tiff(file),
        [b'C', b'D', b'F', 1 | 2 | 5, ..] => {
            let text = netcdf::text_attribute(BufReader::new(file), RECIPE)?;
            Ok(Extracted::of("a NetCDF file", text))
        }
        [b'p', b'l', b'y', b'\n', ..] => of_comments("a PLY file", "comment ", file),
        [b'E', b'N', b'V', b'I', ..] => of_envi(file),
        [b'#', ..] => of_comments("a table", "# ", file),
        [b'{', ..] => of_json("JSON", file),
        [b'<', ..] => of_svg(file),
        _ => Ok(Extracted::NotAResult),
    }
}

fn damaged(error: impl std::fmt::Display) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, error.to_string())
}

fn of_png(file: File) -> io::Result<Extracted> {
    let mut decoder = png::Decoder::new(BufReader::new(file));
    decoder.set_ignore_text_chunk(false);
    let reader = decoder.read_info().map_err(damaged)?;
    let texts = &reader.info().utf8_text;
    let found = texts.iter().find(|text| text.keyword == RECIPE);
    let text = found.map(png::text_metadata::ITXtChunk::get_text).transpose().map_err(damaged)?;
    Ok(Extracted::of("a picture", text))
}

fn of_exr(file: File) -> io::Result<Extracted> {
    let metadata = MetaData::read_from_buffered(BufReader::new(file), false).map_err(damaged)?;
    let comments =
        metadata.headers.first().and_then(|header| header.own_attributes.comments.clone());
    let text = comments.map(|text| String::from_utf8_lossy(text.bytes()).into_owned());
    Ok(Extracted::of("an EXR image", text.and_then(|text| in_object(&text))))
}

/// Recipe of an object of keys and texts.
fn in_object(json: &str) -> Option<String> {
    match serde_json::from_str(json).ok()? {
        Value::Object(mut object) => object.remove(RECIPE).map(text_of),
        _ => None,
    }
}

/// Text of a recipe that is one already, or an object.
fn text_of(value: Value) -> String {
    match value {
        Value::String(text) => text,
        other => other.to_string(),
    }
}

fn of_tiff(file: File) -> io::Result<Extracted> {
    let mut limits = Limits::default();
    limits.ifd_value_size = LONGEST as usize;
    let decoder = Decoder::new(BufReader::new(file)).map_err(damaged)?;
    let mut decoder = decoder.with_limits(limits);
    let found = decoder.find_tag(Tag::Unknown(42_112)).map_err(damaged)?;
    let text = found.map(tiff::decoder::ifd::Value::into_string).transpose().map_err(damaged)?;
    let item = |text: String| {
        let (_, rest) = text.split_once("name=\"sunfleck_recipe\">")?;
        // Escaped twice, as GDAL has it.
        Some(unescaped(&unescaped(rest.split_once('<')?.0)))
    };
    Ok(Extracted::of("a GeoTIFF", text.and_then(item)))
}

/// Text that XML holds.
fn unescaped(text: &str) -> String {
    text.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&amp;", "&")
}

fn of_svg(file: File) -> io::Result<Extracted> {
    let mut text = Vec::new();
    file.take(LONGEST).read_to_end(&mut text)?;
    let text = String::from_utf8_lossy(&text);
    let inner = || {
        let (_, rest) = text.split_once("<metadata id=\"sunfleck\">")?;
        in_object(&unescaped(rest.split_once("</metadata>")?.0))
    };
    Ok(Extracted::of("a drawing", inner()))
}

/// Comments `recipe: ..`, and `recipe+ ..` with more of it, at the start of a text.
fn of_comments(kind: &'static str, mark: &str, file: File) -> io::Result<Extracted> {
    let mut lines = BufReader::new(file.take(LONGEST));
    let mut recipe: Option<String> = None;
    let mut line = Vec::new();
    loop {
        line.clear();
        lines.read_until(b'\n', &mut line)?;
        let text = String::from_utf8_lossy(&line);
        let text = text.trim_end();
        let is_first = recipe.is_none()
            && kind == "a PLY file"
            && (text == "ply" || text.starts_with("format"));
        let Some(comment) = text.strip_prefix(mark) else {
            if is_first {
                continue;
            }
            break;
        };
        if let Some(first) = comment.strip_prefix("recipe: ") {
            recipe = Some(first.to_owned());
        } else if let (Some(more), Some(recipe)) = (comment.strip_prefix("recipe+ "), &mut recipe) {
            recipe.push_str(more);
        }
    }
    Ok(Extracted::of(kind, recipe))
}

fn of_envi(file: File) -> io::Result<Extracted> {
    let mut text = Vec::new();
    file.take(LONGEST).read_to_end(&mut text)?;
    let text = String::from_utf8_lossy(&text);
    let found = text.split_once("; recipe: ").map(|(_, rest)| rest);
    let recipe = found.and_then(|rest| rest.split([';', '}']).next());
    Ok(Extracted::of("a raster of ENVI", recipe.map(|recipe| recipe.trim().to_owned())))
}

/// Keys of a summary, or of the attributes of a Zarr store.
#[derive(Deserialize)]
struct Document {
    /// As it is written: the order of parameters counts.
    recipe: Option<Box<RawValue>>,
    command: Option<String>,
}

/// Recipe of a summary, or of the attributes of a Zarr store.
fn of_json(kind: &'static str, file: File) -> io::Result<Extracted> {
    let Document { recipe, command } =
        serde_json::from_reader(BufReader::new(file.take(MOST))).map_err(damaged)?;
    if let Some(recipe) = recipe {
        // A text, or the record itself.
        let text = serde_json::from_str(recipe.get()).unwrap_or_else(|_| recipe.get().to_owned());
        return Ok(Extracted::Recipe(text));
    }
    Ok(match command {
        Some(command) if command != "run" => Extracted::OtherCommand(command),
        _ => Extracted::Nothing(kind),
    })
}
