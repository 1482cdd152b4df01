//! Checks of `effects` for scenes in which some or all surfaces are dark.

use super::scenes::{ONE_SAMPLE, add_material, everything, light};
use super::whole::judge;
use checks::prelude::*;
use raykata::effects::{Effects, MaterialEffects};
use raykata::material::Material;
use raykata::scene::{Background, Scene};

/// A scene, and which of its parts light reaches.
struct Dark {
    what: &'static str,
    scene: Scene,
    /// Whether any light can reach the camera.
    shines: bool,
    /// Whether material 1, which has an image, is lit.
    lit: bool,
}

impl Dark {
    /// The effects if materials with images are lit as `lit` says, and the scene shines as `shines` says.
    fn effects(&self, shines: bool, lit: bool) -> Effects {
        let scene = &self.scene;
        let mut materials = vec![MaterialEffects::default(); scene.materials.len()];
        if shines {
            let lights = (0..scene.lights.len()).filter(|_| self.listed()).collect();
            materials[1] =
                MaterialEffects { lights, mirror: true, glossy: true, texture: lit, transmission: false };
        }
        Effects {
            lens: shines,
            motion: shines,
            indirect_light: shines && scene.indirect_light,
            lights: vec![ONE_SAMPLE; scene.lights.len()],
            materials,
            smooth_meshes: vec![shines],
        }
    }

    /// Whether the light of the scene changes the colour of material 1.
    fn listed(&self) -> bool {
        let material = &self.scene.materials[1];
        self.scene.lights.iter().any(|light| {
            let radiance = light.radiance();
            radiance * material.diffuse != Vec3::ZERO || radiance * material.specular != Vec3::ZERO
        })
    }

    /// Mistakes, each with whether it gives this answer.
    fn mistakes(&self, yours: &Effects) -> Vec<(bool, &'static str)> {
        let material = &self.scene.materials[1];
        let shown_colour = material.diffuse != Vec3::ZERO || material.ambient != Vec3::ZERO;
        let of_any_light = !self.scene.lights.is_empty()
            || self.scene.ambient != Vec3::ZERO
            || (self.scene.indirect_light && material.diffuse != Vec3::ZERO);
        let any_bright = self.scene.materials.iter().any(|material| {
            material.emission != Vec3::ZERO || self.scene.ambient * material.ambient != Vec3::ZERO
        });
        let without_indirect = of_any_light && !self.scene.indirect_light;
        let sky = !self.scene.background.is_black();
        let by_any_ambient = self.scene.ambient != Vec3::ZERO && material.ambient != Vec3::ZERO;
        let by_ambient = self.scene.ambient * material.ambient != Vec3::ZERO;
        let without_sky = !sky || self.listed() || by_ambient;
        let without_emitters = sky || self.listed();
        let without_emission = without_emitters || by_ambient;
        let without_ambient = without_emitters || !without_emission;
        named![
            *yours == self.effects(self.shines && without_emission, self.lit) =>
                "a material that emits light shines, also in a scene without lights",
            *yours == self.effects(self.shines && without_ambient, self.lit) =>
                "ambient light shines, too, where a material reflects it",
            *yours == self.effects(self.shines, shown_colour) =>
                "an image shows only where light reaches its material: a light, ambient light, or indirect light",
            *yours == self.effects(self.shines, of_any_light) =>
                "light of one channel shows nothing of a colour in another: multiply channel by channel",
            *yours == self.effects(self.shines, self.lit && without_indirect) => "indirect light reaches images too",
            *yours == self.effects(self.shines || any_bright, self.lit) => "a material that no shape has does not shine",
            *yours == self.effects(self.shines, self.lit || self.scene.indirect_light) =>
                "indirect light shows no image of a material without a diffuse colour",
            *yours == self.effects(self.shines, self.lit || self.scene.ambient * material.diffuse != Vec3::ZERO) =>
                "ambient light shows an image by the `ambient` of its material, not by its `diffuse`",
            *yours == self.effects(self.shines, self.lit || by_any_ambient) =>
                "ambient light shows no image of a material that has none of its channels",
            *yours == self.effects(self.shines && without_sky, self.lit) =>
                "what is before a bright background is seen: the background shines, too",
            *yours == self.effects(self.shines && !self.scene.lights.is_empty(), self.lit)
                || *yours == self.effects(self.shines && without_emitters, self.lit) =>
                "a scene without lights is not dark: emitters, ambient light and the background shine, too",
            *yours == self.effects(true, self.lit) => "nothing shines in this scene, so its picture is black and needs nothing",
        ].to_vec()
    }
}

