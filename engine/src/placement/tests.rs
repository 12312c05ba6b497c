//! Tests of placement by counting.

use std::f64::consts::PI;
use std::slice::from_ref;

use glam::DVec2;

use super::*;
use crate::components::{Placement, PrototypeId};
use crate::document::Distribution;
use crate::geometry::Polygon;

const TERRAIN: Rectangle = Rectangle { min: DVec2::ZERO, max: DVec2::new(100.0, 60.0) };

fn polygon(rings: &[&[(f64, f64)]]) -> Polygon {
    let ring = |ring: &&[(f64, f64)]| ring.iter().map(|&corner| DVec2::from(corner)).collect();
    Polygon { rings: rings.iter().map(ring).collect() }
}

fn whole() -> Region {
    Region::new(TERRAIN, &[], &[]).expect("a rectangle is a region")
}

/// Returns whether a point lies in a polygon: crossings of a ray, edge by edge.
fn is_inside(polygon: &Polygon, p: DVec2) -> bool {
    let edges = polygon.rings.iter().flat_map(|ring| {
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next)
    });
    edges
        .filter(|(a, b)| {
            (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)
        })
        .count()
        % 2
        == 1
}

/// A star of so many points around a centre, its corners in order.
fn star(center: DVec2, points: usize, key: Key) -> Polygon {
    let corner = |index: usize| {
        let angle = 2.0 * PI * (index as f64 + 0.8 * key.uniform(2 * index as u64)) / points as f64;
        center + DVec2::from_angle(angle) * (5.0 + 40.0 * key.uniform(2 * index as u64 + 1))
    };
    Polygon { rings: vec![(0..points).map(corner).collect()] }
}

#[test]
fn the_area_of_a_polygon_with_a_hole_is_exact() {
    let square = polygon(&[
        &[(10.0, 10.0), (50.0, 10.0), (50.0, 50.0), (10.0, 50.0)],
        &[(20.0, 20.0), (30.0, 20.0), (25.0, 30.0)],
    ]);
    let triangle = polygon(&[&[(40.0, 0.0), (100.0, 0.0), (100.0, 60.0)]]);
    let of = |inside: &[Polygon], outside: &[Polygon]| {
        Region::new(TERRAIN, inside, outside).expect("a region").area()
    };
    assert!((whole().area() - 6000.0).abs() < 1e-9);
    assert!((of(from_ref(&square), &[]) - 1550.0).abs() < 1e-9);
    assert!((of(&[], from_ref(&square)) - 4450.0).abs() < 1e-9);
    // They share the point (50, 10) and no area.
    assert!((of(&[square.clone(), triangle.clone()], &[]) - (1550.0 + 1800.0)).abs() < 1e-9);
    // An area counts once, however often it is covered.
    assert!((of(&[square.clone(), square.clone()], &[]) - 1550.0).abs() < 1e-9);
    // What lies beside the terrain is no ground.
    let wide = polygon(&[&[(-1e6, 30.0), (1e6, 30.0), (1e6, 1e6), (-1e6, 1e6)]]);
    assert!((of(&[wide], &[]) - 3000.0).abs() < 1e-6);
}

#[test]
fn a_region_holds_the_points_that_its_polygons_say_and_no_others() {
    for trial in 0..40 {
        let key = Key::new(trial);
        let center = |at: u64| TERRAIN.at(key.uniform(1000 + at), key.uniform(2000 + at));
        let inside = [star(center(0), 12, key.index(0)), star(center(1), 7, key.index(1))];
        let outside = [star(center(2), 5, key.index(2))];
        let region = Region::new(TERRAIN, &inside, &outside).expect("a region");
        let belongs = |p: DVec2| {
            inside.iter().any(|polygon| is_inside(polygon, p)) && !is_inside(&outside[0], p)
        };
        let n = 4000_u64;
        let points = key.path("points");
        let mut hits = 0_u32;
        for index in 0..n {
            let p = TERRAIN.at(points.uniform(2 * index), points.uniform(2 * index + 1));
            assert_eq!(region.contains(p), belongs(p), "trial {trial}: {p}");
            hits += u32::from(belongs(p));
            let q = region.sample(points.uniform(2 * index), points.uniform(2 * index + 1));
            assert!(belongs(q), "trial {trial}: {q} was drawn");
        }
        let share = region.area() / 6000.0;
        let sd = (share * (1.0 - share) / n as f64).sqrt();
        let z = (f64::from(hits) / n as f64 - share) / sd;
        assert!(z.abs() < 4.0, "trial {trial}: area {} of 6000, z = {z}", region.area());
    }
}

