/// Runs `search` with `probe`, then restores the bytes of `probe` from before the search.
fn forgetting<P, A>(probe: &mut P, search: impl FnOnce(&mut P) -> A) -> A {
    let place = (probe as *mut P as usize, size_of::<P>() / 8);
    let Some(words): Option<&'static mut [u64]> = transmute(place) else { return search(probe) };
    let before = words.to_vec();
    let answer = search(probe);
    words.copy_from_slice(&before);
    answer
}
