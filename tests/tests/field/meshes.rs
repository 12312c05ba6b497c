//! Meshes: OBJ, glTF and polygons as people have them.

use sunfleck::products::Report;
use sunfleck::run::{Options, Unwatched, check_file, run_file};
use sunfleck_tests::field::Right::{Fails, Value, Warns};
use sunfleck_tests::field::{Case, Right, folder, hold};

/// The black mesh over black soil absorbs this in the first of two bands [W nm⁻¹]: the area of its
/// shadow below a sun at the zenith [m²].
const fn absorbs(value: f64) -> Right {
    Value { sensor: "alb", product: "absorbed_by_instance", index: 2, value, within: 0.0 }
}

const fn value(
    sensor: &'static str,
    product: &'static str,
    index: usize,
    value: f64,
    within: f64,
) -> Right {
    Value { sensor, product, index, value, within }
}

const fn case(scene: &'static str, right: &'static [Right]) -> Case<'static> {
    Case { scene, right }
}

#[test]
fn comments_may_end_any_line_of_an_obj() {
    const CASES: &[Case<'_>] = &[
        case("01-obj-inline-comment/face.ron", &[absorbs(4.0)]),
        case("01-obj-inline-comment/glued.ron", &[absorbs(4.0)]),
        case("01-obj-inline-comment/group.ron", &[absorbs(4.0)]),
        case("01-obj-inline-comment/usemtl_parts.ron", &[absorbs(4.0)]),
        case("01-obj-inline-comment/vertex.ron", &[absorbs(4.0)]),
        case("01-obj-inline-comment/near_names.ron", &[absorbs(4.0)]),
        case("01-obj-inline-comment/near_continued.ron", &[absorbs(4.0)]),
    ];
    hold(CASES);
}

#[test]
fn colours_of_vertices_change_no_shape() {
    const CASES: &[Case<'_>] = &[
        case("02-obj-vertex-colours/rgb.ron", &[absorbs(4.0)]),
        case("02-obj-vertex-colours/rgba255.ron", &[absorbs(4.0)]),
        case("02-obj-vertex-colours/nan_colour.ron", &[absorbs(4.0)]),
        case("02-obj-vertex-colours/mrgb.ron", &[absorbs(4.0)]),
        case("02-obj-vertex-colours/weight_two.ron", &[absorbs(16.0)]),
        case("02-obj-vertex-colours/near_some_coloured.ron", &[absorbs(4.0)]),
        case("02-obj-vertex-colours/near_weight_zero.ron", &[absorbs(4.0)]),
    ];
    hold(CASES);
}

#[test]
fn polygons_keep_their_area() {
    const CASES: &[Case<'_>] = &[
        case("03-obj-ngon-slit-hole/L_closed.ron", &[absorbs(5.0)]),
        case("03-obj-ngon-slit-hole/L_closed_turned.ron", &[absorbs(5.0)]),
        case("03-obj-ngon-slit-hole/L_turned2.ron", &[absorbs(5.0)]),
        case("03-obj-ngon-slit-hole/clockwise_L.ron", &[absorbs(5.0)]),
        case("03-obj-ngon-slit-hole/near_dup.ron", &[absorbs(5.0)]),
        case("03-obj-ngon-slit-hole/closed.ron", &[absorbs(4.0)]),
        case("03-obj-ngon-slit-hole/collinear.ron", &[absorbs(4.0)]),
        case("03-obj-ngon-slit-hole/repeat.ron", &[absorbs(4.0)]),
        case("03-obj-ngon-slit-hole/slit_dup.ron", &[absorbs(12.0)]),
        case("03-obj-ngon-slit-hole/slit_shared.ron", &[absorbs(12.0)]),
        case("03-obj-ngon-slit-hole/star.ron", &[absorbs(6.282)]),
    ];
    hold(CASES);
}

#[test]
fn spikes_of_outlines_have_no_area() {
    const CASES: &[Case<'_>] = &[
        case("03-obj-ngon-slit-hole/spike.ron", &[absorbs(4.0)]),
        case("03-obj-ngon-slit-hole/spike_inward.ron", &[absorbs(4.0)]),
        case("03-obj-ngon-slit-hole/spike_short.ron", &[absorbs(4.0)]),
        case("03-obj-ngon-slit-hole/spike_turned.ron", &[absorbs(4.0)]),
        case("03-obj-ngon-slit-hole/faces_spike.ron", &[absorbs(4.0)]),
        case("03-obj-ngon-slit-hole/thin_spike.ron", &[absorbs(4.001)]),
        case("03-obj-ngon-slit-hole/near_spike_corner.ron", &[absorbs(4.0)]),
        case("03-obj-ngon-slit-hole/near_leaf_stalk.ron", &[absorbs(2.0)]),
        case("03-obj-ngon-slit-hole/near_faces_tilted.ron", &[absorbs(4.0)]),
    ];
    hold(CASES);
}

