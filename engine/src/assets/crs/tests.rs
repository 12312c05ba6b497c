use super::*;

#[test]
fn codes_have_the_units_of_the_registry() {
    let axes = |code| from_code(code).map(|crs| crs.axes);
    let foot = |code| match axes(code) {
        Some(Axes::Length(unit)) => unit.metres,
        other => panic!("{code}: {other:?}"),
    };
    // State planes in US survey feet and in feet, on NAD27, NAD83 and its later adjustments, and Esri's.
    for code in [2227, 2263, 6597, 2229, 26741, 102_642] {
        assert!((foot(code) - 1200.0 / 3937.0).abs() < 1e-12, "{code}");
    }
    for code in [2222, 2256, 2994, 6557, 3361] {
        assert!((foot(code) - 0.3048).abs() < 1e-12, "{code}");
    }
    for code in [4326, 4258, 4269, 4490, 4674, 4283, 7844, 4979, 6318, 7912] {
        assert_eq!(axes(code), Some(Axes::Degrees), "{code}");
    }
    for code in [32632, 25832, 2154, 3035, 27700, 2056, 28992, 3006, 4647, 4499, 7856] {
        assert_eq!(axes(code), Some(Axes::Metres), "{code}");
    }
    for code in [3857, 3785, 900_913, 102_100, 102_113, 3395, 6933, 32662] {
        assert_eq!(axes(code), Some(Axes::World), "{code}");
    }
    assert_eq!(axes(4978), Some(Axes::Geocentric));
    assert_eq!(from_code(99_999_999), None);
    assert_eq!(
        from_code(6360).and_then(|c| c.heights).map(|h| h.unit.name).as_deref(),
        Some("US survey foot")
    );
    assert_eq!(from_code(8228).and_then(|c| c.heights).map(|h| h.unit.metres), Some(0.3048));
    assert_eq!(from_code(5703).and_then(|c| c.heights).map(|h| h.unit.metres), Some(1.0));
    assert_eq!(from_code(5715).and_then(|c| c.heights).map(|h| h.is_depth), Some(true));
}

#[test]
fn names_of_every_way_of_writing_are_the_same_system() {
    let utm = UtmZone { number: 32, is_south: false };
    for name in [
        "EPSG:25832",
        "epsg:25832",
        "25832",
        "urn:ogc:def:crs:EPSG::25832",
        "urn:ogc:def:crs:EPSG:9.9.1:25832",
        "http://www.opengis.net/def/crs/EPSG/0/25832",
        "https://www.opengis.net/gml/srs/epsg.xml#25832",
        "EPSG:25832+7837",
        "EPSG:5555",
        "urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::7837",
    ] {
        let crs = from_name(name).unwrap_or_else(|| panic!("{name}"));
        assert_eq!((crs.utm, crs.datum.as_deref()), (Some(utm), Some("ETRS89")), "{name}");
    }
    for name in [
        "urn:ogc:def:crs:OGC:1.3:CRS84",
        "OGC:CRS83",
        "http://www.opengis.net/def/crs/OGC/1.3/CRS84",
    ] {
        assert_eq!(from_name(name).map(|crs| crs.axes), Some(Axes::Degrees), "{name}");
    }
    assert_eq!(from_name("local"), None);
}

