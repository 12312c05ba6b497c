//! Coordinate reference systems of the scene and of its files.

use super::Spawner;
use crate::assets::crs::{Agreement, TargetSystem, compare, from_name};
use crate::assets::{AssetError, Axes, Crs};
use crate::components::Projection;
use crate::document::Diagnostic;

/// The system of the scene, and what says so.
#[derive(Clone, Debug)]
pub(super) struct System {
    pub(super) crs: Crs,
    /// `frame.crs` or a file.
    owner: String,
}

impl Spawner<'_> {
    /// Takes `frame.crs` as the system of the scene.
    pub(super) fn frame_system(&mut self) {
        let Some(name) = &self.scene.frame.crs else { return };
        let utm = "write the number of a projected system in metres, such as `EPSG:32632` (UTM zone 32 \
                   north on WGS 84) or `EPSG:25832` (on ETRS89)";
        let Some(crs) = from_name(name) else {
            let message = format!("{name:?} names no coordinate reference system that is known");
            self.problems.push(Diagnostic::error("frame.crs", message).help(utm));
            return;
        };
        let problem = match &crs.axes {
            Axes::Unknown if crs.heights.is_some() => {
                Some("is a system of heights alone".to_owned())
            }
            Axes::Metres | Axes::Unknown => None,
            Axes::Degrees => Some("is in degrees, but a scene is in metres".to_owned()),
            Axes::Length(unit) => {
                Some(format!("is in the unit {}, but a scene is in metres", unit.name))
            }
            Axes::World => {
                Some("is a map of the world, whose metres are not metres on the ground".to_owned())
            }
            Axes::Geocentric => Some("has its origin in the centre of the Earth".to_owned()),
        };
        if let Some(problem) = problem {
            let message = format!("{} {problem}", crs.name);
            self.problems.push(Diagnostic::error("frame.crs", message).help(utm));
            return;
        }
        self.system = Some(System { crs, owner: "`frame.crs`".to_owned() });
    }

    /// Holds the system of a file against that of the scene; the first that is known becomes it.
    pub(super) fn check_system(&mut self, crs: &Crs, file: &str, path: &str) -> Option<()> {
        if crs.name.is_empty() {
            return Some(());
        }
        let Some(System { crs: reference, owner }) = &self.system else {
            self.system = Some(System { crs: crs.clone(), owner: format!("`{file}`") });
            return Some(());
        };
        let names = format!("it is in {}, but {owner} in {}", crs.name, reference.name);
        let target =
            reference.code.map_or_else(|| "EPSG:..".to_owned(), |code| format!("EPSG:{code}"));
        let is_area = path.contains("inside") || path.contains("outside");
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
                self.problems.push(Diagnostic::warning(path, names).help(help));
                Some(())
            }
            Agreement::Differ(reason) => {
                let help = format!(
                    "{reason}, so that the same coordinates are other places: reproject it ({tool}), or \
                     correct what it says of itself ({correct})"
                );
                self.problems.push(Diagnostic::error(path, names).help(help));
                None
            }
        }
    }

    /// Names the system of the scene as that to convert an area to, where it is known.
    pub(super) fn name_target(&self, error: &mut AssetError) {
        let (AssetError::InDegrees { target, .. } | AssetError::NotInMetres { target, .. }) = error
        else {
            return;
        };
        if let Some(System { crs, owner }) = &self.system
            && let Some(code) = crs.code
        {
            *target = TargetSystem { code, reason: format!("that of {owner}") };
        }
    }

    /// Projection of the coordinates that places of the scene and its anchor add up to.
    pub(super) fn frame_projection(&self) -> Option<Projection> {
        self.scene.frame.crs.as_ref()?;
        projection_of(&self.system.as_ref()?.crs)
    }
}

/// How ENVI names a system; `None` where it has no name for it.
pub(super) fn projection_of(crs: &Crs) -> Option<Projection> {
    let Some(zone) = crs.utm else {
        let wkt = crs.wkt.clone()?;
        return Some(Projection {
            name: "Arbitrary".to_owned(),
            rest: "0, North".to_owned(),
            wkt: Some(wkt),
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
