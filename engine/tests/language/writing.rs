//! Writing: whatever a scene holds, what is read back is equal.

use indexmap::IndexMap;
use proptest::prelude::*;
use sunfleck::document::{
    Area, Axis, Band, BandSource, Boundary, Coating, Cover, DerivativeSteps, Directions,
    Distribution, Ends, FileFormat, Fisheye, FisheyeProjection, Frame, Gltf, ImageMeasure,
    ImageOptions, InstanceList, InstanceTable, Instances, Lambertian, Layers, Leaf, Look, Map,
    Material, Obj, Origin, Orthographic, Param, PartsBy, Per, Perspective, PhotonMeasure, Photons,
    Picture, Ply, Prospect, Prototype, RasterBands, ReadOptions, ReflectanceMap, Response,
    Roulette, Rpv, Rule, Scatter, Scene, Sensor, Sky, SoilMixture, Soilspect, Spa, SpeciesMeshes,
    Spectrum, SpectrumFile, Stems, StopCriterion, Sun, SunPosition, Sweep, System,
    TableCoordinates, TabulatedSpectrum, Temperature, Terrain, TerrainPlane, ThermalSky, Transport,
    ValueUnit, Views, VirtualPlane, WavelengthUnit, read_file, read_text,
};

use crate::crowns::crown;

pub(crate) fn number() -> impl Strategy<Value = f64> {
    use prop::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    prop_oneof![0.0..100.0_f64, POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO]
}

/// Texts, also as names of definitions and as paths.
pub(crate) fn text<T: From<String> + std::fmt::Debug>() -> impl Strategy<Value = T> {
    prop_oneof!["[a-z]{0,8}", "=[a-z]{0,8}", any::<String>()].prop_map(T::from)
}

pub(crate) fn list<T: std::fmt::Debug>(
    of: impl Strategy<Value = T>,
) -> impl Strategy<Value = Vec<T>> {
    prop::collection::vec(of, 0..4)
}

fn map<T: std::fmt::Debug>(of: impl Strategy<Value = T>) -> impl Strategy<Value = Map<T>> {
    list((text(), of)).prop_map(IndexMap::from_iter)
}

pub(crate) fn option<T: std::fmt::Debug>(
    of: impl Strategy<Value = T>,
) -> impl Strategy<Value = Option<T>> {
    prop::option::of(of)
}

fn param() -> impl Strategy<Value = Param> {
    prop_oneof![number().prop_map(Param::Number), text().prop_map(Param::Text)]
}

fn spectrum() -> BoxedStrategy<Spectrum> {
    prop_oneof![
        number().prop_map(Spectrum::Constant),
        prop::collection::vec(number(), 0..60).prop_map(Spectrum::Bands),
        prop::collection::vec((number(), number()), 0..20).prop_map(Spectrum::Points),
        (
            (text(), option(text()), option(text()), option(text())),
            (
                option(prop::sample::select(WavelengthUnit::ALL.to_vec())),
                option(prop_oneof![Just(ValueUnit::Fraction), Just(ValueUnit::Percent)]),
                number()
            )
        )
            .prop_map(
                |((file, wavelength, value, wavelengths), (wavelength_unit, unit, scale))| {
                    let source =
                        SpectrumFile { file, wavelength, value, wavelength_unit, wavelengths };
                    Spectrum::Table(TabulatedSpectrum { source, unit, scale })
                }
            ),
        Just(Spectrum::AstmG173),
        Just(Spectrum::AstmE490),
        text().prop_map(Spectrum::Library),
        (number(), number())
            .prop_map(|(dryness, brightness)| Spectrum::Soil(SoilMixture { dryness, brightness })),
        text().prop_map(Spectrum::Named),
        ((number(), number(), number(), number()), (number(), number(), number(), number()))
            .prop_map(
                |((n, chlorophyll_ug_cm2, carotenoid_ug_cm2, anthocyanin_ug_cm2), (a, b, c, d))| {
                    Spectrum::Prospect(Prospect {
                        n,
                        chlorophyll_ug_cm2,
                        carotenoid_ug_cm2,
                        anthocyanin_ug_cm2,
                        brown: a,
                        water_cm: b,
                        dry_matter_g_cm2: c,
                        protein_g_cm2: d,
                        carbon_g_cm2: a,
                    })
                }
            ),
    ]
    .boxed()
}

