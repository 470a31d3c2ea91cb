//! Files of the tools that define each kind, number by number against the formulas of `data/make.py`.

#![expect(clippy::cast_precision_loss, clippy::cast_possible_wrap, reason = "rows are counted to 40")]

use clatter_record::{Column, Error, Kind, Table, Values, read};
#[cfg(feature = "parquet")]
use clatter_record::{Field, FieldKind, RowGroupWriter, RowGroups, Series, write_parquet};
use std::fs;
use std::path::PathBuf;

const N: usize = 40;
const MOST: usize = 100_000;
const EPOCH_NS: i64 = 1_700_000_000_000_000_000;

fn t(i: usize) -> f64 {
    i as f64 / 1024.0
}
fn a(i: usize) -> f64 {
    ((37 * i % 101) as f64 - 50.0) / 4.0
}
fn b(i: usize) -> f64 {
    ((53 * i % 97) as f64 - 48.0) * 2.0
}
fn c(i: usize) -> f64 {
    4.0 * a(i)
}
fn ns(i: usize) -> i64 {
    EPOCH_NS + 1_000_000 * i as i64
}
fn big(i: usize) -> i64 {
    (1 << 60) + i as i64
}

fn bytes(name: &str) -> Vec<u8> {
    fs::read(PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)).expect(name)
}
fn table(name: &str) -> Table {
    let bytes = bytes(name);
    let kind = Kind::of(&bytes).expect(name);
    read(kind, &bytes, MOST).unwrap_or_else(|error| panic!("{name}: {error}"))
}
fn fault(name: &str) -> String {
    let bytes = bytes(name);
    let Error::File(message) = Kind::of(&bytes).and_then(|kind| read(kind, &bytes, MOST)).expect_err(name) else {
        panic!("{name}: another error")
    };
    message
}

/// Name, unit, times of samples, values of a column.
type Expected<'a> = (&'a str, Option<&'a str>, Option<[f64; 2]>, Values);

fn floats(value: fn(usize) -> f64) -> Values {
    Values::Float((0..N).map(value).collect())
}
fn integers(value: fn(usize) -> i64) -> Values {
    Values::Integer((0..N).map(value).collect())
}
/// NaN for a gap is no equal of itself: compared as bits.
fn bits(values: &Values) -> Vec<u64> {
    match values {
        Values::Float(values) => values.iter().map(|value| value.to_bits()).collect(),
        Values::Integer(values) => values.iter().map(|value| value.cast_unsigned()).collect(),
        other => panic!("{other:?}"),
    }
}
fn plain(name: &str, value: fn(usize) -> f64) -> Expected<'_> {
    (name, None, None, floats(value))
}
fn holds(file: &str, expected: Vec<Expected<'_>>) {
    let found = table(file).columns;
    let names: Vec<&str> = found.iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names, expected.iter().map(|column| column.0).collect::<Vec<_>>(), "{file}");
    for (found, (name, unit, sampled_s, values)) in found.iter().zip(expected) {
        assert_eq!(
            (found.unit.as_deref(), found.sampled_s, &found.values),
            (unit, sampled_s, &values),
            "{file}, {name}"
        );
    }
}

#[test]
fn npy() {
    for file in ["c_order.npy", "fortran_f4_big.npy", "rows.npy"] {
        holds(file, vec![plain("", t), plain("", a)]);
    }
    holds("one_i2_big.npy", vec![plain("", c)]);
    holds("big_u8.npy", vec![("", None, None, integers(big))]);
    holds(
        "fields.npy",
        vec![
            plain("t", t),
            plain("acc[0]", a),
            plain("acc[1]", b),
            plain("n", c),
            ("when", Some("ns"), None, integers(ns)),
        ],
    );
    assert!(fault("complex.npy").contains("\"array\" (complex;"));
    assert!(fault("objects.npy").contains("\"|O\""));
}

