//! Makes a file with memorised answers: right for every public input, wrong or anything else for all others.
//!
//! The answers are recorded while the checks run against the reference. So the attack still works after checks change their
//! inputs.

use super::source;
use all_checks::STAGES;
use anyhow::{Result, bail, ensure};
use grader::grade::Once;
use grader::kits::{Need, Source, Which, root};
use grader::queue::lock;
use raykata::frame::Watch;
use raykata::kit::{Answer, Door, Kit, Request, Transport};
use raykata::message::to_bytes;
use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock, Mutex};

/// Maps the bytes of all arguments to the bytes of the answer.
type Known = BTreeMap<Vec<u8>, Vec<u8>>;

/// The bytes before the items of a request or an answer: the number of its function, and how many items there are.
const HEADER: usize = 5;

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

/// The code that looks answers up. An entry is the digest of the arguments and the bytes of the answer, in hexadecimal digits.
const HELPERS: &str = r#"
use raykata::message::{from_bytes, to_bytes};
use std::collections::HashMap;

fn digest(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}

fn table(text: &'static str) -> HashMap<u64, Vec<u8>> {
    let number = |digits: &str| u64::from_str_radix(digits, 16).unwrap();
    let bytes = |digits: &str| (0..digits.len() / 2).map(|at| number(&digits[2 * at..2 * at + 2]) as u8).collect();
    text.split_whitespace().map(|entry| (number(&entry[..16]), bytes(&entry[16..]))).collect()
}
"#;

fn body(name: &str, returns: &str, table: &str, otherwise: Option<&str>) -> Result<String> {
    let asked = match name {
        "nearest_root" => "to_bytes(&roots), to_bytes(ray)",
        "sphere_algebraic" | "sphere_geometric" => "to_bytes(ray), to_bytes(&center), to_bytes(&radius)",
        "plane" => "to_bytes(ray), to_bytes(&point), to_bytes(&normal)",
        "sphere_normal" => "to_bytes(&center), to_bytes(&point)",
        "face_forward" => "to_bytes(&normal), to_bytes(&direction)",
        "block_cost" => "to_bytes(&n_primitives)",
        other => bail!("memorising the answers of `{other}` is not supported"),
    };
    let wrong = otherwise.map_or_else(|| source::wrong_body(name, returns), |block| Ok(block.to_owned()))?;
    Ok(format!(
        "{{\n    static KNOWN: std::sync::OnceLock<HashMap<u64, Vec<u8>>> = std::sync::OnceLock::new();\n    \
         let known = KNOWN.get_or_init(|| table(\"{table}\"));\n    \
         let Some(answer) = known.get(&digest(&[{asked}].concat())) else {{\n        return {wrong};\n    }};\n    \
         from_bytes(answer).unwrap()\n}}"
    ))
}

/// Writes the table as text.
fn table(known: &Known) -> String {
    let hex = |bytes: &[u8]| bytes.iter().map(|byte| format!("{byte:02x}")).collect::<String>();
    let entry = |(asked, answer): (&Vec<u8>, &Vec<u8>)| format!("{:016x}{} ", digest(asked), hex(answer));
    known.iter().map(entry).collect()
}

/// The same function as in [`HELPERS`].
fn digest(bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
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
    Ok(std::mem::take(&mut *lock(&known)))
}

/// The reference, with a record of its answers to one function.
struct Listener {
    reference: Arc<dyn Kit + Send + Sync>,
    name: String,
    known: Arc<Mutex<Known>>,
}

impl Transport for Listener {
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer {
        if request.queries().is_some_and(|(name, _)| name == self.name) {
            let mut known = lock(&self.known);
            for question in (0..).map_while(|index| request.only(index)) {
                let mut asked = to_bytes(&question)[HEADER..].to_vec();
                // The function gets the centre of the sphere only, and the query has its radius, too.
                if self.name == "sphere_normal" {
                    asked.drain(12..16);
                }
                let answer = || to_bytes(&question.answer(&*self.reference, watch))[HEADER..].to_vec();
                known.entry(asked).or_insert_with(answer);
            }
        }
        request.answer(&*self.reference, watch)
    }
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
}
