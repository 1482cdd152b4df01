macro_rules! t0 {
    () => {
        "all work and no play"
    };
}
macro_rules! t1 {
    () => {
        concat!(t0!(), t0!())
    };
}
macro_rules! t2 {
    () => {
        concat!(t1!(), t1!())
    };
}
macro_rules! t3 {
    () => {
        concat!(t2!(), t2!())
    };
}
macro_rules! t4 {
    () => {
        concat!(t3!(), t3!())
    };
}
macro_rules! t5 {
    () => {
        concat!(t4!(), t4!())
    };
}
macro_rules! t6 {
    () => {
        concat!(t5!(), t5!())
    };
}
macro_rules! t7 {
    () => {
        concat!(t6!(), t6!())
    };
}
macro_rules! t8 {
    () => {
        concat!(t7!(), t7!())
    };
}
macro_rules! t9 {
    () => {
        concat!(t8!(), t8!())
    };
}
macro_rules! t10 {
    () => {
        concat!(t9!(), t9!())
    };
}
macro_rules! t11 {
    () => {
        concat!(t10!(), t10!())
    };
}
macro_rules! t12 {
    () => {
        concat!(t11!(), t11!())
    };
}
macro_rules! t13 {
    () => {
        concat!(t12!(), t12!())
    };
}
macro_rules! t14 {
    () => {
        concat!(t13!(), t13!())
    };
}
macro_rules! t15 {
    () => {
        concat!(t14!(), t14!())
    };
}
macro_rules! t16 {
    () => {
        concat!(t15!(), t15!())
    };
}
macro_rules! t17 {
    () => {
        concat!(t16!(), t16!())
    };
}
macro_rules! t18 {
    () => {
        concat!(t17!(), t17!())
    };
}
macro_rules! t19 {
    () => {
        concat!(t18!(), t18!())
    };
}
macro_rules! t20 {
    () => {
        concat!(t19!(), t19!())
    };
}
macro_rules! t21 {
    () => {
        concat!(t20!(), t20!())
    };
}
macro_rules! t22 {
    () => {
        concat!(t21!(), t21!())
    };
}
macro_rules! t23 {
    () => {
        concat!(t22!(), t22!())
    };
}
macro_rules! t24 {
    () => {
        concat!(t23!(), t23!())
    };
}
macro_rules! t25 {
    () => {
        concat!(t24!(), t24!())
    };
}
macro_rules! t26 {
    () => {
        concat!(t25!(), t25!())
    };
}
macro_rules! t27 {
    () => {
        concat!(t26!(), t26!())
    };
}
macro_rules! t28 {
    () => {
        concat!(t27!(), t27!())
    };
}
macro_rules! t29 {
    () => {
        concat!(t28!(), t28!())
    };
}
macro_rules! t30 {
    () => {
        concat!(t29!(), t29!())
    };
}
pub fn bomb() -> usize {
    t30!().len()
}