fn material() -> BoxedStrategy<Material> {
    prop_oneof![
        (spectrum(), option(spectrum()), option(temperature())).prop_map(
            |(reflectance, back_reflectance, temperature)| {
                Material::Lambertian(Lambertian { reflectance, back_reflectance, temperature })
            }
        ),
        (spectrum(), spectrum(), option(spectrum()), option(coating()), option(temperature()))
            .prop_map(|(reflectance, transmittance, back_reflectance, coating, temperature)| {
                Material::Leaf(Leaf {
                    reflectance,
                    transmittance,
                    back_reflectance,
                    coating,
                    temperature,
                })
            }),
        (spectrum(), spectrum(), spectrum(), option(spectrum()), option(temperature())).prop_map(
            |(rho0, k, asymmetry, rho_c, temperature)| {
                Material::Rpv(Rpv { rho0, k, asymmetry, rho_c, temperature })
            }
        ),
        (
            (spectrum(), spectrum(), spectrum()),
            (spectrum(), spectrum(), spectrum(), spectrum()),
            option(temperature())
        )
            .prop_map(
                |((albedo, roughness, hot_spot), (b, c, b_prime, c_prime), temperature)| {
                    Material::Soilspect(Soilspect {
                        albedo,
                        roughness,
                        hot_spot,
                        b,
                        c,
                        b_prime,
                        c_prime,
                        temperature,
                    })
                }
            ),
        (
            (text(), raster_bands(), option(number()), number()),
            (option(spectrum()), option(temperature()))
        )
            .prop_map(|((file, bands, scale, offset), (elsewhere, temperature))| {
                Material::ReflectanceMap(ReflectanceMap {
                    file,
                    bands,
                    scale,
                    offset,
                    elsewhere,
                    temperature,
                })
            }),
    ]
    .boxed()
}

fn raster_bands() -> BoxedStrategy<RasterBands> {
    prop_oneof![
        param().prop_map(RasterBands::All),
        map(param()).prop_map(RasterBands::Each),
        Just(RasterBands::Wavelengths),
    ]
    .boxed()
}

fn coating() -> BoxedStrategy<Coating> {
    (number(), number())
        .prop_map(|(refractive_index, roughness)| Coating { refractive_index, roughness })
        .boxed()
}

fn temperature() -> BoxedStrategy<Temperature> {
    prop_oneof![
        number().prop_map(Temperature::Uniform),
        (number(), number())
            .prop_map(|(sunlit_k, shaded_k)| Temperature::SunlitShaded { sunlit_k, shaded_k }),
        (number(), number())
            .prop_map(|(mean_k, delta_k)| Temperature::MeanDelta { mean_k, delta_k }),
    ]
    .boxed()
}

fn thermal_sky() -> BoxedStrategy<ThermalSky> {
    prop_oneof![
        Just(ThermalSky::None),
        number().prop_map(ThermalSky::BlackBody),
        spectrum().prop_map(ThermalSky::Radiance),
    ]
    .boxed()
}

fn from_file() -> BoxedStrategy<Prototype> {
    let axis = prop_oneof![Just(Axis::X), Just(Axis::Y), Just(Axis::Z)];
    let origin = prop_oneof![Just(Origin::File), Just(Origin::BaseCenter)];
    let parts_by = prop_oneof![Just(PartsBy::Group), Just(PartsBy::Material)];
    // An OBJ file where there is a kind of parts, else glTF.
    (option(parts_by), text(), axis, number(), map(text()), option(text()), origin)
        .prop_map(|(parts_by, file, up, unit_m, parts, material, origin)| match parts_by {
            Some(parts_by) => {
                Prototype::Obj(Obj { file, up, unit_m, parts, parts_by, material, origin })
            }
            None => Prototype::Gltf(Gltf { file, up, unit_m, parts, material, origin }),
        })
        .boxed()
}

