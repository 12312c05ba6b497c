//! Files of spectra in the layouts of the programs and libraries that write them.

use std::fs;
use std::path::{Path, PathBuf};

/// Wavelengths of all files, nm.
pub(super) const NM: [f64; 5] = [400.0, 550.0, 660.0, 865.0, 2400.0];

/// Reflectances of all files; the last channel is deleted where a format has a mark for that.
pub(super) const LEAF: [f64; 5] = [0.052, 0.121, 0.06, 0.46, 0.1];

/// Reflectances of a second spectrum.
pub(super) const SOIL: [f64; 5] = [0.1, 0.15, 0.2, 0.3, 0.35];

fn write(folder: &Path, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, content).expect("a file");
    path
}

/// An ENVI spectral library of two spectra, in µm, as float32 of a byte order, times a factor.
///
/// Source: NV5 Geospatial, ENVI documentation, "ENVI Header Files" and "Spectral libraries".
pub(super) fn envi(folder: &Path, stem: &str, is_big: bool, factor: f32, more: &str) -> PathBuf {
    let number = |value: f64| {
        let value = value as f32 * factor;
        if is_big { value.to_be_bytes() } else { value.to_le_bytes() }
    };
    let bytes: Vec<u8> = LEAF.iter().chain(&SOIL).flat_map(|&value| number(value)).collect();
    let wavelengths: Vec<String> = NM.iter().map(|nm| (nm / 1e3).to_string()).collect();
    let order = u8::from(is_big);
    let header = format!(
        "ENVI\ndescription = {{\n  made for a test}}\nsamples = 5\nlines   = 2\nbands   = 1\nheader offset = 0\n\
         file type = ENVI Spectral Library\ndata type = 4\ninterleave = bsq\nbyte order = {order}\n\
         wavelength units = Micrometers\nspectra names = {{\n leaf of oak, dry soil}}\n\
         wavelength = {{\n {}}}\n{more}",
        wavelengths.join(",\n ")
    );
    write(folder, &format!("{stem}.hdr"), header);
    write(folder, &format!("{stem}.sli"), bytes)
}

/// A text of the ECOSTRESS library; wavelengths fall, as in its files of the laboratory.
///
/// Source: keys of the files at speclib.jpl.nasa.gov, 18 lines and a blank one as the reader `SPy` of ASTER 2.0 expects them.
pub(super) fn ecostress(folder: &Path, name: &str, y_units: &str) -> PathBuf {
    let mut text = format!(
        "Name: Quercus robur\nType: vegetation\nClass: tree\nSubClass: broadleaf\nParticle Size: Unknown\n\
         Sample No.: Q1\nOwner: somebody\nWavelength Range: VSWIR\nOrigin: Unknown; field: site A.\n\n\
         Description: A leaf: measured three times.\n\n\n\n\n\n\
         Measurement: Directional (10 Degree) Hemispherical Reflectance\nFirst Column: X\nSecond Column: Y\n\
         X Units: Wavelength (micrometers)\nY Units: {y_units}\nFirst X Value: 2.4\nLast X Value: 0.4\n\
         Number of X Values: 5\nAdditional Information: none\n\n"
    );
    let rows = NM.iter().zip(LEAF).rev();
    let rows: Vec<_> =
        rows.map(|(nm, value)| format!("   {:.4}\t {:.4}\n", nm / 1e3, 100.0 * value)).collect();
    text += &rows.concat();
    write(folder, name, text)
}

/// A spectrum of the USGS library version 7 with a deleted channel; returns its file and that of the wavelengths.
///
/// Source: Kokaly et al. (2017), USGS Data Series 1035, `ASCIIdata_splib07a`.
pub(super) fn usgs(folder: &Path) -> [PathBuf; 2] {
    let column = |title: &str, values: &[f64]| {
        let rows: Vec<_> = values.iter().map(|value| format!("   {value:.7E}\n")).collect();
        format!(" splib07a {title}\n{}", rows.concat())
    };
    let mut values = LEAF;
    values[4] = -1.23e34;
    let leaf = column("Record=22083: Leaf oak            ASDFRa AREF", &values);
    let waves = column("Record=6: Wavelengths ASD 0.35-2.5 microns 5 ch", &NM.map(|nm| nm / 1e3));
    [
        write(folder, "splib07a_Leaf_ASDFRa_AREF.txt", leaf),
        write(folder, "splib07a_Wavelengths_ASD_0.35-2.5_microns_5_ch.txt", waves),
    ]
}

/// A binary file of an ASD spectrometer, version 7: counts of the target, then of the white reference.
///
/// Source: ASD Inc., "Indico version 8 file format": bytes 186 (type of data), 191 and 195 (first wavelength and step, f32),
/// 199 (type of numbers), 204 (channels, u16), 390 (integration time), 436 (gains), 444 (splices).
pub(super) fn asd(folder: &Path, name: &str, kind: u8, has_reference: bool) -> PathBuf {
    let mut bytes = vec![0_u8; 484];
    let mut put =
        |place: usize, value: &[u8]| bytes[place..place + value.len()].copy_from_slice(value);
    put(0, b"as7");
    put(160, &0_u16.to_le_bytes());
    for (index, field) in [0_i16, 30, 12, 1, 6, 126, 0, 0, 0].into_iter().enumerate() {
        put(160 + 2 * index, &field.to_le_bytes());
    }
    put(186, &[kind]);
    put(187, &1_700_000_000_i32.to_le_bytes());
    put(191, &350.0_f32.to_le_bytes());
    put(195, &1.0_f32.to_le_bytes());
    put(199, &[2]);
    put(204, &5_u16.to_le_bytes());
    put(390, &17_u32.to_le_bytes());
    put(436, &2048_u16.to_le_bytes());
    put(438, &2048_u16.to_le_bytes());
    put(444, &1000.0_f32.to_le_bytes());
    put(448, &1800.0_f32.to_le_bytes());
    let white = [1000.0, 2000.0, 3000.0, 2500.0, 500.0];
    bytes.extend(
        LEAF.iter().zip(white).flat_map(|(leaf, white): (_, f64)| (leaf * white).to_le_bytes()),
    );
    bytes.extend(u16::from(has_reference).wrapping_neg().to_le_bytes());
    bytes.extend([0_u8; 16]);
    bytes.extend(5_u16.to_le_bytes());
    bytes.extend(b"white");
    bytes.extend(white.iter().flat_map(|white| white.to_le_bytes()));
    // Empty lists of what other programs keep: classifier, dependent variables, calibration.
    bytes.extend([0_u8; 64]);
    write(folder, name, bytes)
}
