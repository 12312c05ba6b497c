//! Checks of instances.

use crate::counts::counted;
use indexmap::IndexMap;

use super::super::diagnostic::{Diagnostic, suggestion};
use super::super::scene::{
    Area, CanopyHeights, Distribution, INSTANCE_COLUMNS, InstanceList, InstanceTable, Instances,
    Prototype, Ref, Rule, Scatter, Scene, SpeciesMeshes, Stems, meant_column,
};
use super::{Report, ScenePath};

pub(super) fn check_instances(scene: &Scene, report: &mut Report<'_>) {
    for (index, instances) in scene.instances.iter().enumerate() {
        let path = ScenePath::from("instances").index(index);
        check_name(scene, index, instances.name(), &path, report);
        match instances {
            Instances::Table(InstanceTable { of, columns, .. }) => {
                if matches!(of, SpeciesMeshes::BySpecies(meshes) if meshes.is_empty()) {
                    let help = "write, for example, `of: { \"birch\": \"birch.tree\" }`";
                    report.error(path.key("of"), "no species has a mesh", help);
                }
                if let Some(columns) = columns {
                    check_columns(&path.key("columns"), columns, report);
                }
            }
            Instances::List(InstanceList { at_m, yaw_deg, scale, .. }) => {
                for (index, (x, y, z)) in at_m.iter().enumerate() {
                    if !(x.is_finite() && y.is_finite() && z.is_finite()) {
                        let message = format!("expected finite numbers, found ({x}, {y}, {z})");
                        report.push(Diagnostic::error(path.key("at_m").index(index), message));
                    }
                }
                check_count(&path, "yaw_deg", yaw_deg.len(), at_m.len(), report);
                check_count(&path, "scale", scale.len(), at_m.len(), report);
                report.finite(path.key("yaw_deg"), yaw_deg);
                for (index, &scale) in scale.iter().enumerate() {
                    if !(scale > 0.0 && scale.is_finite()) {
                        report.above_zero(path.key("scale").index(index), scale);
                    }
                }
            }
            Instances::Scatter(scatter) => check_scatter(scatter, &path, report),
            Instances::CanopyHeights(CanopyHeights {
                of,
                min_height_m,
                window,
                sink_m,
                height_unit_m,
                ..
            }) => {
                if let Some(unit) = height_unit_m {
                    report.above_zero(path.key("height_unit_m"), *unit);
                }
                let at = path.key("of");
                if of.is_empty() && report.is_whole(&at) {
                    let help = "write, for example, `of: [\"oak\", \"fir\"]`";
                    report.error(at, "nothing would stand there", help);
                }
                report.above_zero(path.key("min_height_m"), *min_height_m);
                report.at_least(path.key("window").index(0), window.0, 0.0);
                report.at_least(path.key("window").index(1), window.1, 0.0);
                report.finite(path.key("sink_m"), &[*sink_m]);
            }
        }
    }
}

/// A name that streams are keyed by, so no two may have the same.
fn check_name(
    scene: &Scene,
    index: usize,
    name: Option<&str>,
    path: &ScenePath,
    report: &mut Report<'_>,
) {
    let Some(name) = name else { return };
    let at = path.key("name");
    if name.is_empty() || name.contains(['/', '*']) {
        let help = "patterns of `hide` and `select` are made of names, `/` and `*`";
        report.error(at, format!("`{name}` cannot be a name of instances"), help);
    } else if scene.instances[..index].iter().any(|other| other.name() == Some(name)) {
        report.error(at, format!("a second `{name}`"), "give each instances a name of their own");
    }
}

fn check_scatter(scatter: &Scatter, path: &ScenePath, report: &mut Report<'_>) {
    let Scatter {
        of,
        rule,
        stems,
        inside,
        outside,
        yaw_deg,
        tilt_deg,
        tilt_azimuth_deg,
        height_m,
        scale,
        scale_vertical,
        sink_m,
        ..
    } = scatter;
    check_shares(of, &path.key("of"), report);
    check_rule(rule, stems, path, report);
    for (key, areas) in [("inside", inside), ("outside", outside)] {
        for (index, area) in areas.iter().enumerate() {
            check_area(area, &path.key(key).index(index), report);
        }
    }
    check_distribution(yaw_deg, &path.key("yaw_deg"), Least::Any, report);
    check_distribution(tilt_azimuth_deg, &path.key("tilt_azimuth_deg"), Least::Any, report);
    let tilt_path = path.key("tilt_deg");
    check_distribution(tilt_deg, &tilt_path, Least::Zero("a lean"), report);
    let most = largest(tilt_deg);
    if most >= 90.0 {
        let (message, help) = if most.is_finite() {
            (format!("expected a lean below 90°, found up to {most}"), "0 is upright")
        } else {
            let message = "expected a lean below 90°, but a Gaussian has no end".to_owned();
            (message, "cut it off: add, for example, `max: 30.0`")
        };
        report.error(&tilt_path, message, help);
    }
    let sizes = [
        ("height_m", height_m.as_ref()),
        ("scale", Some(scale)),
        ("scale_vertical", scale_vertical.as_ref()),
    ];
    for (key, size) in sizes {
        if let Some(size) = size {
            let path = path.key(key);
            check_distribution(size, &path, Least::AboveZero("sizes"), report);
        }
    }
    report.finite(path.key("sink_m"), &[*sink_m]);
}

