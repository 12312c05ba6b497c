//! CSV files and the table of a report.

use super::*;

#[test]
fn csv_reads_back_bit_for_bit() {
    let (_folder, paths) = written();
    let text = fs::read_to_string(&paths[7]).unwrap();
    for line in
        ["# scene: Birch # stand \u{df}\n", "# params: sza=30\n", "# hash: c0ffee\n", "# unit: 1\n"]
    {
        assert!(text.contains(line), "{line:?} in\n{text}");
    }
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(&paths[7]).unwrap();
    let header: Vec<_> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let expected = [
        "zenith_deg",
        "azimuth_deg",
        "signed_zenith_deg",
        "red",
        "red_se",
        "nir, wide",
        "nir, wide_se",
    ];
    assert_eq!(header, expected);
    let rows: Vec<Vec<f64>> = reader
        .records()
        .map(|row| row.unwrap().iter().map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let views = views();
    let (values, errors) = (&views.values, &views.standard_error);
    let bits = |row: &[f64]| row.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!(rows.len(), 3);
    for (index, (zenith, azimuth)) in
        [(-5.0, 90.0), (0.0, 0.0), (5.0, 270.0)].into_iter().enumerate()
    {
        let at = 2 * index;
        // The sun's azimuth is 250°: -5 at 90° is 5 on the sun's side.
        let signed = [5.0, 0.0, 5.0][index];
        let row = [zenith, azimuth, signed, values[at], errors[at], values[at + 1], errors[at + 1]];
        assert_eq!(bits(&rows[index]), bits(&row));
    }
}

#[test]
fn csv_of_several_dimensions_counts_the_last_fastest() {
    let folder = tempfile::tempdir().unwrap();
    let product = Product {
        name: "fapar".to_owned(),
        unit: "1".to_owned(),
        dimensions: vec![
            vec![labels("material", &["leaf", "bark"])],
            vec![axis("height_m", &[0.5, 1.5])],
            vec![labels("band", &["red"])],
        ],
        values: vec![0.1, 0.2, 0.3, 0.4],
        standard_error: vec![0.01; 4],
        image: None,
        faces: None,
        replicates: Vec::new(),
    };
    write(&report(vec![sensor("flux", product)]), folder.path()).unwrap();
    let text = fs::read_to_string(folder.path().join("flux_fapar.csv")).unwrap();
    let rows: Vec<_> = text.lines().filter(|line| !line.starts_with('#')).collect();
    let expected = [
        "material,height_m,red,red_se",
        "leaf,0.5,0.1,0.01",
        "leaf,1.5,0.2,0.01",
        "bark,0.5,0.3,0.01",
        "bark,1.5,0.4,0.01",
    ];
    assert_eq!(rows, expected);
}

#[test]
fn table_is_aligned_and_condensed() {
    let count = 31_u8;
    let mut long = views();
    let zenith: Vec<f64> = (0..count).map(|view| f64::from(view) * 5.0 - 75.0).collect();
    long.dimensions[0] = vec![axis("zenith_deg", &zenith)];
    long.values = (0..2 * count).map(|index| 0.1 + f64::from(index) / 1000.0).collect();
    long.standard_error = vec![0.001; 2 * usize::from(count)];
    let text = table(&report(vec![sensor("nadir", image()), sensor("plane", long)]));
    let expected = "\
sensor  product  at                band        value  standard error
nadir   brf      mean of 3 x 2 px  red        0.2500  ± 0.0010
                                   nir, wide  0.3125  ± 0.0020
plane   brf      zenith -75°       red        0.1000  ± 0.0010
                                   nir, wide  0.1010  ± 0.0010
                 zenith -35°       red        0.1160  ± 0.0010
                                   nir, wide  0.1170  ± 0.0010
                 zenith 0°         red        0.1300  ± 0.0010
                                   nir, wide  0.1310  ± 0.0010
                 zenith 40°        red        0.1460  ± 0.0010
                                   nir, wide  0.1470  ± 0.0010
                 zenith 75°        red        0.1600  ± 0.0010
                                   nir, wide  0.1610  ± 0.0010
                 (26 more)
";
    assert_eq!(text, expected, "got\n{text}");
}

/// *Scene*: texts that spreadsheets take for formulas, in every place that a scene's author can name.
#[test]
fn no_cell_is_a_formula() {
    let folder = tempfile::tempdir().unwrap();
    let evil = ["=1+1", "+cmd", "-2+3", "@sum", "\ttab", "-5.5", "#1"];
    let product = Product {
        name: "fapar".to_owned(),
        unit: "1".to_owned(),
        dimensions: vec![vec![labels("material", &evil)], vec![labels("band", &["=red", "a"])]],
        values: vec![0.0; 14],
        standard_error: vec![-0.5; 14],
        image: None,
        faces: None,
        replicates: Vec::new(),
    };
    let mut report = report(vec![sensor("=flux", product)]);
    report.scene = "=1, =2; +3\t@4, e-5".to_owned();
    let paths = write(&report, folder.path()).unwrap();
    let text = fs::read_to_string(&paths[0]).unwrap();
    assert!(text.contains("# scene: '=1, '=2; '+3 @4, e-5\n# params"), "{text}");
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(&paths[0]).unwrap();
    let header = reader.headers().unwrap().clone();
    assert_eq!(Vec::from_iter(&header), ["material", "'=red", "'=red_se", "a", "a_se"]);
    let first: Vec<String> = reader.records().map(|row| row.unwrap()[0].to_owned()).collect();
    assert_eq!(first, ["'=1+1", "'+cmd", "'-2+3", "'@sum", "'\ttab", "-5.5", "#1"]);
    assert!(text.contains("-0.5"), "numbers stay as they are");
}
