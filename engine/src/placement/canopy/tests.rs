//! Known trees, drawn as a canopy height model and found again.

use glam::DVec2;

use super::*;
use crate::components::PrototypeId;
use crate::sampling::Key;
use crate::terrain::Cells;

const WINDOW: Window = Window { a: 2.51, b: 0.009 };

/// A model of 60 m x 40 m in cells of 0.25 m, at a place of its own.
fn drawn(height: impl Fn(DVec2) -> f64) -> Cells<f64> {
    let (columns, rows) = (240, 160);
    let mut model = Cells {
        columns,
        rows,
        values: vec![0.0; columns * rows],
        corner: DVec2::new(100.0, -50.0),
        size: DVec2::new(60.0, 40.0),
    };
    for index in 0..model.values.len() {
        model.values[index] = height(model.center(index));
    }
    model
}

/// Paraboloids on trunks: place from the corner, height and diameter, m. They touch at most.
const TREES: [(f64, f64, f64, f64); 6] = [
    (8.1, 8.2, 18.0, 7.0),
    (16.0, 9.0, 24.0, 8.5),
    (30.0, 12.0, 9.0, 4.0),
    (34.2, 12.3, 11.0, 4.2),
    (45.0, 30.0, 30.0, 12.0),
    (10.0, 30.0, 4.0, 3.0),
];

fn canopy(place: DVec2) -> f64 {
    let of = |&(x, y, height, diameter): &(f64, f64, f64, f64)| {
        let r = (place - DVec2::new(100.0 + x, y - 50.0)).length() / (0.5 * diameter);
        if r < 1.0 { height * (1.0 - 0.4 * r * r) } else { 0.0 }
    };
    TREES.iter().map(of).fold(0.0, f64::max)
}

#[test]
fn trees_are_found_with_their_heights_and_diameters() {
    // Of the lowest tree only what is above 3 m counts: 1 - 0.4 r² > 3/4 up to r = 0.79.
    let found = crowns(&drawn(canopy), WINDOW, 3.0);
    assert_eq!(found.len(), TREES.len());
    for (index, &(x, y, height, diameter)) in TREES.iter().enumerate() {
        let place = DVec2::new(100.0 + x, y - 50.0);
        let crown = found
            .iter()
            .min_by(|a, b| a.place.distance(place).total_cmp(&b.place.distance(place)))
            .expect("a tree");
        assert!(crown.place.distance(place) < 0.25, "{index}: {crown:?}");
        assert!((crown.height / height - 1.0).abs() < 0.01, "{index}: {crown:?}");
        let visible = if height < 5.0 { 0.625_f64.sqrt() * diameter } else { diameter };
        assert!((crown.diameter / visible - 1.0).abs() < 0.05, "{index}: {crown:?}");
    }
}

#[test]
fn a_level_top_is_one_tree_and_what_is_unknown_is_none() {
    let center = DVec2::new(130.0, -30.0);
    let disc = |place: DVec2| if place.distance(center) < 6.0 { 8.0 } else { f64::NAN };
    let found = crowns(&drawn(disc), WINDOW, 3.0);
    assert_eq!(found.len(), 1);
    assert!(found[0].place.distance(center) < 0.25 && (found[0].diameter - 12.0).abs() < 0.1);
    assert_eq!(crowns(&drawn(|_| f64::NAN), WINDOW, 3.0), []);
    assert_eq!(crowns(&drawn(|_| 2.9), WINDOW, 3.0), []);
    assert_eq!(crowns(&drawn(|_| 9.0), WINDOW, 3.0).len(), 1);
    // Two equal tops in one window are one tree, beyond it two.
    let two = |distance: f64| {
        move |place: DVec2| {
            let near = |x: f64| place.distance(DVec2::new(130.125 + x, -29.875));
            10.0 - near(0.0).min(near(distance))
        }
    };
    assert_eq!(crowns(&drawn(two(1.5)), WINDOW, 3.0).len(), 1);
    assert_eq!(crowns(&drawn(two(2.5)), WINDOW, 3.0).len(), 2);
}

/// *Scene*: every cell of a height of its own at random. *Expected*: tops by brute force over all
/// cells, and crowns that together cover what is high enough and hangs together.
#[test]
fn every_top_is_the_highest_of_its_window_and_crowns_share_out_the_canopy() {
    let key = Key::new(3);
    let noise = drawn(|place| {
        let cell = ((place.x - 100.0) * 4.0) as u64 + 1000 * ((place.y + 50.0) * 4.0) as u64;
        20.0 * key.uniform(cell)
    });
    let tops = tops::tops(&noise, WINDOW, 3.0);
    assert!(tops.len() > 50);
    for (number, &top) in tops.iter().enumerate() {
        let height = noise.values[top];
        let reach = 0.5 * (WINDOW.a + WINDOW.b * height * height);
        let place = noise.center(top);
        let higher = (0..noise.values.len()).find(|&cell| {
            noise.values[cell] > height && noise.center(cell).distance(place) <= reach
        });
        assert_eq!(higher, None, "top {number}");
    }
    let found = crowns(&noise, WINDOW, 3.0);
    let area: f64 = found.iter().map(|c| std::f64::consts::PI * (0.5 * c.diameter).powi(2)).sum();
    let above = noise.values.iter().filter(|&&height| height >= 3.0).count() as f64 * 0.0625;
    // Cells that nothing but lower ones surround belong to no tree.
    assert!(area <= above + 1e-6 && area > 0.95 * above, "{area} of {above}");
}

#[test]
fn the_model_of_the_nearest_ratio_is_scaled_to_the_tree() {
    let model = |id, height, diameter| Model { prototype: PrototypeId(id), height, diameter };
    let models = [model(0, 10.0, 8.0), model(1, 20.0, 4.0)];
    let found = crowns(&drawn(canopy), WINDOW, 3.0);
    let ground: Vec<f64> = found.iter().map(|crown| 0.1 * crown.place.x).collect();
    let trees = fit(&found, &ground, &models, 0.5, Key::new(1));
    let mut used = [0; 2];
    for (tree, crown) in trees.iter().zip(&found) {
        let model = models[tree.prototype.0 as usize];
        used[tree.prototype.0 as usize] += 1;
        let top = tree.position.z + f64::from(tree.scale.vertical) * model.height;
        let ground = 0.1 * crown.place.x;
        assert!((top - ground - crown.height).abs() < 1e-5, "{top}");
        assert!((f64::from(tree.scale.horizontal) * model.diameter - crown.diameter).abs() < 1e-5);
        // Half-way between the ratios 1.25 and 5 is 2.5.
        let ratio = (crown.height + 0.5) / crown.diameter;
        assert_eq!(tree.prototype.0 == 1, ratio > 2.5, "{ratio}");
    }
    assert!(used[0] > 0 && used[1] > 0, "{used:?}");
    assert_eq!(trees, fit(&found, &ground, &models, 0.5, Key::new(1)));
}
