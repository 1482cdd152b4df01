//! `view` from outside: what its server answers and refuses, its messages, and its page in a browser. A script stands in place of
//! cargo, and this program itself in place of the exercises: it renders one colour, which the first line of the exercise names.

#![cfg(unix)]

use browser::Browser;
use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::count::{Counts, Uncounted};
use raykata::frame::{CameraSample, FrameSettings, Watch};
use raykata::kit::{
    Answer, RayKind, RayVisits, RenderJob, Rendering, Request, TestedBox, TracedRay, WeightedColor,
};
use raykata::worker::serve_with;
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{IpAddr, TcpStream, UdpSocket};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// The longest time that anything may take on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// The script in place of cargo.
const CARGO: &str = r#"#!/bin/sh
case "$(head -n 1 exercises/src/stage1_shapes.rs)" in
    *error*) cat error.json; exit 101 ;;
esac
"#;

const ERROR: &str = r#"{"reason":"compiler-message","message":{"level":"error","message":"expected one of `;` or `}`, found `<b>`","spans":[{"is_primary":true,"file_name":"exercises/src/stage1_shapes.rs","line_start":7,"column_start":4,"label":"expected `;`","text":[{"text":"let x = <b>1</b>"}]}],"children":[]}}"#;

const SCENE: &str = r#"
[film]
width = 64
height = 40
[camera]
position = [0, 0, 5]
look_at = [0, 0, 0]
vertical_fov = 40
[quality]
samples_per_pixel = 4
"#;

/// This program in place of the exercises. Started as a test, it does nothing.
#[test]
fn the_worker() {
    let Some(root) = std::env::var_os("VIEW_TEST_ROOT").map(PathBuf::from) else { return };
    let first = fs::read_to_string(root.join("exercises/src/stage1_shapes.rs")).unwrap_or_default();
    if first.starts_with("// loop") {
        fs::write(root.join("looping"), format!("{}\n", std::process::id())).unwrap();
    }
    serve_with(&|request, watch| match request {
        Request::Render(job) | Request::RenderInTiles(job) => {
            if first.starts_with("// loop") {
                loop {
                    std::thread::sleep(Duration::from_secs(1));
                }
            }
            assert!(!first.starts_with("// panic"), "on purpose");
            let color = if first.starts_with("// red") { Vec3::X } else { Vec3::Y };
            Answer::Render(one_color(job, color, watch).map(Box::new))
        }
        Request::Trace(..) => Answer::Trace(vec![ray(RayKind::Primary, None), ray(RayKind::Shadow, Some(0))]),
        Request::Visits(..) => Answer::Visits(vec![visits(3), visits(1)]),
        Request::Outlines(_, depth) => {
            let edge = [Vec3::new(-1.0, 0.0, 0.0), Vec3::X];
            Answer::Outlines(if *depth == 0 { vec![edge] } else { Vec::new() })
        }
        _ => panic!("not asked by the page"),
    });
}

fn one_color(job: &RenderJob, color: Vec3, watch: &dyn Watch) -> Option<Rendering> {
    let settings = FrameSettings {
        width: job.scene.film.width,
        height: job.scene.film.height,
        samples_per_pixel: job.scene.quality.samples_per_pixel,
        sampler: job.scene.quality.sampler,
        lens: false,
        motion: false,
        on_the_way: false,
        threads: 1,
        seed: 0,
    };
    let radiance = |_: &CameraSample, _: &mut Uncounted| WeightedColor { color, weight: 1.0 };
    let (film, _) = raykata::frame::render(&settings, watch, radiance, |samples| samples[0].color)?;
    Some(Rendering {
        film,
        counts: Counts { primary: 7, node_visits: 21, ..Counts::default() },
        primitives: 5,
        structure: None,
        accelerator: None,
        bytes_of_parts: 0,
        build_seconds: 0.0,
        render_seconds: 0.0,
        notes: vec!["a note about the picture".into()],
    })
}

fn ray(kind: RayKind, parent: Option<usize>) -> TracedRay {
    let hit = Some((5.0, "gold <i>".into()));
    let (origin, direction) = (Vec3::new(0.0, 0.0, 5.0), Vec3::new(0.1, 0.05, -1.0));
    TracedRay { kind, parent, depth: 0, weight: Vec3::ONE, origin, direction, hit }
}

fn visits(n: u64) -> RayVisits {
    let boxes = vec![TestedBox { bounds: Aabb::new(-Vec3::ONE, Vec3::ONE), hit: true }];
    RayVisits { node_visits: n, box_tests: 1, primitive_tests: 2, boxes }
}

/// A kit in a temporary folder.
struct Kit(tempfile::TempDir);

