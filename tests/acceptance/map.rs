//! `clatter map`: the same values in every format, whole files or none.

use std::fs;
use std::path::Path;

use clatter::{Axis, Map, Quantity};
use clatter_cli::Exit;
use serde_json::{Value, json};

use crate::{Outcome, answer, clatter};

/// Writes a small map of `quantity`, three values of q by four of e, into `file`.
fn small_map(quantity: &str, file: &Path) -> Outcome {
    clatter(["map", quantity, "--q=-0.5:1:3", "--e=0:1:4", "-o", file.to_str().unwrap()])
}

/// What the library says to the same.
fn expected(quantity: Quantity) -> Vec<f64> {
    Map::compute(quantity, Axis::q(-0.5, 1.0, 3).unwrap(), Axis::e(0.0, 1.0, 4).unwrap()).unwrap().values
}

/// Reads what `.npy` version 1.0 says about itself, and its values.
fn read_npy(file: &Path) -> (String, Vec<f64>) {
    let bytes = fs::read(file).unwrap();
    let (magic, rest) = bytes.split_at(8);
    assert_eq!(magic, b"\x93NUMPY\x01\x00");
    let length = usize::from(u16::from_le_bytes([rest[0], rest[1]]));
    assert_eq!((10 + length) % 64, 0, "data start at a multiple of 64 bytes");
    let (header, data) = rest[2..].split_at(length);
    assert_eq!(header.last(), Some(&b'\n'));
    let values = data.chunks(8).map(|eight| f64::from_le_bytes(eight.try_into().unwrap())).collect();
    (String::from_utf8(header.to_vec()).unwrap().trim_end().to_owned(), values)
}

#[test]
fn an_npy_file_holds_the_values_bit_by_bit() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("impacts.npy");
    let outcome = small_map("impacts", &file);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""));
    let (header, values) = read_npy(&file);
    assert_eq!(header, "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }");
    assert_eq!(values, expected(Quantity::Impacts));
    assert!(values.contains(&f64::INFINITY), "endless is inf");
}

#[test]
fn a_csv_file_has_a_line_for_every_point_with_e_fastest() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("peak.csv");
    assert_eq!(small_map("peak-end", &file).exit, Exit::Done);
    let text = fs::read_to_string(&file).unwrap();
    let (heading, rows) = text.split_once('\n').unwrap();
    assert_eq!(heading, "q,e,peak-end");
    let third = 1.0 / 3.0;
    let grid = [-0.5, 0.25, 1.0].into_iter().flat_map(|q| [0.0, third, 2.0 * third, 1.0].map(|e| (q, e)));
    for ((row, (q, e)), value) in rows.lines().zip(grid).zip(expected(Quantity::PeakEnd)) {
        let read: Vec<f64> = row.split(',').map(|number| number.parse().unwrap()).collect();
        assert_eq!(read, [q, e, value], "{row}");
    }
    assert_eq!(rows.lines().count(), 12);
    assert!(rows.ends_with("1.0,1.0,inf\n"), "{rows}");
}

#[test]
fn a_json_file_has_a_row_for_every_q_and_says_infinite() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("peak.json");
    assert_eq!(small_map("peak-end", &file).exit, Exit::Done);
    let read: Value = serde_json::from_str(&fs::read_to_string(&file).unwrap()).unwrap();
    assert_eq!(read["quantity"], json!("peak-end"));
    assert_eq!(read["q"], json!([-0.5, 0.25, 1.0]));
    assert_eq!(read["e"].as_array().unwrap().len(), 4);
    let expected = expected(Quantity::PeakEnd);
    for (i, row) in read["values"].as_array().unwrap().iter().enumerate() {
        for (j, value) in row.as_array().unwrap().iter().enumerate() {
            let want = expected[4 * i + j];
            assert_eq!(*value, if want.is_infinite() { json!("infinite") } else { json!(want) }, "row {i}, column {j}");
        }
    }
}

#[test]
fn every_quantity_is_the_one_it_is_called() {
    let folder = tempfile::tempdir().unwrap();
    for (name, quantity) in [
        ("impacts", Quantity::Impacts),
        ("peak-end", Quantity::PeakEnd),
        ("peak-center", Quantity::PeakCenter),
        ("peak-angular", Quantity::PeakAngular),
        ("net-center", Quantity::NetCenter),
        ("duration", Quantity::Duration),
    ] {
        let file = folder.path().join(format!("{name}.npy"));
        assert_eq!(small_map(name, &file).exit, Exit::Done);
        assert_eq!(read_npy(&file).1, expected(quantity), "{name}");
    }
    let file = folder.path().join("zone.npy");
    let file_name = file.to_str().unwrap();
    let outcome = clatter(["map", "zone", "--threshold=0.5", "--q=-0.5:1:3", "--e=0:1:4", "-o", file_name]);
    assert_eq!(outcome.exit, Exit::Done);
    assert_eq!(read_npy(&file).1, expected(Quantity::Zone(0.5)));
}

