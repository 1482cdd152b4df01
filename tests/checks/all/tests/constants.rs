//! Functions that do not look at their arguments earn no points: a kit whose functions all return a constant, or one of
//! their arguments unchanged, must fail every check. A check that asks for `None` or 0 in some cases needs other cases in
//! which the answer is something else.

use all_checks::STAGES;
use checks::{Check, rubric};
use raykata::kit::types::*;
use raykata::kit::{GramScalars, Kit, Linked, SolidHit, StudentFunctions, StudentKit, TriangleHit};
use raykata::light_path::{Lobe, NextRay, ShadowQuestion};
use std::marker::PhantomData;
use std::sync::Arc;

/// The constants: `None`, 0, empty, `false` and the first; 1, `true` and the last; the vertical axis; an argument of the
/// right type unchanged; NaN.
const ZERO: u8 = 0;
const ONE: u8 = 1;
const UP: u8 = 2;
const UNCHANGED: u8 = 3;
const NAN: u8 = 4;

/// A type of which this test knows constants.
trait Constant: Sized {
    fn constant(kind: u8) -> Self;
}

impl Constant for f32 {
    fn constant(kind: u8) -> f32 {
        match kind {
            ONE | UP => 1.0,
            NAN => f32::NAN,
            _ => 0.0,
        }
    }
}

impl Constant for f64 {
    fn constant(kind: u8) -> f64 {
        f64::from(f32::constant(kind))
    }
}

impl Constant for Vec3 {
    fn constant(kind: u8) -> Vec3 {
        if kind == UP { Vec3::Y } else { Vec3::splat(f32::constant(kind)) }
    }
}

impl Constant for Vec2 {
    fn constant(kind: u8) -> Vec2 {
        if kind == UP { Vec2::splat(0.5) } else { Vec2::splat(f32::constant(kind)) }
    }
}

/// Whole numbers and truth values: 1 and `true` for every constant other than 0.
macro_rules! whole {
    ($($Type:ty: $one:expr, $zero:expr;)*) => {
        $(impl Constant for $Type {
            fn constant(kind: u8) -> $Type {
                if kind == ONE || kind == UP { $one } else { $zero }
            }
        })*
    };
}

whole! {
    bool: true, false;
    u8: 255, 0;
    u32: 1, 0;
    u64: 1, 0;
    usize: 1, 0;
    UVec3: UVec3::ONE, UVec3::ZERO;
}

impl<T: Constant> Constant for Option<T> {
    fn constant(kind: u8) -> Option<T> {
        (kind != ZERO && kind != UNCHANGED).then(|| T::constant(kind))
    }
}

impl<T: Constant> Constant for Vec<T> {
    fn constant(kind: u8) -> Vec<T> {
        if kind == ZERO || kind == UNCHANGED { Vec::new() } else { vec![T::constant(kind)] }
    }
}

impl<T: Constant, U: Constant> Constant for (T, U) {
    fn constant(kind: u8) -> (T, U) {
        (T::constant(kind), U::constant(kind))
    }
}

impl<T: Constant, const N: usize> Constant for [T; N] {
    fn constant(kind: u8) -> [T; N] {
        std::array::from_fn(|_| T::constant(kind))
    }
}

/// Structures whose fields are constants.
macro_rules! fields {
    ($($Type:ident { $($field:ident),* })*) => {
        $(impl Constant for $Type {
            fn constant(kind: u8) -> $Type {
                $Type { $($field: Constant::constant(kind)),* }
            }
        })*
    };
}

fields! {
    Aabb { min, max }
    PrimitiveHit { t, primitive }
    Filtered { possible, certain }
    TriangleHit { t, beta, gamma }
    GramScalars { uu, uv, vv, d }
    SolidHit { t, normal }
    Sphere { center, radius }
    SecondaryRay { bounce, direction, weight }
    RayCounts { primary, shadow, reflection, transmission }
    Ray { origin, direction, t_min, t_max, time }
    EmitterSample { direction, distance, radiance, pdf }
    BsdfSample { lobe, direction, weight, pdf }
    NextRay { lobe, direction, weight, pdf }
    ShadowQuestion { direction, distance, light }
    PathStep { light, shadow, next }
    PathEffects { diffuse, sampled, environment }
    BinSplit { axis, bin, cost }
    Entered { mask, t }
}

impl Constant for Bounce {
    fn constant(_: u8) -> Bounce {
        Bounce::Reflection
    }
}

impl Constant for Lobe {
    fn constant(kind: u8) -> Lobe {
        if kind == ZERO { Lobe::Diffuse } else { Lobe::Reflection }
    }
}

