//! A changed scene makes those systems run that depend on the change, and gives the world of a scene that was read anew.

use std::path::Path;

use sunfleck::components::{
    BlackBody, Emission, Instance, InstanceCount, InstanceRange, LeafArea, Mesh, MeshBounds,
    PartMaterials, PlantingAreas, ResolvedSensor, SceneId, ShownMeshes, SkyLight, SunLight,
    SurfaceOptics, TerrainPatch,
};
use sunfleck::document::{ReadOptions, Scene, read_text};
use sunfleck::run::SceneWorld;
use sunfleck::systems::MapFrame;

/// Two crowns and a scatter on soil, in two bands.
const SCENE: &str = r#"Scene(
    format: 1,
    bands: [(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.0)],
    spectra: { "green": Bands([0.05, 0.4]) },
    materials: {
        "soil": Lambertian(reflectance: Bands([0.1, 0.2]), temperature: Uniform(300.0)),
        "leaf": Leaf(reflectance: Named("green"), transmittance: Bands([0.02, 0.4]), temperature: Uniform(295.0)),
        "bark": Lambertian(reflectance: Bands([0.1, 0.3]), temperature: Uniform(296.0)),
    },
    meshes: {
        "crown": Crown(shape: Ellipsoid(diameter_m: 2.0, height_m: 3.0), base_m: 1.0, leaf_area_m2: 4.0,
            leaf: Disc(radius_m: 0.1), leaf_material: "leaf"),
        "slab": Faces(faces_m: [[(0.0, 0.0, 1.0), (1.0, 0.0, 1.0), (0.0, 1.0, 2.0)]], material: "bark"),
    },
    terrain: Plane(size_m: (20.0, 20.0), material: "soil"),
    instances: [
        List(of: "crown", at_m: [(5.0, 5.0, 0.0), (12.0, 5.0, 0.0)]),
        Scatter(of: { "crown": 0.5, "slab": 0.5 }, rule: PoissonDisc(min_distance_m: 3.0), stems: Count(8)),
    ],
    hide: [],
    sun: (zenith_deg: 30.0, azimuth_deg: 90.0, irradiance: Bands([1.0, 1.0])),
    sky: Isotropic(irradiance: Bands([0.1, 0.1])),
    boundary: Periodic,
    sensors: {
        "brf": Directions(views: PrincipalPlane(max_deg: 60.0, step_deg: 15.0)),
        "flux": Photons(per_m2: 10.0, measure: [Albedo, Absorbed(per: Instance)]),
    },
)"#;

fn scene(edits: &[(&str, &str)]) -> Scene {
    let mut text = SCENE.to_owned();
    for (old, new) in edits {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    let reading = read_text("changes.ron", &text, &ReadOptions::default()).expect("a scene");
    assert!(reading.is_sound(), "{}", reading.render());
    reading.scene
}

/// Systems that run when the scene changes by an edit.
fn ran(edit: (&str, &str)) -> Vec<&'static str> {
    let mut world = SceneWorld::from_scene(&scene(&[]), Path::new("")).expect("a world");
    world.set(&scene(&[edit])).expect("a world");
    world.ran
}

#[test]
fn unchanged_scene_runs_no_system() {
    let mut world = SceneWorld::from_scene(&scene(&[]), Path::new("")).expect("a world");
    assert!(world.ran.len() > 20);
    world.set(&scene(&[])).expect("a world");
    assert_eq!(world.ran, [""; 0]);
}

#[test]
fn changed_sun_leaves_meshes_ground_instances_and_optics() {
    let expected = [
        "check_tiles_crossed",
        "resolve_weights",
        "resolve_light",
        "warn_dark_bands",
        "resolve_sensors",
    ];
    assert_eq!(ran(("zenith_deg: 30.0", "zenith_deg: 40.0")), expected);
}

