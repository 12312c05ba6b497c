//! Elevation, canopy height, density and land-cover rasters.

use std::fs;

use sunfleck::components::{Instance, Placement};
use sunfleck::document::{ReadOptions, read_text};
use sunfleck::run::SceneWorld;
use sunfleck_tests::field::{Case, Right, folder, hold};

/// Where instances stand, and what the author is told; or why the scene is refused.
pub(super) type Stood = Result<(Vec<Placement>, String), String>;

pub(super) fn stand(scene: &str) -> Stood {
    let path = folder().join(scene);
    let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let reading =
        read_text(scene, &text, &ReadOptions::default()).map_err(|error| error.to_string())?;
    if !reading.diagnostics.is_empty() {
        return Err(reading.render());
    }
    let parent = path.parent().ok_or("a scene lies in a folder")?;
    let built = SceneWorld::from_scene(&reading.scene, parent)
        .map_err(|found| reading.source.render(&found))?;
    let all = Instance::in_order(&built.world).into_iter().map(|one| one.placement).collect();
    Ok((all, reading.source.render(&built.diagnostics())))
}

/// Scenes in which instances stand on the ground at heights that are known, m; with what is told, if
/// anything should be.
fn stands_at(cases: &[(&str, &[f64], &str)]) {
    let mut faults: Vec<String> = Vec::new();
    for (scene, heights, told) in cases {
        match stand(scene) {
            Err(problem) => faults.push(format!("{scene} is refused: {problem}")),
            Ok((all, warnings)) => {
                let found: Vec<f64> = all.iter().map(|placement| placement.position.z).collect();
                // The ground is kept in f32 over its range.
                let is_near = |(a, b): (&f64, &f64)| (a - b).abs() < 2e-4 * b.abs().max(1.0);
                if found.len() != heights.len() || !found.iter().zip(*heights).all(is_near) {
                    faults.push(format!("{scene}: {found:?}, not {heights:?}"));
                }
                if !warnings.contains(told) {
                    faults.push(format!("{scene} does not say {told:?}: {warnings}"));
                }
                let is_quiet = told.is_empty();
                if is_quiet
                    && warnings.matches("warning:").count() != warnings.matches("float").count()
                {
                    faults.push(format!("{scene} warns: {warnings}"));
                }
            }
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

/// Scenes that are refused, with parts of the message.
pub(super) fn refused(cases: &[(&str, &[&str])]) {
    let mut faults: Vec<String> = Vec::new();
    for (scene, parts) in cases {
        match stand(scene) {
            Ok((all, _)) => faults.push(format!("{scene} is accepted: {} instances", all.len())),
            Err(problem) => {
                for part in parts.iter().filter(|part| !problem.contains(**part)) {
                    faults.push(format!("{scene} does not say {part:?}: {problem}"));
                }
            }
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn coordinates_in_feet_are_refused_whatever_says_so() {
    refused(&[
        ("09-geotiff-feet/gdal.ron", &["its coordinates are in feet", "US survey foot"]),
        ("09-geotiff-feet/code_only.ron", &["its coordinates are in feet", "EPSG:6597"]),
        ("09-geotiff-feet/code_2263.ron", &["its coordinates are in feet", "EPSG:2263"]),
        ("09-geotiff-feet/near_compound.ron", &["its coordinates are in feet", "EPSG:2227"]),
        ("09-geotiff-feet/near_oregon.ron", &["its coordinates are in feet", "EPSG:2994"]),
        ("09-geotiff-feet/near_yard.ron", &["another unit than metres", "British yard"]),
        ("09-geotiff-feet/near_prj.ron", &["its coordinates are in feet", "US survey foot"]),
        ("09-geotiff-feet/near_chm.ron", &["its coordinates are in feet", "EPSG:2263"]),
        ("51-land-cover-palette/near_feet.ron", &["its coordinates are in feet"]),
    ]);
}

#[test]
fn heights_in_feet_become_metres_and_that_is_told() {
    let foot = 1200.0 / 3937.0;
    let heights = [301.0 * foot, 301.5 * foot];
    let told = "its heights are in the unit US survey foot";
    stands_at(&[
        ("10-geotiff-vertical-feet/vert.ron", &heights, told),
        ("10-geotiff-vertical-feet/compound.ron", &heights, told),
        ("10-geotiff-vertical-feet/unittype.ron", &heights, told),
        ("10-geotiff-vertical-feet/near_8228.ron", &[301.0 * 0.3048], "in the unit foot"),
        ("10-geotiff-vertical-feet/near_cm.ron", &[301.0], "in the unit centimetre"),
        ("10-geotiff-vertical-feet/near_metres_after_all.ron", &[301.0], ""),
    ]);
    refused(&[("10-geotiff-vertical-feet/near_depth.ron", &["depths", "count downwards"])]);
    // Of a canopy as well: its tree of 32.8 ft is 10 m high.
    let (trees, warnings) = stand("17-chm-plateau/near_feet.ron").expect("a stand");
    assert!(warnings.contains("in the unit foot"), "{warnings}");
    let (scaled, _) = stand("17-chm-plateau/near_scaled.ron").expect("a stand");
    // The mesh is some 10 m high, and both files hold the same tree.
    let scale = |trees: &[Placement]| f64::from(trees[0].scale.vertical);
    assert_eq!((trees.len(), scaled.len()), (1, 1));
    assert!((scale(&trees) - 1.0).abs() < 0.1, "{}", scale(&trees));
    assert!((scale(&trees) - scale(&scaled)).abs() < 1e-3, "{}", scale(&scaled));
}

#[test]
fn scale_and_offset_are_applied() {
    stands_at(&[
        ("11-geotiff-scale-offset/dm.ron", &[301.0, 301.5], ""),
        ("11-geotiff-scale-offset/scaled.ron", &[301.0, 301.5], ""),
        ("11-geotiff-scale-offset/gain.ron", &[301.0, 301.5], ""),
        ("11-geotiff-scale-offset/near_nodata.ron", &[301.0], ""),
        ("11-geotiff-scale-offset/near_big.ron", &[301.0], ""),
    ]);
}

#[test]
fn values_that_stand_for_no_data_are_no_heights() {
    let missing = "9 of its 400 cells have no data";
    let unnamed = "9 of its 400 cells hold -9999";
    refused(&[
        ("12-ascii-nodata-default/with.ron", &[missing]),
        ("12-ascii-nodata-default/without.ron", &[missing]),
        ("12-ascii-nodata-default/mismatch.ron", &[missing, unnamed]),
        ("12-ascii-nodata-default/f32.ron", &[missing, unnamed]),
        ("12-ascii-nodata-default/int16.ron", &[missing, "hold -32768"]),
        ("16-geotiff-variants/mask.ron", &["192 of its 4096 cells have no data"]),
        ("16-geotiff-variants/near_external.ron", &[missing]),
        ("16-geotiff-variants/near_tiled_mask.ron", &["36 of its 1600 cells have no data"]),
    ]);
    stands_at(&[
        ("12-ascii-nodata-default/with_neigh.ron", &[301.0, 300.65], ""),
        ("12-ascii-nodata-default/near_int16.ron", &[301.0], "hold -32768"),
        ("16-geotiff-variants/near_alpha.ron", &[301.0], ""),
        ("16-geotiff-variants/nan_nodata.ron", &[301.0, 300.248], ""),
        ("16-geotiff-variants/fltmin.ron", &[301.0, 300.248], ""),
        ("52-nodata-infinite/neginf.ron", &[301.0], ""),
        ("52-nodata-infinite/near_inf.ron", &[301.0], ""),
        ("52-nodata-infinite/near_ascii.ron", &[301.0], ""),
    ]);
    // Holes that are heights of 0 can be known by their steps alone.
    let (_, warnings) = stand("12-ascii-nodata-default/zero.ron").expect("a stand");
    assert!(warnings.contains("rises or falls by 300.9 m"), "{warnings}");
    // 800 stems per hectare of the eastern half, which is 0.02 ha; four standard deviations of their
    // number, which is drawn cell by cell, are 15. In the western half there are no data.
    let (stems, _) = stand("12-ascii-nodata-default/near_density.ron").expect("a stand");
    assert!(stems.iter().all(|stem| stem.position.x >= 10.0), "no stem where no data are");
    assert!((1..=31).contains(&stems.len()), "{}", stems.len());
}

#[test]
fn numbers_of_ascii_grids_are_read_or_refused_by_line() {
    stands_at(&[
        ("13-ascii-nan-null/first_nan.ron", &[301.0], ""),
        ("13-ascii-nan-null/nan_nodata.ron", &[301.0], ""),
        ("13-ascii-nan-null/qnan.ron", &[301.0], ""),
        ("13-ascii-nan-null/sci.ron", &[301.0], ""),
        ("13-ascii-nan-null/near_plus.ron", &[301.0], ""),
        ("13-ascii-nan-null/near_tabs.ron", &[301.0], ""),
    ]);
    refused(&[
        ("13-ascii-nan-null/null.ron", &["line 6", "null"]),
        ("13-ascii-nan-null/comma.ron", &["line 1", "2,0000000E+01"]),
        ("13-ascii-nan-null/comma2.ron", &["line 6", "300,05", "decimal point"]),
        ("13-ascii-nan-null/dexp.ron", &["line 6", "3.0005D+02"]),
        ("13-ascii-nan-null/grass.ron", &["GRASS ASCII grid", "gdal_translate"]),
        ("13-ascii-nan-null/near_not_available.ron", &["line 6", "N/A"]),
    ]);
}

#[test]
fn values_and_headers_belong_together_by_their_whole_name() {
    stands_at(&[
        ("14-envi-dotted-names/by_values.ron", &[301.0], ""),
        ("14-envi-dotted-names/alone/alone_by_header.ron", &[301.0], ""),
        ("14-envi-dotted-names/alone/upper_hdr.ron", &[301.0], ""),
        ("14-envi-dotted-names/alone/bom_hdr.ron", &[301.0], ""),
        ("14-envi-dotted-names/alone/upper_img_by_header.ron", &[301.0], ""),
        ("14-envi-dotted-names/alone/img_hdr_by_header.ron", &[301.0], ""),
        ("14-envi-dotted-names/alone/noext.ron", &[301.0], ""),
        // Beside `plot.v2` and `plot`, whose heights are 1000 m and 2000 m more.
        ("14-envi-dotted-names/near/near_header.ron", &[301.0], ""),
        ("14-envi-dotted-names/near/near_values.ron", &[301.0], ""),
    ]);
}

#[test]
fn binary_rasters_of_esri_are_read_and_strange_ones_named() {
    stands_at(&[
        ("15-bil-esri-header/bil.ron", &[301.0], ""),
        ("15-bil-esri-header/flt.ron", &[301.0], ""),
        ("15-bil-esri-header/near/near_srtm.ron", &[309.5], ""),
        ("15-bil-esri-header/near/near_grid.ron", &[301.0], ""),
    ]);
    refused(&[
        ("15-bil-esri-header/hdr.ron", &["dem.bil, dem.flt", "name the one that is meant"]),
        ("15-bil-esri-header/nohdr.ron", &["binary values", "no header beside it"]),
        ("15-bil-esri-header/near/near_erdas.ron", &["ERDAS Imagine", "gdal_translate"]),
    ]);
}

#[test]
fn geotiffs_of_every_kind_are_read_or_refused() {
    let both: &[f64] = &[301.0, 302.05];
    stands_at(&[
        ("16-geotiff-variants/cog.ron", both, ""),
        ("16-geotiff-variants/f64.ron", both, ""),
        ("16-geotiff-variants/point.ron", both, ""),
        ("16-geotiff-variants/sparse_ok.ron", both, ""),
        ("16-geotiff-variants/tiled_lzw_pred3.ron", both, ""),
        ("16-geotiff-variants/alpha.ron", &[10.5, 12.0], ""),
        ("16-geotiff-variants/minisblack_u8.ron", &[11.0, 12.0], ""),
        ("16-geotiff-variants/palette.ron", &[11.0, 12.0], ""),
        ("16-geotiff-variants/tfw.ron", &[301.0], ""),
        ("16-geotiff-variants/near_window.ron", &[335.05], ""),
        ("16-geotiff-variants/miniswhite_u8.ron", &[11.0, 12.0], ""),
        ("16-geotiff-variants/miniswhite_u16.ron", both, ""),
        ("16-geotiff-variants/miniswhite_i16.ron", both, ""),
        ("16-geotiff-variants/miniswhite_f32.ron", both, ""),
        ("50-geotiff-miniswhite/u8.ron", &[11.0, 12.0], ""),
        ("50-geotiff-miniswhite/u8_black.ron", &[11.0, 12.0], ""),
        ("50-geotiff-miniswhite/f32.ron", both, ""),
        ("50-geotiff-miniswhite/near_i16.ron", &[301.0], ""),
        ("50-geotiff-miniswhite/near_big_endian.ron", &[301.0], ""),
    ]);
    refused(&[
        ("16-geotiff-variants/mercator.ron", &["Web Mercator", "1.64 times as long", "gdalwarp"]),
        ("16-geotiff-variants/near_world.ron", &["map of the world", "EPSG:3395"]),
        ("17-chm-plateau/mercator.ron", &["Web Mercator"]),
        ("16-geotiff-variants/rotated.ron", &["rotated"]),
        ("16-geotiff-variants/south_up.ron", &["south to north"]),
        ("16-geotiff-variants/gcp.ron", &["how large its cells are"]),
        ("16-geotiff-variants/two_bands.ron", &["2 values a pixel"]),
        ("16-geotiff-variants/lerc.ron", &["COMPRESS=DEFLATE"]),
        ("16-geotiff-variants/zstd_pred2_i16.ron", &["COMPRESS=DEFLATE"]),
        ("16-geotiff-variants/lzma.ron", &["COMPRESS=DEFLATE"]),
    ]);
}

#[test]
fn trees_of_canopies_are_counted_as_they_stand() {
    for (scene, trees) in [
        ("17-chm-plateau/smooth.ron", 3),
        ("17-chm-plateau/resampled2.ron", 3),
        ("17-chm-plateau/integers.ron", 3),
        ("17-chm-plateau/flat_top.ron", 3),
        ("17-chm-plateau/blocks.ron", 2),
        ("46-chm-on-plane/same.ron", 3),
        ("46-chm-on-plane/plane100.ron", 3),
        ("46-chm-on-plane/utm.ron", 3),
        ("46-chm-on-plane/dem.ron", 3),
        ("46-chm-on-plane/near_middle.ron", 3),
        ("42-dsm-for-chm/near_unit.ron", 3),
        ("42-dsm-for-chm/near_unit_dm.ron", 3),
        ("49-crs-mismatch/same.ron", 3),
        ("49-crs-mismatch/etrs.ron", 3),
    ] {
        let (all, _) = stand(scene).unwrap_or_else(|problem| panic!("{scene}: {problem}"));
        assert_eq!(all.len(), trees, "{scene}");
    }
    let (trees, warnings) = stand("46-chm-on-plane/near_part.ron").expect("a stand");
    assert_eq!(trees.len(), 1);
    assert!(warnings.contains("2 of 3 trees have no terrain below"), "{warnings}");
    refused(&[
        ("42-dsm-for-chm/dsm.ron", &["300.012 m", "subtract the terrain"]),
        ("42-dsm-for-chm/dsm_150.ron", &["a tree of 150 m", "subtract the terrain"]),
        ("42-dsm-for-chm/dsm_cm.ron", &["656.25 m", "height_unit_m: 0.01"]),
        ("42-dsm-for-chm/dsm_dm.ron", &["a tree of 118.125 m", "subtract the terrain"]),
        ("46-chm-on-plane/utm_far.ron", &["it reaches from (100000, 0)"]),
    ]);
}

#[test]
fn systems_that_differ_are_refused_or_told() {
    refused(&[
        ("49-crs-mismatch/zone33.ron", &["EPSG:32633", "EPSG:32632", "zone 33 north"]),
        ("49-crs-mismatch/south.ron", &["EPSG:32732", "zone 32 south"]),
        ("49-crs-mismatch/poly33.ron", &["EPSG:32633", "ogr2ogr"]),
        ("49-crs-mismatch/near_prj.ron", &["WGS_1984_UTM_Zone_33N", "EPSG:32632"]),
        ("49-crs-mismatch/near_density33.ron", &["EPSG:32733", "EPSG:32632"]),
        ("49-crs-mismatch/near_frame.ron", &["EPSG:32632", "`frame.crs` in EPSG:32633"]),
        ("49-crs-mismatch/near_degrees.ron", &["EPSG:4326 is in degrees"]),
    ]);
    let (trees, warnings) = stand("49-crs-mismatch/near_ed50.ron").expect("a stand");
    assert_eq!(trees.len(), 1);
    assert!(warnings.contains("ED50 and WGS 84"), "{warnings}");
}

/// *Scene*: half the ground of 0.4 and half of 0.2, on a slope of 0.1, by land cover with and without a colour table.
/// *Expected*: BRF `0.3 cos i` from above with the sun at the zenith.
#[test]
fn land_cover_with_a_colour_table_gives_the_classes() {
    let mean = 0.3 / 1.01_f64.sqrt();
    let right =
        [Right::value("i", "brf", 0, mean), Right::value("i", "brf", 1, mean), Right::Quiet];
    hold(&[
        Case { scene: "51-land-cover-palette/plain.ron", right: &right },
        Case { scene: "51-land-cover-palette/palette.ron", right: &right },
        Case { scene: "51-land-cover-palette/white.ron", right: &right },
        Case { scene: "51-land-cover-palette/near_tiled.ron", right: &right },
    ]);
}

#[test]
fn relief_that_cannot_be_meant_is_told() {
    const SEAM: Right = Right::Warns(&["opposite sides differ", "6.0 m"]);
    let (_, warnings) = stand("12-ascii-nodata-default/near_centimetres.ron").expect("a stand");
    assert!(warnings.contains("steeper than 75 degrees"), "{warnings}");
    hold(&[
        Case { scene: "32-dem-periodic/periodic.ron", right: &[SEAM] },
        Case { scene: "32-dem-periodic/mesh_slope.ron", right: &[SEAM] },
        Case { scene: "32-dem-periodic/isolated.ron", right: &[] },
        Case {
            scene: "32-dem-periodic/near_high.ron",
            right: &[Right::Warns(&["opposite sides differ", "44.0 m"])],
        },
    ]);
}
