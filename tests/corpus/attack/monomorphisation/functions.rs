fn f0<T>() -> usize {
    size_of::<T>()
}

fn f1<T>() -> usize {
    f0::<(T, u8)>() + f0::<(u8, T)>()
}

fn f2<T>() -> usize {
    f1::<(T, u8)>() + f1::<(u8, T)>()
}

fn f3<T>() -> usize {
    f2::<(T, u8)>() + f2::<(u8, T)>()
}

fn f4<T>() -> usize {
    f3::<(T, u8)>() + f3::<(u8, T)>()
}

fn f5<T>() -> usize {
    f4::<(T, u8)>() + f4::<(u8, T)>()
}

fn f6<T>() -> usize {
    f5::<(T, u8)>() + f5::<(u8, T)>()
}

fn f7<T>() -> usize {
    f6::<(T, u8)>() + f6::<(u8, T)>()
}

fn f8<T>() -> usize {
    f7::<(T, u8)>() + f7::<(u8, T)>()
}

fn f9<T>() -> usize {
    f8::<(T, u8)>() + f8::<(u8, T)>()
}

fn f10<T>() -> usize {
    f9::<(T, u8)>() + f9::<(u8, T)>()
}

fn f11<T>() -> usize {
    f10::<(T, u8)>() + f10::<(u8, T)>()
}

fn f12<T>() -> usize {
    f11::<(T, u8)>() + f11::<(u8, T)>()
}

fn f13<T>() -> usize {
    f12::<(T, u8)>() + f12::<(u8, T)>()
}

fn f14<T>() -> usize {
    f13::<(T, u8)>() + f13::<(u8, T)>()
}

fn f15<T>() -> usize {
    f14::<(T, u8)>() + f14::<(u8, T)>()
}

fn f16<T>() -> usize {
    f15::<(T, u8)>() + f15::<(u8, T)>()
}

fn f17<T>() -> usize {
    f16::<(T, u8)>() + f16::<(u8, T)>()
}

fn f18<T>() -> usize {
    f17::<(T, u8)>() + f17::<(u8, T)>()
}

fn f19<T>() -> usize {
    f18::<(T, u8)>() + f18::<(u8, T)>()
}

fn f20<T>() -> usize {
    f19::<(T, u8)>() + f19::<(u8, T)>()
}

fn f21<T>() -> usize {
    f20::<(T, u8)>() + f20::<(u8, T)>()
}

fn f22<T>() -> usize {
    f21::<(T, u8)>() + f21::<(u8, T)>()
}

fn f23<T>() -> usize {
    f22::<(T, u8)>() + f22::<(u8, T)>()
}

fn f24<T>() -> usize {
    f23::<(T, u8)>() + f23::<(u8, T)>()
}

fn f25<T>() -> usize {
    f24::<(T, u8)>() + f24::<(u8, T)>()
}

fn f26<T>() -> usize {
    f25::<(T, u8)>() + f25::<(u8, T)>()
}

fn f27<T>() -> usize {
    f26::<(T, u8)>() + f26::<(u8, T)>()
}

fn f28<T>() -> usize {
    f27::<(T, u8)>() + f27::<(u8, T)>()
}

fn f29<T>() -> usize {
    f28::<(T, u8)>() + f28::<(u8, T)>()
}

fn f30<T>() -> usize {
    f29::<(T, u8)>() + f29::<(u8, T)>()
}

pub fn bomb() -> usize {
    f30::<u16>()
}