fn mesh() -> BoxedStrategy<Prototype> {
    let ply = (text(), number(), text()).prop_map(|(file, unit_m, material)| {
        Prototype::Ply(Ply { file, up: Axis::Y, unit_m, material, origin: Origin::BaseCenter })
    });
    let discs = (text(), text()).prop_map(|(file, material)| Prototype::Discs { file, material });
    let corner = (number(), number(), number());
    let faces = (list(list(corner)), text())
        .prop_map(|(faces_m, material)| Prototype::Faces { faces_m, material });
    prop_oneof![from_file(), ply, discs, faces, crown()].boxed()
}

fn distribution() -> BoxedStrategy<Distribution> {
    let cut = || (number(), number(), option(number()), option(number()));
    prop_oneof![
        number().prop_map(Distribution::Fixed),
        (number(), number()).prop_map(Distribution::Uniform),
        cut().prop_map(|(mean, sd, min, max)| Distribution::Normal { mean, sd, min, max }),
        cut().prop_map(|(median, sd_ln, min, max)| Distribution::LogNormal {
            median,
            sd_ln,
            min,
            max
        }),
    ]
    .boxed()
}

fn area() -> BoxedStrategy<Area> {
    let ring = || list((number(), number()));
    prop_oneof![
        (ring(), list(ring()))
            .prop_map(|(outline_m, holes_m)| Area::Polygon { outline_m, holes_m }),
        (text(), any::<bool>())
            .prop_map(|(file, georeferenced)| Area::GeoJson { file, georeferenced }),
        (text(), any::<bool>())
            .prop_map(|(file, georeferenced)| Area::Table { file, georeferenced }),
    ]
    .boxed()
}

fn scatter() -> BoxedStrategy<Instances> {
    let rule = prop_oneof![
        Just(Rule::Uniform),
        number().prop_map(|min_distance_m| Rule::PoissonDisc { min_distance_m }),
        ((number(), number()), number(), number()).prop_map(
            |(spacing_m, row_azimuth_deg, jitter_m)| Rule::Grid {
                spacing_m,
                row_azimuth_deg,
                jitter_m
            }
        ),
    ];
    let stems = prop_oneof![
        Just(Stems::Fill),
        any::<u32>().prop_map(Stems::Count),
        number().prop_map(Stems::PerHectare),
    ];
    let size = (option(distribution()), distribution(), option(distribution()), number());
    let turn = (distribution(), distribution(), distribution());
    let shares = list((text(), number())).prop_map(IndexMap::from_iter);
    let places = (shares, rule, stems, list(area()), list(area()));
    (places, turn, size, option(text()), option(any::<u64>()))
        .prop_map(|((of, rule, stems, inside, outside), turn, size, name, seed)| {
            let (yaw_deg, tilt_deg, tilt_azimuth_deg) = turn;
            let (height_m, scale, scale_vertical, sink_m) = size;
            Instances::Scatter(Scatter {
                of,
                rule,
                stems,
                inside,
                outside,
                yaw_deg,
                tilt_deg,
                tilt_azimuth_deg,
                height_m,
                scale,
                scale_vertical,
                sink_m,
                name,
                seed,
            })
        })
        .boxed()
}

fn species_meshes() -> BoxedStrategy<SpeciesMeshes> {
    let pairs = prop::collection::vec((text(), text()), 0..5);
    let by_species = pairs.prop_map(|pairs| SpeciesMeshes::BySpecies(pairs.into_iter().collect()));
    prop_oneof![text().prop_map(SpeciesMeshes::One), by_species].boxed()
}

