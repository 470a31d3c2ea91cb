//! Files as outputs: whole, or as they were.

use std::fs::{self, File};
use std::io;
use std::path::Path;

use tempfile::Builder;

use crate::Failure;

/// Writes a file beside `path` and puts it in its place only once it is whole, so that a full disk or a killed run
/// leaves what was there before. A link is followed; what is no regular file (a directory, a device) is refused.
pub(crate) fn replace(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> Result<(), Failure> {
    replace_io(path, write).map_err(|reason| Failure::File { path: path.to_owned(), reason })
}

fn replace_io(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    let target = match fs::metadata(path) {
        Ok(old) if old.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
        Ok(old) if !old.is_file() => return Err(io::Error::other("not a regular file")),
        Ok(_) => path.canonicalize()?,
        Err(_) => path.to_owned(),
    };
    let parent = target.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !parent.is_dir() {
        return Err(io::Error::new(io::ErrorKind::NotFound, format!("there is no directory {}", parent.display())));
    }
    let mut builder = Builder::new();
    builder.prefix(".clatter-").suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666)); // less the umask, as for any new file
    // The temporary's own name says nothing to the user.
    let mut beside = builder.tempfile_in(parent).map_err(|error| io::Error::from(error.kind()))?;
    write(beside.as_file_mut())?;
    beside.persist(&target).map_err(|error| error.error)?;
    Ok(())
}