impl Kit {
    fn new() -> Kit {
        let kit = Kit(tempfile::tempdir().unwrap());
        for folder in ["exercises/src", "target/debug", "scenes/reference", "out/a-cost"] {
            fs::create_dir_all(kit.path(folder)).unwrap();
        }
        kit.write("error.json", ERROR);
        kit.write("scenes/a.toml", SCENE);
        kit.write("scenes/b.toml", SCENE);
        kit.write("out/a-cost/cost.html", "<title>cost</title>");
        kit.write("secret.png", "not for the page");
        kit.script("cargo", CARGO);
        let this = std::env::current_exe().unwrap();
        let worker = format!(
            "#!/bin/sh\nVIEW_TEST_ROOT='{}' exec '{}' --exact the_worker --nocapture\n",
            kit.0.path().display(),
            this.display()
        );
        kit.script("target/debug/exercises-frames", &worker);
        fs::copy(env!("CARGO_BIN_EXE_view"), kit.path("target/debug/view")).unwrap();
        // The reference is blue, at half the size.
        let blue = image::RgbImage::from_pixel(32, 20, image::Rgb([0, 0, 255]));
        blue.save(kit.path("scenes/reference/a.png")).unwrap();
        kit.save("// green");
        kit
    }

    fn path(&self, path: &str) -> PathBuf {
        self.0.path().join(path)
    }

    fn write(&self, path: &str, text: &str) {
        fs::write(self.path(path), text).unwrap();
    }

    fn script(&self, path: &str, text: &str) {
        self.write(path, text);
        fs::set_permissions(self.path(path), fs::Permissions::from_mode(0o755)).unwrap();
    }

    /// Writes the exercise. The lengths differ, so that the change is seen where times are coarse.
    fn save(&self, first: &str) {
        self.write("exercises/src/stage1_shapes.rs", &format!("{first}\n"));
    }

    fn view(&self) -> View {
        let mut command = Command::new(self.path("target/debug/view"));
        command.arg(self.0.path()).arg(self.path("scenes/a.toml")).env("CARGO", self.path("cargo"));
        let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let address = line.trim().rsplit(' ').next().unwrap().to_owned();
        let rest = address.strip_prefix("http://127.0.0.1:").unwrap_or_else(|| panic!("{line}"));
        let (port, token) = rest.split_once('/').unwrap();
        let (port, token) = (port.parse().unwrap(), token.trim_end_matches('/').to_owned());
        View { child, address, port, token }
    }
}

/// A running `view`.
struct View {
    child: Child,
    address: String,
    port: u16,
    token: String,
}

impl Drop for View {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl View {
    fn host(&self) -> String {
        format!("127.0.0.1:{}", self.port)
    }

    fn connect(&self, method: &str, path: &str, host: &str) -> BufReader<TcpStream> {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        write!(stream, "{method} {path} HTTP/1.1\r\nHost: {host}\r\n\r\n").unwrap();
        BufReader::new(stream)
    }

    /// The status and the body of an answer.
    fn get(&self, path: &str) -> (u16, String) {
        answer(self.connect("GET", path, &self.host()))
    }

    /// The data of an answer.
    fn data(&self, what: &str) -> Value {
        let (status, body) = self.get(&format!("/{}/{what}", self.token));
        assert_eq!(status, 200, "{what}: {body}");
        serde_json::from_str(&body).unwrap()
    }

    /// The messages, from the present state on.
    fn events(&self) -> Events {
        let mut stream = self.connect("GET", &format!("/{}/events", self.token), &self.host());
        let mut head = String::new();
        while !head.ends_with("\r\n\r\n") {
            assert!(stream.read_line(&mut head).unwrap() > 0);
        }
        assert!(head.starts_with("HTTP/1.1 200") && head.contains("text/event-stream"), "{head}");
        Events(stream, Instant::now())
    }
}

fn answer(mut stream: BufReader<TcpStream>) -> (u16, String) {
    let mut bytes = Vec::new();
    // A refused request may be cut off with a reset, after its answer.
    let _ = stream.read_to_end(&mut bytes);
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let (head, body) = text.split_once("\r\n\r\n").unwrap_or((&text, ""));
    (head.split(' ').nth(1).and_then(|code| code.parse().ok()).unwrap_or(0), body.to_owned())
}

/// Messages of the server, each of which must be well formed.
struct Events(BufReader<TcpStream>, Instant);

impl Iterator for Events {
    type Item = (String, Value);

    fn next(&mut self) -> Option<(String, Value)> {
        let mut name = String::new();
        loop {
            let mut line = String::new();
            self.0.read_line(&mut line).ok().filter(|&n| n > 0)?;
            assert!(self.1.elapsed() < 5 * PATIENCE, "the message does not come");
            let line = line.strip_suffix('\n').expect("a whole line");
            if let Some(event) = line.strip_prefix("event: ") {
                name = event.to_owned();
            } else if let Some(data) = line.strip_prefix("data: ") {
                let data = serde_json::from_str(data).expect("JSON in one line");
                let mut end = String::new();
                self.0.read_line(&mut end).ok()?;
                assert_eq!(end, "\n", "a message ends with an empty line");
                return Some((name, data));
            } else {
                assert!(line.is_empty() || line.starts_with(':') || line.starts_with("retry: "), "{line}");
            }
        }
    }
}

impl Events {
    /// Skips messages up to one of this name that fulfils a condition.
    fn wait_for(&mut self, name: &str, is_wanted: impl Fn(&Value) -> bool) -> Value {
        let begin = Instant::now();
        let found = self.find(|(event, data)| {
            assert!(begin.elapsed() < PATIENCE, "no `{name}`");
            event == name && is_wanted(data)
        });
        found.unwrap_or_else(|| panic!("no `{name}`")).1
    }

