//! The quality parameters of a scene as options, the same for all commands that render.

use crate::args::{Given, Misuse, Opt, names};
use crate::report::load_scene;
use anyhow::{Result, anyhow};
use raykata::film::ToneCurve;
use raykata::scene::error::LoadError;
use raykata::scene::load::{Limits, set};
use raykata::scene::{Accelerator, Field, Quality, Scene};
use std::path::Path;

/// The number of threads that render, the same for all commands.
pub const THREADS: &[Opt] = &[Opt::value("--threads", "N", "Threads; 0 takes one per core [default: 0].")];

/// Reads [`THREADS`]: the number of threads for a job.
pub fn threads(given: &Given) -> Result<usize, Misuse> {
    Ok(given.number("--threads", 0..=1024)?.unwrap_or(0))
}

/// The memory that a scene may use, the same for all commands that read one.
pub const MEMORY: Opt =
    Opt::value("--memory", "GB", "The most memory for film, textures and triangles [default: 4].");

/// Reads [`MEMORY`]: the limits for a scene.
pub fn limits(given: &Given) -> Result<Limits, Misuse> {
    let gigabytes: Option<u64> = given.number("--memory", 1..=1_000_000)?;
    Ok(gigabytes.map_or(Limits::default(), |n| Limits { memory: n * 1_000_000_000 }))
}

/// How bright a picture file is, the same for all commands that write a picture of a scene.
#[derive(Clone, Copy, Default)]
pub struct ToneOptions {
    exposure: Option<f32>,
    curve: Option<ToneCurve>,
}

impl ToneOptions {
    /// The options.
    pub const OPTIONS: &[Opt] = &[
        Opt::value(
            "--exposure",
            "STOPS",
            "Of the PNG file: each stop doubles the light [default: the scene's, as for --tone].",
        ),
        Opt::value("--tone", "NAME", "How the PNG file shows light above 1.")
            .choices(&names(&ToneCurve::ALL)),
    ];

    /// Reads the options.
    pub fn read(given: &Given) -> Result<ToneOptions, Misuse> {
        Ok(ToneOptions {
            exposure: given.parsed("--exposure", parse_exposure)?,
            curve: given.choice("--tone", &ToneCurve::ALL)?,
        })
    }

    /// Sets the given options in the scene.
    pub fn apply(self, scene: &mut Scene) {
        let tone = &mut scene.film.tone;
        tone.exposure = self.exposure.unwrap_or(tone.exposure);
        tone.curve = self.curve.unwrap_or(tone.curve);
    }
}

/// The size of the picture and the settings of `[quality]`. Those that are not given keep the value of the scene.
#[derive(Default)]
pub struct QualityOptions {
    /// The width and height of the picture, if they are given.
    pub size: Option<(u32, u32)>,
    /// The settings that are given, and their keys.
    wanted: Quality,
    keys: Vec<&'static str>,
    /// The limits for a scene.
    pub limits: Limits,
}

impl QualityOptions {
    /// The options.
    pub const OPTIONS: &[Opt] = &[
        Opt::value(
            "--size",
            "WxH",
            "Size in pixels, such as 640x360 [default: the scene's, as for all below].",
        ),
        Opt::value("--spp", "N", "Samples per pixel."),
        Opt::value("--accelerator", "NAME", "Acceleration structure.").choices(&names(&Accelerator::NAMES)),
        Opt::value(
            "--set",
            "KEY=VALUE",
            "A setting of `[quality]` and its value, as in scene files, such as max_depth=3 or sampler=random; it can \
             be repeated. The keys:",
        )
        .choices(&Quality::KEYS)
        .many()
        .earlier(earlier),
        MEMORY,
    ];

    /// Reads the options.
    pub fn read(given: &Given) -> Result<QualityOptions, Misuse> {
        let mut options = QualityOptions {
            size: given.parsed("--size", parse_size)?,
            limits: limits(given)?,
            ..QualityOptions::default()
        };
        let mut changes = given.repeated("--set", |text| match text.split_once('=') {
            Some((key, value)) => change(key_of(key.trim()).unwrap_or(key.trim()), value.trim()),
            None => Err("a setting is KEY=VALUE, such as max_depth=3".into()),
        })?;
        changes.extend(given.parsed("--spp", |text| change("samples_per_pixel", text))?);
        changes.extend(given.parsed("--accelerator", |text| change("accelerator", text))?);
        for (key, quality) in changes {
            given.refuse(options.keys.contains(&key), format!("`{key}` is given twice"))?;
            options.wanted.take(key, &quality);
            options.keys.push(key);
        }
        Ok(options)
    }

    /// The accelerator, if one is given.
    pub fn accelerator(&self) -> Option<Accelerator> {
        self.keys.contains(&"accelerator").then_some(self.wanted.accelerator)
    }

    /// Whether a number of samples per pixel was given.
    pub fn names_samples(&self) -> bool {
        self.keys.contains(&"samples_per_pixel")
    }

    /// Reads a scene, and sets the given parameters in it.
    pub fn load(&self, file: &Path) -> Result<Scene> {
        let mut scene = load_scene(file, self.limits)?;
        self.apply(&mut scene)?;
        Ok(scene)
    }

