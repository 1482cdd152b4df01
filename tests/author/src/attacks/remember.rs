//! Makes a file with memorised answers: right for every public input, wrong or anything else for all others.
//!
//! The answers are recorded while the checks run against the reference. So the attack still works after checks change their
//! inputs.

use super::source;
use all_checks::STAGES;
use anyhow::{Result, bail, ensure};
use glam::Vec3;
use grader::grade::Once;
use grader::kits::{Need, Source, Which, root};
use raykata::frame::Watch;
use raykata::kit::{Answer, Door, Kit, PlaneQuery, Request, SphereQuery, Transport};
use raykata::ray::Ray;
use raykata::shape::Sphere;
use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// Maps the bits of all arguments to the bits of the answer.
type Known = BTreeMap<Vec<u32>, Vec<u32>>;

/// Returns the file with functions that look their answers up. For unknown inputs they run the block `otherwise`, or return a
/// wrong answer if there is none.
pub(super) fn by_heart(text: &str, names: &[String], otherwise: Option<&str>) -> Result<String> {
    let mut changed = source::with_top(text, HELPERS);
    for name in names {
        let known = known(name)?;
        ensure!(!known.is_empty(), "no check calls `{name}`");
        let table = table(&known);
        changed =
            source::with_bodies(&changed, name, |name, returns| body(name, returns, &table, otherwise))?;
    }
    Ok(changed)
}

/// The code that looks answers up. Keys and answers are 32-bit words, each written as six characters.
const HELPERS: &str = r#"
use std::collections::HashMap;

fn word(text: &str) -> u32 {
    text.bytes().fold(0, |word, byte| word << 6 | u32::from(byte) - 48)
}

fn digest(words: &[u32]) -> u32 {
    words.iter().fold(0x811c_9dc5u32, |hash, word| (hash ^ word).wrapping_mul(0x0100_0193).rotate_left(13))
}

fn table(text: &'static str, width: usize) -> HashMap<u32, Vec<u32>> {
    let words: Vec<u32> = (0..text.len() / 6).map(|at| word(&text[6 * at..6 * at + 6])).collect();
    words.chunks(width + 1).map(|entry| (entry[0], entry[1..].to_vec())).collect()
}

trait Words {
    fn words(&self) -> Vec<u32>;
}

impl Words for f32 {
    fn words(&self) -> Vec<u32> {
        vec![self.to_bits()]
    }
}

impl Words for [f32; 2] {
    fn words(&self) -> Vec<u32> {
        self.iter().map(|x| x.to_bits()).collect()
    }
}

impl Words for u32 {
    fn words(&self) -> Vec<u32> {
        vec![*self]
    }
}

impl Words for glam::Vec3 {
    fn words(&self) -> Vec<u32> {
        self.to_array().iter().map(|x| x.to_bits()).collect()
    }
}

impl Words for &raykata::ray::Ray {
    fn words(&self) -> Vec<u32> {
        [self.origin.words(), self.direction.words(), vec![self.t_min.to_bits(), self.t_max.to_bits()]].concat()
    }
}
"#;

fn body(name: &str, returns: &str, table: &str, otherwise: Option<&str>) -> Result<String> {
    let (asked, answer, width) = match name {
        "nearest_root" => ("[roots.words(), ray.words()]", "found", 2),
        "sphere_algebraic" | "sphere_geometric" => {
            ("[ray.words(), center.words(), radius.words()]", "found", 2)
        }
        "plane" => ("[ray.words(), point.words(), normal.words()]", "found", 2),
        "sphere_normal" => ("[center.words(), point.words()]", "vector", 3),
        "face_forward" => ("[normal.words(), direction.words()]", "vector", 3),
        "block_cost" => ("[n_primitives.words()]", "number", 1),
        other => bail!("memorising the answers of `{other}` is not supported"),
    };
    let answer = match answer {
        "found" => "if answer[0] == 1 { Some(f32::from_bits(answer[1])) } else { None }",
        "number" => "f32::from_bits(answer[0])",
        _ => "Vec3::from_array([answer[0], answer[1], answer[2]].map(f32::from_bits))",
    };
    let wrong = otherwise.map_or_else(|| source::wrong_body(name, returns), |block| Ok(block.to_owned()))?;
    Ok(format!(
        "{{\n    static KNOWN: std::sync::OnceLock<HashMap<u32, Vec<u32>>> = std::sync::OnceLock::new();\n    \
         let known = KNOWN.get_or_init(|| table(r\"{table}\", {width}));\n    \
         let Some(answer) = known.get(&digest(&{asked}.concat())) else {{\n        return {wrong};\n    }};\n    {answer}\n}}"
    ))
}

/// Writes the table as text: per entry the digest of the question, then the answer.
fn table(known: &Known) -> String {
    let mut text = String::new();
    for (asked, answer) in known {
        for word in std::iter::once(digest(asked)).chain(answer.iter().copied()) {
            let digits = (0..6).rev().map(|place| 48 + (word >> (6 * place) & 63) as u8);
            text.extend(digits.map(char::from));
        }
    }
    text
}

/// The same function as in [`HELPERS`].
fn digest(words: &[u32]) -> u32 {
    words.iter().fold(0x811c_9dc5u32, |hash, word| (hash ^ word).wrapping_mul(0x0100_0193).rotate_left(13))
}

/// Returns all public inputs with which the checks call this function, and the reference's answers.
fn known(name: &str) -> Result<Arc<Known>> {
    static KNOWN: LazyLock<Once<String, Arc<Known>>> = LazyLock::new(Once::default);
    KNOWN.get(name.to_owned(), || learned(name).map(Arc::new))
}

