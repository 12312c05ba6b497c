//! Tables of stems, coordinates, the sun by place and time, paths.
