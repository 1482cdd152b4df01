//! `view` from outside: what its server answers and refuses, its messages, and its page in a browser. A script stands in place of
//! cargo, and this program itself in place of the exercises: it renders one colour, which the first line of the exercise names.

#![cfg(unix)]

mod kit_folder;
mod view_kit;

use browser::Browser;
use kit_folder::{PATIENCE, runs};
use serde_json::Value;
use std::fs;
use std::net::{IpAddr, TcpStream, UdpSocket};
use std::os::unix::fs::PermissionsExt;
use std::time::{Duration, Instant};
use view_kit::{SCENE, View, answer, new_kit, view};

#[test]
fn strangers_are_refused() {
    let (kit, other) = (new_kit(), new_kit());
    let (view, other) = (view(&kit), view(&other));
    let page = format!("/{}/", view.token);
    let (status, body) = view.get(&page);
    assert_eq!(status, 200);
    // The page loads nothing from elsewhere.
    for word in ["http://", "https://", "src=", "@import", "url("] {
        assert!(!body.contains(word), "{word}");
    }
    // Another token, and another host, are forbidden for every path.
    assert_ne!(view.token, other.token);
    for path in ["", "events", "reference", "out/a-cost/cost.html", "nothing"] {
        for token in [&other.token, "", "..", &view.token.to_uppercase()] {
            assert_eq!(view.get(&format!("/{token}/{path}")).0, 403, "{token}/{path}");
        }
        for host in ["evil.example", "127.0.0.1", &format!("evil.example:{}", view.port)] {
            let (status, body) = answer(view.connect("GET", &format!("{page}{path}"), host));
            assert_eq!(status, 403, "{host}: {body}");
        }
    }
    assert_eq!(answer(view.connect("POST", &page, &view.host())).0, 405);
    // Only the machine itself can connect. No packet is sent to find its address.
    let outside = UdpSocket::bind("0.0.0.0:0").and_then(|socket| {
        socket.connect("192.0.2.1:9")?;
        socket.local_addr()
    });
    match outside.map(|address| address.ip()) {
        Ok(IpAddr::V4(address)) if !address.is_loopback() && !address.is_unspecified() => {
            assert!(TcpStream::connect((address, view.port)).is_err(), "reached at {address}");
        }
        _ => println!("this machine has no other address"),
    }
    assert_eq!(view.address, format!("http://127.0.0.1:{}/{}/", view.port, view.token));
    // The token is readable for the user alone.
    let mode = fs::metadata(kit.path("out/.view")).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
}

#[test]
fn no_path_leads_out_of_the_reports() {
    let kit = new_kit();
    let view = view(&kit);
    let at = |path: &str| view.get(&format!("/{}/{path}", view.token));
    assert_eq!(at("out/a-cost/cost.html"), (200, "<title>cost</title>".into()));
    // Paths below out/ have a test in `reports`.
    for path in ["out/../secret.png", "out/a-cost/", "../../../etc/passwd", "secret.png", "scenes/a.toml"] {
        assert_eq!(at(path).0, 404, "{path}");
    }
    assert_eq!(view.data("open?scene=../../etc/passwd")["error"], "there is no such scene");
    assert_eq!(view.data("reports")[0]["files"][0], "cost.html");
}

#[test]
fn readers_that_read_nothing_keep_no_page_from_loading() {
    let kit = new_kit();
    let view = view(&kit);
    let page = format!("/{}/", view.token);
    let open = |_| {
        let reader = view.connect("GET", &format!("{page}events"), &view.host());
        // Wait for its first byte, and leave it unread.
        reader.get_ref().peek(&mut [0]).expect("an answer");
        reader
    };
    let mut readers: Vec<_> = (0..80).map(open).collect();
    assert_eq!(view.get(&page).0, 200);
    // The oldest reader is closed, and the newest gets its messages.
    readers[0].get_ref().set_read_timeout(Some(PATIENCE)).unwrap();
    std::io::Read::read_to_end(&mut readers[0], &mut Vec::new()).expect("an end");
    view.events().wait_for_phase("done");
}

