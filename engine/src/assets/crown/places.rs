//! Positions of leaves.

use glam::DVec3;

use super::heights::HeightDistribution;
use super::stream::{Purpose, Stream};
use super::{CrownError, GeneratedCrown, shape, wood};
use crate::document::Clumps;

/// Times that a leaf looks for a place in its clump that is in the crown too.
const ATTEMPTS: u32 = 64;

/// Middles of leaves, above the crown's base.
pub(super) struct Places<'a> {
    crown: &'a GeneratedCrown,
    heights: Option<HeightDistribution>,
    clumps: Option<(&'a Clumps, Vec<DVec3>)>,
}

impl<'a> Places<'a> {
    pub(super) fn new(crown: &'a GeneratedCrown) -> Result<Self, CrownError> {
        let heights = HeightDistribution::new(&crown.shape, &crown.leaf_profile, crown.base_m)?;
        let mut places = Self { crown, heights, clumps: None };
        if let Some(clumps) = &crown.clumps {
            places.clumps = Some((clumps, places.middles(clumps)));
        }
        Ok(places)
    }

    /// Middles of all clumps.
    fn middles(&self, clumps: &Clumps) -> Vec<DVec3> {
        let branches = if clumps.on_branches { wood::branches(self.crown) } else { Vec::new() };
        // As leaves on branches that share a crown: of each branch by its length squared, and of
        // its parts by their distance from the trunk.
        let mut whole = 0.0;
        let up_to: Vec<f64> = branches
            .iter()
            .map(|branch| {
                whole += branch.end.distance_squared(branch.start);
                whole
            })
            .collect();
        let middle = |clump: u32| {
            let random = &mut Stream::new(self.crown.seed, Purpose::Clump, clump.into());
            if branches.is_empty() {
                return self.anywhere(random);
            }
            let wanted = whole * random.uniform();
            let index = up_to.partition_point(|&up_to| up_to <= wanted).min(branches.len() - 1);
            let (start, end) = (branches[index].start, branches[index].end);
            start.lerp(end, random.uniform().sqrt()) - DVec3::Z * self.crown.base_m
        };
        (0..clumps.count).map(middle).collect()
    }

    /// A point that follows the crown's outline and profile.
    fn anywhere(&self, random: &mut Stream) -> DVec3 {
        match &self.heights {
            None => shape::point(&self.crown.shape, random),
            Some(heights) => {
                let z = heights.at(random.uniform());
                shape::point_at(&self.crown.shape, z, random)
            }
        }
    }

    /// The middle of a leaf.
    pub(super) fn of(&self, leaf: u64) -> DVec3 {
        self.draw(leaf, &mut Stream::new(self.crown.seed, Purpose::Position, leaf))
    }

    /// The next place for the middle of a leaf, from its stream of positions.
    pub(super) fn draw(&self, leaf: u64, random: &mut Stream) -> DVec3 {
        let Some((clumps, middles)) = &self.clumps else { return self.anywhere(random) };
        let middle = middles[(leaf % middles.len() as u64) as usize];
        let half_height = clumps.height_m.map_or(clumps.radius_m, |height| 0.5 * height);
        let reach = DVec3::new(clumps.radius_m, clumps.radius_m, half_height);
        for _ in 0..ATTEMPTS {
            let place = middle + reach * in_ball(random);
            if shape::contains(&self.crown.shape, place) {
                return place;
            }
        }
        middle
    }
}

/// A point uniform in the unit ball.
fn in_ball(random: &mut Stream) -> DVec3 {
    loop {
        let mut u = || 2.0 * random.uniform() - 1.0;
        let point = DVec3::new(u(), u(), u());
        if point.length_squared() <= 1.0 {
            return point;
        }
    }
}
