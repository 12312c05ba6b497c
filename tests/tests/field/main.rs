//! Inputs that people of the field had trouble with in other programs, each with its right value, a
//! clear error or a warning; beside them neighbours of the same kind (`near_*`). The inputs lie in
//! `tests/field`, one folder a case.

mod first_hour;
mod guards;
mod hostile;
mod meshes;
mod polygons;
mod rasters;
mod spectra;
mod stems;
mod tables;
mod transport;
mod views;
mod words;
