//! The tables that occur at most once in a scene: `film`, `camera`, `environment` and `quality`.

use super::files;
use super::limits::Limits;
use super::reader::{Source, Table, Value};
use super::textures::Images;
use crate::camera::{Camera, Lens, Shutter};
use crate::files::error::LoadError;
use crate::film::ToneCurve;
use crate::material::Wrap;
use crate::scene::{
    Background, ColorPlace, Encoding, EnvironmentMap, Field, FilmSettings, Gradient, GradientColor, Quality,
};
use glam::Vec3;
use std::path::Path;
use toml::Spanned;
use toml::de::DeValue;

/// How bytes encode linear light: those of 8-bit pictures, of colours as text, and of images.
pub(super) const ENCODINGS: [(&str, Encoding); 2] = [("srgb", Encoding::Srgb), ("gamma2", Encoding::Gamma2)];

/// The largest width or height of a picture, in pixels.
const MAX_SIDE: u32 = 65_536;

/// The film of `[film]`, 640 by 360 pixels in sRGB where nothing else is given; fails if a value is out of
/// range or the picture needs more memory than the limit.
pub(super) fn film(value: Option<Value>) -> Result<FilmSettings, LoadError> {
    let mut film = FilmSettings::default();
    let Some(value) = value else { return Ok(film) };
    let table = value.table(&["width", "height", "encoding", "exposure", "tone"])?;
    if let Some(width) = table.get("width") {
        film.width = width.whole(1..=MAX_SIDE)?;
    }
    if let Some(height) = table.get("height") {
        film.height = height.whole(1..=MAX_SIDE)?;
    }
    if let Some(encoding) = table.get("encoding") {
        film.encoding = encoding.choice(&ENCODINGS)?;
    }
    if let Some(exposure) = table.get("exposure") {
        film.tone.exposure =
            exposure.number_that("from -100 to 100", |stops| (-100.0..=100.0).contains(&stops))?;
    }
    if let Some(curve) = table.get("tone") {
        film.tone.curve = curve.choice(&ToneCurve::ALL)?;
    }
    value.source.budget.film(|why| value.error(why), film.width, film.height)?;
    Ok(film)
}

/// The camera of `[camera]`; `aspect` is width over height of the film. Fails if a value is missing or out of
/// range, if the view direction is zero, or if `up` is parallel to it.
pub(super) fn camera(value: Value, aspect: f32) -> Result<Camera, LoadError> {
    let table = value.table(&[
        "position",
        "look_at",
        "direction",
        "up",
        "vertical_fov",
        "horizontal_fov",
        "orthographic_height",
        "lens",
        "shutter",
    ])?;
    let position = table.need("position", "[0, 1, 5]")?.vector()?;
    let aim = table.one_of(&["look_at", "direction"])?;
    let direction = match aim.key {
        "direction" => aim.direction()?,
        // Subtract in double precision, where the difference overflows never and is 0 only for equal points.
        _ => {
            (aim.vector()?.as_dvec3() - position.as_dvec3()).try_normalize().map(|d| d.as_vec3()).ok_or_else(
                || aim.error("`look_at` and `position` are the same point, so the camera has no direction"),
            )?
        }
    };
    let up_value = table.get("up");
    let up = up_value.map_or(Ok(Vec3::Y), |up| up.direction())?;
    let vertical_fov = field_of_view(&table, aspect)?;

    let camera = Camera::new(position, direction, up, vertical_fov, aspect).map_err(|error| {
        // The only remaining error is that `up` is parallel to the view direction. Suggest an axis along
        // which the camera does not look.
        let other = if direction.y.abs() > 0.5 { "[0, 0, -1]" } else { "[0, 1, 0]" };
        up_value.unwrap_or(aim).error(error.to_string()).help(format!("write, for example, `up = {other}`"))
    })?;
    let camera = Camera {
        lens: table.get("lens").map(lens).transpose()?,
        shutter: table.get("shutter").map(shutter).transpose()?,
        ..camera
    };
    let Some(height) = table.get("orthographic_height") else { return Ok(camera) };
    if let Some(other) = ["vertical_fov", "horizontal_fov", "lens"].iter().find_map(|key| table.get(key)) {
        let message = format!("`camera` has both `orthographic_height` and `{}`", other.key);
        return Err(other
            .error(message)
            .help("delete one of the two: parallel rays have no angle and no focus"));
    }
    Ok(Camera { orthographic: true, half_height: 0.5 * height.positive()?, ..camera })
}

