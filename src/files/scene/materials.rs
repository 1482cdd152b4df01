//! Reads `[materials.NAME]`, and converts the materials that come with OBJ meshes.

use super::names::Names;
use super::reader::Value;
use crate::files::error::LoadError;
use crate::files::obj::ObjMaterial;
use crate::material::{Fresnel, Material};
use crate::scene::{ColorPlace, MaterialColor};
use glam::Vec3;

const FRESNEL: [(&str, Fresnel); 3] =
    [("none", Fresnel::None), ("schlick", Fresnel::Schlick), ("exact", Fresnel::Exact)];

const KEYS: [&str; 14] = [
    "ambient",
    "diffuse",
    "specular",
    "exponent",
    "mirror",
    "transmission",
    "index_of_refraction",
    "outside",
    "fresnel",
    "roughness",
    "emission",
    "one_sided_emission",
    "coat",
    "texture",
];

/// All materials of a scene with their names. Index 0 is the default.
pub(super) struct Materials<'a> {
    /// The materials by index: those of the scene file, then those of OBJ meshes.
    pub list: Vec<Material>,
    /// The name of each material by index, for messages.
    pub list_names: Vec<String>,
    /// The names that nodes and meshes may refer to: `default`, and all `[materials.NAME]`.
    pub names: Names<'a>,
}

impl Materials<'_> {
    /// Adds a material and returns its index. It can be referred to by name only after an entry in
    /// [`Materials::names`].
    pub fn push(&mut self, name: impl Into<String>, material: Material) -> usize {
        self.list.push(material);
        self.list_names.push(name.into());
        self.list.len() - 1
    }
}

/// All `[materials.NAME]` in the order of the file, after the default; `textures` are the names that they may
/// refer to. Fails if a key is unknown or a value is out of range.
pub(super) fn materials<'a>(value: Option<Value<'a>>, textures: &Names) -> Result<Materials<'a>, LoadError> {
    let mut materials = Materials { list: Vec::new(), list_names: Vec::new(), names: Names::new("material") };
    materials.push("default", Material::default());
    materials.names.insert("default", 0);
    let Some(value) = value else { return Ok(materials) };
    for entry in value.any_table()?.values() {
        let index = if entry.key == "default" { 0 } else { materials.list.len() };
        let material = material(entry, index, textures)?;
        if entry.key == "default" {
            materials.list[0] = material;
        } else {
            let index = materials.push(entry.key, material);
            materials.names.insert(entry.key, index);
        }
    }
    Ok(materials)
}

fn material(value: Value, index: usize, textures: &Names) -> Result<Material, LoadError> {
    let table = value.table(&KEYS)?;
    let mut material = Material::default();
    let at = |color| ColorPlace::Material(index, color);
    for value in table.values() {
        match value.key {
            "ambient" => material.ambient = value.color(at(MaterialColor::Ambient))?,
            "diffuse" => material.diffuse = value.color(at(MaterialColor::Diffuse))?,
            "specular" => material.specular = value.color(at(MaterialColor::Specular))?,
            "exponent" => material.exponent = value.not_negative()?,
            "mirror" => material.mirror = value.color(at(MaterialColor::Mirror))?,
            "transmission" => material.transmission = value.color(at(MaterialColor::Transmission))?,
            "index_of_refraction" => material.index_of_refraction = value.positive()?,
            // Divided out below, once all keys are read.
            "outside" => {}
            "fresnel" => material.fresnel = value.choice(&FRESNEL)?,
            "roughness" => {
                material.roughness = value.or_nothing(value.share()?, 1.0, "the material is smooth");
            }
            "one_sided_emission" => material.one_sided_emission = value.truth()?,
            "coat" => material.coat = value.positive()?,
            "emission" => material.emission = value.color(at(MaterialColor::Emission))?,
            _ => material.texture = Some(textures.find(value)?),
        }
    }
    // Snell's law and Fresnel's equations depend only on the ratio of the indices, so the ratio is all that the tracer needs.
    if let Some(outside) = table.get("outside") {
        material.index_of_refraction /= outside.positive()?;
        if !(f32::MIN_POSITIVE..f32::INFINITY).contains(&material.index_of_refraction) {
            return Err(outside
                .error("`index_of_refraction` divided by `outside` does not fit into 32 bits")
                .help("indices of refraction of real media lie between 1 and 5"));
        }
    }
    if let Some(coat) = table.get("coat").filter(|_| material.transmission != Vec3::ZERO) {
        return Err(coat
            .error("a material that transmits light has no coat")
            .help("write `fresnel = \"exact\"`: glass reflects by itself"));
    }
    if table.get("ambient").is_none() {
        material.ambient = match table.get("diffuse") {
            Some(diffuse) => diffuse.color(at(MaterialColor::Ambient))?,
            None => material.diffuse,
        };
    }
    Ok(material)
}

/// The material that an MTL file describes, without its texture. The fraction 1 - `d` of the light passes through, so only
/// the fraction `d` is reflected diffusely: a material that did both would make light. What passes through a medium with an
/// index of refraction is divided by Fresnel's equations, which reflect all light beyond the critical angle.
pub(super) fn from_obj(obj: &ObjMaterial) -> Material {
    let default = Material::default();
    let diffuse = obj.diffuse.unwrap_or(default.diffuse);
    let opacity = obj.dissolve.unwrap_or(1.0);
    let index_of_refraction = obj.index_of_refraction.unwrap_or(default.index_of_refraction);
    Material {
        ambient: opacity * obj.ambient.unwrap_or(diffuse),
        diffuse: opacity * diffuse,
        specular: opacity * obj.specular.unwrap_or(default.specular),
        exponent: obj.shininess.unwrap_or(default.exponent),
        transmission: Vec3::splat(1.0 - opacity),
        index_of_refraction,
        fresnel: if opacity < 1.0 && index_of_refraction != 1.0 { Fresnel::Exact } else { Fresnel::None },
        emission: obj.emission.unwrap_or(default.emission),
        ..default
    }
}