#[test]
fn changed_leaf_spectrum_runs_what_reads_spectra() {
    let named = [
        "resolve_weights",
        "resolve_optics",
        "map_reflectance",
        "resolve_light",
        "warn_dark_bands",
        "resolve_sky_emission",
    ];
    assert_eq!(ran((r#"{ "green": Bands([0.05, "#, r#"{ "green": Bands([0.06, "#)), named);
    let own = ["resolve_optics", "map_reflectance", "resolve_temperatures"];
    assert_eq!(ran(("transmittance: Bands([0.02", "transmittance: Bands([0.03")), own);
}

#[test]
fn moved_planting_leaves_meshes_ground_light_and_optics() {
    let expected = [
        "hide_and_select",
        "plant",
        "check_patterns",
        "count_instances",
        "warn_floating_instances",
        "check_positions",
        "warn_mesh_sizes",
        "warn_implausible_plants",
        "measure_extents",
        "warn_sensor_heights",
        "check_tiles_crossed",
        "find_used_materials",
        "check_absorption_memory",
    ];
    assert_eq!(ran(("(12.0, 5.0, 0.0)", "(13.0, 5.0, 0.0)")), expected);
}

#[test]
fn changed_sensor_runs_what_reads_sensors() {
    let expected = [
        "check_flux_maps",
        "warn_image_footprints",
        "warn_sensor_heights",
        "check_tiles_crossed",
        "warn_dark_bands",
        "resolve_sensors",
        "check_absorption_memory",
    ];
    assert_eq!(ran(("step_deg: 15.0", "step_deg: 20.0")), expected);
}

/// Sorted texts of all derived components and messages of a world.
fn contents(world: &SceneWorld) -> Vec<String> {
    let mut texts = Vec::new();
    macro_rules! list {
        ($($component:ty),+) => {$(
            for (id, value) in &mut world.world.query::<(Option<&SceneId>, &$component)>() {
                texts.push(format!("{}: {id:?} {value:?}", stringify!($component)));
            }
        )+};
    }
    list!(
        BlackBody,
        Emission,
        InstanceCount,
        InstanceRange,
        LeafArea,
        MapFrame,
        Mesh,
        MeshBounds,
        PartMaterials,
        PlantingAreas,
        ResolvedSensor,
        ShownMeshes,
        SkyLight,
        SunLight,
        SurfaceOptics,
        TerrainPatch
    );
    texts.sort();
    texts.extend(Instance::in_order(&world.world).iter().map(|one| format!("{one:?}")));
    let messages = &world.resources.messages;
    texts.extend(messages.diagnostics().map(|one| format!("{one:?}")));
    texts.extend(messages.notes().chain(messages.skipped()).cloned());
    texts.extend(messages.files().iter().map(|file| file.display().to_string()));
    texts.push(format!("{:?}", world.resources.extents));
    texts
}

#[test]
fn changed_world_is_that_of_a_scene_read_anew() {
    let edits = [
        ("zenith_deg: 30.0", "zenith_deg: 89.0"),
        ("hide: []", r#"hide: ["slab"]"#),
        ("hide: []", r#"hide: ["crown"]"#),
        ("center_nm: 865.0", "center_nm: 10500.0"),
        ("measure: [Albedo", "measure: [Exitance"),
        ("(12.0, 5.0, 0.0)", "(12.0, 5.0, 9.0)"),
        ("size_m: (20.0, 20.0)", "size_m: (8.0, 20.0)"),
        ("leaf_area_m2: 4.0", "leaf_area_m2: 400.0"),
        (
            r#""bark": Lambertian"#,
            r#""other": Lambertian(reflectance: Constant(0.1)), "bark": Lambertian"#,
        ),
        ("reflectance: Bands([0.1, 0.3])", "reflectance: Bands([0.1, 0.4])"),
        (r#"material: "bark""#, r#"material: "leaf""#),
        ("boundary: Periodic", "boundary: Isolated"),
        ("sky: Isotropic(irradiance: Bands([0.1, 0.1]))", "sky: None"),
        ("stems: Count(8)", "stems: Count(3)"),
        (
            "stems: Count(8)",
            "stems: Count(8), inside: [Polygon(outline_m: [(1.0, 1.0), (19.0, 1.0), (10.0, 19.0)])]",
        ),
        ("hide: [],", "hide: [], transport: (seed: 7),"),
        (r#"List(of: "crown", at_m: [(5.0, 5.0, 0.0), (12.0, 5.0, 0.0)]),"#, ""),
    ];
    let mut world = SceneWorld::from_scene(&scene(&[]), Path::new("")).expect("a world");
    let all = edits.iter().chain(edits.iter().rev());
    for edit in all {
        let changed = scene(&[*edit]);
        world.set(&changed).unwrap_or_else(|problems| panic!("{edit:?}: {problems:?}"));
        let anew = SceneWorld::from_scene(&changed, Path::new("")).expect("a world");
        assert_eq!(contents(&world), contents(&anew), "{edit:?}");
    }
}

#[test]
fn error_stays_until_its_cause_is_mended() {
    let wrong =
        scene(&[("transmittance: Bands([0.02, 0.4])", "transmittance: Bands([0.02, 0.8])")]);
    let mut world = SceneWorld::new(Path::new(""));
    assert_eq!(world.set(&wrong).expect_err("a leaf gains energy").len(), 1);
    assert_eq!(world.set(&wrong).expect_err("a leaf gains energy").len(), 1);
    world.set(&scene(&[])).expect("a world");
}
