//! Colours of pictures, against those that follow by hand from the radiances written beside them.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use sunfleck::run::Options;
use sunfleck_tests::measure;

const WIDTH: usize = 5;
const BANDS: usize = 16;
/// Every 20 nm from 400 nm: the CIE 1931 colour matching functions x̄, ȳ, z̄ of the 2° observer, and the
/// power of D65. Source: CIE 15:2004, tables T.4 and T.1.
const OBSERVER: [[f64; 4]; BANDS] = [
    [0.0143, 0.0004, 0.0679, 82.7549],
    [0.1344, 0.0040, 0.6456, 93.4318],
    [0.3483, 0.0230, 1.7471, 104.865],
    [0.2908, 0.0600, 1.6692, 117.812],
    [0.0956, 0.1390, 0.8130, 115.923],
    [0.0049, 0.3230, 0.2720, 109.354],
    [0.0633, 0.7100, 0.0782, 104.790],
    [0.2904, 0.9540, 0.0203, 104.405],
    [0.5945, 0.9950, 0.0039, 100.000],
    [0.9163, 0.8700, 0.0017, 95.7880],
    [1.0622, 0.6310, 0.0008, 90.0062],
    [0.8544, 0.3810, 0.0002, 87.6987],
    [0.4479, 0.1750, 0.0000, 83.6992],
    [0.1649, 0.0610, 0.0000, 80.2146],
    [0.0468, 0.0170, 0.0000, 78.2842],
    [0.0114, 0.0041, 0.0000, 71.6091],
];

/// Reflectance of each strip of ground at a wavelength in nm: grey, green as a leaf, red as brick, blue,
/// and nearly black.
fn reflectance(strip: usize, nm: f64) -> f64 {
    let hill = |middle: f64, width: f64| (-((nm - middle) / width).powi(2)).exp();
    let rise = 1.0 / (1.0 + ((600.0 - nm) / 25.0).exp());
    match strip {
        0 => 0.5,
        1 => 0.08 + 0.25 * hill(545.0, 50.0),
        2 => 0.05 + 0.4 * rise,
        3 => 0.06 + 0.5 * hill(450.0, 60.0),
        _ => 0.01,
    }
}

/// Irradiance of the sun at normal incidence, at a wavelength in nm.
fn irradiance(nm: f64) -> f64 {
    0.8 + nm / 500.0
}

fn wavelength(band: usize) -> f64 {
    400.0 + 20.0 * band as f64
}

/// The files of `sensor`'s `name`: radiances of shape `[pixels, bands]`, and red, green, blue and opacity.
fn read(folder: &Path, stem: &str) -> (Vec<Vec<f64>>, Vec<[u8; 4]>) {
    let bytes = fs::read(folder.join(format!("{stem}.img"))).expect("ENVI pixels");
    let values: Vec<f64> = bytes
        .as_chunks::<4>()
        .0
        .iter()
        .map(|bytes| f64::from(f32::from_le_bytes(*bytes)))
        .collect();
    assert_eq!(values.len(), WIDTH * BANDS, "one row, band after band");
    let pixels = (0..WIDTH).map(|x| (0..BANDS).map(|band| values[band * WIDTH + x]).collect());
    let file = fs::File::open(folder.join(format!("{stem}.pixels.png"))).expect("a picture");
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().expect("PNG");
    let mut picture = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut picture).expect("pixels");
    assert_eq!((info.width, info.height, info.color_type), (5, 1, png::ColorType::Rgba));
    (pixels.collect(), picture.as_chunks::<4>().0.to_vec())
}

/// sRGB from its linear form. Source: IEC 61966-2-1.
fn srgb(linear: f64) -> f64 {
    let linear = linear.clamp(0.0, 1.0);
    255.0
        * if linear > 0.003_130_8 { 1.055 * linear.powf(1.0 / 2.4) - 0.055 } else { 12.92 * linear }
}

fn assert_colours(name: &str, found: &[[u8; 4]], expected: &[[f64; 3]], most: f64) {
    for (pixel, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert_eq!(found[3], 255, "{name}: all of pixel {pixel} is ground");
        for channel in 0..3 {
            let off = (f64::from(found[channel]) - expected[channel]).abs();
            assert!(off <= most, "{name}, {pixel}: {found:?}, expected {expected:?}");
        }
    }
}

