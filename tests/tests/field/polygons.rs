//! Areas from `GeoJSON` files.

use sunfleck_tests::field::{Case, Right, folder, hold};

use super::rasters::{refused, stand};

#[test]
fn stems_fill_the_area_of_polygons_however_they_are_written() {
    for (scene, stems) in [
        ("18-geojson-bom/bom.ron", 1600),
        ("20-polygon-oddities/outer_cw.ron", 1200),
        ("20-polygon-oddities/cw_and_hole_same_way.ron", 1200),
        ("20-polygon-oddities/overlap_multi.ron", 2800),
        ("20-polygon-oddities/dup_feature.ron", 1600),
        ("20-polygon-oddities/unclosed.ron", 1600),
        ("20-polygon-oddities/xyz.ron", 1600),
        ("20-polygon-oddities/self_touch.ron", 1600),
        ("18-geojson-bom/near_bom_utm.ron", 1600),
        ("20-polygon-oddities/near_hole_touches.ron", 1400),
        ("20-polygon-oddities/near_repeated.ron", 1600),
    ] {
        let (all, _) = stand(scene).unwrap_or_else(|problem| panic!("{scene}: {problem}"));
        assert_eq!(all.len(), stems, "{scene}");
    }
    refused(&[
        ("18-geojson-bom/utf16.ron", &["UTF-16", "UTF-8"]),
        ("18-geojson-bom/near_utf16be.ron", &["UTF-16", "UTF-8"]),
        ("18-geojson-bom/latin1.ron", &["latin1.geojson"]),
        ("18-geojson-bom/seq.ron", &["line 2"]),
        ("20-polygon-oddities/bowtie.ron", &["crosses itself"]),
        ("20-polygon-oddities/null_z.ron", &["null"]),
        ("20-polygon-oddities/near_hole_crosses_itself.ron", &["crosses itself"]),
    ]);
}

#[test]
fn coordinates_that_are_no_metres_are_refused() {
    const DEGREES: &[&str] = &["is in degrees", "ogr2ogr"];
    refused(&[
        ("19-geojson-datum/d_4326.ron", DEGREES),
        ("19-geojson-datum/d_CRS84.ron", DEGREES),
        ("19-geojson-datum/d_4490.ron", DEGREES),
        ("19-geojson-datum/d_4674.ron", DEGREES),
        ("19-geojson-datum/d_4283.ron", DEGREES),
        ("19-geojson-datum/d_7844.ron", DEGREES),
        ("19-geojson-datum/nocrs.ron", DEGREES),
        ("19-geojson-datum/inside_4490.ron", DEGREES),
        ("19-geojson-datum/small_4490.ron", DEGREES),
        ("19-geojson-datum/out4326.ron", DEGREES),
        ("19-geojson-datum/out4490.ron", DEGREES),
        ("19-geojson-datum/feet.ron", &["US survey foot", "EPSG::2227"]),
        ("19-geojson-datum/near_6318.ron", DEGREES),
        ("19-geojson-datum/near_old_code.ron", DEGREES),
        ("19-geojson-datum/near_3857.ron", &["map of the world"]),
        ("19-geojson-datum/near_2994.ron", &["unit foot"]),
    ]);
}

#[test]
fn an_area_beside_the_terrain_is_told() {
    assert!(folder().join("19-geojson-datum/outfar.ron").is_file());
    hold(&[Case {
        scene: "19-geojson-datum/outfar.ron",
        right: &[Right::Warns(&["beside the terrain", "no effect"])],
    }]);
}
