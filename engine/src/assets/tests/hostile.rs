//! Files that are not what they should be: an error, never a panic.

use std::path::Path;

use proptest::prelude::*;

use super::glb::{glb, square_bytes, square_json};
use super::*;
use crate::assets::{
    SpectrumColumns, read_discs, read_gltf, read_instances, read_obj, read_spectrum,
};

/// Characters that mean something to one of the readers.
const TELLING: &[u8] = b"0123456789-+.eE/ ,;\n\\{}[]\"naif";

/// A reader as a function that asserts what it gave and gives whether it gave anything.
type Reader = fn(&Path) -> bool;

fn obj(path: &Path) -> bool {
    read_obj(path, &AS_IS, &PartsBy::Group).inspect(|loaded| assert_lawful(&loaded.value)).is_ok()
}

fn gltf(path: &Path) -> bool {
    read_gltf(path, &AS_IS).inspect(|loaded| assert_lawful(&loaded.value)).is_ok()
}

fn discs(path: &Path) -> bool {
    read_discs(path).inspect(|loaded| assert_lawful(&loaded.value)).is_ok()
}

fn instances(path: &Path) -> bool {
    let lawful = |row: &crate::assets::StemRow| {
        row.position.is_finite() && row.scale_horizontal > 0.0 && row.scale_vertical > 0.0
    };
    read_instances(path, None).inspect(|table| assert!(table.rows.iter().all(lawful))).is_ok()
}

fn spectrum(path: &Path) -> bool {
    read_spectrum(path, &SpectrumColumns::default())
        .inspect(|table| {
            assert!(table.points.is_sorted_by(|a, b| a.wavelength < b.wavelength));
        })
        .is_ok()
}

fn valid() -> [(Reader, Vec<u8>); 6] {
    let text = |text: &str| text.as_bytes().to_vec();
    [
        (
            obj,
            text(
                "# tree\ng leaf\nv 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nvt 0 0\nusemtl a\n\
                 f 1/1 2/1 3/1 4/1\no b\nf -1 -2 -4\nf 1 2 \\\n 3\n",
            ),
        ),
        (gltf, glb(&square_json(), &square_bytes())),
        (gltf, {
            let mut json = square_json();
            let zeros = "AAAA".repeat(20);
            json["buffers"][0]["uri"] = format!("data:;base64,{zeros}").into();
            json["nodes"][0]["scale"] = serde_json::json!([1, 2, -3]);
            json.to_string().into_bytes()
        }),
        (discs, text("radius,x,y,z,nx,ny,nz\n0.1,1,2,3,0,0,1\n0.2,4,5,6,1,1,1\n")),
        (instances, text("x_m;y_m;yaw_deg;scale\n1;2;3;4\n5;6;7;8\n")),
        (spectrum, text("wavelength_nm,value\n400,0.1\n500,0.2\n600,0.3\n")),
    ]
}

#[test]
fn what_is_no_file_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    for (read, _) in valid() {
        assert!(!read(folder.path()), "a folder");
        assert!(!read(&folder.path().join("gone.obj")), "nothing");
        assert!(!read(Path::new("")), "no name");
    }
    let error = read_obj(folder.path(), &AS_IS, &PartsBy::Group).unwrap_err();
    assert!(matches!(error, AssetError::NotAFile { .. }), "{error}");
    #[cfg(unix)]
    assert!(!obj(Path::new("/dev/zero")), "a device without end");
}

#[test]
fn what_is_not_text_is_an_error() {
    let utf16: Vec<u8> = [0xfeff_u16]
        .into_iter()
        .chain("x_m,y_m\n1,2\n".encode_utf16())
        .flat_map(u16::to_le_bytes)
        .collect();
    let without_mark = utf16[2..].to_vec();
    let png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x01\0".repeat(100);
    for content in
        [utf16, without_mark, png, vec![0; 5000], vec![0xff; 5000], vec![b'\n'; 99], Vec::new()]
    {
        for (read, _) in valid() {
            assert!(!read(file(&content).path()), "{:?}", &content[..content.len().min(20)]);
        }
    }
    let endless = file("1".repeat(3 << 20));
    assert!(matches!(read_discs(endless.path()), Err(AssetError::LineTooLong { line: 1, .. })));
    let utf16 = file(b"\xff\xfex\0_\0m\0\n\0");
    let error = read_instances(utf16.path(), None).unwrap_err();
    assert!(message(&error).contains("UTF-16"), "{error}");
    let unmarked = file(b"x\0_\0m\0\n\0");
    let error = read_instances(unmarked.path(), None).unwrap_err();
    assert!(matches!(error, AssetError::NotText { line: 1, .. }), "{error}");
}

#[test]
fn files_cut_anywhere_never_panic() {
    for (read, content) in valid() {
        for length in 0..content.len() {
            read(file(&content[..length]).path());
        }
        let valid_gives_values = read(file(&content).path());
        assert!(valid_gives_values || content.starts_with(b"{"), "zeros alone have no area");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn random_bytes_never_panic(content in prop::collection::vec(any::<u8>(), 0..300)) {
        let content = file(&content);
        for (read, _) in valid() {
            read(content.path());
        }
    }

    /// Bytes changed, left out and repeated in a valid file.
    #[test]
    fn damaged_files_never_panic(
        which in 0..6_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), 0..4_u8, any::<u8>()), 1..6),
    ) {
        let (read, mut content) = valid()[which].clone();
        for (place, kind, byte) in changes {
            let place = place.index(content.len());
            match kind {
                0 => content[place] = byte,
                1 => content[place] = TELLING[byte as usize % TELLING.len()],
                2 => drop(content.drain(place..content.len().min(place + 1 + usize::from(byte % 9)))),
                _ => {
                    let end = content.len().min(place + 1 + usize::from(byte % 40));
                    let copy = content[place..end].to_vec();
                    content.splice(place..place, copy);
                }
            }
            if content.is_empty() {
                break;
            }
        }
        read(file(&content).path());
    }
}

/// A list in braces that a header of 1 MiB never closes: what each line costs must not grow with
/// those before it.
#[test]
fn a_header_that_closes_no_brace_is_read_in_no_time() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.hdr");
    let header = format!("ENVI\nsamples = 1\nlines = 1\nmap info = {{UTM{}", "\n,".repeat(1 << 19));
    std::fs::write(&path, header).unwrap();
    std::fs::write(folder.path().join("a.img"), [1]).unwrap();
    let error = crate::assets::read_raster(&path, None).unwrap_err();
    assert!(message(&error).contains("no `data type`"), "{error}");
}
