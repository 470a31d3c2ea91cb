//! Writes the paper's report into the directory that is given.
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let dir = std::env::args().nth(1).unwrap_or_else(|| "target/report".into());
    let written = clatter_report::write(clatter_report::Report::Paper, dir.as_ref(), &mut |_| ())?;
    assert!(!written.files.is_empty(), "nothing was written");
    Ok(())
}