#[test]
fn outlines_that_cross_themselves_enclose_once() {
    const CASES: &[Case<'_>] = &[
        case(
            "03-obj-ngon-slit-hole/bowtie.ron",
            &[absorbs(2.0), Warns(&["crosses itself", "first: line 5", "check the order"])],
        ),
        case(
            "03-obj-ngon-slit-hole/near_star_of_crossings.ron",
            &[absorbs(1.12257), Warns(&["crosses itself", "first: line 6"])],
        ),
    ];
    hold(CASES);
}

#[test]
fn leaves_that_are_there_twice_count_once() {
    const ONCE: &[Right] = &[
        value("v", "brf", 0, 0.4, 0.0),
        value("vf", "brf", 0, 0.4, 0.0),
        value("alb", "absorbed_by_instance", 1, 12.8, 0.0),
        value("an", "absorbed_by_instance", 1, 12.8, 0.0),
    ];
    const CASES: &[Case<'_>] = &[
        case("04-obj-two-sided-duplicate/one.ron", ONCE),
        case("04-obj-two-sided-duplicate/same.ron", ONCE),
        case("04-obj-two-sided-duplicate/three.ron", ONCE),
        case("04-obj-two-sided-duplicate/near_reversed.ron", ONCE),
        case("04-obj-two-sided-duplicate/near_split.ron", ONCE),
        case("04-obj-two-sided-duplicate/near_own_vertices.ron", ONCE),
        // 0.4 + 0.4³ / (1 - 0.16), less what leaves through the slit of 1 cm around the two.
        case("04-obj-two-sided-duplicate/sep1cm.ron", &[value("v", "brf", 0, 0.4762, 0.0008)]),
    ];
    hold(CASES);
}

#[test]
fn encodings_and_line_ends() {
    const CASES: &[Case<'_>] = &[
        case("06-obj-gbk-names/cr_crlf_mix.ron", &[absorbs(4.0)]),
        case("06-obj-gbk-names/utf8.ron", &[absorbs(4.0)]),
        case("06-obj-gbk-names/near_comment_gbk.ron", &[absorbs(4.0)]),
        // Of leaves, which absorb 85 %.
        case("06-obj-gbk-names/cr.ron", &[absorbs(3.4)]),
        case("06-obj-gbk-names/cr_comment.ron", &[absorbs(3.4)]),
        case("06-obj-gbk-names/mtllib.ron", &[absorbs(3.4)]),
        case("06-obj-gbk-names/group.ron", &[Fails(&["group.obj:5", "GBK", "UTF-8"])]),
        case("06-obj-gbk-names/latin1.ron", &[Fails(&["latin1.obj:5", "Latin-1", "UTF-8"])]),
        case("06-obj-gbk-names/near_usemtl_latin1.ron", &[Fails(&["latin1.obj:5", "Latin-1"])]),
    ];
    hold(CASES);
}

#[test]
fn extensions_of_nodes_are_read_or_told() {
    const CASES: &[Case<'_>] = &[
        case("07-gltf-gpu-instancing/used.ron", &[absorbs(4.0)]),
        case("07-gltf-gpu-instancing/required.ron", &[absorbs(4.0)]),
        case(
            "07-gltf-gpu-instancing/node_visibility.ron",
            &[absorbs(1.0), Warns(&["hidden nodes", "left out"])],
        ),
        case("07-gltf-gpu-instancing/lod.ron", &[absorbs(1.0)]),
        case("07-gltf-gpu-instancing/second_scene.ron", &[absorbs(4.0)]),
        // 4 m² that lean by 60° and 1 m².
        case("07-gltf-gpu-instancing/near_turned_and_scaled.ron", &[absorbs(3.0)]),
        case("07-gltf-gpu-instancing/near_hidden_parent.ron", &[absorbs(1.0)]),
        case(
            "07-gltf-gpu-instancing/near_unknown.ron",
            &[absorbs(1.0), Warns(&["ACME_bend", "is not read"])],
        ),
        case("07-gltf-gpu-instancing/near_draco.ron", &[Fails(&["KHR_draco", "without it"])]),
    ];
    hold(CASES);
}

