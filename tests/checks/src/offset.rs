//! The start of a ray that leaves a surface: how far it must be from the surface, and which known mistake moved it.

use crate::broken::Words;
use crate::double::U;
use glam::{DVec3, Vec3, Vec3Swizzles as _};
use raykata::kit::Surface;
use raykata::ray::Ray;

/// The mistake of [`Start::is_along_shading`].
pub const ALONG_SHADING: &str = "you move along the shading normal: move along the geometric normal";
const PER_AXIS: &str = "you move each axis by its own error: move along the normal, by error·|n|";

/// The start of a ray that leaves a surface on one side.
pub struct Start {
    /// The start relative to the point of the surface.
    moved: DVec3,
    surface: Surface,
    /// The geometric normal on the side on which the ray must start.
    side: DVec3,
    /// The unit direction that the ray must have.
    direction: DVec3,
    /// The start of the range, if the ray leaves the surface by it and starts at the point itself.
    t_min: Option<f32>,
}

impl Start {
    /// The start of `ray`, which must leave `surface` on the side of the unit normal `side`, along the unit vector
    /// `direction`.
    pub fn new(surface: &Surface, side: Vec3, direction: Vec3, ray: &Ray) -> Self {
        let start = ray.origin.as_dvec3() + f64::from(ray.t_min) * ray.direction.as_dvec3();
        let moved = start - surface.point.as_dvec3();
        let t_min = (ray.origin == surface.point && ray.t_min > 0.0).then_some(ray.t_min);
        Start { moved, surface: *surface, side: side.as_dvec3(), direction: direction.as_dvec3(), t_min }
    }

    /// The distance from the point along the normal of the side.
    pub fn height(&self) -> f64 {
        self.moved.dot(self.side)
    }

    /// The least height: the bound on the error of the point along the normal, `error·|n|`.
    pub fn least(&self) -> f64 {
        self.surface.error.as_dvec3().dot(self.side.abs())
    }

    /// The greatest height: four times the bound, plus 64 float steps of the largest coordinate.
    pub fn most(&self) -> f64 {
        64.0 * 2.0 * U * f64::from(self.surface.point.abs().max_element()) + 4.0 * self.least()
    }

    /// Whether the height is less than allowed, or NaN. One per cent is left for the rounding of the bound itself.
    pub fn is_too_low(&self) -> bool {
        !(self.height() >= 0.99 * self.least())
    }

    /// Whether the height is more than allowed, or NaN.
    pub fn is_too_high(&self) -> bool {
        !(self.height() <= self.most())
    }

    /// The rounding of a start that is `moved` away from the point, per axis: two and a half float steps of the sum, and the
    /// rounding of the way and of the bound.
    fn slack(&self, moved: DVec3) -> DVec3 {
        let point = self.surface.point.as_dvec3();
        let relative = 5.0 * U * point.abs().max((point + moved).abs());
        // The floats beside 0 are 1.4e-45 apart.
        relative + 1e-6 * (moved.abs().max_element() + self.least()) + 1e-44
    }

    /// Whether the start is where a student's formula puts it.
    fn is(&self, moved: DVec3) -> bool {
        (self.moved - moved).abs().cmple(self.slack(moved)).all()
    }

    /// Whether the start is somewhere along the unit vector `way`, or at the point. Each coordinate may be one float further
    /// out, and the projection spreads these roundings over all axes.
    fn is_along(&self, way: DVec3) -> bool {
        let along = self.moved.dot(way);
        let slack = 3.0 * self.slack(self.moved).max_element();
        along >= -slack && (self.moved - along * way).abs().max_element() <= slack
    }

    /// Whether the start is somewhere along the shading normal on the same side.
    pub fn is_along_shading(&self) -> bool {
        let shading = self.surface.shading_normal.as_dvec3();
        self.is_along(shading * self.side.dot(shading).signum())
    }

    /// Wrong formulas, each with whether it gives this start.
    pub fn mistakes(&self) -> Vec<(bool, &'static str)> {
        let error = self.surface.error.as_dvec3();
        let along_the_side = |distance: f64| self.is(distance * self.side);
        let mut all = vec![
            "your ray starts on the rounded point, so it may hit its own surface (shadow acne)"
                .when(self.moved == DVec3::ZERO),
            "you move by error·|n|, but rounding makes the sum smaller: move each coordinate one float further"
                .when(along_the_side(self.least())),
            (along_the_side(error.dot(self.side)), "you leave out the absolute values in error·|n|"),
            "you take the absolute value of error·n: take those of n"
                .when(along_the_side(error.dot(self.side).abs())),
            (self.is(error * self.side), PER_AXIS),
            (self.is(error * self.side.signum()), PER_AXIS),
            (along_the_side(error.x), "you move by the error of x: along the normal the error is error·|n|"),
            "you move by the largest error: along the normal the error is error·|n|"
                .when(along_the_side(error.max_element())),
            "you move by the length of error: along the normal the error is error·|n|"
                .when(along_the_side(f64::from(self.surface.error.length()))),
            "you add up the errors of all axes: along the normal it is error·|n|"
                .when(along_the_side(error.element_sum())),
        ];
        if self.surface.shading_normal != self.surface.geometric_normal {
            all.push((self.is_along_shading(), ALONG_SHADING));
        }
        let turned = [error.yzx(), error.zxy(), error.yxz(), error.xzy(), error.zyx()];
        let text = "the errors belong to other axes: multiply each by the same axis of |n|";
        all.extend(turned.map(|error| (along_the_side(error.dot(self.side.abs())), text)));
        let text = "the error along an axis is left out: error·|n| has all three";
        all.extend(
            DVec3::AXES.map(|axis| (along_the_side((error * (1.0 - axis)).dot(self.side.abs())), text)),
        );
        let times = [5, 6, 8, 10, 16, 20, 32, 50, 64, 100, 1000];
        all.extend(times.map(|n| {
            let text =
                "you move by a multiple of error·|n|: the error itself is enough, and 4 times it is the most";
            (along_the_side(f64::from(n) * self.least()), text)
        }));
        let point = self.surface.point.as_dvec3().abs();
        let sizes = [
            point.max_element(),
            point.length(),
            point.element_sum(),
            point.max_element().max(1.0),
            1.0 + point.length(),
        ];
        all.extend(
            sizes.into_iter().flat_map(|size| (2..=7).map(move |digits| size * 10f64.powi(-digits))).map(
                |length| {
                    let text =
                        "your offset grows with the distance of the point from the origin: move by error·|n|";
                    (along_the_side(length), text)
                },
            ),
        );
        // A round number, alone or in addition to the bound.
        let lengths = (0..=7).flat_map(|digits| [1.0, 2.0, 5.0].map(|n| n * 10f64.powi(-digits)));
        all.extend(lengths.flat_map(|length| [length, length + self.least(), length.max(self.least())]).map(
            |length| {
                (along_the_side(length), "your offset has the same length at every scale: move by error·|n|")
            },
        ));
        all.extend((1..=7).map(|digits| {
            let is_fixed = self.t_min == Some(10f32.powi(-digits));
            "your t_min is the same at every scale, as in One Weekend: move the origin by error·|n|"
                .when(is_fixed)
        }));
        // A start at the point itself is along any way, if the point is not so large that its rounding loses a step.
        let step = f64::from(self.surface.error.length()).min(1e-4);
        let size = f64::from(self.surface.point.abs().max_element());
        if self.moved != DVec3::ZERO || step <= 4.0 * U * size {
            let text = "you move the origin along the ray: move it along the geometric normal";
            all.push((self.is_along(self.direction) && self.t_min.is_none(), text));
        }
        all
    }
}
