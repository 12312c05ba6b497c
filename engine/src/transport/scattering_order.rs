/// Parts of what a scene reflects, as RAMI splits it; they sum to the whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScatteringOrder {
    /// Scattered once, by the ground: it has met no canopy on its way in or out.
    Uncollided,
    /// Scattered once, by anything but the ground.
    Single,
    /// Scattered more than once.
    Multiple,
}

impl ScatteringOrder {
    /// All, in the order of their cells.
    pub const ALL: [Self; 3] = [Self::Uncollided, Self::Single, Self::Multiple];

    /// Suffix that RAMI appends to a name.
    #[must_use]
    pub const fn suffix(self) -> &'static str {
        match self {
            Self::Uncollided => "uc",
            Self::Single => "co_sgl",
            Self::Multiple => "mlt",
        }
    }

    /// Part of the light with this number of scattering events, some of them at the ground or none.
    #[must_use]
    pub const fn from_order(order: u32, has_met_ground: bool) -> Self {
        match (order, has_met_ground) {
            (..=1, true) => Self::Uncollided,
            (..=1, false) => Self::Single,
            _ => Self::Multiple,
        }
    }
}

/// Number of spectra of a path: the whole and, on request, its parts.
#[must_use]
pub const fn spectrum_count(separates_orders: bool) -> usize {
    if separates_orders { 1 + ScatteringOrder::ALL.len() } else { 1 }
}