/// The vertical field of view in degrees: `vertical_fov`, or the one that follows from `horizontal_fov` and the
/// aspect ratio; 40 if neither is given, and an error if both are.
fn field_of_view(table: &Table, aspect: f32) -> Result<f32, LoadError> {
    let angle = |value: Value| {
        value.number_that("above 0 and below 180 degrees", |angle| 0.0 < angle && angle < 180.0)
    };
    match (table.get("vertical_fov"), table.get("horizontal_fov")) {
        (None, None) => Ok(40.0),
        (Some(vertical), None) => angle(vertical),
        (None, Some(horizontal)) => {
            // The film at distance 1 is `aspect` times as wide as high.
            let half_width = (f64::from(angle(horizontal)?).to_radians() / 2.0).tan();
            let vertical = 2.0 * (half_width / f64::from(aspect)).atan().to_degrees();
            // On a very wide or high film the angle can round to 180 or, in principle, to 0.
            Some(vertical as f32).filter(|angle| 0.0 < *angle && *angle < 180.0).ok_or_else(|| {
                horizontal.error("this `horizontal_fov` makes the vertical one 180 degrees on so high a film")
            })
        }
        (Some(_), Some(horizontal)) => {
            let message = "`camera` has both `vertical_fov` and `horizontal_fov`";
            Err(horizontal
                .error(message)
                .help("delete one of the two: it follows from the other and the film's size"))
        }
    }
}

fn lens(value: Value) -> Result<Lens, LoadError> {
    let table = value.table(&["aperture", "focal_distance"])?;
    let (aperture, focal_distance) = (table.need("aperture", "0.1")?, table.need("focal_distance", "5.0")?);
    let (radius, focal_distance) = (aperture.not_negative()?, focal_distance.positive()?);
    let radius = aperture.or_nothing(radius, focal_distance, "the camera is a pinhole");
    Ok(Lens { aperture: radius, focal_distance })
}

fn shutter(value: Value) -> Result<Shutter, LoadError> {
    let table = value.table(&["open", "close"])?;
    let open = table.get("open").map_or(Ok(0.0), |open| open.share())?;
    let close = table.get("close").map_or(Ok(1.0), |close| {
        close.number_that(&format!("from {open}, where `open` is, to 1"), |time| (open..=1.0).contains(&time))
    })?;
    Ok(Shutter { open, close })
}

/// Light that comes from no light source, from the table `[environment]`.
pub(super) struct Environment {
    /// The radiance of rays that hit nothing.
    pub background: Background,
    /// Ambient light of the Phong model in linear RGB, at least 0.
    pub ambient: Vec3,
    /// Whether light that bounces between surfaces is wanted.
    pub indirect_light: bool,
}

/// The values of `[environment]`, black and `false` where nothing else is given; fails if one is of the wrong
/// type or below 0, or if the file of a background is missing or is not an image. The image of an environment map is
/// added to `images`, unless it is the same in all directions.
pub(super) fn environment<'a>(
    value: Option<Value<'a>>,
    images: &mut Images<'a>,
) -> Result<Environment, LoadError> {
    let mut environment =
        Environment { background: Background::Color(Vec3::ZERO), ambient: Vec3::ZERO, indirect_light: false };
    let Some(value) = value else { return Ok(environment) };
    for value in value.table(&["background", "ambient", "indirect_light"])?.values() {
        match value.key {
            "background" => environment.background = background(value, images)?,
            "ambient" => environment.ambient = value.color(ColorPlace::AmbientLight)?,
            _ => environment.indirect_light = value.truth()?,
        }
    }
    Ok(environment)
}