/// *Scene*: squares of 10 m side by side, inside some and outside others, whose corners differ from each other by
/// what rounding or another system of coordinates changes. *Expected*: the area of exact squares.
#[test]
fn borders_that_are_nearly_the_same_enclose_nothing() {
    let square = |place: usize, offset: f64, key: Key| {
        let corner = DVec2::new(place as f64 % 4.0, (place / 4) as f64) * 10.0;
        let corners = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].into_iter().zip(0..);
        let ring = corners.map(|(at, index)| {
            let off = DVec2::new(key.uniform(2 * index), key.uniform(2 * index + 1)) - 0.5;
            corner + DVec2::from(at) + offset * off
        });
        Polygon { rings: vec![ring.collect()] }
    };
    for trial in 0..400 {
        let key = Key::new(trial);
        let offset = [0.0, 1e-14, 1e-12, 1e-9][trial as usize % 4];
        let squares = |places: [usize; 6]| {
            let squares = places.into_iter().zip(0..);
            squares.map(|(place, index)| square(place, offset, key.index(index))).collect()
        };
        let inside: Vec<Polygon> = squares([0, 1, 1, 4, 5, 7]);
        let outside: Vec<Polygon> = squares([2, 6, 8, 5, 5, 9]);
        let region = Region::new(TERRAIN, &inside, &outside).expect("a region");
        // Left are the squares 0, 1, 4 and 7.
        assert!(
            (region.area() - 400.0).abs() < 100.0 * offset + 1e-9,
            "{trial}: {}",
            region.area()
        );
    }
}

#[test]
fn a_ring_of_many_corners_has_its_area() {
    let key = Key::new(3);
    let corner = |index: usize| {
        let angle = 2.0 * PI * index as f64 / 3e4;
        let radius = 25.0 + (17.0 * angle).sin() + 0.001 * key.uniform(index as u64);
        DVec2::new(50.0, 30.0) + radius * DVec2::from_angle(angle)
    };
    let ring: Vec<DVec2> = (0..30_000).map(corner).collect();
    let next = ring.iter().cycle().skip(1);
    let center = DVec2::new(50.0, 30.0);
    let area: f64 = ring.iter().zip(next).map(|(a, b)| (a - center).perp_dot(b - center)).sum();
    let star = Polygon { rings: vec![ring] };
    let region = Region::new(TERRAIN, from_ref(&star), &[]).expect("a region");
    assert!((region.area() - 0.5 * area).abs() < 1e-12 * area, "{} {area}", region.area());
    for index in 0..3000 {
        let p = TERRAIN.at(key.uniform(2 * index), key.uniform(2 * index + 1));
        assert_eq!(region.contains(p), is_inside(&star, p), "{p}");
        let cell = Rectangle { min: p, max: p + 2.0 * key.uniform(index) };
        let corners = [cell.min, cell.max, 0.5 * (cell.min + cell.max)];
        let is_met = corners.iter().any(|&corner| is_inside(&star, corner));
        assert!(!is_met || region.may_overlap(cell), "{cell:?}");
        let far = cell.min.distance(center) > 29.1;
        assert!(!far || !region.may_overlap(Rectangle { max: p + 0.01, ..cell }), "{cell:?}");
    }
}

/// Rows of stems often lie on the sides of a polygon.
#[test]
fn of_two_regions_side_by_side_the_upper_one_holds_the_points_between() {
    let band =
        |low: f64| polygon(&[&[(10.0, low), (50.0, low), (50.0, low + 10.0), (10.0, low + 10.0)]]);
    let region = |low: f64| Region::new(TERRAIN, &[band(low)], &[]).expect("a region");
    let between = DVec2::new(20.0, 20.0);
    assert!(!region(10.0).contains(between) && region(20.0).contains(between));
    for x in [10.0, 50.0] {
        assert!(region(10.0).contains(DVec2::new(x, 10.0)), "{x}");
        assert!(!region(10.0).contains(DVec2::new(x, 20.0)), "{x}");
    }
}

