//! Figures that can be touched show in a browser, bit for bit, what the kit computes here. The library is compiled to WebAssembly
//! and a browser runs it, so this runs only with `CI_LONG=1`.

use super::deck::root;
use browser::Browser;
use raykata_cli::touch::write_page;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;

/// Compares the answers in the value of an expression, `[question, answer, …]`, with those of the kit, and returns the questions.
fn compare(browser: &mut Browser, expression: &str) -> BTreeSet<String> {
    let answers = browser.evaluate(expression).unwrap();
    let texts: Vec<&str> = answers.as_array().unwrap().iter().filter_map(Value::as_str).collect();
    let (pairs, []) = texts.as_chunks() else { panic!("an answer is missing: {texts:?}") };
    for [question, shown] in pairs {
        let expected = touch::answer(&*solutions::kit(), question).unwrap();
        let first = shown.split('<').zip(expected.split('<')).find(|(a, b)| a != b);
        assert!(*shown == expected, "{question}: page and kit differ in {first:?}");
    }
    pairs.iter().map(|[question, _]| (*question).to_owned()).collect()
}

/// Presses at the middle of an element with the mouse or a finger, and moves it to a place beside it.
fn drag(browser: &mut Browser, element: &str, by: [f64; 2], finger: bool) {
    let middle = format!(
        "(e => {{ e.scrollIntoView({{ block: 'center' }}); const b = e.getBoundingClientRect(); \
         return [b.x + b.width / 2, b.y + b.height / 2]; }})(document.querySelector('{element}'))"
    );
    let middle = browser.evaluate(&middle).unwrap();
    let [x, y] = [0, 1].map(|axis| middle[axis].as_f64().unwrap());
    let end = [x + by[0], y + by[1]];
    for (mouse, touch, [x, y]) in [
        ("mousePressed", "touchStart", [x, y]),
        ("mouseMoved", "touchMove", end),
        ("mouseReleased", "touchEnd", end),
    ] {
        let points = if touch == "touchEnd" { json!([]) } else { json!([{ "x": x, "y": y }]) };
        let event = json!({ "type": mouse, "x": x, "y": y, "button": "left", "buttons": 1, "clickCount": 1 });
        let (kind, event) = match finger {
            true => ("Input.dispatchTouchEvent", json!({ "type": touch, "touchPoints": points })),
            false => ("Input.dispatchMouseEvent", event),
        };
        browser.call(kind, event).unwrap();
        browser.evaluate("new Promise(done => requestAnimationFrame(() => setTimeout(done)))").unwrap();
    }
}

#[test]
fn touched_figures_are_what_the_kit_computes() {
    if std::env::var_os("CI_LONG").is_none() {
        return println!("skipped: run only with CI_LONG=1");
    }
    let Some(mut browser) = Browser::start().unwrap() else { return };
    // Make the page, with the still figures beside it.
    let folder = tempfile::tempdir().unwrap();
    let names = write_page(&root(), folder.path()).unwrap();
    fs::create_dir(folder.path().join("figures")).unwrap();
    for figure in fs::read_dir(root().join("slides/figures")).unwrap().flatten() {
        fs::copy(figure.path(), folder.path().join("figures").join(figure.file_name())).unwrap();
    }
    assert_eq!(names, touch::FIGURES.iter().map(|figure| figure.name).collect::<Vec<_>>());
    let page = folder.path().join("touch.html");
    let size = fs::metadata(&page).unwrap().len();
    assert!(size < 2_300_000, "{size} bytes: slides/README.md states the size");
    let page = format!("file://{}", page.display());
    browser.window(1000, 900, false).unwrap();
    browser.open(&page).unwrap();
    browser.wait_for("!!document.documentElement.dataset.state").unwrap();
    if browser.evaluate("document.getElementById('wasm').textContent").unwrap() == "" {
        return eprintln!("SKIPPED: the target is not installed: rustup target add wasm32-unknown-unknown");
    }

    // Move a handle by keys, the mouse and a finger, and a slider by a key. It keeps the focus when it is drawn again.
    let all = "[...document.querySelectorAll('section')].flatMap(one => [one.asked, one.html])";
    let mut before = compare(&mut browser, all);
    let focus = |element: &str| format!("document.querySelector('{element}').focus()");
    for step in 0..5 {
        match step {
            0 => drop(browser.evaluate(&focus("#snell .handle")).unwrap()),
            2 => drag(&mut browser, "#slab-intervals .handle", [31.0, 47.0], false),
            3 => drag(&mut browser, "#thin-lens .handle", [0.0, 23.0], true),
            4 => drop(browser.evaluate(&focus("#grid-steps input")).unwrap()),
            _ => {}
        }
        if [0, 1, 4].contains(&step) {
            browser.press("ArrowRight").unwrap();
        }
        let after = compare(&mut browser, all);
        assert_eq!(after.difference(&before).count(), 1, "step {step} changes one figure");
        before = after;
    }
    // Draw all figures with many handles.
    let asked = compare(&mut browser, include_str!("../touch.js"));
    assert!(asked.len() > 80, "{} questions", asked.len());
    assert_eq!(browser.complaints, Vec::<String>::new());

    // Without WebAssembly the still figures are shown.
    let without = json!({ "source": "delete window.WebAssembly" });
    browser.call("Page.addScriptToEvaluateOnNewDocument", without).unwrap();
    browser.open(&page).unwrap();
    browser.wait_for("document.documentElement.dataset.state === 'still'").unwrap();
    let still = "[...document.images].every(image => image.naturalWidth > 0 && image.checkVisibility())";
    assert_eq!(browser.evaluate(still).unwrap(), true);
}