/// A background: a colour, or a table with the colours of a gradient or with the file of an environment map.
fn background<'a>(value: Value<'a>, images: &mut Images<'a>) -> Result<Background, LoadError> {
    let Ok(table) = value.any_table() else {
        return Ok(Background::Color(value.color(ColorPlace::Background)?));
    };
    let given = table.one_of(&["horizon", "file"])?;
    if given.key == "horizon" {
        let table = table.with_keys(&["zenith", "horizon", "nadir"])?;
        let color = |value: Value, place| value.color(ColorPlace::Gradient(place));
        let horizon = color(given, GradientColor::Horizon)?;
        let zenith = color(table.need("zenith", "[0.2, 0.4, 0.8]")?, GradientColor::Zenith)?;
        // Without a colour of its own the ground is that of the horizon, whose encoded bytes are kept for it as well.
        let nadir = color(table.get("nadir").unwrap_or(given), GradientColor::Nadir)?;
        return Ok(Background::Gradient(Gradient { zenith, horizon, nadir }));
    }
    let table = table.with_keys(&["file", "rotation", "scale"])?;
    let file = table.need("file", "\"sky.hdr\"")?;
    let rotation = table.get("rotation").map_or(Ok(0.0), |degrees| degrees.number())?.to_radians();
    let scale = table.get("scale").map_or(Ok(1.0), |scale| scale.not_negative())?;
    let path = files::find(file)?;
    if scale == 0.0 {
        return Ok(Background::Color(Vec3::ZERO));
    }
    let texture = images.add(path, Wrap::Repeat, file);
    images.read(texture)?;
    let pixels = &images.list[texture].pixels;
    match pixels.iter().all(|pixel| *pixel == pixels[0]) {
        true => Ok(Background::Color(scale * pixels[0])),
        false => Ok(Background::Map(EnvironmentMap { texture, rotation, scale })),
    }
}

/// The settings of `[quality]`, with `Quality::default()` for keys that are missing; fails if a value is out
/// of range.
pub(super) fn quality(value: Option<Value>) -> Result<Quality, LoadError> {
    let mut quality = Quality::default();
    if let Some(value) = value {
        for value in value.table(&Quality::KEYS)?.values() {
            read(&mut quality, value)?;
        }
    }
    Ok(quality)
}

fn read(quality: &mut Quality, value: Value) -> Result<(), LoadError> {
    // The caller has refused unknown keys.
    let Some(field) = quality.field(value.key) else { return Ok(()) };
    match field {
        Field::Whole(number, range) => *number = value.whole(range)?,
        Field::Number(number, range) => {
            let wanted = match (*range.start(), *range.end()) {
                (least, f32::MAX) => format!("at least {least}"),
                (least, most) => format!("from {least} to {most}"),
            };
            *number = value.number_that(&wanted, |number| range.contains(&number))?;
        }
        Field::Truth(truth) => *truth = value.truth()?,
        Field::Name(name) => {
            let names: Vec<_> = name.names().into_iter().map(|name| (name, name)).collect();
            name.choose(value.choice(&names)?);
        }
        Field::Switches(switches) => {
            let switches = switches.switches();
            let names: Vec<_> = switches.iter().map(|(name, _)| *name).collect();
            let table = value.table(&names)?;
            for (name, is_on) in switches {
                *is_on = table.get(name).map_or(Ok(true), |wanted| wanted.truth())?;
            }
        }
    }
    Ok(())
}

/// Sets one setting of `[quality]`, as a command line names it, and returns its key: a name needs no quotes, and `-`
/// stands for `_`.
///
/// # Errors
///
/// The errors of the reader of scenes: the key is unknown, or the value is of the wrong type or out of range.
pub fn set(quality: &mut Quality, key: &str, text: &str) -> Result<&'static str, LoadError> {
    let source = Source::new(Path::new("--set"), text, Limits::default());
    let key = key.replace('-', "_");
    let unknown = || source.unknown(0..0, "key", &key, &Quality::KEYS);
    let known = Quality::KEYS.into_iter().find(|known| *known == key).ok_or_else(unknown)?;
    let name = || Spanned::new(0..text.len(), DeValue::String(text.replace('-', "_").into()));
    let item = DeValue::parse(text).unwrap_or_else(|_| name());
    read(quality, Value::alone(&source, known, &item)).map(|()| known)
}