#[test]
fn corners_beyond_all_maps_are_refused() {
    for x in [1e10, f64::INFINITY, f64::NAN] {
        let far = polygon(&[&[(10.0, 10.0), (50.0, 10.0), (x, 20.0)]]);
        let error = Region::new(TERRAIN, &[far], &[]).expect_err("far");
        assert!(matches!(error, PlacementError::FarCorner { .. }), "{error}");
    }
}

#[test]
fn a_polygon_that_crosses_itself_is_refused_where_it_does() {
    let bow = polygon(&[&[(10.0, 10.0), (50.0, 50.0), (50.0, 10.0), (10.0, 50.0)]]);
    let square = polygon(&[&[(60.0, 10.0), (70.0, 10.0), (70.0, 20.0), (60.0, 20.0)]]);
    let error = Region::new(TERRAIN, &[square.clone(), bow], &[]).expect_err("a bow tie");
    assert_eq!(error, PlacementError::CrossesItself { polygon: 1, at: DVec2::new(30.0, 30.0) });
    let nothing =
        Region::new(TERRAIN, from_ref(&square), from_ref(&square)).expect_err("no ground");
    assert_eq!(nothing, PlacementError::NoGround);
    let flat = polygon(&[&[(10.0, 10.0), (50.0, 50.0), (20.0, 20.0)]]);
    assert_eq!(Region::new(TERRAIN, &[flat], &[]).expect_err("a line"), PlacementError::NoGround);
}

/// *Scene*: 40 000 uniform stems in a star with corners on the terrain and beyond. *Expected*:
/// counts in 8 x 8 cells follow the cells' shares of the area, by Pearson's χ².
#[test]
fn uniform_stems_are_equally_dense_everywhere() {
    let region = Region::new(TERRAIN, &[star(DVec2::new(40.0, 30.0), 9, Key::new(5))], &[]);
    let region = region.expect("a region");
    let stems = places(&Rule::Uniform, Amount::Count(40_000), &region, TERRAIN, false, Key::new(2));
    let stems = stems.expect("room");
    let mut counts = [0_u32; 64];
    for stem in &stems {
        let cell = (stem / TERRAIN.size() * 8.0).as_usizevec2();
        counts[cell.y * 8 + cell.x] += 1;
    }
    let (mut chi2, mut degrees) = (0.0, -1.0);
    for (cell, &count) in counts.iter().enumerate() {
        let min = TERRAIN.size() * DVec2::new((cell % 8) as f64, (cell / 8) as f64) / 8.0;
        let cell = Rectangle { min, max: min + TERRAIN.size() / 8.0 };
        // The share of a cell, from the region cut to the cell.
        let star = star(DVec2::new(40.0, 30.0), 9, Key::new(5));
        let share = Region::new(cell, &[star], &[]).map_or(0.0, |part| part.area()) / region.area();
        let expected = share * stems.len() as f64;
        if expected < 5.0 {
            continue;
        }
        chi2 += (f64::from(count) - expected).powi(2) / expected;
        degrees += 1.0;
    }
    // χ² is nearly Gaussian for so many degrees of freedom.
    let z = (chi2 - degrees) / (2.0 * degrees).sqrt();
    assert!(degrees > 20.0 && z.abs() < 4.0, "χ² = {chi2} of {degrees}, z = {z}");
}

#[test]
fn stems_per_hectare_hold_for_the_area_where_they_may_stand() {
    let square = polygon(&[&[(10.0, 10.0), (50.0, 10.0), (50.0, 50.0), (10.0, 50.0)]]);
    let region = Region::new(TERRAIN, &[], &[square]).expect("a region");
    let stems = Amount::Density(0.1);
    for rule in [Rule::Uniform, Rule::PoissonDisc { min_distance_m: 1.0 }] {
        let placed = places(&rule, stems, &region, TERRAIN, false, Key::new(1)).expect("room");
        assert_eq!(placed.len(), 440, "{rule:?}");
    }
}