/// Texts as GDAL, Esri and PROJ write them.
#[test]
fn well_known_texts_give_unit_zone_and_datum() {
    let esri = r#"PROJCS["NAD_1983_UTM_Zone_11N",GEOGCS["GCS_North_American_1983",DATUM["D_North_American_1983",SPHEROID["GRS_1980",6378137.0,298.257222101]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],PARAMETER["False_Easting",500000.0],PARAMETER["False_Northing",0.0],PARAMETER["Central_Meridian",-117.0],PARAMETER["Scale_Factor",0.9996],PARAMETER["Latitude_Of_Origin",0.0],UNIT["Meter",1.0]]"#;
    let crs = from_wkt(esri).expect("a system");
    assert_eq!(crs.utm, Some(UtmZone { number: 11, is_south: false }));
    assert_eq!((crs.axes, crs.datum.as_deref()), (Axes::Metres, Some("North American 1983")));
    let same = from_code(26911).expect("a system");
    assert_eq!(compare(&from_wkt(esri).expect("a system"), &same), Agreement::Same);
    let feet = esri.replace("UNIT[\"Meter\",1.0]", "UNIT[\"Foot_US\",0.3048006096012192]");
    let Some(Axes::Length(unit)) = from_wkt(&feet).map(|crs| crs.axes) else { panic!("feet") };
    assert_eq!(unit.name, "US survey foot");
    let two = r#"PROJCRS["WGS 84 / UTM zone 33S",BASEGEOGCRS["WGS 84",ENSEMBLE["World Geodetic System 1984 ensemble",MEMBER["World Geodetic System 1984 (Transit)"],ELLIPSOID["WGS 84",6378137,298.257223563,LENGTHUNIT["metre",1]],ENSEMBLEACCURACY[2.0]],PRIMEM["Greenwich",0,ANGLEUNIT["degree",0.0174532925199433]],ID["EPSG",4326]],CONVERSION["UTM zone 33S",METHOD["Transverse Mercator",ID["EPSG",9807]],PARAMETER["Latitude of natural origin",0,ANGLEUNIT["degree",0.0174532925199433]],PARAMETER["Longitude of natural origin",15,ANGLEUNIT["degree",0.0174532925199433]],PARAMETER["Scale factor at natural origin",0.9996,SCALEUNIT["unity",1]],PARAMETER["False easting",500000,LENGTHUNIT["metre",1]],PARAMETER["False northing",10000000,LENGTHUNIT["metre",1]]],CS[Cartesian,2],AXIS["(E)",east,ORDER[1],LENGTHUNIT["metre",1]],AXIS["(N)",north,ORDER[2],LENGTHUNIT["metre",1]]]"#;
    let crs = from_wkt(two).expect("a system");
    assert_eq!(crs.utm, Some(UtmZone { number: 33, is_south: true }));
    assert_eq!(crs.axes, Axes::Metres);
    assert_eq!(compare(&crs, &from_code(32733).expect("a system")), Agreement::Same);
    let geographic = r#"GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]]"#;
    assert_eq!(from_wkt(geographic).map(|crs| crs.axes), Some(Axes::Degrees));
    let compound = format!(
        r#"COMPD_CS["a",{esri},VERT_CS["NAVD88 height (ftUS)",VERT_DATUM["North American Vertical Datum 1988",2005],UNIT["US survey foot",0.304800609601219],AXIS["Up",UP]]]"#
    );
    let heights = from_wkt(&compound).and_then(|crs| crs.heights).expect("heights");
    assert_eq!(heights.unit.name, "US survey foot");
    assert!(
        from_wkt("PROJCS[\"cut").is_none() && from_wkt("").is_none() && from_wkt("]").is_none()
    );
}

#[test]
fn systems_differ_by_zone_hemisphere_and_datum() {
    let crs = |code| from_code(code).expect("a system");
    assert!(matches!(compare(&crs(32632), &crs(32633)), Agreement::Differ(_)));
    assert!(matches!(compare(&crs(32632), &crs(32732)), Agreement::Differ(_)));
    assert!(matches!(compare(&crs(32632), &crs(2154)), Agreement::Differ(_)));
    assert!(matches!(compare(&crs(32632), &crs(23032)), Agreement::MayDiffer(_)));
    assert!(matches!(compare(&crs(2056), &crs(21781)), Agreement::MayDiffer(_)));
    assert_eq!(compare(&crs(32632), &crs(25832)), Agreement::Same);
    assert_eq!(compare(&crs(25832), &crs(5555)), Agreement::Same);
    assert_eq!(compare(&crs(25833), &crs(3045)), Agreement::Same);
}