pub(super) fn what_nothing_lights_needs_nothing(trial: &Trial<'_>) -> CheckResult {
    let brightness = trial.varied(1.0, 0.1f32..4.0);
    let (green, grey) = (vec3(0.0, 0.5, 0.0), Vec3::splat(0.25));
    // A rough mirror with an image, a smooth mesh, a lens and a motion, without any light.
    let mut dark = everything();
    dark.lights.clear();
    dark.materials.truncate(2);
    dark.material_names.truncate(2);
    dark.materials[1].diffuse = green;
    dark.materials[1].ambient = green;
    dark.nodes[1].material = Some(1);
    dark.nodes[2].material = Some(1);
    let case = |what, shines, lit, change: &dyn Fn(&mut Scene)| {
        let mut scene = dark.clone();
        change(&mut scene);
        Dark { what, scene, shines, lit }
    };
    let sky = |scene: &mut Scene| scene.background = Background::Color(brightness * grey);
    let add_emitter = |scene: &mut Scene, node: Option<usize>| {
        let emission = brightness * grey;
        let emitter = Material { diffuse: Vec3::ZERO, ambient: Vec3::ZERO, emission, ..Material::default() };
        add_material(scene, "emitter", emitter);
        node.into_iter().for_each(|node| scene.nodes[node].material = Some(2));
    };
    let cases = [
        case("a mirror with an image, and nothing that shines", false, false, &|_| {}),
        case("the same, and indirect light", false, true, &|scene| scene.indirect_light = true),
        case("the same, and an emitter that no shape has", false, false, &|scene| add_emitter(scene, None)),
        case("the same, and red ambient light on green", false, false, &|scene| {
            scene.ambient = brightness * Vec3::X;
        }),
        case(
            "the same before a bright background, in ambient light that no material reflects",
            true,
            false,
            &|scene| {
                sky(scene);
                scene.ambient = brightness * grey;
                scene.materials.iter_mut().for_each(|material| material.ambient = Vec3::ZERO);
            },
        ),
        case("the same, and a red light on green", false, false, &|scene| {
            scene.lights.push(light(Vec3::X, brightness));
        }),
        case("the same before a bright background", true, false, &sky),
        case("the same beside an emitter", true, false, &|scene| add_emitter(scene, Some(1))),
        case("the same under a white light", true, true, &|scene| {
            scene.lights.push(light(Vec3::ONE, brightness));
        }),
        case("the same in ambient light", true, true, &|scene| scene.ambient = brightness * grey),
        case("the same under a red light, before a bright background", true, false, &|scene| {
            sky(scene);
            scene.lights.push(light(Vec3::X, brightness));
        }),
        case("the same in red ambient light, before a bright background", true, false, &|scene| {
            sky(scene);
            scene.ambient = brightness * Vec3::X;
        }),
        case("the same with a red highlight under a red light", true, false, &|scene| {
            scene.materials[1].specular = Vec3::X;
            scene.lights.push(light(Vec3::X, brightness));
        }),
        case("the same before a bright background, with indirect light", true, true, &|scene| {
            sky(scene);
            scene.indirect_light = true;
        }),
        case("the same without a diffuse colour", true, false, &|scene| {
            sky(scene);
            scene.indirect_light = true;
            scene.materials[1].diffuse = Vec3::ZERO;
        }),
    ];
    let scenes: Vec<Scene> = cases.iter().map(|case| case.scene.clone()).collect();
    let law = |case: &Dark, yours: Effects| judge(case.what, &yours, &case.effects(case.shines, case.lit));
    all_hold(compare_formulas(&cases, trial.kit.effects(&scenes), law, Dark::mistakes))
}