fn instances() -> BoxedStrategy<Instances> {
    let place = (number(), number(), number());
    prop_oneof![
        (
            (text(), species_meshes(), option(list(text())), any::<bool>(), option(text())),
            option(prop_oneof![Just(TableCoordinates::Map), Just(TableCoordinates::Local)])
        )
            .prop_map(|((file, of, columns, on_terrain, name), coordinates)| {
                Instances::Table(InstanceTable { file, of, columns, on_terrain, coordinates, name })
            }),
        (
            (text(), prop::collection::vec(place, 0..20), list(number()), list(number())),
            (any::<bool>(), option(text()))
        )
            .prop_map(|((of, at_m, yaw_deg, scale), (on_terrain, name))| Instances::List(
                InstanceList { of, at_m, yaw_deg, scale, on_terrain, name }
            )),
        scatter(),
    ]
    .boxed()
}

fn views() -> BoxedStrategy<Views> {
    prop_oneof![
        (number(), number())
            .prop_map(|(max_deg, step_deg)| Views::PrincipalPlane { max_deg, step_deg }),
        (number(), number())
            .prop_map(|(max_deg, step_deg)| Views::CrossPlane { max_deg, step_deg }),
        list((number(), number())).prop_map(Views::List),
    ]
    .boxed()
}

fn picture() -> BoxedStrategy<Picture> {
    prop_oneof![
        Just(Picture::Quicklook),
        (text(), text(), text(), option(number())).prop_map(
            |(red, green, blue, exposure_stops)| Picture::Bands {
                red,
                green,
                blue,
                exposure_stops
            }
        ),
        option(number()).prop_map(|exposure_stops| Picture::Cie { exposure_stops }),
    ]
    .boxed()
}

fn look() -> BoxedStrategy<Look> {
    prop_oneof![
        Just(Look::Up),
        Just(Look::Down),
        (number(), number())
            .prop_map(|(zenith_deg, azimuth_deg)| Look::Towards { zenith_deg, azimuth_deg }),
        (number(), number(), number()).prop_map(|at_m| Look::Target { at_m }),
    ]
    .boxed()
}

fn projection() -> BoxedStrategy<FisheyeProjection> {
    prop::sample::select(vec![
        FisheyeProjection::Equisolid,
        FisheyeProjection::Equidistant,
        FisheyeProjection::Orthographic,
        FisheyeProjection::Stereographic,
    ])
    .boxed()
}

fn virtual_plane() -> impl Strategy<Value = Option<VirtualPlane>> {
    let pair = || option((number(), number()));
    option(
        (pair(), pair(), option(number())).prop_map(|(center_m, size_m, height_m)| VirtualPlane {
            center_m,
            size_m,
            height_m,
        }),
    )
}

/// Keys of all images, of one of these transport systems.
fn image_options(systems: Vec<System>) -> impl Strategy<Value = ImageOptions> {
    let measure = prop::sample::select(vec![ImageMeasure::Radiance, ImageMeasure::Brf]);
    let system = prop::sample::select(systems);
    (option(ends()), list(measure), any::<bool>(), picture(), system).prop_map(
        |(until, measure, denoised, picture, system)| ImageOptions {
            until,
            measure,
            denoised,
            picture,
            system,
        },
    )
}

fn image_sensor() -> BoxedStrategy<Sensor> {
    let any_system = || image_options(System::ALL.to_vec());
    let backward = || image_options(vec![System::Backward]);
    let pair = || (number(), number());
    let triple = || (number(), number(), number());
    let cover = || option(Just(Cover::WholeScene));
    let flags = || any::<(bool, bool, u32)>();
    prop_oneof![
        (
            (option(any::<(u32, u32)>()), option(number())),
            (option(pair()), cover()),
            option(pair()),
            pair(),
            (option(any::<u32>()), option(number())),
            virtual_plane(),
            any_system()
        )
            .prop_map(
                |(
                    (size_px, pixel_m),
                    (extent_m, cover),
                    center_m,
                    angles,
                    samples,
                    virtual_plane,
                    image,
                )| {
                    Sensor::Orthographic(Orthographic {
                        size_px,
                        pixel_m,
                        extent_m,
                        cover,
                        center_m,
                        zenith_deg: angles.0,
                        azimuth_deg: angles.1,
                        samples_per_px: samples.0,
                        samples_per_m2: samples.1,
                        virtual_plane,
                        image,
                    })
                }
            ),
        (any::<(u32, u32)>(), (triple(), triple(), triple()), pair(), flags(), backward())
            .prop_map(|(size_px, points, fov_deg, flags, image)| {
                Sensor::Perspective(Perspective {
                    size_px,
                    position_m: points.0,
                    target_m: points.1,
                    up: points.2,
                    fov_deg,
                    above_ground: flags.0,
                    sees_sky: flags.1,
                    samples_per_px: flags.2,
                    image,
                })
            }),
        (
            any::<(u32, u32)>(),
            (triple(), look(), option(triple())),
            (number(), projection()),
            flags(),
            backward()
        )
            .prop_map(
                |(size_px, (position_m, look, up), (fov_deg, projection), flags, image)| {
                    Sensor::Fisheye(Fisheye {
                        size_px,
                        position_m,
                        look,
                        up,
                        fov_deg,
                        projection,
                        above_ground: flags.0,
                        sees_sky: flags.1,
                        samples_per_px: flags.2,
                        image,
                    })
                }
            ),
    ]
    .boxed()
}

