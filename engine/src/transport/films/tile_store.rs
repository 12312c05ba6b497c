//! Tiles of an image in memory, or in a temporary file if they take too much of it.

use std::io::{self, Read, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use super::tile::Tile;
use super::tile_grid::TileGrid;
use crate::scratch::{RandomAccessFile, ScratchSpace};

/// Sums of all tiles of an image. One thread at a time uses a tile.
pub(super) struct TileStore {
    grid: TileGrid,
    columns: usize,
    storage: Storage,
}

enum Storage {
    Memory(Vec<Mutex<Tile>>),
    File(TileFile),
}

/// Tiles in a temporary file, each at a place of its own.
struct TileFile {
    file: RandomAccessFile,
    /// Place of each tile, bytes.
    places: Vec<u64>,
    /// True for each tile that was written; others hold no samples.
    is_written: Vec<AtomicBool>,
}

/// Returns whether tiles whose sums take so many bytes in all are kept in memory.
pub(super) const fn is_in_memory(bytes: u64, scratch: &ScratchSpace) -> bool {
    bytes <= scratch.memory
}

/// Memory of a shared store of so many tiles, bytes; `in_memory` is the size of their sums if these are in memory.
pub(super) const fn bytes(tiles: usize, in_memory: Option<u64>) -> u64 {
    let shared = size_of::<TileStore>() + 2 * size_of::<usize>();
    match in_memory {
        Some(sums) => sums + (shared + tiles * size_of::<Mutex<Tile>>()) as u64,
        None => (shared + tiles * (size_of::<u64>() + size_of::<AtomicBool>())) as u64,
    }
}

impl TileStore {
    /// Store without samples, in memory or in a file.
    pub(super) fn new(
        grid: TileGrid,
        columns: usize,
        is_in_memory: bool,
        scratch: &ScratchSpace,
    ) -> io::Result<Self> {
        let storage = if is_in_memory {
            Storage::Memory(
                grid.iter().map(|(low, high)| Mutex::new(Tile::new(low, high))).collect(),
            )
        } else {
            let places = grid.iter().scan(0, |next, (low, high)| {
                let place = *next;
                *next += Tile::bytes((high - low).element_product().into(), columns as u64);
                Some(place)
            });
            let places: Vec<u64> = places.collect();
            let is_written = places.iter().map(|_| AtomicBool::new(false)).collect();
            let file = RandomAccessFile::new(&scratch.folder)?;
            Storage::File(TileFile { file, places, is_written })
        };
        Ok(Self { grid, columns, storage })
    }

    /// Tiles of the image.
    pub(super) const fn grid(&self) -> TileGrid {
        self.grid
    }

    /// Calls a function with a tile and keeps what it makes of it.
    pub(super) fn update<R>(&self, tile: usize, f: impl FnOnce(&mut Tile) -> R) -> io::Result<R> {
        match &self.storage {
            Storage::Memory(tiles) => {
                let mut tile = tiles[tile].lock().unwrap_or_else(PoisonError::into_inner);
                tile.set_up(self.columns);
                Ok(f(&mut tile))
            }
            Storage::File(file) => {
                let mut held = self.read_from(file, tile)?;
                let result = f(&mut held);
                let mut record = Vec::with_capacity(held.saved_bytes());
                held.save(&mut record)?;
                file.file.write_at(&record, file.places[tile])?;
                file.is_written[tile].store(true, Ordering::Release);
                Ok(result)
            }
        }
    }

    /// Calls a function with a tile.
    pub(super) fn read<R>(&self, tile: usize, f: impl FnOnce(&Tile) -> R) -> io::Result<R> {
        match &self.storage {
            Storage::Memory(tiles) => {
                let mut tile = tiles[tile].lock().unwrap_or_else(PoisonError::into_inner);
                tile.set_up(self.columns);
                Ok(f(&tile))
            }
            Storage::File(file) => Ok(f(&self.read_from(file, tile)?)),
        }
    }

    /// Writes the state of a tile.
    pub(super) fn save(&self, tile: usize, out: &mut dyn Write) -> io::Result<()> {
        self.read(tile, |tile| tile.save(out))?
    }

    /// Replaces the state of a tile.
    pub(super) fn restore(&self, tile: usize, input: &mut dyn Read) -> io::Result<()> {
        self.update(tile, |tile| tile.restore(input))?
    }

    fn read_from(&self, file: &TileFile, tile: usize) -> io::Result<Tile> {
        let (low, high) = self.grid.corners(tile);
        let mut held = Tile::new(low, high);
        held.set_up(self.columns);
        if file.is_written[tile].load(Ordering::Acquire) {
            let mut record = vec![0; held.saved_bytes()];
            file.file.read_at(&mut record, file.places[tile])?;
            held.restore(&mut record.as_slice())?;
        }
        Ok(held)
    }
}
