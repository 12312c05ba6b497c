use std::collections::BTreeSet;
use std::ops::Range;

use super::PrototypeId;
use crate::geometry::Polygon;

/// Mesh prototypes of a planting that are neither hidden nor left out.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ShownMeshes(pub BTreeSet<PrototypeId>);

/// Instances of a planting: scene ids of the first and behind the last.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct InstanceRange(pub Range<u32>);

/// Polygons that the stems of a planting stand in, or keep out of, m, local frame. Plantings without polygons have none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlantingAreas {
    /// Stems stand only in these; everywhere if empty.
    pub inside: Vec<Polygon>,
    /// No stem stands in these.
    pub outside: Vec<Polygon>,
}