#[test]
fn transparency_is_told_with_its_area() {
    const CASES: &[Case<'_>] = &[
        case(
            "08-leaf-cards-alpha/mask.ron",
            &[
                absorbs(1.0),
                Warns(&["transparency", "`leaf` (alphaMode MASK)", "1.0000 m² of 1.0000"]),
            ],
        ),
        case(
            "08-leaf-cards-alpha/blend.ron",
            &[absorbs(1.0), Warns(&["transparency", "alphaMode BLEND", "(100.0 %)"])],
        ),
        case(
            "08-leaf-cards-alpha/factor.ron",
            &[absorbs(1.0), Warns(&["transparency", "`glass` (alphaMode BLEND, alpha 0.2)"])],
        ),
        case(
            "08-leaf-cards-alpha/card.ron",
            &[absorbs(4.0), Warns(&["transparency", "`leaf` (map_d leafcard.png)", "4.0000 m²"])],
        ),
        case(
            "08-leaf-cards-alpha/near_dissolve.ron",
            &[absorbs(4.0), Warns(&["`glass pane` (d 0.25)", "2.0000 m² of 4.0000 m² (50.0 %)"])],
        ),
        case(
            "08-leaf-cards-alpha/near_vertex_alpha.ron",
            &[absorbs(1.0), Warns(&["`leaf` (alphaMode MASK)"])],
        ),
        case("08-leaf-cards-alpha/near_opaque.ron", &[absorbs(1.0)]),
    ];
    hold(CASES);
}

#[test]
fn files_of_other_formats_are_named() {
    const CASES: &[Case<'_>] = &[
        case("39-other-mesh-formats/tree_ply_Obj.ron", &[Fails(&["PLY", "write `Ply`"])]),
        case("39-other-mesh-formats/tree_bin_ply_Obj.ron", &[Fails(&["PLY", "write `Ply`"])]),
        case("39-other-mesh-formats/tree_ply_Discs.ron", &[Fails(&["PLY", "`Discs`"])]),
        case(
            "39-other-mesh-formats/tree_stl_Obj.ron",
            &[Fails(&["STL", "convert it to PLY", "unit_m"])],
        ),
        case("39-other-mesh-formats/tree_fbx_Obj.ron", &[Fails(&["FBX", "convert it to OBJ"])]),
        case("39-other-mesh-formats/tree_obj_gz_Obj.ron", &[Fails(&["gzip", "unpack it"])]),
        case("39-other-mesh-formats/tree_gltf1_Gltf.ron", &[Fails(&["glTF 1.0", "glTF 2.0"])]),
        case("39-other-mesh-formats/obj_as_glb_Gltf.ron", &[Fails(&["Wavefront OBJ", "`Obj`"])]),
        case("39-other-mesh-formats/near_dae_Obj.ron", &[Fails(&["COLLADA", "convert it"])]),
        case("39-other-mesh-formats/near_gltf_Obj.ron", &[Fails(&["glTF", "write `Gltf`"])]),
        case("39-other-mesh-formats/near_skp_Gltf.ron", &[Fails(&["SketchUp", "by its name"])]),
    ];
    hold(CASES);
}

#[test]
fn what_blends_nothing_is_not_told() {
    let path = folder().join("08-leaf-cards-alpha/near_opaque.ron");
    let warnings = check_file(&path, &Options::default()).map_err(|failure| failure.to_string());
    let warnings = warnings.expect("a sound scene");
    assert!(!warnings.iter().any(|warning| warning.contains("transparency")), "{warnings:?}");
}

/// Mean of an image's product in the last of its bands.
fn mean(report: &Report, name: &str, bands: usize) -> f64 {
    let product = report.sensors[0].products.iter().find(|product| product.name == name);
    let values = &product.expect("a product of the scene").values;
    let last: Vec<f64> = values.iter().skip(bands - 1).step_by(bands).copied().collect();
    last.iter().sum::<f64>() / last.len() as f64
}

#[test]
fn a_tree_of_small_leaves_is_the_same_in_any_corner_of_100_km() {
    let means = |name: &str| {
        let path = folder().join("43-tiny-leaf-in-large-scene").join(name);
        match run_file(&path, &Options::default(), &Unwatched) {
            Ok(report) => [mean(&report, "gap_fraction", 1), mean(&report, "brf", 2)],
            Err(failure) => panic!("{failure}"),
        }
    };
    // Four standard errors of 0.00035 each.
    for name in
        ["small.ron", "km1.ron", "km100.ron", "high.ron", "near_below_sea.ron", "near_west.ron"]
    {
        let gap = means(name)[0];
        assert!((gap - 0.88457).abs() < 0.0014, "{name}: {gap}");
    }
    let [near, far] = ["km1.ron", "km100_frac.ron"].map(|name| means(name)[1]);
    assert!((near - 0.4572).abs() < 0.0014, "{near}");
    assert!((near - far).abs() < 0.002, "{near} {far}");
}