#[test]
fn wav() {
    // A share of full scale: 2^7, 2^15, 2^23 or 2^31.
    let full_scale = |name, value| (name, Some("full scale"), Some([0.0, 1e-4]), floats(value));
    holds("u8.wav", vec![full_scale("channel 1", |i| c(i) / 128.0)]);
    holds(
        "i16_two.wav",
        vec![full_scale("channel 1", |i| c(i) * 8.0 / 32768.0), full_scale("channel 2", |i| b(i) / 32768.0)],
    );
    holds("i24.wav", vec![full_scale("channel 1", |i| c(i) / 32768.0)]);
    holds("i32.wav", vec![full_scale("channel 1", |i| c(i) / 32768.0)]);
    holds("rifx.wav", vec![full_scale("channel 1", |i| c(i) / 32768.0)]);
    for file in ["f32.wav", "f64.wav", "extensible.wav", "extensible_big.wav", "rf64.wav"] {
        holds(file, vec![("channel 1", None, Some([0.0, 1e-4]), floats(a))]);
    }
}

#[test]
fn mat() {
    let at = |name, value| (name, None, Some([0.0, 1.0 / 1024.0]), floats(value));
    for file in ["plain.mat", "packed.mat"] {
        holds(
            file,
            vec![
                at("t", t),
                at("a", a),
                at("m(:,1)", c),
                at("m(:,2)", b),
                at("s", a),
                at("run.acc", b),
                at("run.inner.n", c),
                ("big", None, Some([0.0, 1.0 / 1024.0]), integers(big)),
            ],
        );
    }
    holds("big_endian.mat", vec![plain("a", c)]);
    assert!(fault("complex.mat").contains("\"z\" (complex;"));
    holds("level4.mat", vec![plain("t", t)]);
    holds("level4_big.mat", vec![at("a", a), at("m(:,1)", c), at("m(:,2)", b)]);
}

#[cfg(feature = "hdf5")]
#[test]
fn hdf5() {
    let at = |name, value| (name, None, Some([0.0, 1.0 / 1024.0]), floats(value));
    holds(
        "plain.h5",
        vec![
            ("acc", Some("g"), None, floats(a)),
            plain("t", t),
            at("run 2/m[:,0]", a),
            at("run 2/m[:,1]", b),
            ("run 2/own", Some("m/s2"), Some([0.0, 0.25]), floats(b)),
            at("run 2/deep/x", c),
        ],
    );
    holds(
        "packed.h5",
        vec![
            at("growing", c),
            at("lzf", b),
            at("m[0,:]", a),
            at("m[1,:]", b),
            at("scaled", |i| 0.25 * c(i) + 1.0),
            at("t", t),
            at("table.t", t),
            at("table.a", a),
        ],
    );
    holds("v73.mat", vec![at("m(:,1)", a), at("m(:,2)", b), at("t", t)]);
}

#[test]
fn tdms() {
    holds(
        "segments.tdms",
        vec![
            ("run 1/ax", Some("g"), Some([-0.25, 1.0 / 1024.0]), floats(a)),
            plain("it's", c),
            ("when", Some("ns"), None, integers(ns)),
            plain("run 2/ax", b),
            ("big", None, None, integers(big)),
        ],
    );
    holds("scaled.tdms", vec![plain("a", |i| 2.0 + 0.5 * (0.25 * c(i) + 1.0).powi(2))]);
    for file in ["interleaved.tdms", "interleaved_big.tdms"] {
        holds(file, vec![plain("a", a), plain("c", c)]);
    }
}

/// Two channels, of these types and numbers of values, and four bytes of data, in a segment that was not finished.
fn odd_tdms(channels: [(u32, u64); 2], interleaved: bool) -> Result<Table, Error> {
    let mut meta = 2_u32.to_le_bytes().to_vec();
    for ((kind, count), path) in channels.into_iter().zip(["/'g'/'a'", "/'g'/'b'"]) {
        meta.extend(8_u32.to_le_bytes());
        meta.extend(path.bytes());
        meta.extend([20_u32, kind, 1].iter().flat_map(|word| word.to_le_bytes()));
        meta.extend(count.to_le_bytes());
        meta.extend([0; 4]);
    }
    let contents = if interleaved { 0x2e_u32 } else { 0x0e };
    let mut file = b"TDSm".to_vec();
    file.extend([contents, 4713].iter().flat_map(|word| word.to_le_bytes()));
    file.extend([u64::MAX, meta.len() as u64].iter().flat_map(|word| word.to_le_bytes()));
    file.extend(meta);
    file.extend([1, 0, 2, 0]);
    read(Kind::of(&file)?, &file, MOST)
}