fn ends() -> impl Strategy<Value = Ends> {
    let until = prop_oneof![
        number().prop_map(StopCriterion::RelError),
        map(number()).prop_map(StopCriterion::RelErrors),
        number().prop_map(StopCriterion::Seconds),
        any::<u64>().prop_map(StopCriterion::Samples),
    ];
    list(until).prop_map(Ends)
}

fn sensor() -> BoxedStrategy<Sensor> {
    let system = || prop::sample::select(System::ALL.to_vec());
    let image = || {
        prop::sample::select(vec![
            ImageMeasure::Radiance,
            ImageMeasure::Brf,
            ImageMeasure::Orders,
            ImageMeasure::BrightnessTemperature,
            ImageMeasure::FourComponents,
            ImageMeasure::GapFraction,
        ])
    };
    let photon = prop_oneof![
        any::<u32>().prop_map(PhotonMeasure::BrfCells),
        views().prop_map(PhotonMeasure::BrfViews),
        any::<u32>().prop_map(PhotonMeasure::RadianceCells),
        views().prop_map(PhotonMeasure::RadianceViews),
        list((number(), number(), number())).prop_map(PhotonMeasure::RadianceCones),
        Just(PhotonMeasure::Albedo),
        Just(PhotonMeasure::Exitance),
        Just(PhotonMeasure::BrightnessTemperature),
        Just(PhotonMeasure::Orders),
        prop_oneof![Just(Per::Instance), Just(Per::Triangle)]
            .prop_map(|per| PhotonMeasure::Absorbed { per }),
        list((number(), number(), number())).prop_map(PhotonMeasure::BrfCones),
        number().prop_map(|m| PhotonMeasure::Fapar { layer_m: Layers::Thickness(m) }),
        list(number()).prop_map(|m| PhotonMeasure::Fapar { layer_m: Layers::Borders(m) }),
        (number(), list(number()))
            .prop_map(|(pixel_m, heights_m)| PhotonMeasure::Fluxes { pixel_m, heights_m }),
    ];
    prop_oneof![
        image_sensor(),
        (views(), ends(), list(image()), virtual_plane(), option(system())).prop_map(
            |(views, until, measure, virtual_plane, system)| Sensor::Directions(Directions {
                views,
                until,
                measure,
                virtual_plane,
                system
            })
        ),
        (number(), option(ends()), list(photon), virtual_plane(), system()).prop_map(
            |(per_m2, until, measure, virtual_plane, system)| Sensor::Photons(Photons {
                per_m2,
                until,
                measure,
                virtual_plane,
                system
            })
        ),
    ]
    .boxed()
}