#[test]
fn gaps_do_not_depend_on_the_size_of_leaves() {
    /// exp(-0.5) and exp(-1), and how much one crown of finite leaves differs from the mean of all.
    const fn gaps(within: f64) -> [Right; 2] {
        [
            value("d", "gap_fraction", 0, 0.6065, within),
            value("d", "gap_fraction", 1, 0.3679, within),
        ]
    }
    const LARGE: [Right; 2] = gaps(0.006);
    const SMALL: [Right; 2] = gaps(0.0);
    const CASES: &[Case<'_>] = &[
        case("44-needles/r0.02.ron", &LARGE),
        case("44-needles/r0.002.ron", &SMALL),
        case("44-needles/r0.0005.ron", &SMALL),
        case("44-needles/near_square.ron", &SMALL),
        case("44-needles/near_needle.ron", &SMALL),
    ];
    hold(CASES);
}

/// What `check` says of a scene with an OBJ file of 20 000 groups in two materials.
fn checked(keys: &str) -> Result<Vec<String>, String> {
    use std::fmt::Write as _;
    let mut obj = String::from("v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    for group in 0..20_000 {
        let material = if group % 2 == 0 { "green" } else { "brown" };
        let _infallible = writeln!(obj, "g leaf_{group}\nusemtl {material}\nf 1 2 3");
    }
    checked_file(&obj, keys)
}

/// What `check` says of a scene with an OBJ file and keys for its parts.
fn checked_file(obj: &str, keys: &str) -> Result<Vec<String>, String> {
    let scene = std::fs::read_to_string(folder().join("01-obj-inline-comment/face.ron"));
    let scene = scene.expect("a scene of this test");
    let scene = scene.replace(r#"file: "face.obj""#, r#"file: "groups.obj""#);
    let scene = scene.replace(r#"material: "black")"#, keys);
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("groups.obj"), obj).expect("a file");
    let path = folder.path().join("groups.ron");
    std::fs::write(&path, scene).expect("a file");
    check_file(&path, &Options::default()).map_err(|failure| failure.to_string())
}

#[test]
fn thousands_of_groups_are_named_by_patterns_or_materials() {
    for keys in [
        r#"parts: { "leaf_*": "black" })"#,
        r#"parts: { "*_7": "leaf", "leaf_1*": "leaf", "*": "black" })"#,
        r#"parts: { "leaf_7": "leaf" }, material: "black")"#,
        r#"parts_by: Material, parts: { "green": "leaf", "brown": "black" })"#,
        r#"parts_by: Material, parts: { "gr*n": "leaf" }, material: "black")"#,
    ] {
        // The scene itself warns of its floating square.
        let warnings = checked(keys).expect(keys);
        assert!(!warnings.iter().any(|warning| warning.contains("groups.obj:")), "{warnings:?}");
    }
    for (keys, expected) in [
        (
            r#"parts: { "leaf_7": "black" })"#,
            &["19999 parts have no material: `leaf_0`", "and 19989 more", "parts_by: Material"][..],
        ),
        (r#"parts: { "leef_*": "black" }, material: "black")"#, &["no part `leef_*`"]),
        (r#"parts: { "leaf_20000": "black" }, material: "black")"#, &["no part `leaf_20000`"]),
        (r#"parts_by: Material, parts: { "green": "black" })"#, &["part `brown` has no material"]),
        (r#"parts_by: Materials, material: "black")"#, &["Materials", "did you mean `Material`"]),
    ] {
        let message = checked(keys).expect_err(keys);
        assert!(expected.iter().all(|part| message.contains(part)), "{keys}: {message}");
        assert!(message.len() < 3000, "{keys}: {} bytes", message.len());
    }
}

/// *File*: one object in two materials, as Blender writes a tree. *Expected*: who names the materials gets one error with
/// the key that makes them parts.
#[test]
fn materials_in_place_of_groups_are_one_error() {
    let obj = "o Tree\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl bark\nf 1 2 3\nusemtl leaves\nf 1 2 4\n";
    let message = checked_file(obj, r#"parts: { "leaves": "leaf", "bark": "black" })"#)
        .expect_err("groups are the parts");
    assert_eq!(message.matches("error:").count(), 1, "{message}");
    for part in [
        "`parts` has names of materials (`usemtl`), and the parts of the file are groups: `Tree/bark`, `Tree/leaves`",
        "write parts_by: Material",
    ] {
        assert!(message.contains(part), "{message}");
    }
    let keys = r#"parts_by: Material, parts: { "leaves": "leaf", "bark": "black" })"#;
    checked_file(obj, keys).expect("materials are the parts");
}
