#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use super::*;
use crate::spectral::{planck, planck_mean};

/// A normal curve over a straight line with a corner at its centre: the mean distance from the centre is `σ √(2/π)`.
#[test]
fn the_mean_under_a_normal_curve_is_its_integral() {
    let (center, fwhm) = (700.0, 20.0);
    let sigma = fwhm / (8.0 * std::f64::consts::LN_2).sqrt();
    let points = [(600.0, 100.0), (700.0, 0.0), (800.0, 100.0)];
    let mean = BandResponse::gaussian(center, fwhm).mean(&points).unwrap();
    let expected = sigma * (2.0 / std::f64::consts::PI).sqrt();
    assert!((mean / expected - 1.0).abs() < 1e-9, "{mean} {expected}");
    let line = [(600.0, 1.0), (800.0, 3.0)];
    let mean = BandResponse::gaussian(720.0, 5.0).mean(&line).unwrap();
    assert!((mean - 2.2).abs() < 1e-12, "{mean}");
}

/// A response of 1, 3 and 0 at three wavelengths, a spectrum with values there: the trapezoidal rule by hand.
#[test]
fn the_mean_under_a_table_is_its_trapezoids() {
    let response = BandResponse::from_points(vec![(500.0, 1.0), (510.0, 3.0), (514.0, 0.0)]);
    let response = response.unwrap();
    let spectrum = [(500.0, 0.2), (510.0, 0.4), (514.0, 0.9)];
    let area = 0.5 * 10.0 * 4.0 + 0.5 * 4.0 * 3.0;
    let expected = (0.5 * 10.0 * (0.2 + 1.2) + 0.5 * 4.0 * 1.2) / area;
    assert!((response.mean(&spectrum).unwrap() - expected).abs() < 1e-15);
    let sun = [(500.0, 2.0), (510.0, 1.0), (514.0, 5.0)];
    let weighted = response.mean_of_fraction(&spectrum, Some(&sun)).unwrap();
    let expected =
        (0.5 * 10.0 * (0.4 + 1.2) + 0.5 * 4.0 * 1.2) / (0.5 * 10.0 * (2.0 + 3.0) + 0.5 * 4.0 * 3.0);
    assert!((weighted - expected).abs() < 1e-15);
    assert!((response.width() - (512.0 - 502.5)).abs() < 1e-12, "{}", response.width());
    // Triangles: ∫ λ S / ∫ S.
    let moment = 10.0 * (1.0 * 500.0 / 3.0 + 3.0 * 510.0 / 3.0 + (510.0 + 3.0 * 500.0) / 6.0)
        + 4.0 * (3.0 * 510.0 / 3.0 + 3.0 * 514.0 / 6.0);
    assert!((response.center() - moment / area).abs() < 1e-9, "{}", response.center());
}

/// *Expected*: 1 % of a response may lie outside a spectrum, which goes on there; not more.
#[test]
fn little_of_a_curve_may_lie_outside_the_spectrum() {
    let points = vec![(390.0, 0.0), (400.0, 0.01), (500.0, 1.0), (600.0, 0.0)];
    let response = BandResponse::from_points(points).unwrap();
    assert!((response.mean(&[(400.0, 0.5), (700.0, 0.5)]).unwrap() - 0.5).abs() < 1e-12);
    assert!(response.mean(&[(430.0, 0.5), (700.0, 0.5)]).is_err());
    assert!(response.mean(&[]).is_err());
    assert!(response.mean(&[(700.0, 0.5), (800.0, 0.5)]).is_err());
}

/// Curves with and without far tails: the rule for smooth functions against many narrow windows.
#[test]
fn means_of_planck_are_those_of_narrow_windows() {
    for points in [
        vec![(8000.0, 0.0), (10_000.0, 0.2), (10_500.0, 1.0), (11_500.0, 0.7), (12_500.0, 0.0)],
        vec![(1000.0, 0.0), (1500.0, 0.01), (4000.0, 1.0), (4500.0, 0.5), (16_000.0, 0.0)],
    ] {
        let response = BandResponse::from_points(points.clone()).unwrap();
        for kelvin in [220.0, 300.0, 900.0] {
            let (mut sum, mut norm) = (0.0, 0.0);
            for pair in points.windows(2) {
                let steps = 4000;
                for step in 0..steps {
                    let part = (f64::from(step) + 0.5) / f64::from(steps);
                    let weight =
                        (pair[1].0 - pair[0].0) * (pair[0].1 * (1.0 - part) + pair[1].1 * part);
                    sum += weight * planck(pair[0].0 + part * (pair[1].0 - pair[0].0), kelvin);
                    norm += weight;
                }
            }
            let mean = planck_mean(&response, kelvin);
            assert!((mean / (sum / norm) - 1.0).abs() < 2e-6, "{kelvin}: {mean} {}", sum / norm);
        }
    }
}

#[test]
fn what_is_no_response_is_refused() {
    let from = BandResponse::from_points;
    assert_eq!(from(vec![(500.0, 1.0)]), Err(InvalidResponse::TooShort));
    for (wavelength, points) in [
        (1e-310, [(1e-310, 1.0), (500.0, 0.0)]),
        (0.64, [(0.64, 1.0), (0.68, 0.0)]),
        (f64::INFINITY, [(500.0, 1.0), (f64::INFINITY, 0.0)]),
    ] {
        assert_eq!(from(points.to_vec()), Err(InvalidResponse::NoLight(wavelength)));
    }
    assert_eq!(from(vec![(500.0, 1.0), (500.0, 1.0)]), Err(InvalidResponse::NotRising));
    assert_eq!(from(vec![(500.0, 1.0), (510.0, -0.1)]), Err(InvalidResponse::Negative));
    assert_eq!(from(vec![(500.0, 1.0), (510.0, f64::NAN)]), Err(InvalidResponse::Negative));
    assert_eq!(from(vec![(500.0, 0.0), (510.0, 0.0)]), Err(InvalidResponse::Zero));
}
