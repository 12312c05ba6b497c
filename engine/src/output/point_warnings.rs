//! Warnings of the points of a sweep, each with the points that it is about.

use indexmap::IndexMap;

use crate::counts::counted;
use crate::products::SweepPoint;

/// Warnings of points of a sweep: equal ones are one text.
#[derive(Clone, Debug, Default)]
pub struct PointWarnings {
    /// By the text of the warning.
    found: IndexMap<String, PointsWithWarning>,
}

/// Points that have the same warning.
#[derive(Clone, Debug)]
struct PointsWithWarning {
    /// Name of the first of them.
    first: String,
    /// Number of the others.
    others: usize,
}

impl PointWarnings {
    /// Adds a warning of a point.
    pub fn add(&mut self, point: &SweepPoint, warning: String) {
        let add = |points: &mut PointsWithWarning| points.others += 1;
        let new = || PointsWithWarning { first: point.name(), others: 0 };
        self.found.entry(warning).and_modify(add).or_insert_with(new);
    }

    /// Removes the warnings for which `keeps` is false.
    pub fn retain(&mut self, mut keeps: impl FnMut(&str) -> bool) {
        self.found.retain(|warning, _| keeps(warning));
    }

    /// Texts of the warnings in the order of their first points: `at sza=60 and 2 more points: ..`.
    pub fn texts(&self) -> impl Iterator<Item = String> {
        self.found.iter().map(|(warning, PointsWithWarning { first, others })| match others {
            0 => format!("at {first}: {warning}"),
            _ => format!("at {first} and {}: {warning}", counted(others, "more point")),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Param;

    #[test]
    fn equal_warnings_are_one_text_and_others_name_their_own_point() {
        let mut all = PointWarnings::default();
        for (sza, warning) in [(0.0, "a"), (30.0, "b"), (60.0, "a"), (75.0, "a"), (80.0, "b")] {
            let params = vec![("sza".to_owned(), Param::Number(sza))];
            let point = SweepPoint { params, key: String::new(), night: None };
            all.add(&point, warning.to_owned());
        }
        let texts: Vec<String> = all.texts().collect();
        assert_eq!(texts, ["at sza=0 and 2 more points: a", "at sza=30 and 1 more point: b"]);
    }
}
