//! This module writes files as outputs: they are complete, or as they were before.

use std::fs::{self, File, Permissions};
use std::io;
use std::path::{Path, PathBuf};

use crate::leftovers::{Left, Listed};
use tempfile::{Builder, NamedTempFile, TempPath};

/// Writes a file next to `path` and puts it in its place only once it is complete, so that a full disk or a killed run leaves the earlier
/// file as it was. A link is followed; a path to anything but a regular file (to a directory, a device) is refused. Content and name
/// are on the disk when the function returns; a file that is there keeps its permissions.
///
/// # Errors
/// Returns the error of the system, or the fault of `path`.
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
    let permissions = regular(path)?;
    let target = followed(path)?;
    let (_listed, beside) = beside(&target, write)?;
    if let Some(permissions) = permissions {
        fs::set_permissions(&beside, permissions)?;
    }
    beside.persist(&target).map_err(|error| error.error)?;
    settle(&target);
    Ok(())
}

/// Returns the permissions of the regular file that a path leads to; none where nothing is there. It does not open the file, as opening
/// a pipe waits for its other end.
fn regular(path: &Path) -> io::Result<Option<Permissions>> {
    match fs::metadata(path) {
        Ok(old) if old.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
        Ok(old) if !old.is_file() => Err(io::Error::other("it is a pipe, a socket or a device, not a regular file")),
        Ok(old) => Ok(Some(old.permissions())),
        Err(_) => Ok(None),
    }
}

/// Returns the one name of a file that is to be written, whichever of its names is given: links are followed, and its directory has its
/// full name.
///
/// # Errors
/// Where what is there is no regular file, or there is no such directory.
pub fn place_of(path: &Path) -> io::Result<PathBuf> {
    regular(path)?;
    let target = followed(path)?;
    let name = target.file_name().ok_or(io::ErrorKind::InvalidInput)?;
    Ok(directory_of(&target)?.canonicalize()?.join(name))
}

/// Checks whether a new file can be made in a directory, as [`replace`] does, so that long work is refused before it begins.
///
/// # Errors
/// Returns the error of the system.
pub fn takes_files(directory: &Path) -> io::Result<()> {
    tempfile::tempfile_in(directory).map(drop).map_err(|error| error.kind().into())
}

/// Returns whether the path is a file that its user may not write.
#[must_use]
pub fn is_protected(path: &Path) -> bool {
    let Ok(Some(permissions)) = regular(path) else { return false };
    let denied = |error: io::Error| error.kind() == io::ErrorKind::PermissionDenied;
    permissions.readonly() || File::options().write(true).open(path).is_err_and(denied)
}

/// Returns whether two [places](place_of) in one directory have names that differ by capitals alone, and the directory takes them as one.
#[must_use]
pub fn differ_by_case_alone(a: &Path, b: &Path) -> bool {
    let lower = |path: &Path| path.file_name().map(|name| name.to_string_lossy().to_lowercase());
    if a == b || a.parent() != b.parent() || lower(a) != lower(b) {
        return false;
    }
    let Ok(probe) =
        directory_of(a).and_then(|there| Builder::new().prefix(".clatter-").suffix(".tmp").tempfile_in(there))
    else {
        return false;
    };
    let capitals = probe.path().file_name().map(|name| name.to_string_lossy().to_uppercase());
    capitals.is_some_and(|name| probe.path().with_file_name(name).exists())
}

/// Returns the place that a path leads to, also where nothing is there yet.
fn followed(path: &Path) -> io::Result<PathBuf> {
    let mut target = path.to_owned();
    for _ in 0..LINKS {
        let Ok(next) = fs::read_link(&target) else { return Ok(target) };
        target = target.parent().unwrap_or(Path::new("")).join(next);
    }
    Err(io::Error::other(format!("more than {LINKS} links, one to the next")))
}

/// The number of links that are followed one after the other, as many as systems do.
const LINKS: usize = 40;

/// Writes the new name to the disk, as the content is there, so that a loss of power leaves the old file or the new one. The file exists
/// already: a directory that may not be read, or a file system that cannot do it, is no failure.
fn settle(target: &Path) {
    if cfg!(unix) {
        let _ = directory_of(target).and_then(File::open).and_then(|directory| directory.sync_all());
    }
}

/// Writes a file as [`replace`] does, but refuses a file that is there already.
///
/// # Errors
/// As [`replace`]; [`io::ErrorKind::AlreadyExists`] where there is a file, which stays as it is.
pub fn create(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    let (_listed, beside) = beside(path, write)?;
    beside.persist_noclobber(path).map_err(|error| error.error)?;
    settle(path);
    Ok(())
}

/// Returns the directory that a file is to stand in, so that long work is refused before it begins.
///
/// # Errors
/// Returns [`io::ErrorKind::NotFound`] where the directory is not there.
pub fn directory_of(path: &Path) -> io::Result<&Path> {
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if parent.is_dir() {
        Ok(parent)
    } else {
        Err(io::Error::new(io::ErrorKind::NotFound, format!("there is no directory {}", parent.display())))
    }
}

/// Writes the whole file under another name in the same directory. Where the system can do it, the file has no name while it is
/// written, which may take long: so a process that is killed outright leaves nothing there.
fn beside(target: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<(Listed, TempPath)> {
    let parent = directory_of(target)?;
    let mut builder = Builder::new();
    builder.prefix(".clatter-").suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(MODE));
    // The temporary's own name says nothing to the user.
    let nameless = |error: io::Error| io::Error::from(error.kind());
    #[cfg(target_os = "linux")]
    if let Some(mut unnamed) = unnamed(parent) {
        write(&mut unnamed)?;
        unnamed.sync_all()?;
        let make = || builder.make_in(parent, |path| name(&unnamed, path)).map_err(nameless);
        let (listed, whole) = Listed::new(make, path_of)?;
        return Ok((listed, whole.into_temp_path()));
    }
    let (listed, mut whole) = Listed::new(|| builder.tempfile_in(parent).map_err(nameless), path_of)?;
    write(whole.as_file_mut())?;
    whole.as_file().sync_all()?;
    Ok((listed, whole.into_temp_path()))
}

fn path_of<F>(file: &NamedTempFile<F>) -> Left {
    Left::Path(file.path().to_owned())
}

/// The mode of a new file; the umask is taken off, as for any new file.
#[cfg(unix)]
const MODE: u32 = 0o666;

/// Makes a file without a name; none where the system has no such files.
#[cfg(target_os = "linux")]
fn unnamed(parent: &Path) -> Option<File> {
    use rustix::fs::{Mode, OFlags, open};
    let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
    Path::new(DESCRIPTORS)
        .is_dir()
        .then(|| open(parent, flags, Mode::from_raw_mode(MODE)).ok())
        .flatten()
        .map(File::from)
}

/// Gives it one.
#[cfg(target_os = "linux")]
fn name(unnamed: &File, path: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD, linkat};
    use std::os::fd::AsRawFd;
    let own = format!("{DESCRIPTORS}/{}", unnamed.as_raw_fd());
    Ok(linkat(CWD, own, CWD, path, AtFlags::SYMLINK_FOLLOW)?)
}

/// The directory where a process sees its open files by name.
#[cfg(target_os = "linux")]
const DESCRIPTORS: &str = "/proc/self/fd";
