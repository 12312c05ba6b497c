//! Meshes: OBJ, glTF and polygons as people have them.
