use std::ops::{BitOr, BitOrAssign};

/// Set of kinds of components and resources that have changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Changes(u32);

impl Changes {
    /// No kind.
    pub const NONE: Self = Self(0);
    /// All kinds.
    pub const ALL: Self = Self(u32::MAX);

    /// These kinds if something has happened; else none.
    #[must_use]
    pub const fn only_if(self, has_happened: bool) -> Self {
        if has_happened { self } else { Self::NONE }
    }

    // Raw components and resources, which `spawn` writes.

    /// Anchor of the local frame on the map.
    pub const FRAME: Self = Self(1);
    /// Boundary of the scene.
    pub const BOUNDARY: Self = Self(1 << 1);
    /// Seed of the random streams.
    pub const SEED: Self = Self(1 << 2);
    /// Spectral bands.
    pub const BANDS: Self = Self(1 << 3);
    /// Named spectra.
    pub const SPECTRA: Self = Self(1 << 4);
    /// Materials.
    pub const MATERIALS: Self = Self(1 << 5);
    /// Names of materials and their order, which ids of materials follow.
    pub const MATERIAL_NAMES: Self = Self(1 << 6);
    /// Kinds of the materials: leaf or not.
    pub const LEAVES: Self = Self(1 << 7);
    /// Mesh prototypes.
    pub const MESHES: Self = Self(1 << 8);
    /// The terrain, and the mesh prototype that it is made of.
    pub const TERRAIN: Self = Self(1 << 9);
    /// Plantings: entries of `instances`.
    pub const PLANTINGS: Self = Self(1 << 10);
    /// Patterns of `hide` and `select`.
    pub const PATTERNS: Self = Self(1 << 11);
    /// The sun.
    pub const SUN: Self = Self(1 << 12);
    /// The sky and what it emits.
    pub const SKY: Self = Self(1 << 13);
    /// Sensors.
    pub const SENSORS: Self = Self(1 << 14);
    /// Existence of a sensor that measures emitted light.
    pub const MEASURES_EMISSION: Self = Self(1 << 15);

    // Derived components and resources, which systems write.

    /// Coordinate reference system of the frame.
    pub const CRS: Self = Self(1 << 16);
    /// Triangulated ground and its georeference.
    pub const GROUND: Self = Self(1 << 17);
    /// Mesh prototypes that each planting shows.
    pub const SHOWN_MESHES: Self = Self(1 << 18);
    /// Loaded meshes, the materials of their parts and their bounds.
    pub const LOADED_MESHES: Self = Self(1 << 19);
    /// Instances.
    pub const INSTANCES: Self = Self(1 << 20);
    /// Leaf area of mesh prototypes.
    pub const LEAF_AREA: Self = Self(1 << 21);
    /// Extents of the scene.
    pub const EXTENTS: Self = Self(1 << 22);
    /// Materials that surfaces have.
    pub const USED_MATERIALS: Self = Self(1 << 23);
    /// Irradiance of sun and sky.
    pub const LIGHT: Self = Self(1 << 24);
    /// Responses of bands, and the irradiance that fractions are weighted with.
    pub const RESPONSES: Self = Self(1 << 25);

    /// Kinds that the ray engine is built from.
    pub const GEOMETRY: Self =
        Self(Self::BOUNDARY.0 | Self::GROUND.0 | Self::LOADED_MESHES.0 | Self::INSTANCES.0);

    /// Union of two sets, in constants.
    #[must_use]
    pub const fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns whether the sets have a kind in common.
    #[must_use]
    pub const fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }
}

impl BitOr for Changes {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        self.or(other)
    }
}

impl BitOrAssign for Changes {
    fn bitor_assign(&mut self, other: Self) {
        *self = self.or(other);
    }
}
