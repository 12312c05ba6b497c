//! Colours that people who see few colours tell apart.

/// Colours of classes, most frequent first. Source: Okabe and Ito (2008), "Color universal design", without black.
pub(super) const CLASSES: [[u8; 3]; 7] = [
    [0, 158, 115],
    [230, 159, 0],
    [0, 114, 178],
    [204, 121, 167],
    [213, 94, 0],
    [86, 180, 233],
    [240, 228, 66],
];

/// Colour of all classes beyond those.
pub(super) const OTHERS: [u8; 3] = [130, 130, 130];