fn light() -> BoxedStrategy<(Option<Sun>, Sky)> {
    let position = (
        (0..3000_u32, 1..13_u32, 1..32_u32),
        (number(), number(), number()),
        (number(), number(), number(), number()),
        (number(), number(), option(number())),
    )
        .prop_map(|(date, time, place, air)| {
            SunPosition::Spa(Spa {
                date,
                time,
                utc_offset_h: place.0,
                latitude_deg: place.1,
                longitude_deg: place.2,
                altitude_m: place.3,
                pressure_hpa: air.0,
                temperature_c: air.1,
                delta_t_s: air.2,
            })
        });
    let sun = (option(number()), number(), option(position), number(), spectrum()).prop_map(
        |(zenith_deg, azimuth_deg, position, disc_deg, irradiance)| Sun {
            zenith_deg,
            azimuth_deg,
            position,
            disc_deg,
            irradiance,
        },
    );
    let sky = prop_oneof![
        Just(Sky::None),
        list(number()).prop_map(Sky::Fraction),
        spectrum().prop_map(|irradiance| Sky::Isotropic { irradiance }),
    ];
    (option(sun), sky).boxed()
}

fn ground() -> BoxedStrategy<(Frame, Terrain, Boundary)> {
    let frame = ((number(), number(), number()), option(text()))
        .prop_map(|(origin_m, crs)| Frame { origin_m, crs });
    let terrain = ((number(), number()), text(), (number(), number()), number()).prop_map(
        |(size_m, material, corner_m, height_m)| {
            Terrain::Plane(TerrainPlane { size_m, material, corner_m, height_m })
        },
    );
    (frame, terrain, prop_oneof![Just(Boundary::Periodic), Just(Boundary::Isolated)]).boxed()
}

pub(crate) fn scene() -> BoxedStrategy<Scene> {
    let source = prop::sample::select(vec![
        BandSource::Auto,
        BandSource::Sunlight,
        BandSource::Emission,
        BandSource::Both,
    ]);
    let table =
        (text::<String>(), option(text()), option(text())).prop_map(|(file, wavelength, value)| {
            SpectrumFile {
                file: file.into(),
                wavelength,
                value,
                wavelength_unit: None,
                wavelengths: None,
            }
        });
    let response = prop_oneof![
        Just(Response::Box),
        Just(Response::Gaussian),
        prop::collection::vec((number(), number()), 0..4).prop_map(Response::Points),
        table.prop_map(Response::Table),
        (text(), text()).prop_map(Response::Sensor),
    ];
    let band = (text(), option(number()), number(), response, source).prop_map(
        |(name, center_nm, width_nm, response, source)| Band {
            name,
            center_nm,
            width_nm,
            response,
            source,
        },
    );
    let output = prop::collection::vec(prop::sample::select(FileFormat::ALL.to_vec()), 0..4);
    let transport = (any::<u64>(), any::<u32>(), number(), any::<bool>(), option(any::<u32>()))
        .prop_map(|(seed, after_order, kill, first_order_only, max_order)| Transport {
            seed,
            roulette: Roulette { after_order, kill },
            first_order_only,
            max_order,
        });
    let sweep = prop_oneof![
        map(list(param())).prop_map(Sweep::Grid),
        map(list(param())).prop_map(Sweep::Zip),
        list(text()).prop_map(|names| Sweep::Derivatives(DerivativeSteps::Relative(names))),
        map(number()).prop_map(|steps| Sweep::Derivatives(DerivativeSteps::Absolute(steps))),
    ];
    let names = (any::<u32>(), text(), map(param()), map(map(param())), option(sweep));
    let surfaces = (list(band), map(spectrum()), map(material()), map(mesh()));
    (
        names,
        surfaces,
        ground(),
        (list(instances()), list(text()), list(text())),
        (light(), thermal_sky()),
        map(sensor()),
        (transport, output),
    )
        .prop_map(|(names, surfaces, ground, instances, light, sensors, (transport, output))| {
            let (format, title, params, variants, sweep) = names;
            let (instances, hide, select) = instances;
            let (bands, spectra, materials, meshes) = surfaces;
            let (frame, terrain, boundary) = ground;
            let ((sun, sky), thermal_sky) = light;
            Scene {
                format,
                title,
                params,
                // Reading takes included files into the scene: `include.rs` shows that.
                include: Map::new(),
                frame,
                bands: bands.into(),
                spectra,
                materials,
                meshes,
                terrain,
                instances,
                hide,
                select,
                sun,
                sky,
                thermal_sky,
                boundary,
                sensors,
                transport,
                variants,
                sweep,
                output,
            }
        })
        .boxed()
}

