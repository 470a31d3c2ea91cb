//! The same file gives the same bytes on any number of threads, whatever else the machine does.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

use crate::clatter;

/// Worked products, drops that were hard to find, and a bar with other casings, of both laws and of none.
fn products(folder: &Path) -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let given = ["reports/examples", "tests/cases"].map(|name| fs::read_dir(root.join(name)).unwrap());
    let mut all: Vec<_> = given.into_iter().flatten().map(|entry| entry.unwrap().path()).collect();
    all.sort();
    for (k, e) in ["[0.1, 0.3]", "[0.0, 0.6]", "0.5"].into_iter().enumerate() {
        for law in ["", "contact_law = \"hysteretic\"\n", "contact_law = \"dashpot\"\n"] {
            let path = folder.join(format!("{k}{}.toml", law.len()));
            let product = format!("[product]\nrestitution = {e}\n{law}");
            let lines =
                include_str!("../cases/bar-handheld.toml").lines().filter(|line| !line.starts_with("restitution"));
            let text: String = lines.flat_map(|line| [line, "\n"]).collect();
            fs::write(&path, text.replacen("[product]\n", &product, 1)).unwrap();
            all.push(path);
        }
    }
    all
}

/// Says so as it goes, by a panic as well.
struct Ends<'a>(&'a AtomicBool);

impl Drop for Ends<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Each answer on so many threads, so often, beside threads that leave it little of the processors.
fn compare(products: &[PathBuf], times: usize) {
    let over = AtomicBool::new(false);
    thread::scope(|scope| {
        let _end = Ends(&over);
        for _ in 0..3 {
            scope.spawn(|| {
                while !over.load(Ordering::Relaxed) {
                    std::hint::spin_loop();
                }
            });
        }
        let answer = |product: &Path, threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let arguments = ["assess", product.to_str().unwrap(), "--format=json"];
            let outcome = pool.install(|| clatter(arguments));
            assert!(outcome.stdout.ends_with("}\n"), "{}: {}", product.display(), outcome.stderr);
            outcome.stdout
        };
        let mut differ = Vec::new();
        for product in products {
            let first = answer(product, 1);
            let again = [1, 2, 7].into_iter().flat_map(|threads| vec![threads; times]);
            let others = again.filter(|threads| answer(product, *threads) != first);
            differ.extend(others.map(|threads| format!("{} on {threads} threads", product.display())));
        }
        assert!(differ.is_empty(), "{differ:?}");
    });
}

#[test]
fn the_same_file_gives_the_same_bytes_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    compare(&products(folder.path()).split_off(10)[..3], 1);
}

/// Minutes: once a week.
#[test]
#[ignore = "minutes"]
fn every_product_gives_the_same_bytes_eight_times_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let products = products(folder.path());
    assert!(products.len() >= 20, "{}", products.len());
    compare(&products, 8);
}