#[test]
fn messages_show_the_picture_from_coarse_to_fine() {
    let kit = new_kit();
    let view = view(&kit);
    let mut events = view.events();
    // Every pass covers the whole picture, in this order.
    let mut passes: Vec<(String, u64)> = Vec::new();
    for (name, data) in events.by_ref() {
        if name == "tile" && data["pass"] != "whole" {
            let pass = data["pass"].as_str().unwrap().to_owned();
            let n_pixels = data["rgb"].as_str().unwrap().len() as u64 / 4;
            let scale = data["scale"].as_u64().unwrap();
            if passes.last().is_none_or(|(last, _)| *last != pass) {
                passes.push((pass, 0));
            }
            passes.last_mut().unwrap().1 += n_pixels * scale * scale;
        } else if name == "status" && data["phase"] == "done" {
            break;
        }
    }
    let finished = passes.last().unwrap();
    assert_eq!((finished.0.as_str(), finished.1), ("all samples", 64 * 40));
    // A page that opens later gets the whole picture at once.
    let whole = view.events().wait_for("tile", |tile| tile["pass"] == "whole");
    assert_eq!(whole["rgb"].as_str().unwrap().len(), 4 * 64 * 40);
    assert!(whole["rgb"].as_str().unwrap().starts_with("AP8AAP8A"), "green");
    // What the page asks for.
    assert_eq!(view.data("reference")["scale"], 2);
    let difference = view.data("difference");
    assert_eq!((&difference["differ"], &difference["total"]), (&640.into(), &640.into()));
    assert_eq!(difference["command"], "cargo run -- tree scenes/a.toml --pixel 1,1");
    let pixel = view.data("pixel?x=3&y=5");
    assert_eq!(pixel["rays"][0]["node_visits"], 3);
    assert_eq!(pixel["rays"][1]["parent"], 0);
    assert_eq!(pixel["rays"][0]["boxes"][0]["lines"].as_array().unwrap().len(), 12);
    assert_eq!(view.data("pixel?x=64&y=5")["error"], "there is no pixel 64,5");
    assert_eq!(view.data("pixel?x=3")["error"], "the number `y` is missing");
    assert_eq!(view.data("level?depth=0")["count"], 1);
    assert_eq!(view.data("level?depth=1")["count"], 0);
    assert_eq!(view.data("heat")["width"], 64);
    // Another scene has no reference.
    view.data("open?scene=b");
    events.wait_for("scene", |scene| scene["name"] == "b" && scene["reference"] == false);
    events.wait_for_phase("done");
    assert_eq!(view.data("difference")["error"], "this scene has no reference");
}

