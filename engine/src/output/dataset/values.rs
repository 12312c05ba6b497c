//! Values of a variable, in memory or in a file, as the bytes that formats hold.

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom};
use std::ops::Range;

/// Values of a variable in the order of its dimensions, the last one fastest.
#[derive(Debug)]
pub(in crate::output) enum Values<'a> {
    Doubles(Cow<'a, [f64]>),
    /// Pixels in memory.
    Floats(Vec<f32>),
    Texts(Vec<String>),
    /// Values in a file.
    Stored(StoredValues),
    /// The 0 of a variable of which attributes are all.
    Nothing,
}

/// Type of the values of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::output) enum ValueType {
    Float,
    Double,
    Integer,
    /// Texts with their greatest number of letters and of bytes in UTF-8, both at least 1.
    Text {
        letters: usize,
        bytes: usize,
    },
}

/// Order of the bytes of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::output) enum ByteOrder {
    Little,
    Big,
}

/// Values in a file that is temporary or complete.
#[derive(Debug)]
pub(in crate::output) struct StoredValues {
    pub(in crate::output) file: File,
    /// Place of the first value, bytes.
    pub(in crate::output) start: u64,
    pub(in crate::output) form: StoredForm,
}

/// Form of values in a file, little-endian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::output) enum StoredForm {
    /// `f32`, with a number in place of NaN.
    Floats { no_data: f32 },
    /// Numbers of classes as bytes, with 0 in place of NaN.
    Classes,
    /// `f64`.
    Doubles,
}

impl Values<'_> {
    pub(in crate::output) fn value_type(&self) -> ValueType {
        match self {
            Self::Doubles(_) | Self::Stored(StoredValues { form: StoredForm::Doubles, .. }) => {
                ValueType::Double
            }
            Self::Stored(_) | Self::Floats(_) => ValueType::Float,
            Self::Nothing => ValueType::Integer,
            Self::Texts(texts) => {
                let longest = |length: fn(&String) -> usize| {
                    texts.iter().map(length).max().unwrap_or(0).max(1)
                };
                ValueType::Text {
                    letters: longest(|text| text.chars().count()),
                    bytes: longest(String::len),
                }
            }
        }
    }

    /// Bytes of numbers; of texts, of one after the other, padded with zeros.
    ///
    /// - `places`: places of the values among all
    pub(in crate::output) fn bytes(
        &self,
        places: Range<usize>,
        order: ByteOrder,
    ) -> io::Result<Vec<u8>> {
        Ok(match self {
            Self::Doubles(all) => doubles(&all[places], order),
            Self::Floats(all) => {
                all[places].iter().flat_map(|&value| float(value, order)).collect()
            }
            Self::Stored(stored) => stored.bytes(places, order)?,
            Self::Nothing => vec![0; size_of::<i32>()],
            Self::Texts(texts) => match (self.value_type(), order) {
                (ValueType::Text { bytes, .. }, ByteOrder::Big) => {
                    texts[places].iter().flat_map(|text| utf_8(text, bytes)).collect()
                }
                (ValueType::Text { letters, .. }, ByteOrder::Little) => {
                    texts[places].iter().flat_map(|text| utf_32(text, letters)).collect()
                }
                _ => Vec::new(),
            },
        })
    }
}

impl StoredValues {
    /// Size of a value in the file, bytes.
    const fn size(&self) -> usize {
        match self.form {
            StoredForm::Floats { .. } => size_of::<f32>(),
            StoredForm::Classes => 1,
            StoredForm::Doubles => size_of::<f64>(),
        }
    }

    fn bytes(&self, places: Range<usize>, order: ByteOrder) -> io::Result<Vec<u8>> {
        let mut bytes = vec![0; places.len() * self.size()];
        let mut file = &self.file;
        file.seek(SeekFrom::Start(self.start + (places.start * self.size()) as u64))?;
        file.read_exact(&mut bytes)?;
        Ok(match self.form {
            StoredForm::Floats { no_data } => {
                for value in bytes.as_chunks_mut().0 {
                    let number = f32::from_le_bytes(*value);
                    let is_none = number.to_bits() == no_data.to_bits();
                    *value = float(if is_none { f32::NAN } else { number }, order);
                }
                bytes
            }
            StoredForm::Classes => {
                let number = |class: u8| if class == 0 { f32::NAN } else { f32::from(class) };
                bytes.into_iter().flat_map(|class| float(number(class), order)).collect()
            }
            StoredForm::Doubles => {
                if order == ByteOrder::Big {
                    bytes.as_chunks_mut::<8>().0.iter_mut().for_each(|value| value.reverse());
                }
                bytes
            }
        })
    }
}

fn float(value: f32, order: ByteOrder) -> [u8; 4] {
    match order {
        ByteOrder::Little => value.to_le_bytes(),
        ByteOrder::Big => value.to_be_bytes(),
    }
}

fn doubles(values: &[f64], order: ByteOrder) -> Vec<u8> {
    let bytes = |value: &f64| match order {
        ByteOrder::Little => value.to_le_bytes(),
        ByteOrder::Big => value.to_be_bytes(),
    };
    values.iter().flat_map(bytes).collect()
}

fn utf_8(text: &str, length: usize) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    bytes.resize(length, 0);
    bytes
}

fn utf_32(text: &str, letters: usize) -> Vec<u8> {
    let mut bytes: Vec<u8> =
        text.chars().flat_map(|letter| u32::from(letter).to_le_bytes()).collect();
    bytes.resize(letters * size_of::<u32>(), 0);
    bytes
}
