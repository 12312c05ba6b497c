//! `sunfleck fmt`: the layout changes, and nothing else; `sunfleck expand`: nothing but the text.

use proptest::prelude::*;
use sunfleck::document::{ReadOptions, format, read_text};

const DESIGN: &str = include_str!("design.ron");

/// Comments wherever they may stand, and every layout that nobody likes.
const MESSY: &str = r#"#![enable(implicit_some)]
// A scene.

/* of two
   lines */ Scene ( // behind the bracket
  format:1,title :"mess" , // behind the title


  // above the params

  params:{"sza":30.0,/* inside */"b":"=sza/2"},
  bands: [ ( name:"red",center_nm : 660.0 ), (name: "nir", center_nm: 865.0,),
  ], materials : {
    "soil": /* odd */ Lambertian /* odder */ ( reflectance: Bands( // values
        [0.10,2e-1 , ]) ), "leaf": Lambertian(reflectance: Constant(0x1)), // behind a map's last
    // at the end
  }, /* own */ /* line */
  terrain: Plane(
     size_m: (10, 10), material: "soil"),
  sun: (zenith_deg: "=sza"), sensors: {
        "a": Photons,
        "b": Directions(views: List([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0), (4.0, 0.0), (5.0, 0.0), (6.0, 0.0), (7.0, 0.0), (8.0, 0.0), (9.0, 0.0)])),
  } // behind the sensors
  // last
) // behind all
// the end"#;

fn formatted(text: &str) -> String {
    format("scene.ron", text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn letters(text: &str) -> String {
    text.chars().filter(|c| !c.is_whitespace() && *c != ',').collect()
}

#[test]
fn a_mess_has_a_normal_form() {
    let once = formatted(MESSY);
    insta::assert_snapshot!("normal_form", once);
    assert_eq!(formatted(&once), once);
}

#[test]
fn the_example_scenes_keep_their_values_and_comments() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).expect("scenes") {
        let path = entry.expect("a file").path();
        if path.extension().is_none_or(|extension| extension != "ron") {
            continue;
        }
        let text = std::fs::read_to_string(&path).expect("a text");
        let once = formatted(&text);
        assert_eq!(letters(&once), letters(&text), "{}", path.display());
        assert_eq!(formatted(&once), once, "{}", path.display());
        count += 1;
    }
    assert!(count > 1, "{count}");
}

#[test]
fn what_is_written_is_in_normal_form() {
    let scene = read_text("scene.ron", DESIGN, &ReadOptions::default()).expect("a scene").scene;
    // But for groups that have no room, and whose last comma then keeps them apart.
    assert_eq!(formatted(&scene.to_ron()), scene.to_ron());
}

#[test]
fn an_expanded_scene_says_where_its_values_come_from() {
    let options =
        ReadOptions { set: vec![("sza".to_owned(), 60.0.into())], ..ReadOptions::default() };
    let reading = read_text("scene.ron", DESIGN, &options).expect("a scene");
    let text = reading.expanded();
    insta::assert_snapshot!("expanded", text);
    let again = read_text("again.ron", &text, &ReadOptions::default()).expect("a scene");
    assert!(again.diagnostics.is_empty(), "{}", again.render());
    assert_eq!(again.scene, reading.scene.resolved());
}

/// A comment in any gap between words.
fn commented() -> impl Strategy<Value = String> {
    let pieces: Vec<&str> =
        MESSY.split_inclusive(['(', ',', ':', ')', '{', '}', '[', ']']).collect();
    let comment = prop::sample::select(vec![
        "",
        "",
        "",
        "// x\n",
        "/* y */",
        "\n\n\n",
        "/* z\n */",
        " // é\n\n",
    ]);
    prop::collection::vec(comment, pieces.len()).prop_map(move |comments| {
        pieces.iter().zip(comments).flat_map(|(piece, comment)| [*piece, comment]).collect()
    })
}

proptest! {
    #[test]
    fn no_comment_is_lost_and_formatting_twice_is_formatting_once(text in commented()) {
        // A comment may have come into the middle of another.
        let Ok(once) = format("scene.ron", &text) else { return Ok(()) };
        let marks = |text: &str| {
            let mut letters: Vec<char> = letters(text).chars().collect();
            letters.sort_unstable();
            letters
        };
        let is_whole = marks(&once) == marks(&text);
        prop_assert!(is_whole, "{}\n---\n{}", text, once);
        let twice = format("scene.ron", &once);
        prop_assert_eq!(&twice.expect("a text"), &once, "{}", text);
    }
}

#[test]
fn an_optional_pair_keeps_its_own_brackets() {
    let text = "Scene(\n    a: Some((1.0, 2.0)),\n    b: Uniform(1.0, 2.0),\n)\n";
    assert_eq!(formatted(text), text);
    assert_eq!(formatted("Scene(\n a: Some((1.0, 2.0)),\n b: Uniform((1.0, 2.0)),\n)\n"), text);
}
