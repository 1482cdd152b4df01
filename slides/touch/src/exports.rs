//! The two functions that the page calls; a generator of such bindings would be one more program to install. Texts pass through a
//! buffer in the memory of WebAssembly.
#![allow(unsafe_code, reason = "an exported name could collide with another; there is no unsafe block")]

use std::cell::RefCell;

thread_local! {
    static TEXT: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// Makes the buffer `length` bytes long, and returns where it begins.
#[unsafe(no_mangle)]
pub extern "C" fn text(length: usize) -> *mut u8 {
    TEXT.with_borrow_mut(|text| {
        text.resize(length, 0);
        text.as_mut_ptr()
    })
}

/// Replaces the question in the buffer, the name of a figure and its handles with a space before each, by HTML, or by `!` and the
/// reason why there is none. Returns the length.
#[unsafe(no_mangle)]
pub extern "C" fn draw() -> usize {
    let question = String::from_utf8_lossy(&TEXT.take()).into_owned();
    let answer = crate::answer(&*solutions::kit(), &question).unwrap_or_else(|error| format!("!{error}"));
    TEXT.replace(answer.into_bytes());
    TEXT.with_borrow(Vec::len)
}