/// Smallest distance of all pairs, in the tile that repeats if `is_periodic`.
fn least_distance(stems: &[DVec2], is_periodic: bool) -> f64 {
    let mut least = f64::INFINITY;
    for (index, a) in stems.iter().enumerate() {
        for b in &stems[..index] {
            let mut offset = (a - b).abs();
            if is_periodic {
                offset = offset.min(TERRAIN.size() - offset);
            }
            least = least.min(offset.length_squared());
        }
    }
    least.sqrt()
}

#[test]
fn the_minimum_distance_is_kept_and_no_place_is_left() {
    let hole = polygon(&[&[(30.0, 20.0), (60.0, 20.0), (60.0, 40.0), (30.0, 40.0)]]);
    let region = Region::new(TERRAIN, &[], &[hole]).expect("a region");
    let rule = Rule::PoissonDisc { min_distance_m: 1.5 };
    let mut counts = Vec::new();
    for is_periodic in [false, true] {
        let stems = places(&rule, Amount::Fill, &region, TERRAIN, is_periodic, Key::new(3));
        let stems = stems.expect("room");
        let least = least_distance(&stems, is_periodic);
        assert!((1.5..1.51).contains(&least), "{least}");
        assert!(stems.iter().all(|&stem| region.contains(stem)));
        counts.push(stems.len());
        let key = Key::new(11);
        for index in 0..20_000 {
            let p = region.sample(key.uniform(2 * index), key.uniform(2 * index + 1));
            let is_free = stems.iter().all(|stem| {
                let mut offset = (stem - p).abs();
                if is_periodic {
                    offset = offset.min(TERRAIN.size() - offset);
                }
                offset.length() >= 1.5
            });
            assert!(!is_free, "{p} is free");
        }
    }
    // Across the border there is less room.
    assert!(counts[0] > counts[1], "{counts:?}");
    // What keeps its distance in the open scene does not across the border.
    let open = places(&rule, Amount::Fill, &region, TERRAIN, false, Key::new(3)).expect("room");
    assert!(least_distance(&open, true) < 1.5);
}

/// *Scene*: a tile filled with discs. *Expected*: the coverage of random sequential addition,
/// 0.54707 (Torquato et al. 2006), within the spread of eight tiles.
#[test]
fn a_full_region_is_covered_as_random_sequential_addition_covers_it() {
    let distance = 0.5;
    let coverage = |seed| {
        let rule = Rule::PoissonDisc { min_distance_m: distance };
        let stems = places(&rule, Amount::Fill, &whole(), TERRAIN, true, Key::new(seed));
        stems.expect("room").len() as f64 * PI * (distance / 2.0).powi(2) / 6000.0
    };
    let all: Vec<f64> = (0..8).map(coverage).collect();
    let mean = all.iter().sum::<f64>() / 8.0;
    let variance = all.iter().map(|c| (c - mean).powi(2)).sum::<f64>() / 7.0;
    // Student's t of 7 degrees of freedom: 5.4 is passed once in a thousand.
    let t = (mean - 0.547_07) / (variance / 8.0).sqrt();
    assert!(t.abs() < 5.4, "mean {mean}, t = {t}");
}

#[test]
fn too_many_stems_at_a_distance_say_how_many_there_can_be() {
    let rule = Rule::PoissonDisc { min_distance_m: 5.0 };
    let error = places(&rule, Amount::Count(400), &whole(), TERRAIN, true, Key::new(1));
    let Err(PlacementError::NoRoom { placed, wanted: 400, at_random, at_most, .. }) = error else {
        panic!("{error:?}");
    };
    assert!((150..190).contains(&placed), "{placed}");
    assert!((at_random - 167.15).abs() < 0.1, "{at_random}");
    assert!((at_most - 277.0).abs() < 1.0, "{at_most}");
    let rule = Rule::PoissonDisc { min_distance_m: 61.0 };
    let error = places(&rule, Amount::Fill, &whole(), TERRAIN, true, Key::new(1));
    assert_eq!(error, Err(PlacementError::TooCloseToItself { distance: 61.0, side: 60.0 }));
    let rule = Rule::PoissonDisc { min_distance_m: 1e-9 };
    let error = places(&rule, Amount::Fill, &whole(), TERRAIN, true, Key::new(1));
    assert!(matches!(error, Err(PlacementError::TooManyStems { .. })), "{error:?}");
    let rule = Rule::Grid { spacing_m: (1e-9, 1.0), row_azimuth_deg: 0.0, jitter_m: 0.0 };
    let error = places(&rule, Amount::Fill, &whole(), TERRAIN, true, Key::new(1));
    assert!(matches!(error, Err(PlacementError::TooManyStems { .. })), "{error:?}");
}

