//! Cameras, pictures and leaf area indices.
