//! The reference passes the same checks as the exercises.

mod stage1 {
    stage1_checks::tests!(solutions::Kit);
}

mod stage2 {
    stage2_checks::tests!(solutions::Kit);
}

mod stage3 {
    stage3_checks::tests!(solutions::Kit);
}

mod stage4 {
    stage4_checks::tests!(solutions::Kit);
}

mod stage5 {
    stage5_checks::tests!(solutions::Kit);
}

mod stage6 {
    stage6_checks::tests!(solutions::Kit);
}

mod stage7 {
    stage7_checks::tests!(solutions::Kit);
}

mod stage8 {
    stage8_checks::tests!(solutions::Kit);
}

mod stage9 {
    stage9_checks::tests!(solutions::Kit);
}

mod stage10 {
    stage10_checks::tests!(solutions::Kit);
}

mod stage11 {
    stage11_checks::tests!(solutions::Kit);
}

mod stage12 {
    stage12_checks::tests!(solutions::Kit);
}
