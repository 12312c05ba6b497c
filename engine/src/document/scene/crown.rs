//! Trees and shrubs that are generated leaf by leaf.

choice! {
    /// Outline of a generated crown.
    pub enum CrownShape ("a crown shape") {
        /// Ellipsoid of revolution.
        Ellipsoid {
            /// Largest width, m.
            diameter_m: f64 => "3.0",
            /// Height from its lowest to its highest point, m.
            height_m: f64 => "5.0",
        },
        /// Upright cone.
        Cone {
            /// Width at its base, m.
            diameter_m: f64 => "3.0",
            /// Height from base to tip, m.
            height_m: f64 => "5.0",
        },
        /// Upright cylinder.
        Cylinder {
            /// Width, m.
            diameter_m: f64 => "3.0",
            /// Height from base to top, m.
            height_m: f64 => "5.0",
        },
        /// Upper half of an ellipsoid of revolution: a dome on a flat base.
        HalfEllipsoid {
            /// Width at its base, m.
            diameter_m: f64 => "3.0",
            /// Height from base to top, m.
            height_m: f64 => "5.0",
        },
        /// Solid of revolution of radius `(diameter / 2) exp(-((z - widest) / s)² / 2)` at z above its
        /// base, `s` being `below_m` under its widest place and `above_m` over it.
        AsymmetricGaussian {
            /// Largest width, m.
            diameter_m: f64 => "3.0",
            /// Height from base to top, which are flat, m.
            height_m: f64 => "5.0",
            /// Height of the widest place above the base, m.
            widest_m: f64 => "1.5",
            /// `s` below the widest place, m.
            below_m: f64 => "1.0",
            /// `s` above the widest place, m.
            above_m: f64 => "2.0",
        },
        /// Box, for homogeneous layers.
        Box {
            /// Extent to the east, to the north and up, m.
            size_m: (f64, f64, f64) => "(10.0, 10.0, 2.0)",
        },
    }
}

choice! {
    /// Distribution of the angle θ between leaf normal and zenith; azimuths are uniform.
    ///
    /// Source: de Wit (1965), Photosynthesis of leaf canopies, Agricultural Research Reports 663,
    /// Wageningen, for the types; Bunnik (1978) for their trigonometric form.
    pub enum LeafAngle ("a leaf angle distribution") {
        /// g(θ) = sin θ.
        Spherical,
        /// g(θ) = 2/π.
        Uniform,
        /// g(θ) = (2/π)(1 + cos 2θ): mostly horizontal leaves.
        Planophile,
        /// g(θ) = (2/π)(1 - cos 2θ): mostly vertical leaves.
        Erectophile,
        /// g(θ) = (2/π)(1 - cos 4θ): mostly leaves at 45°.
        Plagiophile,
        /// g(θ) = (2/π)(1 + cos 4θ): mostly horizontal or vertical leaves.
        Extremophile,
        /// Normals of an ellipsoid of revolution with a vertical axis; one of the two keys is written.
        /// Source: Campbell (1990), Agric. For. Meteorol. 49, 173–176.
        Ellipsoidal {
            /// Its horizontal over its vertical semi-axis: 1 is spherical, more is flatter.
            x: Option<f64> => "1.0" = None,
            /// Mean of θ, degrees.
            mean_deg: Option<f64> = None,
        },
        /// g(θ) = (2/π)(1 - t)^(μ-1) t^(ν-1) / B(μ, ν) with t = 2θ/π; its mean is 90° ν/(μ + ν).
        /// Source: Goel & Strebel (1984), Agron. J. 76, 800–802.
        Beta {
            /// Exponent μ, dimensionless.
            mu: f64 => "2.77",
            /// Exponent ν, dimensionless.
            nu: f64 => "1.172",
        },
    }
}

choice! {
    /// Shape of a generated leaf.
    pub enum LeafShape ("a leaf shape") {
        /// Flat disc.
        Disc {
            /// Radius, m.
            radius_m: f64 => "0.05",
        },
        /// Flat square.
        Square {
            /// Side, m.
            side_m: f64 => "0.05",
        },
        /// Flat rhombus.
        Rhombus {
            /// Long diagonal, m.
            length_m: f64 => "0.08",
            /// Short diagonal, m.
            width_m: f64 => "0.04",
        },
        /// Needles in a spiral around a twig. The twig lies in the plane whose normal follows the leaf
        /// angle distribution, and has no wood itself.
        Shoot {
            /// Length of the twig, m.
            length_m: f64 => "0.12",
            /// Number of needles.
            needles: u32 => "60",
            /// Length of a needle, m; it is a flat rectangle.
            needle_length_m: f64 => "0.05",
            /// Width of a needle, m.
            needle_width_m: f64 => "0.002",
            /// Angle between needle and twig, degrees.
            needle_angle_deg: f64 = 50.0,
        },
    }
}

choice! {
    /// Vertical profile of leaf area. Only ratios count: `leaf_area_m2` is the total.
    pub enum LeafProfile ("a leaf profile") {
        /// Constant leaf area density in the crown.
        Even,
        /// Leaf area density, m² m⁻³, by height above the ground, m: linear between, 0 beyond.
        Density(Vec<(f64, f64)> => "[(2.0, 0.3), (5.0, 1.0), (7.0, 0.5)]"),
        /// Leaf area in each metre of height, m² m⁻¹, by height above the ground, m: linear between,
        /// 0 beyond.
        Area(Vec<(f64, f64)> => "[(2.0, 1.0), (5.0, 8.0), (7.0, 2.0)]"),
    }
}

record! {
    /// Leaves gathered in clumps: ellipsoids that hold the same number of leaves each. What would
    /// stand out of the crown is put elsewhere in its clump.
    pub struct Clumps ("the clumps") {
        /// Number of them.
        count: u32 => "80",
        /// Half of their width, m.
        radius_m: f64 => "0.4",
        /// Height from their lowest to their highest point, m; their width if absent.
        height_m: Option<f64> = None,
        /// True if their middles are on branches; otherwise they are anywhere in the crown.
        on_branches: bool = false,
    }
}

record! {
    /// Trunk of a generated tree: a tapered, closed prism.
    pub struct Trunk ("the trunk") {
        /// Height of its tip, m.
        height_m: f64 => "5.0",
        /// Diameter at the ground, m.
        diameter_m: f64 => "0.2",
        /// Diameter at the tip, m.
        tip_diameter_m: f64 = 0.01,
    }
}

record! {
    /// Branches of a generated tree, spread along the trunk within the crown.
    pub struct Branches ("the branches") {
        /// Number of them.
        count: u32 => "12",
        /// Diameter at the trunk, m.
        diameter_m: f64 => "0.2",
        /// Angle from the zenith, degrees.
        zenith_deg: f64 = 60.0,
    }
}
