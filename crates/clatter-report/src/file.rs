//! Files as outputs: whole, or as they were.

use std::fs::{self, File};
use std::io;
use std::path::Path;

use tempfile::{Builder, NamedTempFile};

/// Writes a file beside `path` and puts it in its place only once it is whole, so that a full disk or a killed run
/// leaves what was there before. A link is followed; what is no regular file (a directory, a device) is refused.
///
/// # Errors
/// What the system says, or what is wrong with `path`.
///
/// # Examples
/// ```
/// use std::io::Write as _;
/// let path = std::env::temp_dir().join(format!("clatter-{}.txt", std::process::id()));
/// clatter_report::replace(&path, |file| file.write_all(b"whole"))?;
/// assert_eq!(std::fs::read(&path)?, b"whole");
/// # std::fs::remove_file(&path)?;
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn replace(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    let target = match fs::metadata(path) {
        Ok(old) if old.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
        Ok(old) if !old.is_file() => return Err(io::Error::other("not a regular file")),
        Ok(_) => path.canonicalize()?,
        Err(_) => path.to_owned(),
    };
    beside(&target, write)?.persist(&target).map_err(|error| error.error)?;
    Ok(())
}

/// As [`replace`], for a file that must not be there yet.
///
/// # Errors
/// As [`replace`]; [`io::ErrorKind::AlreadyExists`] where there is a file, which stays as it is.
pub fn create(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    beside(path, write)?.persist_noclobber(path).map_err(|error| error.error)?;
    Ok(())
}

/// The directory that a file is to stand in; for what takes long, told before it begins.
///
/// # Errors
/// [`io::ErrorKind::NotFound`] where it is not there.
pub fn directory_of(path: &Path) -> io::Result<&Path> {
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if parent.is_dir() {
        Ok(parent)
    } else {
        Err(io::Error::new(io::ErrorKind::NotFound, format!("there is no directory {}", parent.display())))
    }
}

/// The whole file, under another name in the same directory.
fn beside(target: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<NamedTempFile> {
    let parent = directory_of(target)?;
    let mut builder = Builder::new();
    builder.prefix(".clatter-").suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666)); // less the umask, as for any new file
    // The temporary's own name says nothing to the user.
    let mut beside = builder.tempfile_in(parent).map_err(|error| io::Error::from(error.kind()))?;
    write(beside.as_file_mut())?;
    Ok(beside)
}