fn check_shares(of: &IndexMap<Ref<Prototype>, f64>, path: &ScenePath, report: &mut Report<'_>) {
    if of.is_empty() {
        let help = "write, for example, `of: { \"oak\": 0.7, \"birch\": 0.3 }`";
        report.error(path, "nothing would stand there", help);
    } else if of.values().all(|&share| share == 0.0) {
        report.error(path, "all shares are 0", "give at least one mesh a share above 0");
    }
    for (name, &share) in of {
        report.at_least(path.name(name.as_str()), share, 0.0);
    }
}

fn check_rule(rule: &Rule, stems: &Stems, path: &ScenePath, report: &mut Report<'_>) {
    match rule {
        Rule::Uniform if *stems == Stems::Fill && report.is_readable(path.key("stems")) => {
            let message = "`Uniform` has room for any number of stems";
            let help = "add, for example, `stems: PerHectare(400.0)`";
            report.error(path.key("rule"), message, help);
        }
        Rule::Uniform => {}
        Rule::PoissonDisc { min_distance_m } => {
            report.above_zero(path.key("rule").key("min_distance_m"), *min_distance_m);
        }
        Rule::Grid { spacing_m, row_azimuth_deg, jitter_m } => {
            report.above_zero(path.key("rule").key("spacing_m").index(0), spacing_m.0);
            report.above_zero(path.key("rule").key("spacing_m").index(1), spacing_m.1);
            report.azimuth(path.key("rule").key("row_azimuth_deg"), *row_azimuth_deg);
            report.at_least(path.key("rule").key("jitter_m"), *jitter_m, 0.0);
            if *stems != Stems::Fill {
                let help = "take the key out, or choose `Uniform` or `PoissonDisc(..)` as the rule";
                let message = "the spacing of a grid decides how many stems there are";
                report.error(path.key("stems"), message, help);
            }
        }
    }
    if let Stems::Raster { factor, .. } = stems {
        report.at_least(path.key("stems").key("factor"), *factor, 0.0);
    }
    if let Stems::PerHectare(density) = stems
        && !(*density >= 0.0 && density.is_finite())
    {
        let message = format!("expected stems per hectare of at least 0, found {density}");
        report.error(path.key("stems"), message, "write, for example, `PerHectare(400.0)`");
    }
}

fn check_area(area: &Area, path: &ScenePath, report: &mut Report<'_>) {
    let Area::Polygon { outline_m, holes_m } = area else { return };
    check_ring(outline_m, &path.key("outline_m"), report);
    for (index, hole) in holes_m.iter().enumerate() {
        check_ring(hole, &path.key("holes_m").index(index), report);
    }
}

fn check_ring(ring: &[(f64, f64)], path: &ScenePath, report: &mut Report<'_>) {
    if ring.len() < 3 && report.is_whole(path) {
        let message = format!("{} enclose no area", counted(ring.len(), "corner"));
        report.error(path, message, "write at least three: `[(10.0, 10.0), (90.0, 10.0), ..]`");
    }
    if let Some(index) = ring.iter().position(|(x, y)| !(x.is_finite() && y.is_finite())) {
        let (x, y) = ring[index];
        let message = format!("expected finite numbers, found ({x}, {y})");
        report.push(Diagnostic::error(path.index(index), message));
    }
}