    /// Sets the given parameters in the scene. Fails if a picture of the given size needs more memory than the limit.
    pub fn apply(&self, scene: &mut Scene) -> Result<()> {
        if let Some((width, height)) = self.size {
            self.limits.check_film(width, height).map_err(|message| anyhow!(message))?;
            (scene.film.width, scene.film.height) = (width, height);
        }
        for key in &self.keys {
            scene.quality.take(key, &self.wanted);
        }
        Ok(())
    }
}

/// The key of a setting and settings with its value; fails with the message of the reader of scenes.
fn change(key: &str, text: &str) -> Result<(&'static str, Quality), String> {
    let mut quality = Quality::default();
    match set(&mut quality, key, text) {
        Ok(key) => Ok((key, quality)),
        Err(LoadError { message, help: Some(help), .. }) => Err(format!("{message}\nhelp: {help}")),
        Err(LoadError { message, .. }) => Err(message),
    }
}

/// The options that change `own` to `wanted`, for the settings that differ.
pub fn arguments(own: &Quality, wanted: &Quality) -> String {
    let mut texts = *wanted;
    let mut argument = |key| {
        let text = texts.field(key).map_or(String::new(), Field::text);
        match key {
            "samples_per_pixel" => format!(" --spp {text}"),
            "accelerator" => format!(" --accelerator {text}"),
            _ if text.contains(' ') => format!(" --set '{key}={text}'"),
            _ => format!(" --set {key}={text}"),
        }
    };
    own.differences(wanted).into_iter().map(&mut argument).collect()
}

/// What replaces an option of an earlier version; `None` if there was no such option.
fn earlier(name: &str, value: &str) -> Option<String> {
    if name == "--roulette-from" {
        return Some(format!("`{name}` is gone: Russian roulette begins at the third bounce"));
    }
    let key = key_of(name.strip_prefix("--")?)?;
    Some(format!("`{name}` is now written `--set {key}={value}`"))
}

/// The key of `[quality]` that the short form or the earlier name of an option or of a parameter of `cost` stands for.
pub fn key_of(name: &str) -> Option<&'static str> {
    let name = name.replace('-', "_");
    let renamed = match name.as_str() {
        "spp" | "samples" => "samples_per_pixel",
        "depth" => "max_depth",
        "triangles" | "intersection" => "triangle_method",
        "spheres" | "sphere_test" => "sphere_method",
        other => other,
    };
    Quality::KEYS.into_iter().find(|key| *key == renamed)
}

fn parse_exposure(text: &str) -> Result<f32, String> {
    let stops = text.parse().ok().filter(|stops| (-100.0..=100.0).contains(stops));
    stops.ok_or_else(|| "an exposure is a number of stops from -100 to 100, such as -0.5".into())
}

/// The longest side of a picture, as in scene files.
const MAX_SIDE: u32 = 65_536;

pub(crate) fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let side = |text: &str| text.parse().ok().filter(|side| (1..=MAX_SIDE).contains(side));
    let size = text.split_once(['x', '×']).and_then(|(width, height)| Some((side(width)?, side(height)?)));
    let why = "a size is two whole numbers from 1 to 65536 with an x between them, such as 640x360";
    size.ok_or_else(|| why.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{Read, Spec};
    use raykata::scene::{NextEvent, Sampler};
    use std::ffi::OsString;

    static LINE: Spec =
        Spec { name: "render", about: "", arguments: &[], options: &[QualityOptions::OPTIONS] };

    #[test]
    fn arguments_turn_every_parameter() {
        let mut scene = crate::report::scene_of_kit("stage1");
        let own = scene.quality;
        let wanted = Quality {
            samples_per_pixel: 343,
            sampler: Sampler::Jittered,
            min_contribution: 0.03,
            next_event: NextEvent::Only,
            clamp: 10.0,
            accelerator: Accelerator::OctreeByCells,
            leaf_size: 8,
            ..own
        };
        let line = arguments(&own, &wanted);
        assert!(line.starts_with(" --spp 343 --set sampler=jittered --set min_contribution=0.03"), "{line}");
        let read = |line: &str| match LINE.read(line.split_whitespace().map(OsString::from)) {
            Ok(Read::Given(given)) => QualityOptions::read(&given),
            Ok(Read::Help(help)) => panic!("{help}"),
            Err(why) => Err(why),
        };
        read(&line).unwrap().apply(&mut scene).unwrap();
        assert_eq!(scene.quality, wanted);
        assert_eq!(arguments(&own, &own), "");
        let why = |line: &str| read(line).map(|_| ()).unwrap_err().to_string();
        for (line, message) in [
            (
                "--set spp=0",
                "`--set spp=0`: `samples_per_pixel` must be a whole number from 1 to 1048576, but is 0\n",
            ),
            ("--set max-depth", "`--set max-depth`: a setting is KEY=VALUE, such as max_depth=3\n"),
            ("--set sampler=center --set sampler=random", "`sampler` is given twice\n"),
            ("--spp 4 --set samples-per-pixel=8", "`samples_per_pixel` is given twice\n"),
        ] {
            assert!(why(line).starts_with(message), "{}", why(line));
        }
        for (old, new) in [
            ("--depth 3", "`--depth` is now written `--set max_depth=3`"),
            ("--spheres=geometric", "`--spheres` is now written `--set sphere_method=geometric`"),
            ("--clamp", "`--clamp` is now written `--set clamp=VALUE`"),
            ("--roulette-from 3", "`--roulette-from` is gone: Russian roulette begins at the third bounce"),
        ] {
            assert_eq!(why(old), new);
        }
    }
}
