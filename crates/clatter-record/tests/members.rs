//! The account of every container: each member is read or named, by the type of its numbers (`data/make_members.py`).

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use clatter_record::{Error, Kind, Table, Values, read};

const N: u32 = 40;

fn file(name: &str) -> Vec<u8> {
    fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)).expect(name)
}
fn table(name: &str) -> Result<Table, Error> {
    let bytes = file(name);
    read(Kind::of(&bytes)?, &bytes, 100_000)
}
/// Whether a build reads a file.
fn is_built(name: &str) -> bool {
    let (_, ending) = name.rsplit_once('.').unwrap_or_default();
    match ending {
        "parquet" | "arrow" => cfg!(feature = "parquet"),
        "h5" => cfg!(feature = "hdf5"),
        _ => cfg!(feature = "hdf5") || name != "members73.mat",
    }
}

/// The numbers of a member by its name; none for what is no column of numbers.
fn expected(member: &str) -> Option<Values> {
    let a = |i: u32| (f64::from(37 * i % 101) - 50.0) / 4.0;
    let floats = |value: &dyn Fn(u32) -> f64| Some(Values::Float((0..N).map(value).collect()));
    match member.rsplit('.').next().unwrap_or_default().split_at(2) {
        ("a_", _) => floats(&a),
        ("c_", _) => floats(&|i| 4.0 * a(i)),
        ("u_", _) => floats(&|i| 4.0 * a(i) + 50.0),
        ("t_", name) => {
            let (_, tick) = name.rsplit_once(' ').expect("a tick");
            let tick_ns = match tick {
                "s" => 1_000_000_000,
                "ms" => 1_000_000,
                "us" => 1000,
                _ => 1,
            };
            Some(Values::Integer((0..N).map(|i| i64::from(i) * tick_ns).collect()))
        }
        _ => None,
    }
}

/// What is read and what is named are the members that the library which defines the kind finds in the file, each with its numbers.
#[test]
fn every_member_is_read_or_named() {
    let all: BTreeMap<String, Vec<String>> = serde_json::from_slice(&file("members.json")).expect("members.json");
    assert_eq!(all.len(), 10);
    for (name, members) in all.iter().filter(|(name, _)| is_built(name)) {
        let Table { columns, left_out, .. } = table(name).unwrap_or_else(|error| panic!("{name}: {error}"));
        let left_out = left_out.join("; ");
        let mut read = 0;
        for member in members {
            // A member may be several columns: of a structure, a matrix or an array.
            let is_of = |column: &str| {
                column
                    .strip_prefix(member.as_str())
                    .is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '(', '[']))
            };
            let of_member: Vec<_> = columns.iter().filter(|column| is_of(&column.name)).collect();
            read += of_member.len();
            let named = left_out.split('"').skip(1).step_by(2);
            let named = named.filter(|named| is_of(named.strip_prefix("run/").unwrap_or(named))).count();
            let Some(values) = expected(member) else {
                assert!(of_member.is_empty() && named > 0, "{name}: {member} is named, {left_out}");
                continue;
            };
            assert!(!of_member.is_empty() && named == 0, "{name}: {member} is read, {left_out}");
            let unit = matches!(values, Values::Integer(_)).then_some("ns");
            for column in of_member {
                assert_eq!((&column.values, column.unit.as_deref()), (&values, unit), "{name}: {}", column.name);
            }
        }
        assert_eq!(read, columns.len(), "{name}: every column is of one member");
    }
}

/// A file of nothing but what is no column of numbers says what it is.
#[test]
fn a_file_without_numbers_names_what_it_holds() {
    for (name, message) in [
        ("truths.npy", "NPY file: it holds nothing but \"array\" (truths)"),
        ("complex.npy", "NPY file: it holds nothing but \"array\" (complex; a record is real: save its real part)"),
        ("complex.mat", "MAT file: it holds nothing but \"z\" (complex; a record is real: save its real part)"),
    ] {
        assert_eq!(table(name).expect_err(name).to_string(), message);
    }
    let columns = table("text.npy").expect("numbers").columns;
    assert_eq!(columns.iter().map(|column| Some(&column.values)).collect::<Vec<_>>(), [expected("a_").as_ref(); 2]);
}

/// A sparse matrix takes the memory of its zeros, which count as values.
#[test]
fn zeros_of_sparse_matrices_count() {
    let sparse = |rows: f64, place: f64| {
        // Little-endian doubles of a sparse matrix, in two rows of three.
        let words = [2_u32, 2, 3, 0, 2].map(u32::to_le_bytes);
        let numbers = [place, rows, 1.0, 1.0, 4.5, 0.0].map(f64::to_le_bytes);
        [words.as_flattened(), b"s\0", numbers.as_flattened()].concat()
    };
    let read = |rows, place| read(Kind::Mat4, &sparse(rows, place), 1000);
    assert_eq!(read(3.0, 2.0).expect("a table").columns[0].values, Values::Float(vec![0.0, 4.5, 0.0]));
    assert!(read(1e9, 2.0).expect_err("too many").to_string().contains("more than 1000 values"));
    for (rows, place) in [(3.0, 4.0), (3.0, 0.0), (3.0, 1.5), (0.0, 1.0)] {
        assert!(read(rows, place).expect_err("damaged").to_string().contains("sparse"), "{place} of {rows}");
    }
}

