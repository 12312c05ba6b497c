//! Spectra and leaf optics.

use std::f64::consts::PI;

use sunfleck_tests::field::Right::{Fails, Quiet, Value, Warns};
use sunfleck_tests::field::{Case, Right, hold};

/// Mean of the rows of ASTM G173 from 655 to 665 nm, as a trapezoid, W m⁻² nm⁻¹.
const STANDARD_655_665: f64 = 1.226_065;

const fn brf(index: usize, value: f64) -> Right {
    Value { sensor: "v", product: "brf", index, value, within: 1e-6 }
}

const fn case<'a>(scene: &'static str, right: &'a [Right]) -> Case<'a> {
    Case { scene, right }
}

#[test]
fn reflectances_in_percent_are_told_from_fractions_over_the_whole_file() {
    hold(&[
        case(
            "21-spectrum-percent/all_below_one.ron",
            &[brf(0, 0.008_133_333), Warns(&["R_percent", "0.9", "unit: Fraction"])],
        ),
        case(
            "21-spectrum-percent/irradiance_neg.ron",
            &[brf(0, 0.0084), brf(1, 0.25625), Warns(&["irradiance_neg.csv:3", "-0.002"])],
        ),
        case(
            "21-spectrum-percent/overshoot_in_band.ron",
            &[brf(0, 1.0), Warns(&["overshoot_in_band.csv:4", "1.003"]), Warns(&["1 is taken"])],
        ),
        case(
            "21-spectrum-percent/thousands.ron",
            &[Fails(&["thousands.csv:4", "3500", "scale: 0.0001"])],
        ),
        case(
            "21-spectrum-percent/water_blue.ron",
            &[Fails(&["water_blue.csv:3", "4.8", "unit: Percent"])],
        ),
        case("21-spectrum-percent/near_leaf_percent.ron", &[brf(0, 0.06), brf(1, 0.46), Quiet]),
        case(
            "21-spectrum-percent/near_leaf_percent_unsaid.ron",
            &[brf(0, 0.06), brf(1, 0.46), Quiet],
        ),
        case(
            "21-spectrum-percent/near_dark_water.ron",
            &[Fails(&["near_dark_water.txt:4", "2.1", "unit: Percent"])],
        ),
        case("21-spectrum-percent/near_scaled.ron", &[brf(0, 0.08), Quiet]),
        case(
            "21-spectrum-percent/near_field_noise.ron",
            &[brf(0, 0.06), brf(1, 0.46), Warns(&["near_field_noise.csv:6", "2.7", "noise"])],
        ),
    ]);
}

#[test]
fn deleted_channels_matter_where_a_band_needs_them() {
    hold(&[
        case("22-spectrum-deleted/outside_bands.ron", &[brf(0, 0.06), brf(1, 0.4), Quiet]),
        case("22-spectrum-deleted/edge.ron", &[Fails(&["edge.csv:3", "-1.23e34", "no-data mark"])]),
        case("22-spectrum-deleted/minus999.ron", &[Fails(&["minus999.csv:5", "no-data mark"])]),
        case("22-spectrum-deleted/nan.ron", &[Fails(&["nan.csv:5", "no-data mark"])]),
        case("22-spectrum-deleted/blank.ron", &[Fails(&["blank.csv:5", "no-data mark"])]),
        case("22-spectrum-deleted/gap.ron", &[brf(0, 0.084), brf(1, 0.265), Quiet]),
        case("22-spectrum-deleted/zero_fill.ron", &[Warns(&["zero_fill.csv:5", "deleted"])]),
        case("22-spectrum-deleted/near_na_outside.ron", &[brf(0, 0.06), brf(1, 0.4), Quiet]),
        case(
            "22-spectrum-deleted/near_mark_beside_band.ron",
            &[Fails(&["near_mark_beside_band.csv:4", "1395 nm", "no-data mark"])],
        ),
    ]);
}

