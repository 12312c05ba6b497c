//! Mesh prototypes, from files and generated.

use super::crown::{Branches, Clumps, CrownShape, LeafAngle, LeafProfile, LeafShape, Trunk};
use super::{FilePath, Map, Material, Ref};

choice! {
    /// A mesh prototype.
    pub enum Prototype ("a mesh") {
        /// Wavefront OBJ; `parts_by` says what the parts are.
        Obj(..Obj),
        /// glTF 2.0 or GLB; materials are the parts.
        Gltf(..Gltf),
        /// PLY, ASCII or binary: one part.
        Ply(..Ply),
        /// A cloud of discs: CSV with the header `radius,x,y,z,nx,ny,nz`, or a RAMI `.def` text
        /// with rows `r x y z nx ny nz`; m, z up.
        Discs {
            /// Path, relative to the scene file.
            file: FilePath => r#""assets/crown.csv""#,
            /// Material of the discs.
            material: Ref<Material> => r#""leaf""#,
        },
        /// Polygons written here: sheets, walls, boxes.
        Faces {
            /// Corners of each polygon, m, counter-clockwise seen from its front.
            faces_m: Vec<Vec<(f64, f64, f64)>> => "[[(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0)]]",
            /// Material of them all.
            material: Ref<Material> => r#""leaf""#,
        },
        /// A tree or shrub generated leaf by leaf.
        Crown(..GeneratedCrown),
    }
}

record! {
    /// Mesh from a Wavefront OBJ file.
    pub struct Obj ("a mesh from an OBJ file") {
        /// Path, relative to the scene file.
        file: FilePath => r#""assets/tree.obj""#,
        /// Axis that points up.
        up: Axis => "Z",
        /// Length of the file's unit, m.
        unit_m: f64 => "1.0",
        /// Material of each part. `*` in a name stands for any text: `"leaf*": "leaf"`. An exact name
        /// counts before patterns, of these the one with most other letters, then the first.
        parts: Map<Ref<Material>> = Map::new(),
        /// Statement of the file that names its parts.
        parts_by: PartsBy = PartsBy::Group,
        /// Material of the parts that `parts` does not name.
        material: Option<Ref<Material>> = None,
        /// Point that becomes the origin.
        origin: Origin = Origin::File,
    }
}

record! {
    /// Mesh from a glTF file.
    pub struct Gltf ("a mesh from a glTF file") {
        /// Path, relative to the scene file.
        file: FilePath => r#""assets/tree.glb""#,
        /// Axis that points up (Y, if the file keeps to the standard).
        up: Axis => "Y",
        /// Length of the file's unit, m.
        unit_m: f64 => "1.0",
        /// Material of each part. `*` in a name stands for any text: `"leaf*": "leaf"`. An exact name
        /// counts before patterns, of these the one with most other letters, then the first.
        parts: Map<Ref<Material>> = Map::new(),
        /// Material of the parts that `parts` does not name.
        material: Option<Ref<Material>> = None,
        /// Point that becomes the origin.
        origin: Origin = Origin::File,
    }
}

record! {
    /// Mesh from a PLY file.
    pub struct Ply ("a mesh from a PLY file") {
        /// Path, relative to the scene file.
        file: FilePath => r#""assets/tree.ply""#,
        /// Axis that points up.
        up: Axis => "Z",
        /// Length of the file's unit, m.
        unit_m: f64 => "1.0",
        /// Material of all of it.
        material: Ref<Material> => r#""leaf""#,
        /// Point that becomes the origin.
        origin: Origin = Origin::File,
    }
}

/// Keys that OBJ and glTF files have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshFile<'a> {
    /// Path, relative to the scene file.
    pub file: &'a str,
    /// Axis that points up.
    pub up: &'a Axis,
    /// Length of the file's unit, m.
    pub unit_m: f64,
    /// Material of each part, by its name or a pattern.
    pub parts: &'a Map<Ref<Material>>,
    /// Material of the parts that `parts` does not name.
    pub material: Option<&'a Ref<Material>>,
    /// Point that becomes the origin.
    pub origin: &'a Origin,
}