/// Data sets that hold no records stand beside one that does.
#[test]
fn data_sets_of_universal_files_are_named() {
    let other = b"    -1\n    15\n         1         0         0        11  0.0  0.0  0.0\n    -1\n    -1\n   164\nunits\n    -1\n";
    let bytes = [&file("even.uff"), &other[..], &file("complex.uff")].concat();
    let Table { columns, left_out, .. } = read(Kind::of(&bytes).expect("a kind"), &bytes, 1000).expect("a table");
    assert_eq!(columns.len(), 2);
    let [others, complex] = &left_out[..] else { panic!("{left_out:?}") };
    assert_eq!(others, "\"data set 15\" (of the universal file; 58 and 58b hold records)");
    assert!(complex.contains("data set with line") && complex.contains("complex"), "{complex}");
}

/// The unit of a duration and of a time of day is its own, whatever stands beside its name; all that is left out is one note.
#[cfg(feature = "parquet")]
#[test]
fn durations_and_clocks_keep_their_unit() {
    use clatter_record::{Options, Record};
    for (name, step_s) in [("duration.parquet", 1e-3), ("clock.parquet", 1e-6)] {
        let record =
            Record::read(&*file(name), &Options::default(), |_| ()).unwrap_or_else(|error| panic!("{name}: {error}"));
        let found = record.step_s().expect(name);
        assert!((found / step_s - 1.0).abs() < 1e-9, "{name}: {found} s");
    }
    let record = Record::of_table(
        Table {
            left_out: vec!["\"b\" (text)".to_owned(), "\"c\" (truths)".to_owned()],
            ..table("clock.parquet").expect("a table")
        },
        &Options::default(),
    );
    let notes: Vec<String> = record.expect("a record").findings(1.0).iter().map(ToString::to_string).collect();
    assert!(notes.contains(&"nothing is made of \"b\" (text); \"c\" (truths)".to_owned()), "{notes:?}");
}

/// Numbers that stand for a missing one are none, by what is stored, before a scale is applied.
#[cfg(feature = "hdf5")]
#[test]
fn declared_fill_values_are_no_numbers() {
    let columns = table("fill.h5").expect("a table").columns;
    assert_eq!(columns.iter().map(|column| column.name.as_str()).collect::<Vec<_>>(), ["long", "packed", "single"]);
    for (column, member) in columns.iter().zip(["c_", "packed", "a_"]) {
        let Values::Float(values) = &column.values else { panic!("{}: floats", column.name) };
        let Some(Values::Float(all)) = expected(if member == "packed" { "c_" } else { member }) else {
            panic!("{member}")
        };
        let factor = if member == "packed" { 0.5 } else { 1.0 };
        for (i, (found, value)) in values.iter().zip(all).enumerate() {
            assert!(
                if i == 7 { found.is_nan() } else { found.to_bits() == (value * factor).to_bits() },
                "{}, {i}: {found}",
                column.name
            );
        }
    }
}

/// Binary recordings of other fields are refused by their names.
#[test]
fn recordings_of_other_fields_are_named() {
    let edf = |end: &[u8]| {
        let mut file = [b' '; 256];
        file[0] = b'0';
        file[168..184].copy_from_slice(b"01.02.2410.20.30");
        [&file[..], end].concat()
    };
    let sac = |order: fn(f32) -> [u8; 4]| {
        [order(1e-4), order(0.0)].into_iter().chain([order(-12345.0); 156]).flatten().collect::<Vec<u8>>()
    };
    for (bytes, name) in [
        (b"\x02\x50\0\0".to_vec(), "a C3D file"),
        (sac(f32::to_le_bytes), "a SAC file"),
        (sac(f32::to_be_bytes), "a SAC file"),
        (b"000001D DECK   HNZXX\x07\xe8\0\x41".to_vec(), "a SEED or miniSEED file"),
        (b"MS\x03\0\0\0".to_vec(), "a miniSEED file"),
        (edf(b""), "an EDF file"),
        (b"\xffBIOSEMIx".to_vec(), "a BDF file of BioSemi"),
        (b"\xc3\x40\xf1\x40".to_vec(), "a SEG-Y file"),
    ] {
        let message = Kind::of(&bytes).expect_err(name).to_string();
        assert!(message.starts_with(&format!("this is {name}: ")), "{message}");
    }
    for text in [&b"000001, 2\n000002, 3\n"[..], b"100000D 1.5,2\n", b"0       1.5\n", b"\tP,K\n1,2\n"] {
        assert_eq!(Kind::of(text).expect("text"), Kind::Text, "{text:?}");
    }
}
