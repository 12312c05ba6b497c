//! The same scene on other numbers of threads.

use super::finding::Finding;
use super::measured::{bits, differing, forest, measure};

/// *Scene*: the small forest, seen by every kind of sensor. *Expected*: the very same numbers.
pub(super) fn run() -> anyhow::Result<Vec<Finding>> {
    let keys = forest(
        (0.0, 0.0),
        r#"sun: (zenith_deg: 50.0, azimuth_deg: 10.0, irradiance: Constant(1.0)), sky: Fraction([0.3, 0.1]),
        sensors: {
            "image": Orthographic(size_px: (40, 33), cover: WholeScene, samples_per_px: 17),
            "fisheye": Fisheye(
                size_px: (24, 24), position_m: (2.0, 1.0, 0.1), samples_per_px: 16, measure: [GapFraction],
            ),
            "back": Directions(system: Backward, views: PrincipalPlane(max_deg: 60.0, step_deg: 20.0), until: RelError(0.02)),
            "forth": Directions(
                views: PrincipalPlane(max_deg: 60.0, step_deg: 20.0), until: RelError(0.03),
                system: Forward,
            ),
            "photons": Photons(
                per_m2: 4000.0,
                measure: [Albedo, BrfCells(40), Fapar(layer_m: 0.7), Fluxes(pixel_m: 0.5)],
            ),
        },"#,
    );
    let with = |threads: usize| -> anyhow::Result<Vec<u64>> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        Ok(bits(&pool.install(|| measure(&keys))?)?)
    };
    let one = with(1)?;
    let mut findings = vec![Finding::within("numbers to compare", 6000.0, one.len() as f64, 1.0)];
    for threads in [2, 3] {
        let quantity = format!("numbers that differ on {threads} threads from 1");
        findings.push(Finding::exact(quantity, 0.0, differing(&one, &with(threads)?)));
    }
    Ok(findings)
}