#[test]
fn units_of_wavelengths_and_titles_are_those_of_the_file() {
    hold(&[
        case("23-ecostress-text/as_is.ron", &[brf(0, 0.06), brf(1, 0.46), Quiet]),
        case("23-ecostress-text/named.ron", &[brf(0, 0.06), brf(1, 0.46), Quiet]),
        case(
            "23-ecostress-text/with_header.ron",
            &[Fails(&["with_header.csv", "`X,Y`", "wavelength_unit"])],
        ),
        case("23-ecostress-text/asd.ron", &[brf(0, 0.061), brf(1, 0.46), Quiet]),
        case("23-ecostress-text/asd_semicolon_comma.ron", &[brf(0, 0.061), brf(1, 0.46), Quiet]),
        case("23-ecostress-text/micrometres_only.ron", &[brf(0, 0.06), brf(1, 0.46), Quiet]),
        case("23-ecostress-text/two_splice.ron", &[Fails(&["two_splice.csv:5", "1000"])]),
        case("23-ecostress-text/wavenumber.ron", &[Fails(&["band `b`", "11000"])]),
        case(
            "23-ecostress-text/near_micrometres_percent.ron",
            &[brf(0, 0.06), brf(1, 0.46), Quiet],
        ),
        case(
            "23-ecostress-text/near_title_names_micrometres.ron",
            &[brf(0, 0.06), brf(1, 0.46), Quiet],
        ),
        case(
            "23-ecostress-text/near_mixed_units.ron",
            &[Fails(&["near_mixed_units.csv:2", "0.35"])],
        ),
    ]);
}

#[test]
fn the_sun_has_the_irradiance_of_the_standard_unless_the_scene_says_otherwise() {
    let radiance = |irradiance: f64, within: f64| {
        let value = 0.5 * irradiance / PI;
        Value { sensor: "v", product: "radiance", index: 0, value, within }
    };
    // The table has 1.2, 1.25 and 1.3 around the band.
    hold(&[
        case("23-ecostress-text/near_nrel.ron", &[radiance(1.25, 1e-6), Quiet]),
        case("23-ecostress-text/near_default_sun.ron", &[radiance(STANDARD_655_665, 1e-6), Quiet]),
        case(
            "23-ecostress-text/near_per_micrometre.ron",
            &[Warns(&["near_per_micrometre.csv:2", "1400", "scale: 0.001"])],
        ),
    ]);
}

#[test]
fn leaves_of_other_units_are_told() {
    hold(&[
        case("24-prospect-units/default.ron", &[Quiet]),
        case("24-prospect-units/n1.ron", &[Quiet]),
        case("24-prospect-units/zero.ron", &[Quiet]),
        case("24-prospect-units/n30.ron", &[Warns(&["`n` is 30", "real leaves"])]),
        case(
            "24-prospect-units/wrong_units.ron",
            &[brf(0, 0.034_798), Warns(&["`water_cm` is 10"])],
        ),
        case("24-prospect-units/g_m2.ron", &[Warns(&["`dry_matter_g_cm2` is 90", "10000"])]),
        case("24-prospect-units/percent.ron", &[Warns(&["`chlorophyll_ug_cm2` is 4000"])]),
        case("24-prospect-units/uv.ron", &[Fails(&["380", "400 to 2500 nm"])]),
        case("24-prospect-units/near_mg_m2.ron", &[Warns(&["`chlorophyll_ug_cm2` is 400"])]),
        case("24-prospect-units/near_g_m2_water.ron", &[Warns(&["`carbon_g_cm2` is 80"])]),
    ]);
}

#[test]
fn no_surface_sends_out_more_than_it_receives() {
    hold(&[
        case("25-rho-plus-tau/one.ron", &[brf(0, 0.5), brf(1, 0.5), Quiet]),
        case("25-rho-plus-tau/over.ron", &[Fails(&["sum to 1.1:"])]),
        case("25-rho-plus-tau/back.ron", &[Fails(&["sum to 1.1:"])]),
        case("25-rho-plus-tau/tables.ron", &[Fails(&["sum to 1.1:"])]),
        case("25-rho-plus-tau/hair.ron", &[Fails(&["sum to 1.0000001:"])]),
        case("25-rho-plus-tau/near_percent.ron", &[Fails(&["46 % as 0.46"])]),
        case("25-rho-plus-tau/near_hair_of_points.ron", &[Fails(&["sum to 1.0000000"])]),
    ]);
}
