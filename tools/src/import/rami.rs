//! Lists of the RAMI benchmark: `.def` texts of discs, rows `r x y z nx ny nz`, and of places, rows `x y z`.
//!
//! The origin of RAMI's scenes is the middle of their ground. Source: the files of RAMI-3's abstract canopies, such as
//! `HET01_DIS_UNI`, at <https://rami-benchmark.jrc.ec.europa.eu>.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use sunfleck::counts::counted;

use anyhow::{Context as _, Result, bail};

use super::model::{Curve, Names, Pose, surface, write_places};
use super::scene::ImportedScene;
use super::source::{SourceProgram, files_with_ending};
use super::text::{self, quoted};

/// Content of a list.
#[derive(Debug)]
enum Content {
    Discs,
    Places(Vec<[f64; 3]>),
}

/// A list and its content.
#[derive(Debug)]
struct List {
    file: PathBuf,
    stem: String,
    content: Content,
}

/// Imports a folder of lists, or one list of discs, into a folder.
pub(super) fn import(path: &Path, out: &Path, size_m: Option<(f64, f64)>) -> Result<ImportedScene> {
    let files = if path.is_dir() { files_with_ending(path, "def") } else { vec![path.to_owned()] };
    let Some((width, depth)) = size_m else {
        bail!(
            "{}: lists of RAMI do not say how large their scene is; write it, in m: `--size-m 100,100`",
            path.display()
        );
    };
    let lists = files.iter().map(|file| List::read(file)).collect::<Result<Vec<_>>>()?;
    let is_discs = |list: &&List| matches!(list.content, Content::Discs);
    let (discs, places): (Vec<&List>, Vec<&List>) = lists.iter().partition(is_discs);
    if discs.is_empty() {
        bail!("{}: no list holds discs, rows of `r x y z nx ny nz`", path.display());
    }
    let mut scene = ImportedScene::new(SourceProgram::Rami, "Periodic");
    let mut names = Names::default();
    let middle = [width / 2.0, depth / 2.0];
    let mut unused: Vec<&List> = places.clone();
    for list in &discs {
        let name = names.unique(&list.stem);
        let file = format!("assets/{name}.def");
        fs::copy(&list.file, out.join(&file))
            .with_context(|| format!("cannot copy {}", list.file.display()))?;
        let (mesh, file) = (quoted(&name), quoted(&file));
        writeln!(scene.meshes, "{mesh}: Discs(file: {file}, material: \"leaf\"),")?;
        let own = places_of(list, &discs, &places, path)?;
        unused.retain(|other| own.is_none_or(|own| own.file != other.file));
        let at = if let Some(List { content: Content::Places(at), .. }) = own {
            at.clone()
        } else {
            let what = "stands once, at the middle of the ground: no list of places goes with it";
            scene.report.assumed(&list.stem, "", what);
            vec![[0.0; 3]]
        };
        let poses: Vec<Pose> = at.iter().map(|&place| pose(place, middle)).collect();
        let table = format!("assets/places_{name}.csv");
        write_places(&out.join(&table), &poses)?;
        writeln!(scene.instances, "Table(file: {}, of: {mesh}),", quoted(&table))?;
    }
    for list in unused {
        scene.report.left_out(&list.stem, "places", "no list of discs goes with them");
    }
    optics(&mut scene);
    scene.terrain = format!("Plane(size_m: ({width:?}, {depth:?}), material: \"soil\")");
    scene.report.differs(
        "origin",
        "",
        "RAMI's is the middle of the ground, here it is the south-west corner",
    );
    scene.report.assumed("boundary", "", "Periodic: RAMI's scenes are repeated without end");
    scene.title = discs.first().map_or_else(String::new, |list| list.stem.clone());
    Ok(scene)
}

/// Materials and the band: lists hold none.
fn optics(scene: &mut ImportedScene) {
    // RAMI-3, near infrared: Widlowski et al. (2007), J. Geophys. Res. 112, D09111.
    let (leaf, soil) = ([0.4957, 0.4409], 0.159);
    scene.materials += &surface("leaf", &Curve::Constant(leaf[0]), Some(&Curve::Constant(leaf[1])));
    scene.materials += &surface("soil", &Curve::Constant(soil), None);
    scene.bands += "(name: \"nir\", center_nm: 865.0)";
    let what = "those of RAMI-3's abstract canopies in the near infrared: leaves 0.4957 and 0.4409, soil 0.159";
    scene.report.assumed("optical properties", "", what);
}

fn pose([x, y, z]: [f64; 3], [east, north]: [f64; 2]) -> Pose {
    let at = [x + east, y + north, z];
    Pose { at, yaw_deg: 0.0, tilt_deg: 0.0, tilt_azimuth_deg: 0.0, scale: 1.0, scale_vertical: 1.0 }
}

/// The list of places of some discs: the only one, or that whose name begins most alike.
fn places_of<'a>(
    discs: &List,
    all: &[&List],
    places: &[&'a List],
    path: &Path,
) -> Result<Option<&'a List>> {
    if all.len() == 1 && places.len() <= 1 {
        return Ok(places.first().copied());
    }
    let alike = |list: &&List| {
        let pairs = discs.stem.chars().zip(list.stem.chars());
        pairs.take_while(|(a, b)| a.eq_ignore_ascii_case(b)).count()
    };
    let best = places.iter().map(alike).max().unwrap_or(0);
    let mut found = places.iter().filter(|list| alike(list) == best);
    match (found.next(), found.next()) {
        (Some(_), Some(_)) => bail!(
            "{}: several lists of places may go with {}; keep in the folder those that belong together, or let their \
             names begin alike",
            path.display(),
            discs.stem
        ),
        (first, _) => Ok(first.copied()),
    }
}

impl List {
    fn read(file: &Path) -> Result<Self> {
        let mut columns = None;
        let mut places = Vec::new();
        text::lines(file, |line| {
            if line.starts_with('#') {
                return Ok(());
            }
            let numbers: Option<Vec<f64>> = line
                .split_whitespace()
                .map(|word| word.parse().ok().filter(|number: &f64| number.is_finite()))
                .collect();
            let numbers =
                numbers.with_context(|| format!("no numbers: {:?}", text::excerpt(line)))?;
            let count = *columns.get_or_insert(numbers.len());
            match numbers[..] {
                [x, y, z] if count == 3 => places.push([x, y, z]),
                _ if count == 7 && numbers.len() == 7 => {}
                _ => bail!(
                    "a row of {}; lists hold discs, `r x y z nx ny nz`, or places, `x y z`. Convert lists of \
                     triangles, cylinders and spheres to a PLY mesh",
                    counted(numbers.len(), "number")
                ),
            }
            Ok(())
        })?;
        let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let content = match columns {
            None => bail!("{}: holds no row", file.display()),
            Some(7) => Content::Discs,
            Some(_) => Content::Places(places),
        };
        Ok(Self { file: file.to_owned(), stem, content })
    }
}