/// *Scene*: five strips of ground of known colour under the sun at 60°, as pictures of three bands and of
/// what a person would see. *Expected*: from the radiances in the raster beside a picture, `π L / E` of its
/// bands, or their sums with the CIE's own tables, put into sRGB; a stop doubles; without an exposure
/// bands are stretched from the least to the largest value.
#[test]
fn pictures_have_the_colours_of_the_radiances_beside_them() {
    let list = |of: &dyn Fn(usize) -> String| (0..BANDS).map(of).collect::<Vec<_>>().join(", ");
    let bands = list(&|band| {
        let nm = wavelength(band);
        format!("(name: \"b{nm:.0}\", center_nm: {nm:?})")
    });
    let strip = |strip| {
        let rho = list(&|band| format!("{:?}", reflectance(strip, wavelength(band))));
        format!("\"m{strip}\": Lambertian(reflectance: Bands([{rho}])),")
    };
    let each = |of: &dyn Fn(usize) -> String| (0..WIDTH).map(of).collect::<String>();
    let sensor = |name: &str, picture: &str| {
        format!(
            "\"{name}\": Orthographic(size_px: (5, 1), extent_m: (5.0, 1.0), samples_per_px: 32, \
             measure: [Radiance], picture: {picture}),"
        )
    };
    let chosen = "red: \"b620\", green: \"b540\", blue: \"b440\"";
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut meshes = String::new();
    for x in 0..WIDTH {
        let text = format!("g a\nv {x} 0 0\nv {0} 0 0\nv {0} 1 0\nv {x} 1 0\nf 1 2 3 4\n", x + 1);
        fs::write(folder.path().join(format!("{x}.obj")), text).expect("a file");
        write!(
            meshes,
            "\"{x}\": Obj(file: \"{x}.obj\", up: Z, unit_m: 1.0, material: Some(\"m{x}\")),"
        )
        .expect("a string");
    }
    let report = measure(
        &format!(
            r#"Scene(
    format: 1,
    bands: [{bands}],
    materials: {{ {} }},
    meshes: {{ {meshes} }},
    terrain: Plane(size_m: (5.0, 1.0), material: "m0"),
    instances: [{}],
    sun: (zenith_deg: 60.0, irradiance: Bands([{}])),
    boundary: Periodic,
    transport: (first_order_only: true),
    sensors: {{ {} {} {} {} }},
)"#,
            each(&strip),
            each(&|x| format!("List(of: \"{x}\", at_m: [(0.0, 0.0, 0.1)]),")),
            list(&|band| format!("{:?}", irradiance(wavelength(band)))),
            sensor("bands", &format!("Bands({chosen}, exposure_stops: 1.0)")),
            sensor("stretched", &format!("Bands({chosen})")),
            sensor("cie", "Cie(exposure_stops: 0.0)"),
            sensor("bright", "Cie(exposure_stops: 1.0)"),
        ),
        folder.path(),
        &Options::default(),
    );
    let out = folder.path().join("out");
    sunfleck::output::write(&report, &out).expect("files");
    let factor = |pixel: &[f64], band: usize| {
        let white = 0.5 * irradiance(wavelength(band)) / std::f64::consts::PI;
        pixel[band] / white
    };
    let (radiances, picture) = read(&out, "bands_radiance");
    for (x, pixel) in radiances.iter().enumerate() {
        for band in 0..BANDS {
            let off = factor(pixel, band) / reflectance(x, wavelength(band)) - 1.0;
            assert!(off.abs() < 1e-5, "the raster has the ground's radiances: {x}, {band}: {off}");
        }
    }
    let rgb = [11, 7, 2];
    let expected: Vec<_> =
        radiances.iter().map(|pixel| rgb.map(|b| srgb(2.0 * factor(pixel, b)))).collect();
    assert_colours("bands", &picture, &expected, 0.501);

    let (radiances, picture) = read(&out, "stretched_radiance");
    let all: Vec<f64> = radiances.iter().flat_map(|pixel| rgb.map(|band| pixel[band])).collect();
    let least = all.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = all.iter().copied().fold(0.0, f64::max);
    let stretched = |value: f64| 255.0 * ((value - least) / (largest - least)).powf(1.0 / 2.2);
    let expected: Vec<_> =
        radiances.iter().map(|pixel| rgb.map(|band| stretched(pixel[band]))).collect();
    assert_colours("stretched", &picture, &expected, 0.51);

    for (stem, gain) in [("cie_radiance", 1.0), ("bright_radiance", 2.0)] {
        let (radiances, picture) = read(&out, stem);
        let white: f64 = OBSERVER.iter().map(|[_, y, _, light]| y * light).sum();
        let expected: Vec<_> = radiances
            .iter()
            .map(|pixel| {
                let xyz = [0, 1, 2].map(|axis| {
                    let sum = OBSERVER
                        .iter()
                        .enumerate()
                        .map(|(band, observer)| observer[axis] * observer[3] * factor(pixel, band));
                    sum.sum::<f64>() / white
                });
                // Source: IEC 61966-2-1, rounded as there.
                [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]]
                    .map(|row| srgb(gain * (0..3).map(|axis| row[axis] * xyz[axis]).sum::<f64>()))
            })
            .collect();
        // The picture's observer is a fit to the tables, good to 1 %: at most some levels of 255.
        assert_colours(stem, &picture, &expected, 3.0);
        assert!((f64::from(picture[0][0]) - srgb(0.5 * gain)).abs() < 1.0, "{picture:?}");
    }
}
