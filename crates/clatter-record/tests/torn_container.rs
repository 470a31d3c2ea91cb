//! Files that are cut, or have bytes that are not theirs: read or refused, never a panic, in little memory.

use clatter_record::{Kind, read};
use std::fs;
use std::path::PathBuf;

/// Values that are allowed: more than any of the files has.
const MOST: usize = 10_000;
/// Torn variants of each file.
const VARIANTS: u64 = 2_000;
/// Bytes that a reader may take at once: the values that are allowed take 80 kB, and are held at most twice, packed and
/// unpacked bytes once more each; a decoder of LZ4 or Zstandard takes some 100 kB whatever the file. Measured: 276 kB.
const MEMORY: u64 = 1 << 20;
/// A Zstandard frame may ask for a window of up to 100 MiB (ruzstd refuses more), which is never filled.
const WINDOW: u64 = 100 << 20;

/// Numbers as if by chance, the same in every run (Knuth's MMIX).
struct Chance(u64);

impl Chance {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).expect("31 bits") % bound.max(1)
    }
}

/// Cuts the end, changes bits, writes large or small numbers over the bytes, or takes some out.
fn torn(bytes: &[u8], chance: &mut Chance) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=chance.below(4) {
        let (at, width) = (chance.below(bytes.len()), 1 + chance.below(8));
        let end = (at + width).min(bytes.len());
        match chance.below(8) {
            0 => bytes.truncate(at),
            1 => drop(bytes.drain(at..end)),
            2 => bytes[at..end].fill(0xff),
            3 => bytes[at..end].fill(0),
            4 => bytes[at..end].fill(0x7f),
            _ if at < end => bytes[at] ^= 1 << chance.below(8),
            _ => {}
        }
        if bytes.is_empty() {
            break;
        }
    }
    bytes
}

#[test]
fn torn_files_are_read_or_refused() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let mut files: Vec<PathBuf> =
        fs::read_dir(folder).expect("tests/data").map(|entry| entry.expect("a file").path()).collect();
    files.sort();
    let mut chance = Chance(1);
    let (mut refused, mut kept) = (0_u32, 0_u32);
    for file in files {
        let whole = fs::read(&file).expect("a file");
        let Some(_) = Kind::of(&whole).ok().filter(|kind| *kind != Kind::Text) else { continue };
        for variant in 0..VARIANTS {
            let bytes = torn(&whole, &mut chance);
            let taken = allocation_counter::measure(|| {
                // A file that no longer is of its kind is not this test's.
                let Ok(kind) = Kind::of(&bytes) else { return };
                match read(kind, &bytes, MOST) {
                    Ok(table) => {
                        let values: usize = table.columns.iter().map(|column| column.values.len()).sum();
                        assert!(values <= MOST, "{values} values");
                        kept += 1;
                    }
                    Err(_) => refused += 1,
                }
            });
            let bound = MEMORY + if file.to_string_lossy().contains("zstd") { WINDOW } else { 0 };
            assert!(taken.bytes_max < bound, "{} in variant {variant}: {} bytes", file.display(), taken.bytes_max);
        }
    }
    // Both ways were gone.
    assert!(refused > 1000 && kept > 1000, "{refused} refused, {kept} read");
}

/// A million zeros, 8 MB, packed into some kB.
#[test]
fn packed_numbers_beyond_the_bound_take_no_memory() {
    for file in ["bomb.mat", "bomb.h5", "bomb_zstd.parquet", "bomb_zstd.arrow"] {
        let bytes = fs::read(PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(file)).expect(file);
        let kind = Kind::of(&bytes).expect(file);
        let built = cfg!(all(feature = "hdf5", feature = "parquet"));
        assert!(read(kind, &bytes, 1_000_000).is_ok() || !built, "{file}");
        let taken = allocation_counter::measure(|| {
            let refused = read(kind, &bytes, MOST).expect_err(file).to_string();
            assert!(!built || refused.contains("more than"), "{file}: {refused}");
        });
        assert!(taken.bytes_max < MEMORY, "{file}: {} bytes", taken.bytes_max);
    }
}