pub(crate) fn read_back(text: &str) -> Scene {
    match read_text("written.ron", text, &ReadOptions::default()) {
        Ok(reading) => reading.scene,
        Err(error) => panic!("{error}\n{text}"),
    }
}

/// The `ron` crate with the two extensions that scene files are written in.
fn by_crate() -> ron::Options {
    use ron::extensions::Extensions;
    ron::Options::default()
        .with_default_extension(Extensions::IMPLICIT_SOME | Extensions::UNWRAP_VARIANT_NEWTYPES)
}

/// Example scenes, resolved: no formulas and no included files.
#[test]
fn example_scenes_read_by_the_ron_crate_are_equal() {
    let scenes = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let mut count = 0;
    for folder in [scenes.clone(), scenes.join("rami"), scenes.join("species")] {
        for entry in std::fs::read_dir(folder).expect("the folder is there") {
            let path = entry.expect("it can be listed").path();
            if path.extension().is_none_or(|extension| extension != "ron") {
                continue;
            }
            let reading = read_file(&path, &ReadOptions::default()).expect("RON");
            // Libraries of definitions are no scenes.
            if !reading.is_sound() {
                continue;
            }
            let by_crate: Scene = by_crate().from_str(&reading.expanded()).expect("serde reads it");
            assert_eq!(by_crate, reading.scene.resolved(), "{}", path.display());
            count += 1;
        }
    }
    assert!(count >= 8, "{count} scenes");
}

/// What our reader refuses and serde would let pass, or the other way round.
#[test]
fn serde_refuses_what_is_no_key_no_variant_and_what_is_missing() {
    let read = |text: &str| by_crate().from_str::<Sensor>(text);
    assert!(read("Photons").is_ok() && read("Photons()").is_ok());
    let photons = read("Photons(per_m2: 3)").expect("a sensor");
    assert_eq!(photons, Sensor::Photons(Photons { per_m2: 3.0, ..Photons::default() }));
    let error = |text: &str| read(text).expect_err("it is no sensor").to_string();
    assert!(error("Photon").contains("Photon"), "{}", error("Photon"));
    assert!(error("Photons(per_m: 3)").contains("per_m"), "{}", error("Photons(per_m: 3)"));
    let twice = error("Photons(per_m2: 3, per_m2: 4)");
    assert!(twice.contains("`per_m2` is given twice"), "{twice}");
    let missing = error("Perspective(size_px: (2, 2), fov_deg: (1, 1), position_m: (0, 0, 0))");
    assert!(missing.contains("target_m"), "{missing}");
    // Not all of its keys have defaults.
    assert!(read("Directions").is_err());
    assert!(read("Photons(per_m2: \"x\")").is_err());
}

proptest! {
    #[test]
    fn what_is_written_reads_back_as_equal(scene in scene()) {
        let text = scene.to_ron();
        prop_assert_eq!(read_back(&text), scene, "{}", text);
    }

    /// The `ron` crate is a second reader, by other authors.
    #[test]
    fn what_is_written_reads_back_as_equal_by_the_ron_crate(scene in scene()) {
        let text = scene.to_ron();
        let other: Result<Scene, _> = by_crate().from_str(&text);
        prop_assert_eq!(other.as_ref().ok(), Some(&scene), "{:?}\n{}", other, text);
    }

    /// And a second writer.
    #[test]
    fn what_the_ron_crate_writes_reads_back_as_equal(scene in scene()) {
        let text = by_crate().to_string(&scene).expect("every scene can be written");
        // Values that start with `=` are formulas in a file.
        let text = text.replace("\"=", "\"\\u{3D}");
        prop_assert_eq!(read_back(&text), scene, "{}", text);
    }
}

#[test]
fn a_scene_is_written_as_a_person_would() {
    let text = include_str!("design.ron");
    insta::assert_snapshot!(read_back(text).to_ron());
}