/// Lower limit of a distribution's values, with its name in messages.
#[derive(Clone, Copy)]
enum Least {
    Any,
    Zero(&'static str),
    AboveZero(&'static str),
}

/// Checks that values are finite, in order, and not below the minimum.
fn check_distribution(
    distribution: &Distribution,
    path: &ScenePath,
    least: Least,
    report: &mut Report<'_>,
) {
    let before = report.found.len();
    match distribution {
        Distribution::Fixed(value) => report.finite(path, &[*value]),
        Distribution::Uniform((low, high)) => {
            report.finite(path, &[*low, *high]);
            if low > high {
                let help = format!("write `Uniform({high:?}, {low:?})`");
                report.error(path, format!("runs from {low} down to {high}"), help);
            }
        }
        Distribution::Normal { mean, sd, min, max } => {
            report.finite(path.key("mean"), &[*mean]);
            report.at_least(path.key("sd"), *sd, 0.0);
            check_limits(path, ("mean", *mean), *min, *max, report);
        }
        Distribution::LogNormal { median, sd_ln, min, max } => {
            report.above_zero(path.key("median"), *median);
            report.at_least(path.key("sd_ln"), *sd_ln, 0.0);
            check_limits(path, ("median", *median), *min, *max, report);
        }
    }
    let lowest = match distribution {
        Distribution::Fixed(value) | Distribution::Uniform((value, _)) => *value,
        Distribution::Normal { mean, sd: 0.0, .. } => *mean,
        Distribution::Normal { min, .. } => min.unwrap_or(f64::NEG_INFINITY),
        // Its values are above 0 whatever its limits.
        Distribution::LogNormal { .. } => f64::MIN_POSITIVE,
    };
    let (is_lawful, expected) = match least {
        Least::Any => return,
        Least::Zero(what) => (lowest >= 0.0, format!("{what} of at least 0")),
        Least::AboveZero(what) => (lowest > 0.0, format!("{what} above 0")),
    };
    if is_lawful || report.found.len() > before {
        return;
    }
    if lowest.is_finite() {
        report.push(Diagnostic::error(path, format!("expected {expected}, found {lowest}")));
    } else {
        let message = format!("expected {expected}, but a Gaussian has no end");
        let min = if matches!(least, Least::Zero(_)) { "0.0" } else { "0.5" };
        report.error(path, message, format!("cut it off: add, for example, `min: {min}`"));
    }
}

fn check_limits(
    path: &ScenePath,
    (name, middle): (&str, f64),
    min: Option<f64>,
    max: Option<f64>,
    report: &mut Report<'_>,
) {
    let limits = [("min", min, "above"), ("max", max, "below")];
    for (key, limit, side) in limits {
        let Some(limit) = limit else { continue };
        let is_beyond = if key == "min" { limit > middle } else { limit < middle };
        if is_beyond || limit.is_nan() {
            let help = format!("the {name} must lie from `min` to `max`");
            let message = format!("`{key}` {limit} is {side} the {name} {middle}");
            report.error(path.key(key), message, help);
        }
    }
}

/// The largest value that a distribution can give.
fn largest(distribution: &Distribution) -> f64 {
    match distribution {
        Distribution::Fixed(value) | Distribution::Uniform((_, value)) => *value,
        Distribution::Normal { mean, sd: 0.0, .. } => *mean,
        Distribution::Normal { max, .. } | Distribution::LogNormal { max, .. } => {
            max.unwrap_or(f64::INFINITY)
        }
    }
}

/// One value a place, or none.
fn check_count(
    path: &ScenePath,
    key: &'static str,
    values: usize,
    places: usize,
    report: &mut Report<'_>,
) {
    if values != 0 && values != places && report.is_readable(path.key("at_m")) {
        let values = counted(values, "value");
        let message = format!("`{key}` has {values}, but `at_m` has {places}");
        let help = "write one for each place, or leave the key out";
        report.error(path.key(key), message, help);
    }
}

fn check_columns(path: &ScenePath, columns: &[String], report: &mut Report<'_>) {
    for (index, column) in columns.iter().enumerate() {
        let at = path.index(index);
        if !INSTANCE_COLUMNS.contains(&column.as_str()) {
            // Other columns are let be, unless one that means something is meant.
            let is_free = |name: &&'static str| !columns.iter().any(|column| column == name);
            let free: Vec<_> = INSTANCE_COLUMNS.into_iter().filter(is_free).collect();
            if meant_column(column, &free).is_some() {
                let help = suggestion(column, &INSTANCE_COLUMNS, "columns may be");
                report.error(at, format!("no column `{column}`"), help);
            }
        } else if columns[..index].contains(column) {
            report.error(at, format!("a second column `{column}`"), "name each column once");
        }
    }
    for needed in ["x_m", "y_m"] {
        if !columns.iter().any(|column| column == needed) && report.is_whole(path) {
            let help = "write, for example, `columns: [\"x_m\", \"y_m\", \"yaw_deg\"]`";
            report.error(path, format!("no column is `{needed}`"), help);
        }
    }
}