#[test]
fn rows_have_their_spacing_and_azimuth() {
    let place = |azimuth, jitter| {
        let rule = Rule::Grid { spacing_m: (4.0, 2.0), row_azimuth_deg: azimuth, jitter_m: jitter };
        places(&rule, Amount::Fill, &whole(), TERRAIN, false, Key::new(1)).expect("room")
    };
    let north = place(0.0, 0.0);
    assert_eq!(north.len(), 25 * 30);
    assert_eq!(north[..2], [DVec2::new(2.0, 1.0), DVec2::new(2.0, 3.0)]);
    let east = place(90.0, 0.0);
    assert_eq!(east.len(), 50 * 15);
    let turned = place(30.0, 0.0);
    let step = turned[1] - turned[0];
    assert!((step - DVec2::new(1.0, 3_f64.sqrt())).length() < 1e-9, "{step}");
    assert!((turned.len() as f64 - 750.0).abs() < 40.0, "{}", turned.len());
    let jittered = place(0.0, 0.5);
    assert_eq!(jittered.len(), north.len());
    for (moved, place) in jittered.iter().zip(&north) {
        let off = (moved - place).abs().max_element();
        assert!(off > 0.0 && off <= 0.5, "{off}");
    }
}

const FIXED: Distribution = Distribution::Fixed(1.0);
const ANY: Distribution = Distribution::Uniform((0.0, 360.0));

fn habit(scale: &Distribution) -> Habit<'_> {
    Habit {
        yaw_deg: &ANY,
        tilt_deg: &FIXED,
        tilt_azimuth_deg: &ANY,
        height_m: None,
        scale,
        scale_vertical: None,
        sink_m: 0.25,
    }
}

fn species(name: &str, share: f64, prototype: u32) -> Species<'_> {
    Species { name, share, prototype: PrototypeId(prototype), height: 10.0 }
}

fn trees(count: u32, species: &[Species<'_>], habit: &Habit<'_>) -> Vec<Placement> {
    let stems = Amount::Count(count);
    let stems = places(&Rule::Uniform, stems, &whole(), TERRAIN, false, Key::new(4)).expect("room");
    instantiate_trees(&stems, species, habit, |place| Some(0.1 * place.x), Key::new(4))
}

#[test]
fn species_have_their_shares() {
    let all = trees(
        20_000,
        &[species("oak", 2.0, 0), species("birch", 1.0, 1), species("none", 0.0, 2)],
        &habit(&FIXED),
    );
    let oaks = all.iter().filter(|tree| tree.prototype.0 == 0).count() as f64;
    let z = (oaks / 2e4 - 2.0 / 3.0) / (2.0 / 9.0 / 2e4_f64).sqrt();
    assert!(z.abs() < 4.0, "z = {z}");
    assert!(all.iter().all(|tree| tree.prototype.0 < 2));
    assert!(
        all.iter().all(|tree| (tree.position.z - (0.1 * tree.position.x - 0.25)).abs() < 1e-12)
    );
}

#[test]
fn one_more_species_takes_stems_but_moves_none() {
    let two = [species("oak", 2.0, 0), species("birch", 1.0, 1)];
    let three = [species("fir", 1.0, 2), species("birch", 1.0, 1), species("oak", 2.0, 0)];
    let scale = Distribution::Normal { mean: 1.0, sd: 0.2, min: Some(0.5), max: None };
    let (before, after) = (trees(5000, &two, &habit(&scale)), trees(5000, &three, &habit(&scale)));
    let mut taken = 0_u32;
    for (before, after) in before.iter().zip(&after) {
        if after.prototype.0 == 2 {
            taken += 1;
            assert_eq!(Placement { prototype: before.prototype, ..*after }, *before);
        } else {
            assert_eq!(before, after);
        }
    }
    let z = (f64::from(taken) / 5e3 - 0.25) / (0.1875 / 5e3_f64).sqrt();
    assert!(z.abs() < 4.0, "z = {z}");
}

#[test]
fn a_forest_is_the_same_for_any_number_of_threads_and_more_stems_move_none() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let rule = Rule::PoissonDisc { min_distance_m: 0.7 };
            let stems = places(&rule, Amount::Fill, &whole(), TERRAIN, true, Key::new(9));
            let rule = Rule::Grid { spacing_m: (1.0, 1.0), row_azimuth_deg: 20.0, jitter_m: 0.3 };
            let rows = places(&rule, Amount::Fill, &whole(), TERRAIN, true, Key::new(9));
            let own = [species("oak", 2.0, 0), species("birch", 1.0, 1)];
            (stems.expect("room"), rows.expect("room"), trees(3000, &own, &habit(&FIXED)))
        })
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one, on(7));
    let own = [species("oak", 2.0, 0), species("birch", 1.0, 1)];
    assert_eq!(one.2, trees(5000, &own, &habit(&FIXED))[..3000]);
}

