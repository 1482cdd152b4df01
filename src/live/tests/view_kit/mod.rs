//! A kit whose exercises are this program itself, which renders one colour, and a running `view` that shows it.

use crate::kit_folder::{KitFolder, PATIENCE, Running};
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
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// The script in place of cargo.
const CARGO: &str = r#"#!/bin/sh
case "$(head -n 1 exercises/src/stage1_shapes.rs)" in
    *error*) cat error.json; exit 101 ;;
esac
echo '{"reason":"compiler-artifact","target":{"name":"exercises-frames"},"executable":"'"$PWD"'/target/debug/exercises-frames"}'
echo '{"reason":"compiler-artifact","target":{"name":"judge"},"executable":"'"$PWD"'/target/debug/judge"}'
"#;

const ERROR: &str = r#"{"reason":"compiler-message","message":{"level":"error","message":"expected one of `;` or `}`, found `<b>`","spans":[{"is_primary":true,"file_name":"exercises/src/stage1_shapes.rs","line_start":7,"column_start":4,"label":"expected `;`","text":[{"text":"let x = <b>1</b>"}]}],"children":[]}}"#;

pub const SCENE: &str = r#"
film = { width = 64, height = 40 }
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
        Request::Visits(..) => Answer::Visits(vec![
            (ray(RayKind::Primary, None), visits(3)),
            (ray(RayKind::Shadow, Some(0)), visits(1)),
        ]),
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
        rows: job.scene.film.rendered_rows(),
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
        processor_seconds: None,
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
pub fn new_kit() -> KitFolder {
    let kit = KitFolder::with(&["exercises/src", "target/debug", "scenes/reference", "out/a-cost"]);
    kit.write("error.json", ERROR);
    kit.write("scenes/a.toml", SCENE);
    kit.write("scenes/b.toml", SCENE);
    kit.write("scenes/stage1.toml", SCENE);
    kit.verdicts("verdicts", None);
    kit.script("target/debug/judge", "#!/bin/sh\ncat \"$2/verdicts\"\n");
    kit.write("out/a-cost/cost.html", "<title>cost</title>");
    kit.write("secret.png", "not for the page");
    kit.script("cargo", CARGO);
    let this = std::env::current_exe().unwrap();
    let worker = format!(
        "#!/bin/sh\nVIEW_TEST_ROOT='{}' exec '{}' --exact view_kit::the_worker --nocapture\n",
        kit.root().display(),
        this.display()
    );
    kit.script("target/debug/exercises-frames", &worker);
    kit.program("target/debug/view", Path::new(env!("CARGO_BIN_EXE_view")));
    // The reference is blue, at half the size.
    let blue = image::RgbImage::from_pixel(32, 20, image::Rgb([0, 0, 255]));
    blue.save(kit.path("scenes/reference/a.png")).unwrap();
    kit.save("// green");
    kit
}

/// Starts `view` for a kit.
pub fn view(kit: &KitFolder) -> View {
    let mut command = Command::new(kit.path("target/debug/view"));
    command.arg(kit.root()).arg(kit.path("scenes/a.toml")).env("CARGO", kit.path("cargo"));
    let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn().unwrap();
    let mut line = String::new();
    BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
    let address = line.trim().rsplit(' ').next().unwrap().to_owned();
    let rest = address.strip_prefix("http://127.0.0.1:").unwrap_or_else(|| panic!("{line}"));
    let (port, token) = rest.split_once('/').unwrap();
    let (port, token) = (port.parse().unwrap(), token.trim_end_matches('/').to_owned());
    View { _running: Running(child), address, port, token }
}

/// A running `view`.
pub struct View {
    _running: Running,
    pub address: String,
    pub port: u16,
    pub token: String,
}

impl View {
    pub fn host(&self) -> String {
        format!("127.0.0.1:{}", self.port)
    }

    pub fn connect(&self, method: &str, path: &str, host: &str) -> BufReader<TcpStream> {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        write!(stream, "{method} {path} HTTP/1.1\r\nHost: {host}\r\n\r\n").unwrap();
        BufReader::new(stream)
    }

    /// The status and the body of an answer.
    pub fn get(&self, path: &str) -> (u16, String) {
        answer(self.connect("GET", path, &self.host()))
    }

    /// The data of an answer.
    pub fn data(&self, what: &str) -> Value {
        let (status, body) = self.get(&format!("/{}/{what}", self.token));
        assert_eq!(status, 200, "{what}: {body}");
        serde_json::from_str(&body).unwrap()
    }

    /// The messages, from the present state on.
    pub fn events(&self) -> Events {
        let mut stream = self.connect("GET", &format!("/{}/events", self.token), &self.host());
        let mut head = String::new();
        while !head.ends_with("\r\n\r\n") {
            assert!(stream.read_line(&mut head).unwrap() > 0);
        }
        assert!(head.starts_with("HTTP/1.1 200") && head.contains("text/event-stream"), "{head}");
        Events(stream, Instant::now())
    }
}

pub fn answer(mut stream: BufReader<TcpStream>) -> (u16, String) {
    let mut bytes = Vec::new();
    // A refused request may be cut off with a reset, after its answer.
    let _ = stream.read_to_end(&mut bytes);
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let (head, body) = text.split_once("\r\n\r\n").unwrap_or((&text, ""));
    (head.split(' ').nth(1).and_then(|code| code.parse().ok()).unwrap_or(0), body.to_owned())
}

/// Messages of the server, each of which must be well formed.
pub struct Events(BufReader<TcpStream>, Instant);

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
    pub fn wait_for(&mut self, name: &str, is_wanted: impl Fn(&Value) -> bool) -> Value {
        let begin = Instant::now();
        let found = self.find(|(event, data)| {
            assert!(begin.elapsed() < PATIENCE, "no `{name}`");
            event == name && is_wanted(data)
        });
        found.unwrap_or_else(|| panic!("no `{name}`")).1
    }

    /// Waits for a part of the finished picture whose first pixels have these colours, in base64.
    pub fn wait_for_colors(&mut self, rgb: &str) {
        self.wait_for("tile", |tile| {
            tile["pass"] == "all samples" && tile["rgb"].as_str().unwrap().starts_with(rgb)
        });
    }

    pub fn wait_for_phase(&mut self, phase: &str) {
        self.wait_for("status", |status| status["phase"] == phase);
    }
}
