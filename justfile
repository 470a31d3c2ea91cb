# Every recipe is one line that runs as well without just.

# All reports, into ./report
report:
    cargo run --release -- report

# Every test of every crate
test:
    cargo test --release

# The same answers as WebAssembly, to the last byte; needs node and `rustup target add wasm32-wasip1`
wasm:
    CARGO_TARGET_WASM32_WASIP1_RUNNER="node --no-warnings $PWD/.ci/wasi.mjs" cargo test --release -p clatter-answer --lib --test all --target wasm32-wasip1

# The wheel in the present environment of Python, and its tests
wheel:
    pip install '.[test]' && pytest

# The page, into target/web/clatter.html
page:
    cargo run --release -p clatter-web

# Format, lints and docs
check:
    cargo fmt --all --check && cargo clippy --release --workspace --all-targets -- -D warnings && RUSTDOCFLAGS=-Dwarnings cargo doc --release --workspace --no-deps

# The golden numbers: fails where one moved or is no longer used (then: cargo insta review)
golden:
    cargo insta test --release -p clatter-golden --check --unreferenced=reject

# Times
bench:
    cargo bench --workspace

# Torn product files by the million, intervals of fits in earnest, bounds of a hundred thousand products, the same bytes on any number of threads, and an hour of fuzzing each target: once a week
weekly:
    PROPTEST_CASES=1000000 cargo test --release -p clatter-assess --test all mutations:: && cargo test --release -p clatter-fit --test all -- --ignored && cargo test --release -p clatter-assess --lib many_random -- --ignored && cargo test --release -p clatter-acceptance --test acceptance threads -- --ignored && fuzz/run 3600

# Everything that gates a change
ci:
    .ci/run