#[test]
fn the_picture_of_a_stage_that_is_done_is_kept() {
    let kit = new_kit();
    let view = view(&kit);
    let mut events = view.events();
    view.data("open?scene=stage1");
    let facts = events.wait_for("facts", |facts| !facts["done"].is_null());
    let lines: Vec<&str> =
        facts["done"]["lines"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
    assert_eq!(facts["done"]["stage"], 1);
    assert_eq!(lines[0], "5 primitives, 0.0 primitive tests per ray: 7 primary rays.");
    assert_eq!(lines[1], "The picture is kept in out/album/stage1.png.");
    assert!(lines[2].starts_with("Next: stage 2 · "), "{lines:?}");
    let picture = image::open(kit.path("out/album/stage1.png")).unwrap().to_rgb8();
    assert_eq!((picture.dimensions(), picture.get_pixel(9, 9).0), ((64, 40), [0, 255, 0]));
}

#[test]
fn each_save_renders_again_and_ends_what_is_stale() {
    let kit = new_kit();
    let view = view(&kit);
    let mut events = view.events();
    events.wait_for_phase("done");
    // Code that never ends is ended by the next save.
    kit.save("// loop");
    let looping = kit.wait_for_file("looping");
    let begin = Instant::now();
    kit.save("// an error");
    let errors = events.wait_for("errors", |data| data["errors"] != Value::Array(Vec::new()));
    assert_eq!(errors["errors"][0]["place"], "exercises/src/stage1_shapes.rs:7:4");
    while runs(&looping) {
        assert!(begin.elapsed() < PATIENCE, "the run before the save is still there");
        std::thread::sleep(Duration::from_millis(20));
    }
    // A panic of the exercises is a message.
    kit.save("// panic!!!");
    let failure = events.wait_for("errors", |data| data["failure"] != "");
    assert!(failure["failure"].as_str().unwrap().contains("on purpose"), "{failure}");
    kit.save("// red");
    events.wait_for_colors("/wAA");
    events.wait_for_phase("done");
    // A scene with a mistake is a message that shows the line.
    kit.write("scenes/a.toml", &SCENE.replace("width", "widht"));
    let failure = events.wait_for("errors", |data| data["failure"] != "");
    assert!(failure["failure"].as_str().unwrap().contains("widht"), "{failure}");
}

#[test]
fn two_pages_follow_one_kit() {
    let kit = new_kit();
    let views = [view(&kit), view(&kit)];
    let mut all = views.each_ref().map(View::events);
    all.iter_mut().for_each(|events| events.wait_for_phase("done"));
    for save in ["// red", "// green!", "// red again"] {
        kit.save(save);
        let color = if save.starts_with("// red") { "/wAA" } else { "AP8A" };
        all.iter_mut().for_each(|events| events.wait_for_colors(color));
    }
}

/// The middle of an element in the window.
fn middle(browser: &mut Browser, id: &str) -> (f64, f64) {
    let place = format!(
        "(() => {{ const r = document.getElementById('{id}').getBoundingClientRect(); return [r.x + r.width / 2, r.y + \
         r.height / 2] }})()"
    );
    let place = browser.evaluate(&place).unwrap();
    (place[0].as_f64().unwrap(), place[1].as_f64().unwrap())
}

#[test]
fn the_page_works_in_a_browser() {
    let Some(mut browser) = Browser::start().unwrap() else { return };
    let kit = new_kit();
    let mut view = view(&kit);
    browser.window(1200, 900, false).unwrap();
    browser.open(&view.address).unwrap();
    // Tiles arrive, and the canvas has their colour.
    browser
        .wait_for("document.body.dataset.phase === 'done' && Number(document.body.dataset.tiles) > 0")
        .unwrap();
    let color = "String(colorAt(document.getElementById('yours'), [63, 39]))";
    browser.wait_for(&format!("{color} === '0,255,0'")).unwrap();
    browser.wait_for("String(colorAt(document.getElementById('theirs'), [63, 39])) === '0,0,255'").unwrap();
    assert!(
        browser.evaluate("document.getElementById('notes').textContent").unwrap()
            == "a note about the picture"
    );

    // The slider uncovers the reference.
    let clip = "document.getElementById('theirs').style.clipPath";
    browser.wait_for(&format!("{clip} === 'inset(0px 0px 0px 50%)'")).unwrap();
    browser.evaluate("document.getElementById('mix').focus()").unwrap();
    browser.press("ArrowRight").unwrap();
    browser.wait_for(&format!("{clip} === 'inset(0px 0px 0px 51%)'")).unwrap();

    // A click shows the rays of that pixel, and text of the kit stays text.
    let (x, y) = middle(&mut browser, "pane");
    // The middle lies between two pixels; click a little to the right and below.
    browser.click(x + 3.0, y + 3.0).unwrap();
    browser.wait_for("document.querySelectorAll('#rays button').length === 2").unwrap();
    let title = browser.evaluate("document.getElementById('pixel-title').textContent").unwrap();
    assert_eq!(title, "Rays of pixel 32, 20");
    let text = browser.evaluate("document.getElementById('rays').textContent").unwrap();
    assert!(
        text.as_str().unwrap().contains("gold <i>") && text.as_str().unwrap().contains("3 node visits"),
        "{text}"
    );
    let drawn = "document.getElementById('overlay').getContext('2d').getImageData(0, 0, 4096, 4096).data.some(x => x > 0)";
    browser.wait_for(drawn).unwrap();
    // The keyboard does the same.
    browser.evaluate("document.getElementById('stage').focus()").unwrap();
    browser.press("ArrowLeft").unwrap();
    browser.press("Enter").unwrap();
    browser
        .wait_for("document.getElementById('pixel-title').textContent === 'Rays of pixel 31, 20'")
        .unwrap();
    browser.wait_for("document.querySelectorAll('#rays button').length === 2").unwrap();

    // Difference, node visits, zoom, and the boxes of a level.
    for (button, summary) in [
        ("[data-mode=difference]", "640 of 640 pixels differ"),
        ("[data-mode=heat]", "primitive tests per pixel"),
        ("#level", "1 line segment."),
    ] {
        browser.evaluate(&format!("document.querySelector('{button}').click()")).unwrap();
        let shown = format!("document.getElementById('summary').textContent.includes('{summary}')");
        browser.wait_for(&shown).unwrap();
    }
    browser.evaluate("document.getElementById('in').click()").unwrap();

    // A picture without new tiles asks about an infinite loop. The timer does not wait here.
    let stall = "{ const late = setTimeout; window.setTimeout = work => late(work, 0); \
                 status({ phase: 'rendering', words: 'rendering' }); window.setTimeout = late }";
    browser.evaluate(stall).unwrap();
    browser.wait_for("document.getElementById('words').textContent.includes('infinite loop')").unwrap();

    // An error of the compiler is shown, also when the page is opened again.
    kit.save("// an error");
    let message = "!document.getElementById('errors').hidden && document.getElementById('errors').textContent.includes('expected one \
                   of `;` or `}`, found `<b>`')";
    browser.wait_for(message).unwrap();
    browser.open(&view.address).unwrap();
    browser.wait_for(message).unwrap();
    kit.save("// red");
    browser.wait_for(&format!("document.getElementById('errors').hidden && {color} === '255,0,0'")).unwrap();

    // The page finds the server again after a restart.
    let address = view.address.clone();
    drop(view);
    browser.wait_for("document.body.dataset.phase === 'lost'").unwrap();
    kit.save("// green again");
    view = view_kit::view(&kit);
    assert_eq!(view.address, address);
    browser.wait_for(&format!("document.body.dataset.connected === 'yes' && {color} === '0,255,0'")).unwrap();
    let uncaught: Vec<&String> = browser
        .complaints
        .iter()
        .filter(|one| !one.contains("ERR_") && !one.contains("Failed to load"))
        .collect();
    assert!(uncaught.is_empty(), "{uncaught:?}");
}
