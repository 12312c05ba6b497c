//! Files are read back here by the rules of the format, and in `tests/readers/datasets.py` by other programs.

use std::fs;
use std::process::Command;

use super::super::dataset::{Attributes, Dataset, Dimension, Values, Variable};
use super::*;

fn dataset(values: &[f64]) -> Dataset<'_> {
    let variable = |name: &str, dimensions: Vec<usize>, values: Values<'static>| Variable {
        name: name.to_owned(),
        dimensions,
        attributes: Attributes::default(),
        values,
        has_fill: false,
        is_raster: false,
    };
    let mut attributes = Attributes::default();
    attributes.text("title", "ö");
    attributes.number("seed", 7.0);
    let texts = Values::Texts(["a", "öö", "ccc"].map(str::to_owned).into());
    Dataset {
        dimensions: vec![Dimension { name: "n".to_owned(), length: values.len() }],
        attributes,
        variables: vec![
            variable("n", vec![0], texts),
            variable("crs", Vec::new(), Values::Nothing),
            variable("v", vec![0], Values::Doubles(values.to_vec().into())),
        ],
    }
}

/// *Expected*: the last bytes are the values; versions 2 and 5 differ in their headers alone.
#[test]
fn values_end_a_file_of_either_version() {
    let values = [1.5, f64::NAN, -2.0];
    let [narrow, wide] = [u64::MAX, 1].map(|largest| {
        let mut file = Vec::new();
        write_up_to(largest, &dataset(&values), &mut file).unwrap();
        file
    });
    assert_eq!([&narrow[..4], &wide[..4]], [b"CDF\x02", b"CDF\x05"]);
    // Texts of 4 bytes each, one integer, three numbers.
    let data = 3 * 4 + 4 + 3 * 8;
    let [one, other] = [&narrow, &wide].map(|file| &file[file.len() - data..]);
    assert_eq!(one, other);
    assert_eq!(&one[..12], "a\0\0\0ööccc\0".as_bytes());
    let numbers: Vec<u8> = values.iter().flat_map(|value| value.to_be_bytes()).collect();
    assert_eq!(one[16..], numbers);
}

/// *Expected*: netCDF4 reads a file with sizes of 64 bits, if there is a Python that has it.
#[test]
fn sizes_of_64_bits_are_read_by_the_library() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.nc");
    let mut file = Vec::new();
    write_up_to(1, &dataset(&[1.5, 2.5, -2.0]), &mut file).unwrap();
    fs::write(&path, file).unwrap();
    let script = "import sys\ntry:\n    import netCDF4\nexcept ImportError:\n    sys.exit(77)\n\
        d = netCDF4.Dataset(sys.argv[1])\nassert d.data_model == 'NETCDF3_64BIT_DATA', d.data_model\n\
        assert d['v'][:].tolist() == [1.5, 2.5, -2.0] and d['n'][:].tolist() == ['a', 'öö', 'ccc']\n\
        assert d.title == 'ö' and d.seed == 7.0";
    let python = std::env::var_os("SUNFLECK_PYTHON").unwrap_or_else(|| "python3".into());
    let Ok(run) = Command::new(python).args(["-c", script]).arg(&path).output() else { return };
    let is_missing = run.status.code() == Some(77);
    assert!(run.status.success() || is_missing, "{}", String::from_utf8_lossy(&run.stderr));
}
