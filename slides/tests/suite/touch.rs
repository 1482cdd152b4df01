//! Figures that can be touched show in a browser, bit for bit, what the kit computes here. The library is compiled to WebAssembly
//! and a browser runs it, so this runs only with `CI_LONG=1`.

use super::deck::root;
use browser::Browser;
use raykata_cli::touch::write_page;
use serde_json::json;
use touch::FIGURES;

/// Compares what the page shows of each figure with what the kit computes for the same handles.
fn compare(browser: &mut Browser, name: &str) -> Vec<f64> {
    let shown = browser.evaluate(&format!("document.getElementById('{name}').html")).unwrap();
    // As text, because JSON may round numbers.
    let handles = browser.evaluate(&format!("document.getElementById('{name}').asked.join(' ')")).unwrap();
    let words = handles.as_str().unwrap().split_whitespace();
    let handles: Vec<f64> = words.map(|word| word.parse().unwrap()).collect();
    let expected = touch::html(&*solutions::kit(), name, &handles).unwrap();
    let shown = shown.as_str().unwrap();
    let differ = |(a, b): &(&str, &str)| a != b;
    let first = shown.split('<').zip(expected.split('<')).find(differ);
    assert!(shown == expected, "{name} {handles:?}: the page and the kit differ: {first:?}");
    handles
}

/// Sends events of the mouse or of a finger: from the middle of an element to a place beside it.
fn drag(browser: &mut Browser, element: &str, by: [f64; 2], finger: bool) {
    let middle = format!(
        "(() => {{ const e = document.querySelector('{element}'); e.scrollIntoView({{ block: 'center' }}); \
         const b = e.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; }})()"
    );
    let middle = browser.evaluate(&middle).unwrap();
    let [x, y] = [0, 1].map(|axis| middle[axis].as_f64().unwrap());
    for (kind, touched, share) in [
        ("mousePressed", "touchStart", 0.0),
        ("mouseMoved", "touchMove", 1.0),
        ("mouseReleased", "touchEnd", 1.0),
    ] {
        let [x, y] = [x + share * by[0], y + share * by[1]];
        let points = if touched == "touchEnd" { json!([]) } else { json!([{ "x": x, "y": y }]) };
        let event = json!({ "type": kind, "x": x, "y": y, "button": "left", "buttons": 1, "clickCount": 1 });
        let called = match finger {
            true => {
                browser.call("Input.dispatchTouchEvent", json!({ "type": touched, "touchPoints": points }))
            }
            false => browser.call("Input.dispatchMouseEvent", event),
        };
        called.unwrap();
        browser.evaluate("new Promise(done => requestAnimationFrame(() => setTimeout(done)))").unwrap();
    }
}

#[test]
fn touched_figures_are_what_the_kit_computes() {
    if std::env::var_os("CI_LONG").is_none() {
        return println!("skipped: run only with CI_LONG=1");
    }
    let Some(mut browser) = Browser::start().unwrap() else { return };
    let folder = tempfile::tempdir().unwrap();
    let names = write_page(&root(), folder.path()).unwrap();
    assert_eq!(names, FIGURES.iter().map(|figure| figure.name).collect::<Vec<_>>());
    std::fs::create_dir(folder.path().join("figures")).unwrap();
    for figure in std::fs::read_dir(root().join("slides/figures")).unwrap().flatten() {
        std::fs::copy(figure.path(), folder.path().join("figures").join(figure.file_name())).unwrap();
    }
    let page = format!("file://{}", folder.path().join("touch.html").display());
    browser.window(1000, 900, false).unwrap();
    browser.open(&page).unwrap();
    browser.wait_for("!!document.documentElement.dataset.state").unwrap();
    if browser.evaluate("document.getElementById('wasm').textContent").unwrap() == "" {
        return eprintln!("SKIPPED: the target is not installed: rustup target add wasm32-unknown-unknown");
    }

    assert_eq!(browser.evaluate("document.documentElement.dataset.state").unwrap(), "live");

    for figure in FIGURES {
        let name = figure.name;
        let mut states = vec![compare(&mut browser, name)];
        // Move the first handle by keys, the mouse and a finger, and the last input by a key.
        let (handle, input) = (format!("#{name} .handle"), format!("#{name} input"));
        let focus = |element: &str| format!("document.querySelector('{element}')?.focus()");
        let has = |browser: &mut Browser, element: &str| {
            browser.evaluate(&format!("!!document.querySelector('{element}')")).unwrap() == true
        };
        if has(&mut browser, &handle) {
            browser.evaluate(&focus(&handle)).unwrap();
            // The handle keeps the focus when it is drawn again.
            for key in ["ArrowRight", "ArrowDown", "ArrowDown"] {
                browser.press(key).unwrap();
            }
            states.push(compare(&mut browser, name));
            drag(&mut browser, &handle, [31.0, -47.0], false);
            states.push(compare(&mut browser, name));
            drag(&mut browser, &handle, [-12.0, -23.0], true);
            states.push(compare(&mut browser, name));
        }
        if has(&mut browser, &input) {
            browser.evaluate(&focus(&input)).unwrap();
            browser.press("ArrowRight").unwrap();
            states.push(compare(&mut browser, name));
        }
        for pair in states.windows(2) {
            assert_ne!(pair[0], pair[1], "{name}: an event moves no handle");
        }
        // Draw it in more states: all handles moved by other amounts, and each number of each choice.
        for round in 1..=12_u32 {
            let moved = (0..).zip(figure.start).map(|(place, start)| {
                let by = f64::from(round * (2 * place + 3) % 17) - 8.0;
                if name == "live-frame" { start + (by / 3.0).round() } else { start + 0.37 * by }
            });
            let moved: Vec<f64> = moved.collect();
            if touch::html(&*solutions::kit(), name, &moved).is_ok() {
                browser.evaluate(&format!("draw(document.getElementById('{name}'), {moved:?})")).unwrap();
                compare(&mut browser, name);
            }
        }
    }
    assert_eq!(browser.complaints, Vec::<String>::new());

    // Without WebAssembly the still figures are shown.
    let without = json!({ "source": "delete window.WebAssembly" });
    browser.call("Page.addScriptToEvaluateOnNewDocument", without).unwrap();
    browser.open(&page).unwrap();
    browser.wait_for("document.documentElement.dataset.state === 'still'").unwrap();
    let hidden = browser.evaluate("document.querySelectorAll('section > img[hidden], .handle').length");
    assert_eq!(hidden.unwrap(), 0);
    let loaded = browser.evaluate("[...document.images].every(image => image.naturalWidth > 0)");
    assert_eq!(loaded.unwrap(), true);
}
