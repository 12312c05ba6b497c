use super::{CoordinateSystem, MapFrame};
use crate::assets::crs::{Agreement, TargetSystem, compare};
use crate::assets::{AssetError, Crs};
use crate::components::Projection;
use crate::document::{Diagnostic, ScenePath, Step};
use crate::systems::Resources;

/// Compares the coordinate reference system of a file with that of the scene; the first that is known becomes that
/// of the scene. Returns `None` after an error.
pub(in crate::systems) fn check_crs(
    crs: &Crs,
    file: &str,
    path: &ScenePath,
    map: &mut MapFrame,
    resources: &mut Resources,
) -> Option<()> {
    if crs.name.is_empty() {
        return Some(());
    }
    let Some(CoordinateSystem { crs: reference, owner }) = &map.crs else {
        map.crs = Some(CoordinateSystem { crs: crs.clone(), owner: format!("`{file}`") });
        return Some(());
    };
    let names = format!("it is in {}, but {owner} in {}", crs.name, reference.name);
    let target = reference.code.map_or_else(|| "EPSG:..".to_owned(), |code| format!("EPSG:{code}"));
    let is_area = ["inside", "outside"].iter().any(|key| path.steps().contains(&Step::from(*key)));
    let (tool, correct) = if is_area {
        (
            format!("`ogr2ogr -t_srs {target} out.geojson in.geojson`"),
            format!("`ogr2ogr -a_srs {target} out.geojson in.geojson`"),
        )
    } else {
        (
            format!("`gdalwarp -t_srs {target} in.tif out.tif`"),
            format!("`gdal_edit.py -a_srs {target} in.tif`"),
        )
    };
    match compare(crs, reference) {
        Agreement::Same => Some(()),
        Agreement::MayDiffer(reason) => {
            let help = format!("{reason}; if they are not the same, reproject it: {tool}");
            resources.report(Diagnostic::warning(path, names).help(help));
            Some(())
        }
        Agreement::Differ(reason) => {
            let help = format!(
                "{reason}, so that the same coordinates are other places: reproject it ({tool}), or \
                     correct what it says of itself ({correct})"
            );
            resources.report(Diagnostic::error(path, names).help(help));
            None
        }
    }
}

/// Names the system of the scene in an error as the one to convert a file to, where it is known.
pub(in crate::systems) fn name_target(error: &mut AssetError, map: &MapFrame) {
    let (AssetError::InDegrees { target, .. } | AssetError::NotInMetres { target, .. }) = error
    else {
        return;
    };
    if let Some(CoordinateSystem { crs, owner }) = &map.crs
        && let Some(code) = crs.code
    {
        *target = TargetSystem { code, reason: format!("that of {owner}") };
    }
}

/// Projection of the map, if the scene names its coordinate reference system.
pub(in crate::systems) fn frame_projection(
    map: &MapFrame,
    resources: &Resources,
) -> Option<Projection> {
    resources.frame.crs.as_ref()?;
    projection_of(&map.crs.as_ref()?.crs)
}

/// Projection as ENVI names it, with its number; `None` if neither its zone nor its text or number is known.
pub(in crate::systems) fn projection_of(crs: &Crs) -> Option<Projection> {
    let Some(zone) = crs.utm else {
        let is_known = crs.wkt.is_some() || crs.code.is_some();
        return is_known.then(|| Projection {
            name: "Arbitrary".to_owned(),
            rest: "0, North".to_owned(),
            epsg: crs.code,
            wkt: crs.wkt.clone(),
        });
    };
    let half = if zone.is_south { "South" } else { "North" };
    let datum = crs.datum.as_deref().unwrap_or("WGS 84");
    let known = match datum {
        "WGS 84" => "WGS-84",
        "NAD83" => "North America 1983",
        "NAD27" => "North America 1927",
        "ED50" => "European 1950",
        "WGS 72" => "WGS-72",
        other => other,
    };
    let wkt = crs.wkt.clone().or_else(|| utm_text(zone.number, zone.is_south, datum));
    Some(Projection {
        name: "UTM".to_owned(),
        rest: format!("{}, {half}, {known}", zone.number),
        epsg: crs.code,
        wkt,
    })
}

/// Well-known text of a zone of UTM, as Esri and ENVI write it.
fn utm_text(zone: u8, is_south: bool, datum: &str) -> Option<String> {
    const GRS80: &str = "SPHEROID[\"GRS_1980\",6378137.0,298.257222101]";
    let (name, sphere) = match datum {
        "WGS 84" | "WGS-84" => ("WGS_1984", "SPHEROID[\"WGS_1984\",6378137.0,298.257223563]"),
        "ETRS89" => ("ETRS_1989", GRS80),
        "NAD83" | "North America 1983" => ("North_American_1983", GRS80),
        "GDA94" => ("GDA_1994", GRS80),
        "GDA2020" => ("GDA2020", GRS80),
        "SIRGAS 2000" => ("SIRGAS_2000", GRS80),
        "NAD27" | "North America 1927" => {
            ("North_American_1927", "SPHEROID[\"Clarke_1866\",6378206.4,294.9786982]")
        }
        "ED50" | "European 1950" => {
            ("European_1950", "SPHEROID[\"International_1924\",6378388.0,297.0]")
        }
        _ => return None,
    };
    let half = if is_south { 'S' } else { 'N' };
    let north = if is_south { "10000000.0" } else { "0.0" };
    let meridian = 6 * i32::from(zone) - 183;
    let short = name.replace("North_American", "NAD").replace("European", "ED");
    Some(format!(
        "PROJCS[\"{short}_UTM_Zone_{zone}{half}\",GEOGCS[\"GCS_{name}\",DATUM[\"D_{name}\",{sphere}],\
         PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]],\
         PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"False_Easting\",500000.0],\
         PARAMETER[\"False_Northing\",{north}],PARAMETER[\"Central_Meridian\",{meridian}.0],\
         PARAMETER[\"Scale_Factor\",0.9996],PARAMETER[\"Latitude_Of_Origin\",0.0],UNIT[\"Meter\",1.0]]"
    ))
}
