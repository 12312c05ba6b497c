//! Broken scenes, and what a person reads about each.

use sunfleck::document::{ReadOptions, read_text};

/// What `sunfleck check` writes.
fn shown(name: &str, text: &str) -> String {
    match read_text(&format!("{name}.ron"), text, &ReadOptions::default()) {
        Ok(reading) => reading.render(),
        Err(error) => format!("error: {error}\n"),
    }
}

macro_rules! broken {
    ($($name:ident)*) => {
        $(#[test]
        fn $name() {
            let name = stringify!($name);
            let text = include_str!(concat!("broken/", stringify!($name), ".ron"));
            insta::assert_snapshot!(name, shown(name, text));
        })*
    };
}

broken! {
    bands
    bracket_closed_wrongly
    bracket_never_closed
    cameras
    comma_missing
    cones_and_layers
    comment_never_closed
    components
    crown
    crown_leaves
    derivative_steps
    derivatives
    directions
    faces
    formulas
    fractions
    image
    last_string_never_closed
    library
    instances
    land_cover_on_a_mesh
    land_cover_on_a_plane
    leaf_as_light
    loops
    missing_keys
    no_bands
    no_hyperspectral_bands
    no_light
    no_thermal_band
    not_a_scene
    numbers
    params
    photons
    placement
    placement_rules
    quoted_key
    rasters_of_trees
    repeated_keys
    responses
    sky_without_sun
    spectra
    string_never_closed
    sweep_of_nothing
    sweep_too_large
    sweep_unused
    sweeps
    systems
    sun_below_the_horizon
    sun_in_no_month
    sun_nowhere
    sun_on_the_horizon
    sun_position
    terrain
    text_behind_the_scene
    thermal
    unit_behind_a_number
    unknown_key
    unknown_names
    unknown_sensor
    unknown_variants
    variants_written_wrongly
    virtual_planes
    windows_path
    wrong_kinds
}
