//! Header of a file: dimensions, attributes, and variables with the places of their values.

use std::io;

use super::super::dataset::{Attribute, Attributes, Dataset, ValueType, Variable};

/// Numbers that are 64 bits wide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Width {
    /// Places in the file; version 2 of the format.
    Places,
    /// Places and sizes; version 5.
    Sizes,
}

/// Tags of lists and types of values.
const DIMENSIONS: u32 = 10;
const VARIABLES: u32 = 11;
const ATTRIBUTES: u32 = 12;
const CHAR: u32 = 2;
const INT: u32 = 4;
const FLOAT: u32 = 5;
const DOUBLE: u32 = 6;

/// Header of a file.
pub(super) struct Header<'a> {
    dataset: &'a Dataset<'a>,
    /// Lengths of texts, which have a dimension each behind those of the data set.
    text_lengths: Vec<usize>,
    pub(super) variables: Vec<VariableLayout>,
}

/// Size of a variable and its dimensions in the file.
pub(super) struct VariableLayout {
    dimensions: Vec<usize>,
    /// Number of values; a text is one.
    pub(super) values: usize,
    /// Size of all values, bytes.
    pub(super) bytes: u64,
}

impl VariableLayout {
    /// Size in the file, where variables start at multiples of 4.
    pub(super) const fn padded(&self) -> u64 {
        self.bytes.next_multiple_of(4)
    }
}

impl<'a> Header<'a> {
    pub(super) fn new(dataset: &'a Dataset<'a>) -> Self {
        let mut text_lengths = Vec::new();
        let layout = |variable: &Variable<'_>| {
            let values = variable.shape(&dataset.dimensions).iter().product();
            let mut dimensions = variable.dimensions.clone();
            let size = match variable.values.value_type() {
                ValueType::Text { bytes, .. } => {
                    let place = text_lengths.iter().position(|length| *length == bytes);
                    let place = place.unwrap_or_else(|| {
                        text_lengths.push(bytes);
                        text_lengths.len() - 1
                    });
                    dimensions.push(dataset.dimensions.len() + place);
                    bytes
                }
                ValueType::Double => 8,
                ValueType::Float | ValueType::Integer => 4,
            };
            VariableLayout { dimensions, values, bytes: values as u64 * size as u64 }
        };
        let variables = dataset.variables.iter().map(layout).collect();
        Self { dataset, text_lengths, variables }
    }

    /// Bytes of the header.
    ///
    /// # Errors
    /// If a number does not fit.
    pub(super) fn encode(&self, width: Width) -> io::Result<Vec<u8>> {
        // Its length depends on the numbers of things alone.
        let length = self.encode_from(0, width)?.len();
        self.encode_from(length as u64, width)
    }

    /// Bytes of the header, before values that start here.
    fn encode_from(&self, start: u64, width: Width) -> io::Result<Vec<u8>> {
        let mut out = Bytes { bytes: b"CDF".to_vec(), width };
        out.bytes.push(match width {
            Width::Places => 2,
            Width::Sizes => 5,
        });
        // Number of records along an unlimited dimension, which there is none of.
        out.size(0)?;
        let lengths = self.dataset.dimensions.iter().map(|one| (one.name.clone(), one.length));
        let texts = self.text_lengths.iter().map(|length| (format!("string{length}"), *length));
        let dimensions: Vec<(String, usize)> = lengths.chain(texts).collect();
        out.list(DIMENSIONS, dimensions.len())?;
        for (name, length) in dimensions {
            out.name(&name)?;
            out.size(length as u64)?;
        }
        out.attributes(&self.dataset.attributes, &[])?;
        out.list(VARIABLES, self.variables.len())?;
        let mut place = start;
        for (variable, layout) in self.dataset.variables.iter().zip(&self.variables) {
            out.variable(variable, layout, place)?;
            place += layout.padded();
        }
        Ok(out.bytes)
    }
}

/// Bytes of a header that grows.
struct Bytes {
    bytes: Vec<u8>,
    width: Width,
}

impl Bytes {
    fn int(&mut self, number: u32) {
        self.bytes.extend(number.to_be_bytes());
    }

    /// A size or a number of things.
    fn size(&mut self, number: u64) -> io::Result<()> {
        match self.width {
            Width::Places => {
                let too_large = |_| io::Error::other("a dimension is too long for a NetCDF file");
                self.int(u32::try_from(number).map_err(too_large)?);
            }
            Width::Sizes => self.bytes.extend(number.to_be_bytes()),
        }
        Ok(())
    }

    /// Start of a list.
    fn list(&mut self, tag: u32, length: usize) -> io::Result<()> {
        self.int(if length == 0 { 0 } else { tag });
        self.size(length as u64)
    }

    fn name(&mut self, name: &str) -> io::Result<()> {
        self.size(name.len() as u64)?;
        self.padded(name.as_bytes());
        Ok(())
    }

    fn padded(&mut self, bytes: &[u8]) {
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
    }

    /// Attributes, and more of them as type and bytes of one value or text.
    fn attributes(
        &mut self,
        attributes: &Attributes,
        more: &[(&str, Attribute)],
    ) -> io::Result<()> {
        self.list(ATTRIBUTES, attributes.0.len() + more.len())?;
        let all = attributes.0.iter().map(|(name, value)| (name.as_str(), value));
        for (name, value) in all.chain(more.iter().map(|(name, value)| (*name, value))) {
            self.name(name)?;
            let (tag, count, bytes) = match value {
                Attribute::Text(text) => (CHAR, text.len(), text.as_bytes().to_vec()),
                Attribute::Numbers(numbers) => {
                    (DOUBLE, numbers.len(), numbers.iter().flat_map(|n| n.to_be_bytes()).collect())
                }
                Attribute::Floats(numbers) => {
                    (FLOAT, numbers.len(), numbers.iter().flat_map(|n| n.to_be_bytes()).collect())
                }
            };
            self.int(tag);
            self.size(count as u64)?;
            self.padded(&bytes);
        }
        Ok(())
    }

    fn variable(
        &mut self,
        variable: &Variable<'_>,
        layout: &VariableLayout,
        place: u64,
    ) -> io::Result<()> {
        let value_type = variable.values.value_type();
        let (tag, own) = match value_type {
            ValueType::Text { .. } => {
                (CHAR, Some(("_Encoding", Attribute::Text("utf-8".to_owned()))))
            }
            ValueType::Integer => (INT, None),
            ValueType::Float => (FLOAT, Some(("_FillValue", Attribute::Floats(vec![f32::NAN])))),
            ValueType::Double => (DOUBLE, Some(("_FillValue", Attribute::Numbers(vec![f64::NAN])))),
        };
        let is_text = matches!(value_type, ValueType::Text { .. });
        let own = own.filter(|_| variable.has_fill || is_text);
        self.name(&variable.name)?;
        self.size(layout.dimensions.len() as u64)?;
        layout.dimensions.iter().try_for_each(|&dimension| self.size(dimension as u64))?;
        self.attributes(&variable.attributes, own.as_slice())?;
        self.int(tag);
        match self.width {
            // A larger size has no room, and readers compute it from the dimensions.
            Width::Places => self.int(u32::try_from(layout.padded()).unwrap_or(u32::MAX)),
            Width::Sizes => self.size(layout.padded())?,
        }
        self.bytes.extend(place.to_be_bytes());
        Ok(())
    }
}
