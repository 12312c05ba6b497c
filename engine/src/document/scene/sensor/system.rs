//! Transport systems.

choice! {
    /// A transport system.
    #[derive(Copy, Eq)]
    pub enum System ("a transport system") {
        /// Paths from the sensor.
        Backward,
        /// Photon packets from sun and sky, or from what emits.
        Forward,
        /// Photons of one band each, absorbed, reflected or transmitted as a whole: slow, and free of
        /// all that could be wrong with packets. For `Photons`, without views.
        Analog,
        /// Light of sun and sky that was scattered once, integrated over low-discrepancy points with no
        /// random walk. For images and directions: of `Orders` the parts `_uc` and `_co_sgl`, and, where
        /// `first_order_only` is, `Brf` and `Radiance`.
        FirstOrder,
        /// Paths from the sensor as one plain loop, for comparison: slow. For images and directions: `Brf` and
        /// `Radiance` of what is reflected.
        Reference,
    }
}

impl System {
    /// All transport systems.
    pub const ALL: [Self; 5] =
        [Self::Backward, Self::Forward, Self::Analog, Self::FirstOrder, Self::Reference];

    /// Name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Backward => "backward",
            Self::Forward => "forward",
            Self::Analog => "analog",
            Self::FirstOrder => "first_order",
            Self::Reference => "reference",
        }
    }
}