#[test]
fn odd_layouts_of_tdms() {
    for interleaved in [false, true] {
        // Nothing, three times, then two integers.
        let found = odd_tdms([(0, 3), (2, 2)], interleaved).expect("a table").columns;
        assert_eq!((found.len(), &found[0].values), (1, &Values::Float(vec![1.0, 2.0])));
    }
    // More bytes than there are addresses: what the file has is the beginning of the first channel.
    let found = odd_tdms([(2, u64::MAX / 4), (2, u64::MAX / 4)], false).expect("a table").columns;
    assert_eq!(found[0].values, Values::Float(vec![1.0, 2.0]));
}

/// As text with 5 decimals.
fn printed(value: f64) -> f64 {
    format!("{value:.5e}").parse().expect("a number")
}

#[test]
fn uff() {
    let step = printed(1.0 / 1024.0);
    let even = |name, unit, value| (name, Some(unit), Some([0.0, step]), floats(value));
    holds("even.uff", vec![even("Acceleration 12+Z", "m/s2", a), even("acceleration 13-X", "g", b)]);
    holds("binary.uff", vec![even("Acceleration 12+Z", "m/s2", a), even("Force 12+Z", "N", b)]);
    let uneven = |i| printed(t(i) + (i % 2) as f64 / 65536.0);
    let time = |value| ("Time", Some("s"), None, floats(value));
    let acceleration = || ("Acceleration 12+Z", Some("m/s2"), None, floats(a));
    holds("uneven.uff", vec![time(uneven), acceleration(), ("Force 12+Z", Some("N"), None, floats(b))]);
    for file in ["binary_big.uff", "binary_single.uff"] {
        holds(file, vec![time(t), acceleration()]);
    }
    // By another hand: one sample of 1 m/s2 after 1 ms.
    let values = Values::Float(vec![0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
    holds("time58.uff", vec![("Acceleration", Some("m/s2"), Some([0.0, 0.001]), values)]);
    assert!(fault("complex.uff").contains("complex"));
    // In Latin-1.
    let file = bytes("time58.uff");
    let place = file.windows(4).position(|word| word == b"m/s2").expect("a unit");
    let latin = [&file[..place], b"m/s\xb2", &file[place + 4..]].concat();
    assert_eq!(read(Kind::Uff, &latin, MOST).expect("a table").columns[0].unit.as_deref(), Some("m/s²"));
}

/// Fixed fields and Fortran may leave numbers without a blank between them.
#[test]
fn numbers_of_uff() {
    let file = String::from_utf8(bytes("time58.uff")).expect("text");
    let numbers = "  0.00000E+00  1.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00";
    for (line, expected) in [
        ("-1.23457E+001-1.23457E+002 1.0 2 3 4", None),
        (
            "-1.23457E+001-1.23457E+002  0.00000E+00  0.00000D+00  0.00000E+00-1.00000E-002",
            Some([-12.3457, -123.457, 0.0, 0.0, 0.0, -0.01]),
        ),
        ("1 2 3.5 4e0 5 6", Some([1.0, 2.0, 3.5, 4.0, 5.0, 6.0])),
        (
            "  1.00000-101  1.00000+101  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00",
            Some([1e-101, 1e101, 0.0, 0.0, 0.0, 0.0]),
        ),
        ("inf 1 1 1 1 1", None),
    ] {
        let file = file.replace(numbers, line);
        let found = read(Kind::Uff, file.as_bytes(), MOST);
        match expected {
            Some(expected) => assert_eq!(found.expect(line).columns[0].values, Values::Float(expected.to_vec())),
            None => {
                assert!(found.expect_err(line).to_string().contains("line 14: numbers should stand here"), "{line}");
            }
        }
    }
}

#[cfg(feature = "parquet")]
#[test]
fn columnar() {
    let gaps = |i| if i % 5 == 3 { f64::NAN } else { b(i) };
    let huge = |i| 2_f64.powi(63) + 4096.0 * i as f64;
    let expected: Vec<(&str, Option<&str>, Values)> = vec![
        ("t", None, floats(t)),
        ("a", Some("g"), floats(a)),
        ("gaps", Some("m/s2"), floats(gaps)),
        ("n", None, floats(c)),
        ("u", None, floats(|i| c(i) + 50.0)),
        ("ms", Some("ns"), integers(ns)),
        ("ns", Some("ns"), integers(ns)),
        ("big", None, integers(big)),
        ("huge", None, floats(huge)),
        ("same", None, floats(|_| 0.5)),
    ];
    for file in [
        "plain.arrow",
        "lz4.arrow",
        "zstd.arrow",
        "snappy.parquet",
        "gzip_v2.parquet",
        "zstd.parquet",
        "lz4.parquet",
        "plain.parquet",
    ] {
        let found = table(file).columns;
        // A pair of a number and the text of one is two columns.
        let found: Vec<&Column> = found.iter().filter(|column| !column.name.starts_with("pair.")).collect();
        let names: Vec<&str> = found.iter().map(|column| column.name.as_str()).collect();
        assert_eq!(names, expected.iter().map(|column| column.0).collect::<Vec<_>>(), "{file}");
        for (found, (name, unit, values)) in found.iter().zip(&expected) {
            assert_eq!(found.unit.as_deref(), *unit, "{file}, {name}");
            assert_eq!(bits(&found.values), bits(values), "{file}, {name}");
        }
    }
    // Columns of text as views stand before and after.
    let found = table("stream.arrows").columns;
    assert_eq!((found[0].name.as_str(), &found[0].values), ("a", &floats(a)));
    assert_eq!(found.last().map(|column| (column.name.as_str(), &column.values)), Some(("t", &floats(t))));
    let found = table("int96.parquet").columns;
    assert_eq!((found[1].unit.as_deref(), &found[1].values), (Some("ns"), &integers(ns)));
    assert!(fault("brotli.parquet").contains("column \"t\" is compressed by Brotli"));
}

const ODD: [f64; 6] = [0.1, -0.0, f64::MIN_POSITIVE / 8.0, f64::MAX, f64::NAN, -1e-300];

#[cfg(feature = "parquet")]
#[test]
fn written_parquet_comes_back_to_the_bit() {
    // More than one page, with a remainder.
    let long: Vec<f64> = (0..(1 << 17) + 3).map(|i| f64::from(i).sqrt()).collect();
    let odd: Vec<f64> = ODD.iter().cycle().take(long.len()).copied().collect();
    let columns =
        [Series { name: "time", unit: "s", values: &long }, Series { name: "ax", unit: "m/s2", values: &odd }];
    let file = write_parquet(&columns).expect("a file");
    let table = read(Kind::of(&file).expect("Parquet"), &file, 2 * long.len()).expect("a table");
    let [time, ax] = table.columns.as_slice() else { panic!("two columns") };
    assert_eq!((time.name.as_str(), time.unit.as_deref()), ("time [s]", Some("s")));
    assert_eq!((ax.name.as_str(), ax.unit.as_deref()), ("ax [m/s2]", Some("m/s2")));
    assert_eq!(bits(&ax.values), bits(&Values::Float(odd.clone())));
    assert_eq!(bits(&time.values), bits(&Values::Float(long.clone())));
    let twice = Series { name: "a", unit: "g", values: &[1.0] };
    assert!(write_parquet(&[twice, twice]).expect_err("two of a name").to_string().contains("\"a [g]\""));
}

#[cfg(feature = "parquet")]
fn in_groups(groups: &[Vec<Vec<f64>>]) -> Vec<u8> {
    let kinds = [FieldKind::Float, FieldKind::FloatOrNone, FieldKind::Whole, FieldKind::Flag];
    let field = |(i, kind): (usize, &FieldKind)| Field { name: format!("c{i}"), unit: "m/s2".to_owned(), kind: *kind };
    let mut writer = RowGroupWriter::new(Vec::new(), kinds.iter().enumerate().map(field).collect()).unwrap();
    for group in groups {
        writer.write(&group.iter().map(Vec::as_slice).collect::<Vec<_>>()).unwrap();
    }
    writer.finish(&[("plan", "samples = 3"), ("empty", "")]).unwrap()
}

#[cfg(feature = "parquet")]
#[test]
fn row_groups_come_back_to_the_bit_one_by_one() {
    let numbers = |rows: usize| ODD.iter().cycle().take(rows).copied().collect::<Vec<_>>();
    let group = |rows: usize| {
        let count = |i: usize| i as f64;
        let gaps = (0..rows).map(|i| if i % 3 == 1 { f64::NAN } else { count(i).sqrt() }).collect();
        let whole = (0..rows).map(|i| 2_f64.powi(53) - count(i)).collect();
        vec![numbers(rows), gaps, whole, (0..rows).map(|i| count(i % 5 % 2)).collect()]
    };
    // Groups without a gap, whole bytes and not, more than a page.
    let mut groups = vec![group(1), group(16), group(19), group((1 << 17) + 3)];
    groups[1][1] = vec![0.5; 16];
    let file = in_groups(&groups);
    let mut found = RowGroups::new(std::io::Cursor::new(&file)).unwrap();
    assert_eq!(found.names(), ["c0", "c1", "c2", "c3"]);
    assert_eq!((found.note("plan"), found.note("empty"), found.note("seed")), (Some("samples = 3"), Some(""), None));
    assert_eq!(found.rows(), [1, 16, 19, (1 << 17) + 3]);
    for (i, group) in groups.iter().enumerate() {
        for (k, values) in group.iter().enumerate() {
            let read = found.read(i, k).unwrap();
            let same = |a: f64, b: f64| a.to_bits() == b.to_bits() || k == 1 && a.is_nan() && b.is_nan();
            assert!(read.len() == values.len() && read.iter().zip(values).all(|(a, b)| same(*a, *b)), "{i}, {k}");
        }
    }
    // The reader of records takes the columns of numbers.
    let table = read(Kind::of(&file).unwrap(), &file, 1 << 22).unwrap();
    assert_eq!(table.columns.iter().map(|column| column.unit.as_deref()).collect::<Vec<_>>(), [Some("m/s2"); 3]);
}

/// A byte that is not as it was written is told wherever numbers stand, and no file is taken that ends too early.
#[cfg(feature = "parquet")]
#[test]
fn torn_row_groups_are_refused() {
    let file = in_groups(&[vec![vec![0.1, 0.2], vec![f64::NAN, 1.0], vec![3.0, 4.0], vec![0.0, 1.0]]]);
    let all = |file: &[u8]| {
        let mut groups = RowGroups::new(std::io::Cursor::new(file))?;
        let columns = groups.names().len();
        (0..groups.rows().len()).try_for_each(|group| (0..columns).try_for_each(|k| groups.read(group, k).map(drop)))
    };
    assert_eq!(all(&file), Ok(()));
    for length in 0..file.len() {
        assert!(all(&file[..length]).is_err(), "{length} of {} bytes", file.len());
    }
    let numbers = [0.1_f64, 0.2, 1.0].map(f64::to_le_bytes);
    for number in numbers {
        let at = file.windows(8).position(|bytes| bytes == number).unwrap();
        for k in at..at + 8 {
            let mut torn = file.clone();
            torn[k] ^= 4;
            assert!(all(&torn).unwrap_err().to_string().contains("not as it was written"), "byte {k}");
        }
    }
    // Anywhere else there may be a note or a name; nothing panics.
    for k in 0..file.len() {
        let mut torn = file.clone();
        torn[k] ^= 0x81;
        let _ = all(&torn);
    }
}

#[test]
fn what_is_not_read_is_named() {
    for (beginning, message) in [
        (
            &b"PK\x03\x04\x14\x00"[..],
            "this is a spreadsheet, an NPZ or another ZIP file: save a spreadsheet as CSV, unpack what is packed",
        ),
        (b"\x1a\x45\xdf\xa3\xa3", "this is an IDE file of an enDAQ or Mide logger: export it as CSV with enDAQ Lab"),
        (b"\x1f\x8b\x08", "this is a gzip file: unpack it first"),
        (b"\x28\xb5\x2f\xfd", "this is a Zstandard file: unpack it first"),
        (b"%PDF-1.7", "this is a PDF: a record is numbers: save them as CSV"),
        (b"{\"t\": [0.0, 0.1]}", "this is a JSON file: save the numbers as CSV"),
        (b"\n [ [0, 1], [1, 2] ]", "this is a JSON file: save the numbers as CSV"),
        (
            b"<?xml version=\"1.0\"?><usi:tdm>",
            "this is the header of an NI TDM file: save the channels as TDMS or CSV with DIAdem or LabVIEW",
        ),
        (b"\x80\x04\x95\x10\x00", "this is a pickle of Python: save the array with numpy.save or as CSV"),
    ] {
        assert_eq!(Kind::of(beginning).expect_err(message).to_string(), message);
    }
    for text in [
        &b"time [s],a [g]\n0,0\n"[..],
        b"-1\n58\n",
        b"",
        b"[s],[g]\n0,1\n",
        b"\xff\xfet\0,\0a\0",
        b"P,K\n1,2\n",
        b"channel,WAVE\n1,2\n",
    ] {
        assert_eq!(Kind::of(text).expect("text"), Kind::Text, "{text:?}");
    }
}

#[test]
fn larger_tables_are_refused() {
    for entry in files() {
        let bytes = bytes(&entry);
        let Ok(kind) = Kind::of(&bytes) else { continue };
        let Ok(table) = read(kind, &bytes, MOST) else { continue };
        let most = table.columns.iter().map(|column| column.values.len()).sum::<usize>();
        let refused = read(kind, &bytes, most - 1).expect_err(&entry).to_string();
        assert!(refused.contains(&format!("more than {} values", most - 1)), "{entry}: {refused}");
    }
}

fn files() -> Vec<String> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let names = fs::read_dir(folder).expect("tests/data").map(|entry| entry.expect("a file").file_name());
    let mut names: Vec<String> = names.map(|name| name.into_string().expect("a name")).collect();
    names.retain(|name| name != "make.py");
    names.sort();
    names
}

/// Parts behind the samples hold none, of a file too whose length stands in another place; 12 bits stand in two bytes.
#[test]
fn wav_of_other_programs() {
    let values = |bytes: &[u8]| -> Vec<Values> {
        let table = read(Kind::of(bytes).expect("wav"), bytes, MOST).unwrap_or_else(|error| panic!("{error}"));
        table.columns.into_iter().map(|column| column.values).collect()
    };
    let whole = bytes("rf64.wav");
    let more = [&whole[..], b"LIST\x04\0\0\0abcd"].concat();
    assert_eq!(values(&more), values(&whole));
    let of_16 = bytes("i16_two.wav");
    let mut of_12 = of_16.clone();
    assert_eq!(std::mem::replace(&mut of_12[34], 12), 16, "bits of a sample");
    assert_eq!(values(&of_12), values(&of_16));
}

/// Text beside the numbers of a row takes four bytes a letter.
#[test]
fn npy_with_text_beside_its_numbers() {
    let header = b"{'descr': [('name', '<U3'), ('a', '<f8')], 'fortran_order': False, 'shape': (2,), }\n";
    let row = |letter: u8, value: f64| [&[letter, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0][..], &value.to_le_bytes()].concat();
    let length = u8::try_from(header.len()).unwrap();
    let file = [b"\x93NUMPY\x01\0", &[length, 0][..], header, &row(b'x', 1.5), &row(b'y', -2.0)].concat();
    let found = read(Kind::of(&file).expect("npy"), &file, MOST).unwrap_or_else(|error| panic!("{error}")).columns;
    assert_eq!(found.len(), 1);
    assert_eq!((found[0].name.as_str(), &found[0].values), ("a", &Values::Float(vec![1.5, -2.0])));
}
