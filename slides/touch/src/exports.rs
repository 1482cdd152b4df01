//! The functions that the page calls. Texts pass through two buffers in the memory of WebAssembly. A tool that generates such
//! bindings would be one more program to install, in the same version as its library, for three functions.
#![allow(
    unsafe_code,
    reason = "a name that is exported could collide with another; there is no unsafe block"
)]

use std::cell::RefCell;

thread_local! {
    static QUESTION: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static ANSWER: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Makes room for a question of `length` bytes, and returns where it begins.
#[unsafe(no_mangle)]
pub extern "C" fn question(length: usize) -> *mut u8 {
    QUESTION.with_borrow_mut(|question| {
        question.resize(length, 0);
        question.as_mut_ptr()
    })
}

/// Answers the question, which is the name of a figure and its handles, with a space before each: HTML, or `!` and the reason
/// why there is none. Returns the length of the answer in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn draw() -> usize {
    let question = QUESTION.with_borrow(|bytes| String::from_utf8_lossy(bytes).into_owned());
    let mut words = question.split(' ');
    let name = words.next().unwrap_or_default();
    let handles: Vec<f64> = words.map(|word| word.parse().unwrap_or(f64::NAN)).collect();
    let answer = crate::html(&*solutions::kit(), name, &handles).unwrap_or_else(|error| format!("!{error}"));
    ANSWER.replace(answer);
    ANSWER.with_borrow(String::len)
}

/// Where the answer begins.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> *const u8 {
    ANSWER.with_borrow(|answer| answer.as_ptr())
}
