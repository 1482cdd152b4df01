// Safe Rust that reads and writes any memory of its process, through a bug that the compiler has had since 2015
// (rust-lang/rust issue 25860). No syntax check finds it. Only another process is out of its reach.

static UNIT: &&() = &&();

fn translate<'a, 'b, T: ?Sized>(_: &'a &'b (), value: &'b mut T) -> &'a mut T {
    value
}

fn forever<'a, 'b, T: ?Sized>(value: &'a mut T) -> &'b mut T {
    let translate: for<'x> fn(_, &'x mut T) -> &'b mut T = translate;
    translate(UNIT, value)
}

enum Either<A, B> {
    A(Option<Box<A>>),
    B(Option<Box<B>>),
}

fn reread<A, B>(either: &mut Either<A, B>, value: A) -> Option<B> {
    let Either::B(slot) = either else { return None };
    let slot = forever(slot);
    *either = Either::A(Some(Box::new(value)));
    std::hint::black_box(either);
    slot.take().map(|value| *value)
}

/// Returns the bits of one type as a value of another type.
fn transmute<A, B>(value: A) -> Option<B> {
    reread(std::hint::black_box(&mut Either::B(None)), value)
}
