//! Drives a headless Chromium, for tests of pages and slides. Messages of the DevTools protocol are JSON, ended by a zero byte,
//! and go through a pipe, so no port is open and no package is needed. The browser is Chromium, Chrome or Edge, whose path is in
//! `CHROME_PATH` or which is found by its usual names.

use anyhow::{Context, Result, anyhow, bail};
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// The longest time that a browser on a busy machine may need for an answer.
const PATIENCE: Duration = Duration::from_secs(120);

/// The usual names of browsers.
const NAMES: [&str; 6] = [
    "chromium",
    "chromium-browser",
    "chromium-headless-shell",
    "google-chrome",
    "google-chrome-stable",
    "microsoft-edge",
];

/// The path of a browser; `None` if there is none.
#[must_use]
pub fn path() -> Option<PathBuf> {
    if let Some(path) = std::env::var_os("CHROME_PATH") {
        return Some(path.into());
    }
    let folders = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&folders)
        .flat_map(|folder| NAMES.map(|name| folder.join(name)))
        .find(|path| path.is_file())
}

/// Says why a test is skipped. The harness hides what a test prints, but not what is written to standard error directly.
fn skipped<T>(why: &str) -> Option<T> {
    let _ = writeln!(std::io::stderr(), "SKIPPED: {why}");
    None
}

/// A browser with one page. It ends when it is dropped.
pub struct Browser {
    child: Child,
    to_browser: Box<dyn Write + Send>,
    messages: Receiver<Value>,
    session: String,
    number: u64,
    /// What the page has written to its console, and its uncaught errors.
    pub complaints: Vec<String>,
    /// The folder for the profile of the browser.
    _profile: TempDir,
}