fn learned(name: &str) -> Result<Known> {
    let known = Arc::<Mutex<Known>>::default();
    // Ask cargo once for all functions.
    static REFERENCE: LazyLock<Once<(), Arc<Source>>> = LazyLock::new(Once::default);
    let prepared = || Ok(Arc::new(Source::prepare(&root()?, Which::Solutions, Need::Checks)?));
    let reference = REFERENCE.get((), prepared)?.fresh();
    let listener = Listener { reference, name: name.to_owned(), known: known.clone() };
    let kit: Arc<dyn Kit + Send + Sync> = Arc::new(Door(listener));
    let of_function = if name == "block_cost" { 12 } else { 1 };
    for check in STAGES.iter().filter(|(stage, _)| *stage == of_function).flat_map(|(_, checks)| *checks) {
        match checks::examine(check, &kit, 0, checks::Inputs::default()) {
            Ok(Ok(())) => {}
            other => bail!("the reference fails {}: {other:?}", check.name),
        }
    }
    Ok(std::mem::take(&mut *known.lock().unwrap_or_else(PoisonError::into_inner)))
}

/// The reference, with a record of its answers to one function.
struct Listener {
    reference: Arc<dyn Kit + Send + Sync>,
    name: String,
    known: Arc<Mutex<Known>>,
}

impl Transport for Listener {
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer {
        let answer = request.answer(&*self.reference, watch);
        let recorded = match (self.name.as_str(), &request, &answer) {
            ("nearest_root", Request::NearestRoot(asked), Answer::NearestRoot(given)) => {
                pairs(asked, given, |q| vec![q.roots.to_vec(), ray(&q.ray)], |found| option(*found))
            }
            ("sphere_algebraic", Request::SphereAlgebraic(asked), Answer::SphereAlgebraic(given))
            | ("sphere_geometric", Request::SphereGeometric(asked), Answer::SphereGeometric(given)) => {
                let words =
                    |q: &SphereQuery| vec![ray(&q.ray), vector(q.sphere.center), vec![q.sphere.radius]];
                pairs(asked, given, words, |found| option(*found))
            }
            ("plane", Request::Plane(asked), Answer::Plane(given)) => {
                let words = |q: &PlaneQuery| vec![ray(&q.ray), vector(q.plane.point), vector(q.plane.normal)];
                pairs(asked, given, words, |found| option(*found))
            }
            ("sphere_normal", Request::SphereNormal(asked), Answer::SphereNormal(given)) => {
                let words = |(sphere, point): &(Sphere, Vec3)| vec![vector(sphere.center), vector(*point)];
                pairs(asked, given, words, |normal| normal.to_array().map(f32::to_bits).to_vec())
            }
            ("face_forward", Request::FaceForward(asked), Answer::FaceForward(given)) => {
                let words = |(normal, direction): &(Vec3, Vec3)| vec![vector(*normal), vector(*direction)];
                pairs(asked, given, words, |normal| normal.to_array().map(f32::to_bits).to_vec())
            }
            ("block_cost", Request::BlockCost(asked), Answer::BlockCost(given)) => {
                pairs(asked, given, |n| vec![vec![f32::from_bits(*n)]], |cost| vec![cost.to_bits()])
            }
            _ => Vec::new(),
        };
        self.known.lock().unwrap_or_else(PoisonError::into_inner).extend(recorded);
        answer
    }
}

fn pairs<Q, A>(
    asked: &[Q],
    given: &[A],
    question: impl Fn(&Q) -> Vec<Vec<f32>>,
    answer: impl Fn(&A) -> Vec<u32>,
) -> Vec<(Vec<u32>, Vec<u32>)> {
    let bits = |question: Vec<Vec<f32>>| question.concat().into_iter().map(f32::to_bits).collect();
    asked.iter().zip(given).map(|(asked, given)| (bits(question(asked)), answer(given))).collect()
}

fn ray(ray: &Ray) -> Vec<f32> {
    [&ray.origin.to_array()[..], &ray.direction.to_array(), &[ray.t_min, ray.t_max]].concat()
}

fn vector(vector: Vec3) -> Vec<f32> {
    vector.to_array().to_vec()
}

/// Encodes whether there is an answer, and which.
fn option(found: Option<f32>) -> Vec<u32> {
    vec![u32::from(found.is_some()), found.unwrap_or_default().to_bits()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_answers_of_the_reference_are_written_down() {
        let known = known("face_forward").unwrap();
        assert!(known.len() > 500, "{}", known.len());
        let stub =
            "use glam::Vec3;\npub fn face_forward(normal: Vec3, direction: Vec3) -> Vec3 { todo!() }\n";
        let text = by_heart(stub, &["face_forward".into()], None).unwrap();
        assert!(text.contains("static KNOWN") && !text.contains("todo!"));
        assert!(by_heart(stub, &["plan".into()], None).unwrap_err().to_string().contains("`plan`"));
    }

    #[test]
    fn words_survive_as_text() {
        let known = Known::from([(vec![1, 2], vec![u32::MAX, 0, 0x1234_5678])]);
        let text = table(&known);
        assert_eq!(text.len(), 4 * 6);
        let word = |at: usize| {
            text.as_bytes()[6 * at..6 * at + 6]
                .iter()
                .fold(0u32, |word, byte| word << 6 | u32::from(byte - 48))
        };
        assert_eq!([word(0), word(1), word(2), word(3)], [digest(&[1, 2]), u32::MAX, 0, 0x1234_5678]);
    }
}
