//! Zarr stores: a folder an array, a file a chunk, JSON beside them.
//!
//! Source: Zarr storage specification, version 2; names of dimensions as xarray has them, systems of maps as GDAL.

mod chunks;
mod metadata;

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests;

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

pub(super) use self::chunks::TILE;
use self::chunks::{Chunking, compressed};
use super::dataset::{ByteOrder, Dataset, Variable};

/// Writes a data set into an empty folder; returns the size of its files in bytes.
pub(super) fn write(dataset: &Dataset<'_>, folder: &Path) -> io::Result<u64> {
    let store = Store { folder, bytes: AtomicU64::new(0) };
    let mut documents = metadata::of_group(dataset);
    for variable in &dataset.variables {
        let chunking = Chunking::new(variable, &dataset.dimensions);
        fs::create_dir(folder.join(&variable.name))?;
        store.put_chunks(variable, &chunking)?;
        documents.extend(metadata::of_array(variable, dataset, &chunking));
    }
    for (name, document) in &documents {
        store.put(name, &metadata::text(document)?)?;
    }
    store.put(".zmetadata", &metadata::text(&metadata::consolidated(documents))?)?;
    Ok(store.bytes.into_inner())
}

/// Folder that is being filled.
struct Store<'a> {
    folder: &'a Path,
    /// Size of its files.
    bytes: AtomicU64,
}

impl Store<'_> {
    fn put(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        let mut file = File::create_new(self.folder.join(name))?;
        file.write_all(bytes)?;
        // Some file systems report a full disk only here.
        file.sync_all()?;
        self.bytes.fetch_add(bytes.len() as u64, Ordering::Relaxed);
        Ok(())
    }

    /// Writes all chunks of a variable: those of a part of its values that lies together are cut side by side.
    fn put_chunks(&self, variable: &Variable<'_>, chunking: &Chunking) -> io::Result<()> {
        for slab in chunking.slabs() {
            let bytes = variable.values.bytes(slab.places(), ByteOrder::Little)?;
            slab.columns().into_par_iter().try_for_each(|column| {
                let name = format!("{}/{}", variable.name, slab.key(column));
                self.put(&name, &compressed(&slab.cut(&bytes, column))?)
            })?;
        }
        Ok(())
    }
}