    fn wait_for_phase(&mut self, phase: &str) {
        self.wait_for("status", |status| status["phase"] == phase);
    }
}

#[test]
fn strangers_are_refused() {
    let (kit, other) = (Kit::new(), Kit::new());
    let (view, other) = (kit.view(), other.view());
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
    // The token is readable for the user alone.
    let mode = fs::metadata(kit.path("out/.view")).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
}

#[test]
fn no_path_leads_out_of_the_reports() {
    let kit = Kit::new();
    let view = kit.view();
    let at = |path: &str| view.get(&format!("/{}/{path}", view.token));
    assert_eq!(at("out/a-cost/cost.html"), (200, "<title>cost</title>".into()));
    for path in [
        "out/../secret.png",
        "out/a-cost/../../secret.png",
        "out/a-cost/..%2f..%2fsecret.png",
        "out//etc/passwd",
        "out/.view",
        "out/a-cost/",
        "../../../etc/passwd",
        "secret.png",
        "scenes/a.toml",
    ] {
        assert_eq!(at(path).0, 404, "{path}");
    }
    assert_eq!(view.data("open?scene=../../etc/passwd")["error"], "there is no such scene");
    assert_eq!(view.data("reports")[0]["files"][0], "cost.html");
}

#[test]
fn messages_show_the_picture_from_coarse_to_fine() {
    let kit = Kit::new();
    let view = kit.view();
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
fn each_save_renders_again_and_ends_what_is_stale() {
    let kit = Kit::new();
    let view = kit.view();
    let mut events = view.events();
    events.wait_for_phase("done");
    // Code that never ends is ended by the next save.
    kit.save("// loop");
    let begin = Instant::now();
    let looping = loop {
        match fs::read_to_string(kit.path("looping")) {
            Ok(text) if text.ends_with('\n') => break text.trim().parse().unwrap(),
            _ => assert!(begin.elapsed() < PATIENCE, "no endless loop"),
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    kit.save("// an error");
    let errors = events.wait_for("errors", |data| data["errors"] != Value::Array(Vec::new()));
    assert_eq!(errors["errors"][0]["place"], "exercises/src/stage1_shapes.rs:7:4");
    while runs(looping) {
        assert!(begin.elapsed() < PATIENCE, "the run before the save is still there");
        std::thread::sleep(Duration::from_millis(20));
    }
    // A panic of the exercises is a message.
    kit.save("// panic!!!");
    let failure = events.wait_for("errors", |data| data["failure"] != "");
    assert!(failure["failure"].as_str().unwrap().contains("on purpose"), "{failure}");
    kit.save("// red");
    events.wait_for("tile", |tile| {
        tile["pass"] == "all samples" && tile["rgb"].as_str().unwrap().starts_with("/wAA")
    });
    events.wait_for_phase("done");
    // A scene with a mistake is a message that shows the line.
    kit.write("scenes/a.toml", &SCENE.replace("width", "widht"));
    let failure = events.wait_for("errors", |data| data["failure"] != "");
    assert!(failure["failure"].as_str().unwrap().contains("widht"), "{failure}");
}

/// Whether a process runs.
fn runs(id: i32) -> bool {
    nix::sys::signal::kill(nix::unistd::Pid::from_raw(id), None).is_ok()
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
    let kit = Kit::new();
    let mut view = kit.view();
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
    browser.evaluate("document.querySelector('[data-mode=difference]').click()").unwrap();
    browser
        .wait_for("document.getElementById('summary').textContent.includes('640 of 640 pixels differ')")
        .unwrap();
    browser.evaluate("document.querySelector('[data-mode=heat]').click()").unwrap();
    browser
        .wait_for("document.getElementById('summary').textContent.includes('primitive tests per pixel')")
        .unwrap();
    browser.evaluate("document.getElementById('level').click()").unwrap();
    browser.wait_for("document.getElementById('summary').textContent.includes('1 line segments')").unwrap();
    browser.evaluate("document.getElementById('in').click()").unwrap();

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
    view = kit.view();
    assert_eq!(view.address, address);
    browser.wait_for(&format!("document.body.dataset.connected === 'yes' && {color} === '0,255,0'")).unwrap();
    let uncaught: Vec<&String> = browser
        .complaints
        .iter()
        .filter(|one| !one.contains("ERR_") && !one.contains("Failed to load"))
        .collect();
    assert!(uncaught.is_empty(), "{uncaught:?}");
}

#[test]
fn the_address_is_one_that_a_terminal_can_open() {
    let kit = Kit::new();
    let view = kit.view();
    assert_eq!(view.address, format!("http://127.0.0.1:{}/{}/", view.port, view.token));
    assert!(Path::new(&kit.path("out/.view")).is_file());
}
