//! The calls that `raykata try` prints for a student to paste are Rust, and give the answers to the requests from which they
//! were printed.

use checks::linked;
use raykata::frame::Watch;
use raykata::kit::{Answer, Door, Kit, Request, StudentKit, Transport};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

/// The longest call of each function that is not too long for a person.
#[derive(Default)]
struct Longest(Mutex<BTreeMap<String, (String, Request)>>);

impl Transport for Longest {
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer {
        for alone in (0..20).map_while(|index| request.only(index)) {
            let text = alone.call().expect("a call");
            let name = text.split('(').next().expect("a name").to_owned();
            let mut longest = self.0.lock().expect("no panic");
            if text.len() < 2000 && longest.get(&name).is_none_or(|(known, _)| known.len() < text.len()) {
                longest.insert(name, (text, alone));
            }
        }
        request.answer(&*linked(solutions::Kit), watch)
    }
}

#[test]
fn printed_calls_can_be_pasted() {
    #[allow(unused_imports, clippy::useless_vec)]
    let pasted: Vec<fn(&dyn Kit) -> String> = {
        use glam::*;
        use raykata::kit::types::*;
        include!("../../../tests/golden/printed_calls.txt")
    };
    let longest = Arc::new(Door(Longest::default()));
    for check in all_checks::STAGES.iter().flat_map(|(_, checks)| checks.iter()) {
        let kit: Arc<dyn Kit + Send + Sync> = longest.clone();
        assert!(checks::passes(check, &kit, 0), "{}", check.name);
    }
    let calls = longest.0.0.lock().expect("no panic");
    let lines = calls.values().map(|(text, _)| format!("|kit| format!(\"{{:?}}\", kit.{text}),\n"));
    let text = format!("vec![\n{}]\n", lines.collect::<String>());
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/golden/printed_calls.txt");
    if std::env::var("INSTA_UPDATE").is_ok_and(|how| how == "always") {
        std::fs::write(file, &text).expect("a file that can be written");
    }
    assert!(text == std::fs::read_to_string(file).unwrap_or_default(), "{file} is old: INSTA_UPDATE=always");
    assert_eq!(pasted.len(), calls.len(), "run this test again, to compile the new file");
    let kit = solutions::Kit.door();
    for ((name, (_, request)), pasted) in calls.iter().zip(pasted) {
        let answer = request.answer(&*kit, &raykata::frame::Unwatched);
        assert_eq!(pasted(&*kit), format!("{:?}", answer.values()), "{name}");
    }
}
