//! The calls that `raykata try` prints for a student to paste are Rust. The file has one of most functions.

use checks::linked;
use raykata::frame::Watch;
use raykata::kit::{Answer, Door, Kit, Request, StudentKit, Transport};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/golden/printed_calls.txt");

/// The longest call of each function that is not too long for a person.
#[derive(Default)]
struct Longest(Mutex<BTreeMap<String, String>>);

impl Transport for Longest {
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer {
        for call in (0..20).map_while(|index| request.only(index)?.call()) {
            let mut longest = self.0.lock().expect("no panic");
            let known = longest.entry(call.split('(').next().expect("a name").to_owned()).or_default();
            if (known.len()..2000).contains(&call.len()) {
                *known = call;
            }
        }
        request.answer(&*linked(solutions::Kit), watch)
    }
}

#[test]
fn printed_calls_can_be_pasted() {
    if std::env::var("INSTA_UPDATE").is_ok_and(|how| how == "always") {
        // Write the file with calls of the checks.
        let longest = Arc::new(Door(Longest::default()));
        let kit: Arc<dyn Kit + Send + Sync> = longest.clone();
        let mut checks = all_checks::STAGES.iter().flat_map(|(_, checks)| checks.iter());
        assert!(checks.all(|check| checks::passes(check, &kit, 0)));
        let calls = longest.0.0.lock().expect("no panic");
        let short = calls.iter().filter(|(_, call)| !call.is_empty());
        let lines =
            short.map(|(name, call)| format!("(\"{name}\", |kit| format!(\"{{:?}}\", kit.{call})),\n"));
        std::fs::write(FILE, format!("vec![\n{}]\n", lines.collect::<String>())).expect("a file");
    }
    #[allow(unused_imports, clippy::useless_vec, clippy::type_complexity, clippy::init_numbered_fields)]
    let pasted: Vec<(&str, fn(&dyn Kit) -> String)> = {
        use glam::*;
        use raykata::kit::types::*;
        include!("../../../tests/golden/printed_calls.txt")
    };
    let kit = solutions::Kit.door();
    assert!(pasted.iter().all(|(_, call)| call(&*kit) != "[]"));
    assert!(pasted.len() > 120, "run this test with INSTA_UPDATE=always, and again to compile the new file");
}
