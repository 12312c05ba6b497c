use glam::DVec2;

use super::*;
use crate::assets::{read_geojson, read_polygons};
use crate::geometry::Polygon;

fn geojson(text: &str) -> Result<Vec<Polygon>, AssetError> {
    read_geojson(file(text).path()).map(|areas| areas.polygons)
}

fn table(text: &str) -> Result<Vec<Polygon>, AssetError> {
    read_polygons(file(text).path())
}

fn ring(corners: &[(f64, f64)]) -> Vec<DVec2> {
    corners.iter().copied().map(DVec2::from).collect()
}

const SQUARE: &str = "[[0,0],[90,0],[90,90],[0,90],[0,0]]";

#[test]
fn polygons_of_geojson_are_read_wherever_they_stand() {
    let square = ring(&[(0.0, 0.0), (90.0, 0.0), (90.0, 90.0), (0.0, 90.0), (0.0, 0.0)]);
    let hole = "[[1,1,9.5],[2,1,9.5],[2,2,9.5],[1,1,9.5]]";
    let holed = Polygon {
        rings: vec![square.clone(), ring(&[(1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 1.0)])],
    };
    let plain = Polygon { rings: vec![square] };
    let polygon = format!(r#"{{"type":"Polygon","coordinates":[{SQUARE},{hole}]}}"#);
    let many = format!(r#"{{"type":"MultiPolygon","coordinates":[[{SQUARE}],[{SQUARE},{hole}]]}}"#);
    let feature = format!(r#"{{"type":"Feature","properties":{{"a":1}},"geometry":{polygon}}}"#);
    let nothing = r#"{"type":"Feature","properties":null,"geometry":null}"#;
    let collection =
        format!(r#"{{"type":"FeatureCollection","features":[{nothing},{feature},{feature}]}}"#);
    let geometries = format!(r#"{{"type":"GeometryCollection","geometries":[{many},{polygon}]}}"#);
    assert_eq!(geojson(&polygon).unwrap(), std::slice::from_ref(&holed));
    assert_eq!(geojson(&many).unwrap(), [plain.clone(), holed.clone()]);
    assert_eq!(geojson(&feature).unwrap(), std::slice::from_ref(&holed));
    assert_eq!(geojson(&collection).unwrap(), [holed.clone(), holed.clone()]);
    assert_eq!(geojson(&geometries).unwrap(), [plain, holed.clone(), holed]);
}

#[test]
fn geojson_that_is_no_area_in_metres_is_refused() {
    let small = "[[[7.1,51.2],[7.11,51.2],[7.11,51.21],[7.1,51.2]]]";
    let wide = "[[[7.1,51.2],[17.0,51.2],[7.11,61.21],[7.1,51.2]]]";
    let crs = |name: &str, coordinates: &str| {
        format!(
            r#"{{"type":"Polygon","crs":{{"type":"name","properties":{{"name":"{name}"}}}},"coordinates":{coordinates}}}"#
        )
    };
    let of = |kind: &str, coordinates: &str| {
        format!(r#"{{"type":"{kind}","coordinates":{coordinates}}}"#)
    };
    let degrees = ": is in degrees (from 7.10000, 51.20000), but a scene is in metres; convert it to \
                   a projected system: `ogr2ogr -t_srs EPSG:326";
    for (text, expected) in [
        (of("Polygon", small), degrees),
        (crs("urn:ogc:def:crs:OGC:1.3:CRS84", wide), degrees),
        (of("LineString", "[[0,0],[90,0]]"), ": holds a LineString, which has no area; keep its"),
        (of("Polygon", "[]"), ": holds no polygon"),
        (of("Polygon", "[[]]"), ": ring 1 of the file has 0 different corners; three or more"),
        (of("Polygon", "[[[0,0],[90,0],[0,0]]]"), ": ring 1 of the file has 2 different corners"),
        (of("Polygon", "[[[0],[90,0],[0,0]]]"), ": is no GeoJSON: "),
        (of("Polygon", "[[[0,\"a\"],[90,0],[0,0]]]"), ": is no GeoJSON: "),
        ("{\"type\":\"Polygon\",\"coordinates\":[[[0,0".to_owned(), ": is no GeoJSON: "),
        ("[".repeat(1_000_000), ": is no GeoJSON: "),
        (r#"{"type":"GeometryCollection","geometries":["#.repeat(100_000), ": is no GeoJSON: "),
        (String::new(), ": is no GeoJSON: "),
    ] {
        let message = geojson(&text).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}\nlacks {expected}");
    }
    // Local metres, and metres that say so.
    assert!(geojson(&of("Polygon", wide)).is_ok());
    assert!(geojson(&crs("urn:ogc:def:crs:EPSG::32633", small)).is_ok());
}

#[test]
fn polygons_of_a_table_are_rings_and_holes() {
    let outline = ring(&[(0.0, 0.0), (9.0, 0.0), (9.0, 9.0)]);
    let hole = ring(&[(5.0, 1.0), (6.0, 1.0), (6.0, 2.0)]);
    assert_eq!(table("0 0\n9 0\n9 9\n").unwrap(), [Polygon { rings: vec![outline.clone()] }]);
    let text = "ring,x_m,y_m,hole\n1,0,0,0\n1,9,0,0\n1,9,9,0\n1,5,1,1\n1,6,1,1\n1,6,2,1\n\
                2,0,0,0\n2,9,0,0\n2,9,9,0\n";
    let expected =
        [Polygon { rings: vec![outline.clone(), hole] }, Polygon { rings: vec![outline] }];
    assert_eq!(table(text).unwrap(), expected);
    for (text, expected) in [
        ("x_m,y_m,hole\n1,1,1\n", ":2: this hole has no outline before it"),
        ("x_m,ring\n1,1\n", ":1: column \"y_m\" is missing"),
        ("x_m,y_m,rnig\n1,1,1\n", ":1: there is no column \"rnig\"; write \"ring\""),
        ("1 1\n2 2\n", ": ring 1 of the file has 2 different corners"),
        ("1 1\n2 inf\n", ":2: column \"y_m\" is \"inf\""),
        ("x_m,y_m\n", ": holds no polygon"),
    ] {
        let message = table(text).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}\nlacks {expected}");
    }
}