impl Browser {
    /// Starts a browser, or says why that is not possible. A test that gets `None` is skipped, and its output says so.
    ///
    /// # Errors
    ///
    /// If there is a browser, and it does not start.
    pub fn start() -> Result<Option<Browser>> {
        let Some(path) = path() else {
            let install = "install Chromium (Debian: apt-get install chromium) or set CHROME_PATH";
            return Ok(skipped(&format!("no browser was found: {install}")));
        };
        if cfg!(not(unix)) {
            return Ok(skipped("the browser is driven through a pipe of Unix"));
        }
        // The browser reads messages from file 3 and writes its own to file 4. The shell connects them with our pipes.
        let profile = tempfile::tempdir().context("a folder for the profile")?;
        let mut command = Command::new("sh");
        command.args(["-c", "exec \"$0\" \"$@\" 3<&0 4>&1 1>&2"]).arg(path).args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
            "--disable-dev-shm-usage",
            "--hide-scrollbars",
            "--remote-debugging-pipe",
        ]);
        command.arg(format!("--user-data-dir={}", profile.path().display())).arg("about:blank");
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut child = command.spawn().context("the browser cannot be started")?;
        let to_browser = child.stdin.take().context("no pipe to the browser")?;
        let from_browser = child.stdout.take().context("no pipe from the browser")?;
        let (sender, messages) = channel();
        std::thread::spawn(move || {
            for message in BufReader::new(from_browser).split(0).map_while(std::result::Result::ok) {
                let message = serde_json::from_slice(&message).unwrap_or(Value::Null);
                if sender.send(message).is_err() {
                    return;
                }
            }
        });
        let mut browser = Browser {
            child,
            to_browser: Box::new(to_browser),
            messages,
            session: String::new(),
            number: 0,
            complaints: Vec::new(),
            _profile: profile,
        };
        // Open a page, and let its messages come through the same pipe.
        let target = browser.call("Target.createTarget", json!({ "url": "about:blank" }))?;
        let target = json!({ "targetId": target["targetId"], "flatten": true });
        let session = browser.call("Target.attachToTarget", target)?;
        browser.session = session["sessionId"].as_str().context("the browser opens no page")?.to_owned();
        for domain in ["Page", "Runtime", "Log"] {
            browser.call(&format!("{domain}.enable"), json!({}))?;
        }
        Ok(Some(browser))
    }

    /// Calls a method of the DevTools protocol, and returns its result.
    ///
    /// # Errors
    ///
    /// If the method fails, or if the browser does not answer.
    #[expect(clippy::needless_pass_by_value, reason = "callers write the parameters in place")]
    pub fn call(&mut self, method: &str, parameters: Value) -> Result<Value> {
        self.number += 1;
        let mut message = json!({ "id": self.number, "method": method, "params": parameters });
        if !self.session.is_empty() {
            message["sessionId"] = json!(self.session);
        }
        write!(self.to_browser, "{message}\0").context("the browser has ended")?;
        self.to_browser.flush().context("the browser has ended")?;
        loop {
            let reply = self.messages.recv_timeout(PATIENCE);
            let reply = reply.map_err(|_| anyhow!("the browser does not answer to {method}"))?;
            self.note(&reply);
            if reply["id"] != self.number {
                continue;
            }
            if let Some(error) = reply.get("error") {
                bail!("{method}: {error}");
            }
            return Ok(reply["result"].clone());
        }
    }

    /// Keeps errors of the page.
    fn note(&mut self, message: &Value) {
        let parameters = &message["params"];
        let complaint = match message["method"].as_str() {
            Some("Runtime.exceptionThrown") => &parameters["exceptionDetails"]["exception"]["description"],
            Some("Log.entryAdded") if parameters["entry"]["level"] == "error" => &parameters["entry"]["text"],
            _ => return,
        };
        self.complaints.push(complaint.to_string());
    }

    /// Sets the size of the window, and whether the page is dark.
    ///
    /// # Errors
    ///
    /// If the browser does not answer.
    pub fn window(&mut self, width: u32, height: u32, dark: bool) -> Result<()> {
        let size = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        self.call("Emulation.setDeviceMetricsOverride", size)?;
        let scheme = json!({ "name": "prefers-color-scheme", "value": if dark { "dark" } else { "light" } });
        self.call("Emulation.setEmulatedMedia", json!({ "features": [scheme] })).map(|_| ())
    }

    /// Opens an address and waits until the page is loaded.
    ///
    /// # Errors
    ///
    /// If the address cannot be opened.
    pub fn open(&mut self, address: &str) -> Result<()> {
        // Mark the old page, so that it is not mistaken for the new one.
        self.evaluate("window.isOld = true")?;
        let opened = self.call("Page.navigate", json!({ "url": address }))?;
        if let Some(error) = opened.get("errorText") {
            bail!("{address}: {error}");
        }
        let begin = Instant::now();
        while begin.elapsed() < PATIENCE {
            // An expression fails while one page replaces the other.
            let loaded = self.evaluate("!window.isOld && document.readyState === 'complete'");
            if loaded.is_ok_and(|loaded| loaded == true) {
                return Ok(());
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        bail!("{address} is not loaded")
    }

    /// The value of an expression in the page; a promise is awaited.
    ///
    /// # Errors
    ///
    /// If the expression throws.
    pub fn evaluate(&mut self, expression: &str) -> Result<Value> {
        let parameters = json!({ "expression": expression, "awaitPromise": true, "returnByValue": true });
        let result = self.call("Runtime.evaluate", parameters)?;
        match result.get("exceptionDetails") {
            Some(error) => bail!("{expression}: {}", error["exception"]["description"]),
            None => Ok(result["result"]["value"].clone()),
        }
    }

    /// Waits until an expression in the page is true.
    ///
    /// # Errors
    ///
    /// If it does not become true.
    pub fn wait_for(&mut self, expression: &str) -> Result<()> {
        let begin = Instant::now();
        while begin.elapsed() < PATIENCE {
            if self.evaluate(expression)? == true {
                return Ok(());
            }
            std::thread::sleep(Duration::from_millis(50));
        }
        bail!("this does not become true: {expression}; the page says: {:?}", self.complaints)
    }

    /// Clicks at this place of the window, as a user does.
    ///
    /// # Errors
    ///
    /// If the browser does not answer.
    pub fn click(&mut self, x: f64, y: f64) -> Result<()> {
        for kind in ["mousePressed", "mouseReleased"] {
            let event = json!({ "type": kind, "x": x, "y": y, "button": "left", "clickCount": 1 });
            self.call("Input.dispatchMouseEvent", event)?;
        }
        Ok(())
    }

    /// Presses a key, such as `Enter` or `ArrowLeft`.
    ///
    /// # Errors
    ///
    /// If the browser does not answer.
    pub fn press(&mut self, key: &str) -> Result<()> {
        let code = match key {
            "Enter" => 13,
            "ArrowLeft" => 37,
            "ArrowUp" => 38,
            "ArrowRight" => 39,
            "ArrowDown" => 40,
            _ => 0,
        };
        for kind in ["rawKeyDown", "keyUp"] {
            let event = json!({ "type": kind, "key": key, "code": key, "windowsVirtualKeyCode": code });
            self.call("Input.dispatchKeyEvent", event)?;
        }
        Ok(())
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // The browser ends its own processes; then wait, so that its profile can be removed.
        self.session.clear();
        let _ = self.call("Browser.close", json!({}));
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
