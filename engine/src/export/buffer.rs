//! Binary part of a glTF file: views of one buffer, and accessors of numbers in them.

use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};

use serde_json::{Value, json};

/// Target of a buffer view: corners, or their numbers.
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// Component types.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;

/// Buffer that is written to a temporary file, and the JSON about it.
#[derive(Debug)]
pub(super) struct BinaryBuffer {
    file: BufWriter<File>,
    length: u64,
    pub(super) views: Vec<Value>,
    pub(super) accessors: Vec<Value>,
}

impl BinaryBuffer {
    pub(super) fn new() -> io::Result<Self> {
        let file = BufWriter::new(tempfile::tempfile()?);
        Ok(Self { file, length: 0, views: Vec::new(), accessors: Vec::new() })
    }

    /// Length, bytes; a multiple of four.
    pub(super) const fn length(&self) -> u64 {
        self.length
    }

    /// Adds corners of a mesh; returns the number of their accessor.
    pub(super) fn add_corners(&mut self, corners: &[[f32; 3]]) -> io::Result<usize> {
        let fold = |from: f32, pick: fn(f32, f32) -> f32| {
            let all = corners.iter().copied();
            all.fold([from; 3], |a, b| std::array::from_fn(|axis| pick(a[axis], b[axis])))
        };
        let range = [fold(f32::INFINITY, f32::min), fold(f32::NEG_INFINITY, f32::max)];
        let view = self.add_floats(corners, Some(ARRAY_BUFFER))?;
        self.accessors.push(json!({
            "bufferView": view, "componentType": FLOAT, "count": corners.len(), "type": "VEC3",
            "min": range[0], "max": range[1],
        }));
        Ok(self.accessors.len() - 1)
    }

    /// Adds numbers of corners; returns the number of their accessor.
    pub(super) fn add_triangles(&mut self, triangles: &[[u32; 3]]) -> io::Result<usize> {
        for triangle in triangles {
            self.file.write_all(triangle.map(u32::to_le_bytes).as_flattened())?;
        }
        let view = self.close_view(12 * triangles.len(), Some(ELEMENT_ARRAY_BUFFER));
        self.accessors.push(json!({
            "bufferView": view, "componentType": UNSIGNED_INT, "count": 3 * triangles.len(), "type": "SCALAR",
        }));
        Ok(self.accessors.len() - 1)
    }

    /// Adds an attribute of instances; returns the number of its accessor.
    pub(super) fn add_attribute<const N: usize>(
        &mut self,
        values: &[[f32; N]],
    ) -> io::Result<usize> {
        let view = self.add_floats(values, None)?;
        let kind = format!("VEC{N}");
        self.accessors.push(json!({
            "bufferView": view, "componentType": FLOAT, "count": values.len(), "type": kind,
        }));
        Ok(self.accessors.len() - 1)
    }

    fn add_floats<const N: usize>(
        &mut self,
        values: &[[f32; N]],
        target: Option<u32>,
    ) -> io::Result<usize> {
        for value in values {
            self.file.write_all(value.map(f32::to_le_bytes).as_flattened())?;
        }
        Ok(self.close_view(size_of_val(values), target))
    }

    fn close_view(&mut self, bytes: usize, target: Option<u32>) -> usize {
        let mut view = json!({ "buffer": 0, "byteOffset": self.length, "byteLength": bytes });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        self.length += bytes as u64;
        self.views.push(view);
        self.views.len() - 1
    }

    /// The file, read from its start.
    pub(super) fn into_file(self) -> io::Result<File> {
        let mut file = self.file.into_inner().map_err(io::IntoInnerError::into_error)?;
        file.seek(SeekFrom::Start(0))?;
        Ok(file)
    }
}
