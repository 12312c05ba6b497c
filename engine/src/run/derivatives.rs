//! Points of a sweep for derivatives with respect to parameters.

use super::Failure;
use super::point_reader::PointReader;
use crate::document::{
    DerivativeSteps, Diagnostic, Map, Param, Reading, Scene, ScenePath, Sweep, discrete_difference,
};
use crate::products::{CentralDifference, SweepPoint};

/// Completes the points of derivatives, each of which has the parameter that it varies: the others follow from it by the
/// formulas of the scene. Returns the differences between them.
///
/// # Errors
/// Errors of the scene at a point; a parameter without a derivative.
pub(super) fn complete(
    reader: &PointReader,
    points: &mut [SweepPoint],
    steps: &DerivativeSteps,
    sweep: &Sweep,
) -> Result<Vec<CentralDifference>, Failure> {
    let names = sweep.names();
    let mut readings = Vec::with_capacity(points.len());
    for (index, reading) in reader.read_all(points).into_iter().enumerate() {
        let parameter = index.checked_sub(1).map(|side| names[side / 2]);
        readings.push(reading.map_err(|failure| match parameter {
            Some(name) => with_advice(&failure, name),
            None => failure,
        })?);
    }
    for (point, reading) in points.iter_mut().zip(&readings) {
        let own =
            |name: &&str| Some(((*name).to_owned(), reading.scene.params.get(*name)?.clone()));
        point.params = names.iter().filter_map(own).collect();
    }
    let own = |index: usize, name: &str| number(&readings[index].scene.params, name);
    let difference = |(place, &name): (usize, &&str)| {
        let points = [1 + 2 * place, 2 + 2 * place];
        let sides = points.map(|point| &readings[point]);
        check(name, steps.path(place), sides)?;
        let sides = points.map(|point| own(point, name));
        let (parameter, at) = (name.to_owned(), own(0, name));
        Ok(CentralDifference { parameter, at, step: steps.step(place, at), sides, points })
    };
    names.iter().enumerate().map(difference).collect()
}

fn number(params: &Map<Param>, name: &str) -> f64 {
    params.get(name).and_then(Param::number).unwrap_or(f64::NAN)
}

/// A failure at one side of a parameter, with what the parameter must allow.
fn with_advice(failure: &Failure, name: &str) -> Failure {
    let text = failure.to_string();
    Failure::Sweep(format!(
        "{}\n     = help: derivatives take values at both sides of `{name}`. If it must be a whole number or ends here, \
         compare values: `sweep: Grid({{ \"{name}\": [..] }})`",
        text.trim_end()
    ))
}

/// Checks that the scenes at both sides of a parameter differ, and in real numbers alone.
fn check(name: &str, path: ScenePath, sides: [&Reading; 2]) -> Result<(), Failure> {
    let [low, high] = sides.map(|reading| &reading.scene);
    let values = [low, high].map(|scene: &Scene| number(&scene.params, name));
    let grid = format!("compare values: `sweep: Grid({{ \"{name}\": [..] }})`");
    let fail = |path: ScenePath, message: String| {
        let problem = Diagnostic::error(path, message).help(&grid);
        Err(Failure::Problems(vec![problem]).with_source(&sides[0].source))
    };
    let between = format!("between {name}={} and {name}={}", values[0], values[1]);
    if low.resolved() == high.resolved() {
        return fail(path, format!("nothing in the scene changes {between}: it has no derivative"));
    }
    discrete_difference(low, high).map_or(Ok(()), |place| {
        fail(place, format!("this is no real number and changes {between}: it has no derivative"))
    })
}
