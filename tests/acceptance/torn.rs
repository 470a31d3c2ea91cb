//! Records, lists and command lines torn by chance, of those that the fuzz targets begin with: read or refused, and what is read can be
//! used. Product files and containers are torn by the crates that read them.

use std::fs;
use std::path::Path;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;

#[path = "../../fuzz/src/lib.rs"]
#[expect(unreachable_pub, reason = "public to the fuzz targets")]
mod inputs;

/// What has a meaning somewhere in a record, a list or an argument.
const PIECES: [&str; 24] = [
    ",",
    ";",
    "\t",
    "\n",
    "\r\n",
    "\"",
    "=",
    ":",
    "-",
    ".",
    "1e308",
    "1e-320",
    "nan",
    "inf",
    "0",
    "-1",
    "9999999999",
    "1,5",
    "#",
    "12:00:00",
    "ms",
    "g",
    "\u{feff}",
    "\u{0}",
];

#[derive(Debug, Clone)]
enum Tear {
    Cut,
    Remove(usize),
    Repeat(usize),
    Byte(u8),
    Piece(usize),
}

fn tears() -> impl Strategy<Value = Vec<(Index, Tear)>> {
    let tear = prop_oneof![
        1 => Just(Tear::Cut),
        2 => (1..40_usize).prop_map(Tear::Remove),
        2 => (1..80_usize).prop_map(Tear::Repeat),
        2 => any::<u8>().prop_map(Tear::Byte),
        4 => (0..PIECES.len()).prop_map(Tear::Piece),
    ];
    vec((any::<Index>(), tear), 1..6)
}

fn torn(seed: &[u8], tears: &[(Index, Tear)]) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for (place, tear) in tears {
        let at = place.index(bytes.len() + 1);
        let end = |count: usize| bytes.len().min(at + count);
        match *tear {
            Tear::Cut => bytes.truncate(at),
            Tear::Remove(count) => drop(bytes.drain(at..end(count))),
            Tear::Repeat(count) => {
                let again = bytes[at..end(count)].to_vec();
                bytes.splice(at..at, again);
            }
            Tear::Byte(byte) => bytes.insert(at, byte),
            Tear::Piece(piece) => drop(bytes.splice(at..at, PIECES[piece].bytes())),
        }
    }
    bytes
}

/// The files of folders of the tree, in order.
fn seeds(folders: &[&str]) -> Vec<Vec<u8>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut files: Vec<_> = folders
        .iter()
        .flat_map(|folder| fs::read_dir(root.join(folder)).expect(folder))
        .map(|entry| entry.expect("a file").path())
        .filter(|path| path.is_file())
        .collect();
    files.sort();
    let small = |bytes: &Vec<u8>| bytes.len() < 20_000;
    files.iter().map(|path| fs::read(path).expect("a file")).filter(small).collect()
}

fn each(cases: u32) -> ProptestConfig {
    ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(cases) }
}

proptest! {
    #![proptest_config(each(1000))]
    #[test]
    fn records(seed in prop::sample::select(seeds(&["fuzz/corpus/record", "crates/clatter-record/tests/cases", "crates/clatter-record/tests/cases/field"])), tears in tears()) {
        inputs::record(&torn(&seed, &tears));
    }

    #[test]
    fn arguments(seed in prop::sample::select(seeds(&["fuzz/corpus/arguments"])), tears in tears()) {
        inputs::arguments(&String::from_utf8_lossy(&torn(&seed, &tears)));
    }

    #[test]
    fn lists(seed in prop::sample::select(seeds(&["fuzz/corpus/list"])), tears in tears()) {
        inputs::list(&torn(&seed, &tears));
    }
}
