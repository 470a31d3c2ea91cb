//! What samples cost: of a part whose contacts overlap, by contacts that take time; of a part without a contact time, by instant impacts.
//! On all threads.

#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

use clatter_assess::scatter::{Sampler, Settings};
use clatter_product::ProductFile;
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};

fn main() {
    divan::main();
}

fn product(product: &str, drop: &str, part: &str) -> ProductFile {
    let text = format!(
        "[product]\nname = \"p\"\nlength = \"140 mm\"\nradius_of_gyration = \"38 mm\"\nrestitution = 0.3\n{product}\n\
         [drop]\nfirst = \"either\"\n{drop}\n[[component]]\nname = \"part\"\ndamping_ratio = 0.05\n{part}\n"
    );
    ProductFile::read(&text, "p").unwrap_or_else(|faults| panic!("{faults}"))
}

fn draw(bencher: Bencher<'_, '_>, file: &ProductFile) {
    let samples = 100_000;
    let settings = Settings { samples, seed: 1, confidence: 0.95, merge_s: 1e-3 };
    let Ok(sampler) = Sampler::new(file, settings) else { panic!("the product is sound") };
    bencher.counter(ItemsCount::new(samples)).bench_local(|| {
        let Ok(scatter) = black_box(&sampler).run::<()>(false, &|| true, |_| Ok(())) else {
            panic!("nothing stops it")
        };
        scatter
    });
}

#[divan::bench(sample_count = 3, sample_size = 1)]
fn contacts_that_overlap_1e5(bencher: Bencher<'_, '_>) {
    let drop = "height = \"1 m\"\ntilt = { uniform = [\"0 deg\", \"0.5 deg\"] }";
    let part = "position = \"60 mm\"\nnatural_frequency = \"200 Hz\"\nacceleration_limit = \"700 gn\"";
    draw(bencher, &product("contact_time = \"0.4 ms\"", drop, part));
}

#[divan::bench(sample_count = 3, sample_size = 1)]
fn instant_impacts_1e5(bencher: Bencher<'_, '_>) {
    let drop = "height = { normal = [\"1 m\", \"0.2 m\"], range = [\"0.5 m\", \"1.5 m\"] }\n\
        tilt = { triangular = [\"1 deg\", \"2 deg\", \"4 deg\"] }";
    let part = "position = \"40 mm\"\nnatural_frequency = { uniform = [\"80 Hz\", \"120 Hz\"] }\n\
        acceleration_limit = \"400 gn\"\nrattle_space = \"9 mm\"";
    draw(bencher, &product("", drop, part));
}
