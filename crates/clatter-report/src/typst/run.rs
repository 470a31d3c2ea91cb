//! This module runs a program within bounds: of its time, and of the output that is kept.

use std::io::{self, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::thread;
use std::time::{Duration, Instant};

use super::failed;
use crate::ReportError;
use crate::leftovers::{Listed, kill_group};

/// The number of bytes that are kept of each stream of output; the rest is read and dropped.
const KEPT: u64 = 1 << 20;

/// The outcome of a run that has ended.
#[derive(Debug)]
pub(super) struct Ended {
    pub(super) success: bool,
    pub(super) stdout: String,
    pub(super) stderr: String,
}

/// Runs a command to its end and that of its output. At the limit it is killed, and with it what it started.
pub(super) fn run(command: &mut Command, limit: Duration, program: &Path) -> Result<Ended, ReportError> {
    let end = Instant::now() + limit;
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let not_started = |error: io::Error| failed(format!("{} cannot be started: {error}", program.display()));
    let (_listed, mut child) = Listed::group(|| command.spawn()).map_err(not_started)?;
    let streams = read(child.stdout.take()).and_then(|stdout| Ok((stdout, read(child.stderr.take())?)));
    let streams = match streams {
        Ok(streams) => streams,
        Err(error) => {
            kill(&mut child);
            return Err(not_started(error));
        }
    };
    let text = |stream: &Receiver<String>| stream.recv_timeout(end.saturating_duration_since(Instant::now())).ok();
    // The streams are read before the wait for the program: after the wait the number of its group may be that of another one.
    if let (Some(stdout), Some(stderr)) = (text(&streams.0), text(&streams.1))
        && let Some(success) = wait(&mut child, end)
    {
        return Ok(Ended { success, stdout, stderr });
    }
    kill(&mut child);
    Err(failed(format!("{} was cut off: it had not ended after {} s", program.display(), limit.as_secs_f64())))
}

/// Reads a stream to its end during the wait, so that a full pipe stops nobody.
///
/// # Errors
/// Fails where no thread can be made for that.
fn read(stream: Option<impl Read + Send + 'static>) -> io::Result<Receiver<String>> {
    let (sender, receiver) = mpsc::channel();
    thread::Builder::new().spawn(move || {
        let kept = stream.map_or(Vec::new(), keep);
        let _ = sender.send(String::from_utf8_lossy(&kept).into_owned()); // after a cut nobody listens
    })?;
    Ok(receiver)
}

/// Returns the beginning of a stream, which it reads to its end.
fn keep(mut stream: impl Read) -> Vec<u8> {
    let mut kept = Vec::new();
    // Where reading fails, what was read until then is still worth showing.
    if stream.by_ref().take(KEPT).read_to_end(&mut kept).is_ok() {
        let _ = io::copy(&mut stream, &mut io::sink());
    }
    kept
}

/// Returns whether the child succeeded; `None` where it has not ended in time.
fn wait(child: &mut Child, end: Instant) -> Option<bool> {
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Some(status.success()),
            Ok(None) if Instant::now() < end => thread::sleep(Duration::from_millis(2)),
            _ => return None,
        }
    }
}

/// Kills a child and the group it leads.
fn kill(child: &mut Child) {
    kill_group(child.id());
    let _ = child.kill();
    let _ = child.wait();
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use super::*;

    fn shell(script: &str, limit: Duration) -> Result<Ended, ReportError> {
        run(Command::new("sh").args(["-c", script]), limit, Path::new("the script"))
    }

    #[test]
    fn what_never_ends_is_cut_off_with_all_that_it_started() {
        let dir = tempfile::tempdir().unwrap();
        let alive = dir.path().join("alive");
        // In the first script a child holds the output open; in the second a program ends without its child; in the third one runs on with
        // its output closed.
        for script in
            ["(sleep 2; touch alive) & wait", "(sleep 2; touch alive) &", "exec >&- 2>&-; sleep 2; touch alive"]
        {
            let script = format!("cd {} && {script}", dir.path().display());
            let error = shell(&script, Duration::from_millis(100)).unwrap_err().to_string();
            assert_eq!(error, "the script was cut off: it had not ended after 0.1 s", "{script}");
        }
        thread::sleep(Duration::from_millis(2200));
        assert!(!alive.exists(), "a child lived on");
    }

    #[test]
    fn of_endless_output_the_beginning_is_kept() {
        let ended = shell("yes | head -c 20000000; yes no | head -c 20000000 >&2", Duration::from_secs(60)).unwrap();
        let kept = usize::try_from(KEPT).unwrap();
        assert!(ended.success, "{:?}", &ended.stderr[..100]);
        assert_eq!([ended.stdout.len(), ended.stderr.len()], [kept, kept]);
        let error = shell("exec yes", Duration::from_millis(100)).unwrap_err().to_string();
        assert!(error.contains("cut off"), "{error}");
    }
}