#[test]
fn a_picture_is_svg() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("peak.svg");
    assert_eq!(small_map("peak-end", &file).exit, Exit::Done);
    assert!(fs::read_to_string(&file).unwrap().contains("<svg"));
}

#[test]
fn a_grid_of_one_point_is_a_grid() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("one.csv");
    let outcome = clatter(["map", "impacts", "--q=0.5:0.5:1", "--e=0.3:0.3:1", "-o", file.to_str().unwrap()]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""));
    assert_eq!(fs::read_to_string(&file).unwrap(), "q,e,impacts\n0.5,0.3,4\n");
}

#[test]
fn the_answer_says_what_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("peak.csv");
    let name = file.to_str().unwrap();
    let arguments = ["map", "peak-end", "--q=0:1:3", "--e=0:1:4", "-o", name];
    let told = clatter(arguments).stdout;
    assert_eq!(told, format!("{name}: peak-end over 3 values of q from 0 to 1 and 4 values of e from 0 to 1\n"));
    let want = json!({"file": name, "quantity": "peak-end", "axes": ["q", "e"], "points": [3, 4]});
    assert_eq!(answer(arguments), want);
}

#[test]
fn the_gyration_ratio_takes_the_place_of_q_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let file = |ending: &str| folder.path().join(format!("impacts.{ending}"));
    // So little mass at the ends that q rounds to 1, where every train is endless.
    let map = |ending| {
        let name = file(ending).to_str().unwrap().to_owned();
        ["map", "impacts", "--gyration-ratio=1e-9:2e-9:2", "--e=1:1:1", "-o", &name].map(str::to_owned)
    };
    let told = clatter(map("csv")).stdout;
    assert!(told.contains("over 2 values of gyration ratio from 1e-9 to 2e-9 and 1 values of e"), "{told}");
    // N = ⌈π/(2 atan k) − ½⌉.
    let csv = fs::read_to_string(file("csv")).unwrap();
    assert_eq!(csv, "gyration_ratio,e,impacts\n1e-9,1.0,1570796327\n2e-9,1.0,785398163\n");
    assert_eq!(answer(map("json"))["axes"], json!(["gyration_ratio", "e"]));
    let read: Value = serde_json::from_str(&fs::read_to_string(file("json")).unwrap()).unwrap();
    assert_eq!((&read["gyration_ratio"], read.get("q")), (&json!([1e-9, 2e-9]), None));
    assert_eq!(clatter(map("npy")).exit, Exit::Done);
    assert_eq!(read_npy(&file("npy")).1, [1_570_796_327.0, 785_398_163.0]);
    assert_eq!(clatter(map("svg")).exit, Exit::Done);
    assert!(fs::read_to_string(file("svg")).unwrap().contains("gyration ratio"));
}

#[test]
fn one_axis_of_inertia_is_needed_and_no_two() {
    for (arguments, reason) in [
        (vec!["--e=0:1:2"], "required"),
        (vec!["--q=0:1:2", "--gyration-ratio=0:1:2", "--e=0:1:2"], "cannot be used with"),
        (vec!["--gyration-ratio=-1:1:2", "--e=0:1:2"], "axis gyration ratio = -1.0:1.0:2: the gyration ratio must be"),
    ] {
        let outcome = clatter(["map", "impacts", "-o", "never.csv"].into_iter().chain(arguments));
        assert_eq!(outcome.exit, Exit::BadInput);
        assert!(outcome.stderr.contains(reason), "{}", outcome.stderr);
    }
}

#[test]
fn what_was_there_is_replaced_and_nothing_is_left_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("peak.csv");
    fs::write(&file, "an older and longer text".repeat(100)).unwrap();
    assert_eq!(small_map("peak-end", &file).exit, Exit::Done);
    assert!(fs::read_to_string(&file).unwrap().starts_with("q,e,peak-end\n"));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[cfg(unix)]
#[test]
fn a_link_is_followed_and_stays_a_link() {
    let folder = tempfile::tempdir().unwrap();
    let (file, link) = (folder.path().join("real.csv"), folder.path().join("link.csv"));
    fs::write(&file, "old").unwrap();
    std::os::unix::fs::symlink(&file, &link).unwrap();
    assert_eq!(small_map("peak-end", &link).exit, Exit::Done);
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert!(fs::read_to_string(&file).unwrap().starts_with("q,e,peak-end\n"));
}

#[test]
fn what_cannot_be_written_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let (file, directory) = (folder.path().join("file"), folder.path().join("directory.csv"));
    fs::write(&file, "").unwrap();
    fs::create_dir(&directory).unwrap();
    for (target, reason) in [
        (directory, "is a directory"),
        (folder.path().join("missing/map.csv"), "there is no directory"),
        (file.join("map.csv"), "there is no directory"),
    ] {
        let outcome = small_map("peak-end", &target);
        let expected = format!("error: cannot write {}: {reason}", target.display());
        assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""));
        assert!(outcome.stderr.starts_with(&expected), "{}", outcome.stderr);
        assert_eq!(outcome.stderr.lines().count(), 1);
    }
}
