//! Areas from `GeoJSON` files.