/// Structures that have one constant: the empty one.
macro_rules! empty {
    ($($Type:ty => $value:expr;)*) => {
        $(impl Constant for $Type {
            fn constant(_: u8) -> $Type {
                $value
            }
        })*
    };
}

empty! {
    Bvh => Bvh::default();
    FlatTree => FlatTree::default();
    WideTree => WideTree::default();
    Bins => Bins::EMPTY;
    Bsp => Bsp::default();
    PolygonBsp => PolygonBsp::default();
    KdTree => KdTree::new(Aabb::EMPTY);
    Octree => Octree::empty();
    Grid => Grid { bounds: Aabb::EMPTY, resolution: UVec3::ONE, starts: vec![0, 0], items: Vec::new() };
    Mesh => Mesh::default();
    Effects => Effects::default();
    LightEffects => LightEffects::default();
    MaterialEffects => MaterialEffects::default();
    Placement => Placement { to_world: Affine3A::IDENTITY, to_object: Affine3A::IDENTITY };
}

/// An argument of type `T` of a function that returns `R`.
struct Argument<'a, T, R>(&'a T, PhantomData<R>);

/// The argument as the result, if it has its type.
trait Same<R> {
    fn same(&self) -> Option<R>;
}

impl<R: Clone> Same<R> for Argument<'_, R, R> {
    fn same(&self) -> Option<R> {
        Some(self.0.clone())
    }
}

impl<R: Clone> Same<R> for Argument<'_, &R, R> {
    fn same(&self) -> Option<R> {
        Some((*self.0).clone())
    }
}

impl<R: Clone> Same<Option<R>> for Argument<'_, R, Option<R>> {
    fn same(&self) -> Option<Option<R>> {
        Some(Some(self.0.clone()))
    }
}

/// Every other argument. A call `(&argument).same()` finds this only if none of the above fits, because it needs one more
/// reference.
trait Other<R> {
    fn same(&self) -> Option<R>;
}

impl<T, R> Other<R> for &Argument<'_, T, R> {
    fn same(&self) -> Option<R> {
        None
    }
}

/// A kit of constants of one kind.
#[derive(Clone, Copy)]
struct Constants<const KIND: u8>;

macro_rules! constants {
    ($($(#[$trait_doc:meta])* $stage:literal trait $Trait:ident {
        $($(#[$doc:meta])* $Message:ident fn $name:ident $([$($generics:tt)*])? ($($argument:ident: $Type:ty),* $(,)?)
            -> $Return:ty = $file:ident::$function:ident; $how:tt)*
    })*) => {
        impl<const KIND: u8> StudentFunctions for Constants<KIND> {
            $($(
            fn $name $(<$($generics)*>)? ($($argument: $Type),*) -> $Return {
                let arguments = [$((&Argument::<_, $Return>(&$argument, PhantomData)).same()),*];
                let unchanged = arguments.into_iter().flatten().next().filter(|_| KIND == UNCHANGED);
                unchanged.unwrap_or_else(|| <$Return as Constant>::constant(KIND))
            }
            )*)*
        }
    };
}

raykata::student_functions! { constants }

impl<const KIND: u8> StudentKit for Constants<KIND> {
    fn renderer() -> Option<&'static dyn raykata::kit::Frames> {
        None
    }
}

/// A kit of constants earns no points in any stage.
#[track_caller]
fn earns_nothing<const KIND: u8>() {
    let kit: Arc<dyn Kit + Send + Sync> = Arc::new(Linked(Constants::<KIND>));
    let mut passed = Vec::new();
    for (stage, checks) in STAGES {
        let points = |check: &&Check| rubric::entry(check.stage, check.name).points;
        let passes: Vec<&Check> = checks.iter().filter(|check| checks::passes(check, &kit, 0)).collect();
        println!(
            "stage {stage}: {} of {} points",
            passes.iter().map(points).sum::<u32>(),
            checks.iter().map(|check| points(&check)).sum::<u32>()
        );
        passed.extend(passes.iter().map(|check| (*stage, check.name)));
    }
    assert!(passed.is_empty(), "the constant passes {passed:?}");
}

#[test]
fn none_and_zero_earn_nothing() {
    earns_nothing::<ZERO>();
}

#[test]
fn one_and_true_earn_nothing() {
    earns_nothing::<ONE>();
}

#[test]
fn the_vertical_axis_earns_nothing() {
    earns_nothing::<UP>();
}

#[test]
fn arguments_unchanged_earn_nothing() {
    earns_nothing::<UNCHANGED>();
}

#[test]
fn nan_earns_nothing() {
    earns_nothing::<NAN>();
}
