//! This program builds the page: `cargo run --release -p clatter-web` writes `target/web/clatter.html`.

mod lzma;

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::{env, fs};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;

/// The target of WebAssembly that needs no glue: its calls to a system are stubbed in `page/worker.js`.
const TARGET: &str = "wasm32-wasip1";

/// The largest number of bytes of the compressed page.
const MOST: usize = 1 << 20;

const PAGE: &str = include_str!("../../../page/page.html");
const STYLE: &str = include_str!("../../../page/style.css");
const WORKER: &str = include_str!("../../../page/worker.js");
/// The modules of the page, which are joined to one in this order.
const MODULES: [&str; 7] = [
    include_str!("../../../page/engine.js"),
    include_str!("../../../page/element.js"),
    include_str!("../../../page/kept.js"),
    include_str!("../../../page/film.js"),
    include_str!("../../../page/plan.js"),
    include_str!("../../../page/product.js"),
    include_str!("../../../page/record.js"),
];

fn main() -> ExitCode {
    match build() {
        Ok(told) => {
            let _ = writeln!(io::stdout(), "{told}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            let _ = writeln!(io::stderr(), "error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn build() -> Result<String, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().ok_or("the crate is in no workspace")?;
    let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    let wasm = lzma::packed(&compiled(root, &target)?);
    let page = PAGE
        .replace("/*version*/", env!("CARGO_PKG_VERSION"))
        .replace("/*style*/", &lean(STYLE))
        .replace("/*worker*/", &lean(WORKER))
        .replace("/*modules*/", &lean(&MODULES.join("\n")))
        .replace("/*wasm*/", &STANDARD.encode(wasm));
    let path = target.join("web/clatter.html");
    let written = fs::create_dir_all(target.join("web")).and_then(|()| fs::write(&path, &page));
    written.map_err(|error| format!("{}: {error}", path.display()))?;
    let small = gzipped(page.as_bytes()).map_err(|error| error.to_string())?.len();
    if small > MOST {
        return Err(format!("{}: {small} bytes compressed, more than {MOST}", path.display()));
    }
    Ok(format!("{}: {} kB, {} kB compressed", path.display(), page.len() / 1000, small / 1000))
}

/// Leaves out what only readers of the source need: indents, empty lines, and lines of comments.
fn lean(source: &str) -> String {
    let lines = source.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with("//"));
    lines.collect::<Vec<_>>().join("\n")
}

/// Compiles the crate to WebAssembly.
fn compiled(root: &Path, target: &Path) -> Result<Vec<u8>, String> {
    let known = Command::new("rustc").args(["--print", "target-libdir", "--target", TARGET]).output();
    let known = known.ok().and_then(|told| String::from_utf8(told.stdout).ok());
    if !known.is_some_and(|path| Path::new(path.trim()).exists()) {
        run(Command::new("rustup").args(["target", "add", TARGET]))?;
    }
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let arguments = ["rustc", "--profile", "web", "-p", "clatter-web", "--lib", "--target", TARGET, "--locked"];
    // Else the linker leaves the places of calls and data as wide as it found them.
    let linker = ["--", "-Clink-arg=--compress-relocations"];
    run(Command::new(cargo).args(arguments).args(linker).current_dir(root).env("CARGO_TARGET_DIR", target))?;
    let path = target.join(TARGET).join("web/clatter_web.wasm");
    fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))
}

fn run(command: &mut Command) -> Result<(), String> {
    let program = command.get_program().to_string_lossy().into_owned();
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{program}: {status}")),
        Err(error) => Err(format!("{program}: {error}")),
    }
}

/// Packs bytes as servers send them.
fn gzipped(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes)?;
    encoder.finish()
}
