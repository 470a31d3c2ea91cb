//! The tosses of a cube at their first touch, for `peers/cube.py`.
#![expect(clippy::print_stdout, reason = "that is what is asked for")]

fn main() -> Result<(), clatter_studies::Error> {
    println!("{}", clatter_studies::cube::touches()?);
    Ok(())
}
