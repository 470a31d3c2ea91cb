//! A list of velocity shocks, of pulses or of shock tests, as the command reads it.

#![no_main]

use std::fs;

use clatter_cli::{Exit, Streams, run};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let dir = tempfile::tempdir().expect("a directory");
    let file = dir.path().join("list.csv");
    fs::write(&file, bytes).expect("a file");
    let file = file.display();
    for option in ["--shocks-file", "--pulses-file"] {
        let arguments = ["clatter", "respond", "--omega=100", "--damping=0.05", &format!("{option}={file}")];
        let (mut out, mut err) = (Vec::new(), Vec::new());
        let exit = run(arguments, &mut Streams { out: &mut out, err: &mut err, interactive: false });
        assert_eq!(exit == Exit::Done, !out.is_empty(), "{}", String::from_utf8_lossy(&err));
    }
});