macro_rules! mesh_file {
    ($mesh:expr) => {
        MeshFile {
            file: &$mesh.file,
            up: &$mesh.up,
            unit_m: $mesh.unit_m,
            parts: &$mesh.parts,
            material: $mesh.material.as_ref(),
            origin: &$mesh.origin,
        }
    };
}

impl Obj {
    /// Keys that it shares with glTF files.
    #[must_use]
    pub fn mesh_file(&self) -> MeshFile<'_> {
        mesh_file!(self)
    }
}

impl Gltf {
    /// Keys that it shares with OBJ files.
    #[must_use]
    pub fn mesh_file(&self) -> MeshFile<'_> {
        mesh_file!(self)
    }
}

impl Prototype {
    /// Keys of a mesh from a file with parts, if it is one.
    #[must_use]
    pub fn mesh_file(&self) -> Option<MeshFile<'_>> {
        match self {
            Self::Obj(obj) => Some(obj.mesh_file()),
            Self::Gltf(gltf) => Some(gltf.mesh_file()),
            Self::Ply(_) | Self::Discs { .. } | Self::Faces { .. } | Self::Crown(_) => None,
        }
    }
}

record! {
    /// Tree or shrub that is generated leaf by leaf.
    pub struct GeneratedCrown ("a generated crown") {
        /// Outline of the crown.
        shape: CrownShape => "Ellipsoid(diameter_m: 3.0, height_m: 5.0)",
        /// Height of the crown's lowest point above the ground, m.
        base_m: f64 => "2.0",
        /// One-sided area of all leaves, m²; 0 for none.
        leaf_area_m2: f64 => "30.0",
        /// Vertical profile of leaf area.
        leaf_profile: LeafProfile = LeafProfile::Even,
        /// Clumps that leaves are gathered in; without them each stands by itself.
        clumps: Option<Clumps> = None,
        /// Distribution of leaf inclinations.
        leaf_angle: LeafAngle = LeafAngle::Spherical,
        /// Shape and size of a leaf.
        leaf: LeafShape => "Disc(radius_m: 0.05)",
        /// False: no leaf intersects another leaf of the crown. Leaves keep
        /// their number and inclinations; those that would overlap stand elsewhere in the crown, or in
        /// their clump. The needles of one shoot may cross each other, and so may leaves of two instances.
        overlap: bool = true,
        /// Minimum distance between the centres of two leaves of the crown, m; of shoots, between the
        /// middles of their twigs. Leaves that are nearer to an earlier one stand elsewhere, as with
        /// `overlap: false`. Leaves of a diameter up to this distance never intersect.
        min_distance_m: f64 = 0.0,
        /// Material of the leaves.
        leaf_material: Ref<Material> => r#""leaf""#,
        /// Trunk, if any.
        trunk: Option<Trunk> = None,
        /// Branches from the trunk into the crown, if any.
        branches: Option<Branches> = None,
        /// Material of trunk and branches.
        wood_material: Option<Ref<Material>> = None,
        /// Another number is another tree of the same kind.
        seed: u64 = 1,
    }
}

choice! {
    /// The axis of a file's model that points to the zenith.
    pub enum Axis ("an axis") {
        /// x points up, y to the east, z to the north.
        X,
        /// y points up; x stays east and -z points north.
        Y,
        /// z points up: the frame of sunfleck.
        Z,
    }
}

choice! {
    /// Statement of an OBJ file that names its parts.
    pub enum PartsBy ("a kind of part") {
        /// Groups (`g`, `o`), and within them materials: `crown`, or `crown/green` and `crown/brown` if
        /// the group has several materials.
        Group,
        /// Materials (`usemtl`), whatever their groups.
        Material,
    }
}

choice! {
    /// Point of a file that becomes the origin of a prototype.
    pub enum Origin ("an origin") {
        /// The file's own origin.
        File,
        /// The middle of the bounding box, at its lowest height.
        BaseCenter,
    }
}