/// Mean and variance of a distribution's draws against the closed form, as z-scores.
fn moments(distribution: &Distribution, mean: f64, variance: f64, fourth: f64) -> (f64, f64) {
    let n = 100_000_u64;
    let key = Key::new(8);
    let draws: Vec<f64> =
        (0..n).map(|index| distribution::draw(distribution, key.index(index))).collect();
    let n = n as f64;
    let first = draws.iter().sum::<f64>() / n;
    let second = draws.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n;
    (
        (first - mean) / (variance / n).sqrt(),
        (second - variance) / ((fourth - variance.powi(2)) / n).sqrt(),
    )
}

#[test]
fn distributions_have_their_moments() {
    let normal = Distribution::Normal { mean: 5.0, sd: 2.0, min: None, max: None };
    let uniform = Distribution::Uniform((-1.0, 3.0));
    // Half a Gaussian: mean σ √(2/π), second moment σ², third 2 σ³ √(2/π), fourth 3 σ⁴.
    let half = Distribution::Normal { mean: 0.0, sd: 1.0, min: Some(0.0), max: None };
    let m = (2.0 / PI).sqrt();
    let half_fourth = 3.0 - 4.0 * m * 2.0 * m + 6.0 * m * m - 3.0 * m.powi(4);
    // Cut at ±1 σ: variance 1 - 2 φ(1)/(2 Φ(1) - 1), and the fourth moment likewise.
    let narrow = Distribution::Normal { mean: 0.0, sd: 1.0, min: Some(-1.0), max: Some(1.0) };
    let (density, mass) = ((-0.5_f64).exp() / (2.0 * PI).sqrt(), 0.682_689_492_137_085_9);
    let narrow_second = 1.0 - 2.0 * density / mass;
    let narrow_fourth = 3.0 * narrow_second - 2.0 * density / mass;
    // Mean exp(σ²/2), variance (e^σ² - 1) e^σ².
    let log = Distribution::LogNormal { median: 1.0, sd_ln: 0.3, min: None, max: None };
    let w = 0.09_f64.exp();
    let log_variance = (w - 1.0) * w;
    let log_fourth = log_variance.powi(2) * (w.powi(4) + 2.0 * w.powi(3) + 3.0 * w * w - 3.0);
    for (name, distribution, mean, variance, fourth) in [
        ("normal", normal, 5.0, 4.0, 48.0),
        ("uniform", uniform, 1.0, 4.0 / 3.0, 16.0 / 5.0),
        ("half", half, m, 1.0 - m * m, half_fourth),
        ("narrow", narrow, 0.0, narrow_second, narrow_fourth),
        ("log-normal", log, 0.045_f64.exp(), log_variance, log_fourth),
    ] {
        let (first, second) = moments(&distribution, mean, variance, fourth);
        assert!(first.abs() < 4.0 && second.abs() < 4.0, "{name}: z = {first}, {second}");
    }
    let limits =
        Distribution::LogNormal { median: 1.0, sd_ln: 2.0, min: Some(0.5), max: Some(4.0) };
    for index in 0..10_000 {
        let value = distribution::draw(&limits, Key::new(1).index(index));
        assert!((0.5 - 1e-12..=4.0 + 1e-12).contains(&value), "{value}");
    }
}
