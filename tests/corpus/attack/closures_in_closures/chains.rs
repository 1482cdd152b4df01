fn c0() -> impl Iterator<Item = u32> + Clone {
    0..1u32
}
fn c1() -> impl Iterator<Item = u32> + Clone {
    let below = c0();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c2() -> impl Iterator<Item = u32> + Clone {
    let below = c1();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c3() -> impl Iterator<Item = u32> + Clone {
    let below = c2();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c4() -> impl Iterator<Item = u32> + Clone {
    let below = c3();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c5() -> impl Iterator<Item = u32> + Clone {
    let below = c4();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c6() -> impl Iterator<Item = u32> + Clone {
    let below = c5();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c7() -> impl Iterator<Item = u32> + Clone {
    let below = c6();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c8() -> impl Iterator<Item = u32> + Clone {
    let below = c7();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c9() -> impl Iterator<Item = u32> + Clone {
    let below = c8();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c10() -> impl Iterator<Item = u32> + Clone {
    let below = c9();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c11() -> impl Iterator<Item = u32> + Clone {
    let below = c10();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c12() -> impl Iterator<Item = u32> + Clone {
    let below = c11();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c13() -> impl Iterator<Item = u32> + Clone {
    let below = c12();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c14() -> impl Iterator<Item = u32> + Clone {
    let below = c13();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c15() -> impl Iterator<Item = u32> + Clone {
    let below = c14();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c16() -> impl Iterator<Item = u32> + Clone {
    let below = c15();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c17() -> impl Iterator<Item = u32> + Clone {
    let below = c16();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c18() -> impl Iterator<Item = u32> + Clone {
    let below = c17();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c19() -> impl Iterator<Item = u32> + Clone {
    let below = c18();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c20() -> impl Iterator<Item = u32> + Clone {
    let below = c19();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c21() -> impl Iterator<Item = u32> + Clone {
    let below = c20();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c22() -> impl Iterator<Item = u32> + Clone {
    let below = c21();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
fn c23() -> impl Iterator<Item = u32> + Clone {
    let below = c22();
    below.clone().chain(below.clone().zip(below).map(|(p, q)| p + q))
}
pub fn bomb() -> u32 {
    c23().sum()
}
