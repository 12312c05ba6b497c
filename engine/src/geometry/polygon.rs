use glam::DVec2;

/// A polygon on the ground: an outline and its holes, each a ring of corners, m. The last corner of
/// a ring is joined to the first. A point is inside if a ray from it crosses the rings an odd number
/// of times, so the sense of turning is of no account.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygon {
    /// The outline, then the holes.
    pub rings: Vec<Vec<DVec2>>,
}

impl Polygon {
    /// Returns whether a point lies inside; points on the rings do or do not.
    #[must_use]
    pub fn contains(&self, point: DVec2) -> bool {
        let mut is_inside = false;
        for ring in &self.rings {
            let mut previous = ring.last().copied().unwrap_or_default();
            for &corner in ring {
                if (previous.y > point.y) != (corner.y > point.y) {
                    let fraction = (point.y - previous.y) / (corner.y - previous.y);
                    is_inside ^= point.x < previous.x + (corner.x - previous.x) * fraction;
                }
                previous = corner;
            }
        }
        is_inside
    }

    /// Smallest rectangle around the corners, if there are any.
    #[must_use]
    pub fn bounds(&self) -> Option<Rectangle> {
        Rectangle::around(self.rings.iter().flatten().copied())
    }
}

/// A rectangle on the ground, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// South-west corner, m.
    pub min: DVec2,
    /// North-east corner, m.
    pub max: DVec2,
}

impl Rectangle {
    /// Smallest rectangle around some points, if there are any.
    pub fn around(points: impl IntoIterator<Item = DVec2>) -> Option<Self> {
        let bounds = points.into_iter().map(|point| Self { min: point, max: point });
        bounds.reduce(|a, b| Self { min: a.min.min(b.min), max: a.max.max(b.max) })
    }

    /// Returns whether a point lies inside or on a side.
    #[must_use]
    pub fn contains(self, point: DVec2) -> bool {
        point.cmpge(self.min).all() && point.cmple(self.max).all()
    }

    /// Returns whether it shares an area with another rectangle.
    #[must_use]
    pub fn overlaps(self, other: Self) -> bool {
        self.min.cmplt(other.max).all() && other.min.cmplt(self.max).all()
    }

    /// Extent to the east and to the north, m.
    #[must_use]
    pub fn size(self) -> DVec2 {
        self.max - self.min
    }

    /// The point at these fractions of its sides.
    #[must_use]
    pub fn at(self, u: f64, v: f64) -> DVec2 {
        self.min + self.size() * DVec2::new(u, v)
    }
}

impl From<Rectangle> for Polygon {
    fn from(Rectangle { min, max }: Rectangle) -> Self {
        Self { rings: vec![vec![min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)]] }
    }
}
