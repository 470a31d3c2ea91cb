//! Product files torn to pieces: never a panic, never a hang, and every fault has a place.

use clatter_assess::Verdict;
use clatter_product::{EXAMPLE, ProductFile};
use proptest::prelude::*;

const SEEDS: [&str; 5] = [
    EXAMPLE,
    include_str!("../../../tests/cases/bar-handheld.toml"),
    include_str!("../../../tests/cases/bar-phone.toml"),
    include_str!("../../../tests/cases/bar-terminal.toml"),
    include_str!("../../../tests/cases/bar-laptop.toml"),
];

/// What is put into a file: tokens of its language, numbers at the edges, text of other scripts.
const PIECES: [&str; 40] = [
    "\"",
    "'",
    "[",
    "]",
    "{",
    "}",
    "=",
    ",",
    ".",
    "\n",
    "#",
    "\\",
    "[[component]]",
    "[drop]",
    "\"\"\"",
    "nan",
    "inf",
    "-inf",
    "1e308",
    "-1e308",
    "5e-324",
    "0",
    "-0.0",
    "1e999",
    "0x7fffffffffffffff",
    "1979-05-27",
    "true",
    "\"1e-300 m\"",
    "\"0 deg\"",
    "\"30 deg\"",
    "[0, 1]",
    "{ uniform = [0, 1] }",
    "{ normal = [0.3, 0.1], range = [0.1, 0.9] }",
    "\u{202e}",
    "\u{0}",
    "µ",
    "קטן",
    "\"hard\"",
    "a.b.c = 1",
    "📱",
];

#[derive(Debug, Clone)]
enum Change {
    Insert(usize),
    Remove(usize),
    Repeat(usize),
    Byte(u8),
}

fn change() -> impl Strategy<Value = (prop::sample::Index, Change)> {
    let what = prop_oneof![
        (0..PIECES.len()).prop_map(Change::Insert),
        (1..40_usize).prop_map(Change::Remove),
        (1..80_usize).prop_map(Change::Repeat),
        any::<u8>().prop_map(Change::Byte),
    ];
    (any::<prop::sample::Index>(), what)
}

/// The seed after the changes, as text: what is not UTF-8 never reaches the reader.
fn mutated(seed: &str, changes: &[(prop::sample::Index, Change)]) -> String {
    let mut bytes = seed.as_bytes().to_vec();
    for (place, change) in changes {
        let at = place.index(bytes.len() + 1);
        let rest = bytes.len() - at;
        match *change {
            Change::Insert(piece) => drop(bytes.splice(at..at, PIECES[piece].bytes())),
            Change::Remove(count) => drop(bytes.drain(at..at + count.min(rest))),
            Change::Repeat(count) => {
                let again = bytes[at..at + count.min(rest)].to_vec();
                drop(bytes.splice(at..at, again));
            }
            Change::Byte(byte) if rest > 0 => bytes[at] = byte,
            Change::Byte(_) => {}
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

fn reads(text: &str) -> Result<(), TestCaseError> {
    match ProductFile::read(text, "file") {
        // What is accepted can be assessed or refused; that takes too long for every case here.
        Ok(file) => prop_assert!(!file.components.is_empty(), "a product without parts"),
        Err(faults) => {
            prop_assert!(!faults.list().is_empty(), "refused without a reason");
            let shown = faults.to_string();
            prop_assert!(shown.starts_with("error: "), "{shown}");
            prop_assert!(shown.len() < 200_000, "{} bytes of message", shown.len());
            for fault in faults.list() {
                prop_assert!(fault.span.end <= text.len() && fault.span.start <= fault.span.end, "{fault:?}");
            }
        }
    }
    Ok(())
}

/// For a long run: `PROPTEST_CASES=1000000 cargo test --release -p clatter-assess --test all mutations::`.
fn cases(default: u32) -> ProptestConfig {
    let cases = std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(default);
    ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(cases) }
}

proptest! {
    #![proptest_config(cases(2000))]
    #[test]
    fn torn_files_are_read_or_refused(seed in prop::sample::select(&SEEDS[..]), changes in prop::collection::vec(change(), 1..12)) {
        reads(&mutated(seed, &changes))?;
    }

    #[test]
    fn so_is_any_text(text in "\\PC{0,200}") {
        reads(&text)?;
    }
}

proptest! {
    #![proptest_config(cases(24))]
    /// Files whose numbers changed are assessed or refused, in bounded time, and every demand is a number.
    #[test]
    fn changed_numbers_are_assessed_or_refused(
        seed in prop::sample::select(&SEEDS[..]),
        changes in prop::collection::vec((any::<prop::sample::Index>(), 0..=9_u8), 1..8),
    ) {
        let digits: Vec<_> = seed.bytes().enumerate().filter(|(_, b)| b.is_ascii_digit()).map(|(i, _)| i).collect();
        let mut bytes = seed.as_bytes().to_vec();
        for (place, digit) in changes {
            bytes[digits[place.index(digits.len())]] = b'0' + digit;
        }
        if let Ok(file) = ProductFile::read(&String::from_utf8(bytes).unwrap(), "file")
            && let Ok(assessment) = clatter_assess::assess(&file)
        {
            for limit in assessment.components.iter().flat_map(|c| &c.limits) {
                prop_assert!(limit.demand.is_none_or(|demand| demand >= 0.0) && limit.margin.is_none_or(|margin| !margin.is_nan()), "{limit:?}");
                prop_assert!(limit.bound.zip(limit.demand).is_none_or(|(bound, demand)| demand <= bound), "{limit:?}");
                prop_assert!(limit.verdict != Verdict::Safe || limit.room() >= 0.0, "{limit:?}");
            }
        }
    }
}

/// Input that makes naive readers quadratic or deep.
#[test]
fn large_and_deep_files_are_refused_at_once() {
    for text in [
        "[".repeat(200_000),
        "a.".repeat(200_000),
        format!("x = {}", "[".repeat(200_000)),
        format!("x = {}", "{a=".repeat(200_000)),
        "\"".repeat(300_000),
        "[[component]]\n".repeat(60_000),
        (0..60_000).flat_map(|i| [format!("key{i}"), " = 1\n".into()]).collect(),
        format!("[product]\nname = \"{}\"", "\\u0301".repeat(100_000)),
        "\n".repeat(1_000_000),
    ] {
        let began = std::time::Instant::now();
        let faults = ProductFile::read(&text, "file").unwrap_err();
        let shown = faults.to_string();
        assert!(shown.len() < 200_000, "{} bytes of message", shown.len());
        // No time is asserted but that of a hang.
        assert!(began.elapsed().as_secs() < 60, "{} took {:?}", &text[..20], began.elapsed());
    }
}
