//! This module is the interface for JavaScript: `room` for a question and a file, `answer`, and where its text is.

use std::sync::Mutex;

#[link(wasm_import_module = "page")]
unsafe extern "C" {
    /// Receives the progress: the amount done and the whole amount.
    safe fn progress(done: f64, all: f64);
}

static GIVEN: Mutex<Vec<u8>> = Mutex::new(Vec::new());
static TOLD: Mutex<String> = Mutex::new(String::new());

/// Returns where so many bytes are to be written: the question, and after it the file that goes with it.
#[unsafe(no_mangle)]
extern "C" fn room(bytes: usize) -> *mut u8 {
    let Ok(mut given) = GIVEN.lock() else { return std::ptr::null_mut() };
    *given = vec![0; bytes];
    given.as_mut_ptr()
}

/// Answers the question in the first bytes of the room; how many bytes the answer has.
#[unsafe(no_mangle)]
extern "C" fn answer(question: usize) -> usize {
    let (Ok(mut given), Ok(mut told)) = (GIVEN.lock(), TOLD.lock()) else { return 0 };
    let given = std::mem::take(&mut *given);
    let (question, file) = given.split_at(question.min(given.len()));
    #[expect(clippy::cast_precision_loss, reason = "a share")]
    let watch = |done: usize, all: usize| progress(done as f64, all as f64);
    *told = crate::answer(&String::from_utf8_lossy(question), file, &watch);
    told.len()
}

/// Returns where the answer is, until the next one.
#[unsafe(no_mangle)]
extern "C" fn told() -> *const u8 {
    TOLD.lock().map_or(std::ptr::null(), |told| told.as_ptr())
}
