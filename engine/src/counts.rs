//! Numbers of things in messages.

/// Whole number of things.
pub trait Count: Copy {
    /// Returns true if it is 1.
    fn is_one(self) -> bool;
}

macro_rules! count {
    ($($number:ty),*) => {
        $(impl Count for $number {
            fn is_one(self) -> bool {
                self == 1
            }
        })*
    };
}

count!(i32, u32, u64, u128, usize);

impl<C: Count> Count for &C {
    fn is_one(self) -> bool {
        (*self).is_one()
    }
}

/// A number with its noun: `1 cell`, `2 cells`, `0 classes`.
///
/// - `noun`: in the singular, words before it as they are: `more error`
#[must_use]
pub fn counted(count: impl Count + std::fmt::Display, noun: &str) -> String {
    format!("{count} {}", noun_of(count, noun))
}

/// A number of things that exist: `is 1 cell`, `are 2 cells`.
#[must_use]
pub fn existing(count: impl Count + std::fmt::Display, noun: &str) -> String {
    format!("{} {}", agreeing(count, "is", "are"), counted(count, noun))
}

/// The noun of a number of things, without the number: `cell` of 1, `cells` of others.
#[must_use]
pub fn noun_of(count: impl Count, noun: &str) -> String {
    if count.is_one() { noun.to_owned() } else { plural(noun) }
}

/// The word that agrees with a number of things, such as `has` of 1 and `have` of others.
#[must_use]
pub fn agreeing<'a>(count: impl Count, one: &'a str, others: &'a str) -> &'a str {
    if count.is_one() { one } else { others }
}

fn plural(noun: &str) -> String {
    let irregular = match noun {
        "leaf" => "leaves",
        "spectrum" => "spectra",
        "triangle or disc" => "triangles and discs",
        "vertex" => "vertices",
        _ => "",
    };
    if !irregular.is_empty() {
        return irregular.to_owned();
    }
    let is_hissing = ["s", "x", "ch", "sh"].iter().any(|end| noun.ends_with(end));
    match noun.strip_suffix('y') {
        Some(stem) if !stem.ends_with(['a', 'e', 'o', 'u']) => format!("{stem}ies"),
        _ if is_hissing => format!("{noun}es"),
        _ => format!("{noun}s"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nouns_agree_with_their_numbers() {
        let nouns = ["cell", "mesh", "class", "leaf", "vertex", "copy", "ray", "more error"];
        let texts = nouns.map(|noun| [0_usize, 1, 2].map(|count| counted(count, noun)).join(", "));
        let expected = [
            "0 cells, 1 cell, 2 cells",
            "0 meshes, 1 mesh, 2 meshes",
            "0 classes, 1 class, 2 classes",
            "0 leaves, 1 leaf, 2 leaves",
            "0 vertices, 1 vertex, 2 vertices",
            "0 copies, 1 copy, 2 copies",
            "0 rays, 1 ray, 2 rays",
            "0 more errors, 1 more error, 2 more errors",
        ];
        assert_eq!(texts, expected);
        assert_eq!([1_u64, 3].map(|count| agreeing(count, "has", "have")), ["has", "have"]);
        assert_eq!([1_u64, 3].map(|count| existing(count, "cell")), ["is 1 cell", "are 3 cells"]);
        assert_eq!(noun_of(12_u32, "triangle or disc"), "triangles and discs");
    }
}
