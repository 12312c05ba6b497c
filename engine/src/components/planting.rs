use std::collections::BTreeSet;
use std::ops::Range;

use super::PrototypeId;

/// Mesh prototypes of a planting that are neither hidden nor left out.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ShownMeshes(pub BTreeSet<PrototypeId>);

/// Instances of a planting: scene ids of the first and behind the last.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct InstanceRange(pub Range<u32>);
