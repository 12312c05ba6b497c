//! Every crown that a scene may hold, lawful or not.

use proptest::prelude::*;
use sunfleck::document::{
    Branches, Clumps, CrownShape, GeneratedCrown, LeafAngle, LeafProfile, LeafShape, Prototype,
    Trunk,
};

use crate::writing::{list, number, option, text};

fn shape() -> impl Strategy<Value = CrownShape> {
    (0..6, [number(), number(), number(), number(), number()]).prop_map(
        |(kind, [a, b, c, d, e])| match kind {
            0 => CrownShape::Ellipsoid { diameter_m: a, height_m: b },
            1 => CrownShape::Cone { diameter_m: a, height_m: b },
            2 => CrownShape::Cylinder { diameter_m: a, height_m: b },
            3 => CrownShape::HalfEllipsoid { diameter_m: a, height_m: b },
            4 => CrownShape::AsymmetricGaussian {
                diameter_m: a,
                height_m: b,
                widest_m: c,
                below_m: d,
                above_m: e,
            },
            _ => CrownShape::Box { size_m: (a, b, c) },
        },
    )
}

fn angle() -> impl Strategy<Value = LeafAngle> {
    let plain = prop::sample::select(vec![
        LeafAngle::Spherical,
        LeafAngle::Uniform,
        LeafAngle::Planophile,
        LeafAngle::Erectophile,
        LeafAngle::Plagiophile,
        LeafAngle::Extremophile,
    ]);
    prop_oneof![
        plain,
        (option(number()), option(number()))
            .prop_map(|(x, mean_deg)| LeafAngle::Ellipsoidal { x, mean_deg }),
        (number(), number()).prop_map(|(mu, nu)| LeafAngle::Beta { mu, nu }),
    ]
}

fn leaf() -> impl Strategy<Value = LeafShape> {
    (0..4, number(), number(), any::<u32>(), number(), number()).prop_map(
        |(kind, a, b, needles, needle_width_m, needle_angle_deg)| match kind {
            0 => LeafShape::Disc { radius_m: a },
            1 => LeafShape::Square { side_m: a },
            2 => LeafShape::Rhombus { length_m: a, width_m: b },
            _ => LeafShape::Shoot {
                length_m: a,
                needles,
                needle_length_m: b,
                needle_width_m,
                needle_angle_deg,
            },
        },
    )
}

fn profile() -> impl Strategy<Value = LeafProfile> {
    prop_oneof![
        Just(LeafProfile::Even),
        list((number(), number())).prop_map(LeafProfile::Density),
        list((number(), number())).prop_map(LeafProfile::Area),
    ]
}

pub(crate) fn crown() -> BoxedStrategy<Prototype> {
    let trunk =
        (number(), number(), number()).prop_map(|(height_m, diameter_m, tip_diameter_m)| Trunk {
            height_m,
            diameter_m,
            tip_diameter_m,
        });
    let branches = (any::<u32>(), number(), number())
        .prop_map(|(count, diameter_m, zenith_deg)| Branches { count, diameter_m, zenith_deg });
    let clumps = (any::<u32>(), number(), option(number()), any::<bool>()).prop_map(
        |(count, radius_m, height_m, on_branches)| Clumps {
            count,
            radius_m,
            height_m,
            on_branches,
        },
    );
    let leaves = (
        number(),
        number(),
        profile(),
        option(clumps),
        angle(),
        (leaf(), any::<bool>(), number()),
        text(),
    );
    let wood = (option(trunk), option(branches), option(text()));
    (shape(), leaves, wood, any::<u64>())
        .prop_map(|(shape, leaves, (trunk, branches, wood_material), seed)| {
            let (base_m, leaf_area_m2, leaf_profile, clumps, leaf_angle, leaf, leaf_material) =
                leaves;
            let (leaf, overlap, min_distance_m) = leaf;
            Prototype::Crown(GeneratedCrown {
                shape,
                base_m,
                leaf_area_m2,
                leaf_profile,
                clumps,
                leaf_angle,
                leaf,
                overlap,
                min_distance_m,
                leaf_material,
                trunk,
                branches,
                wood_material,
                seed,
            })
        })
        .boxed()
}
