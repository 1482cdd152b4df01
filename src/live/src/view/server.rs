//! Answers the requests of the page.

use super::http::{Request, answer, head};
use super::reports;
use super::studio::Studio;
use anyhow::{Context, Result};
use serde_json::{Value, json};
use std::io::{self, BufReader, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::mpsc::RecvTimeoutError;
use std::time::Duration;

const PAGE: &str = include_str!("page.html");

/// The most connections at the same time, without the pages that wait for events.
const MOST_CONNECTIONS: usize = 64;

/// The longest time to wait for the rest of a request, or for a page that reads nothing.
const PATIENCE: Duration = Duration::from_secs(10);

/// The time between two signs of life to a page for which nothing happens.
const ALIVE: Duration = Duration::from_secs(10);

/// Answers requests until the program ends.
pub fn serve(listener: &TcpListener, port: u16, token: &str, studio: &Arc<Studio>) {
    let slots = Arc::new(());
    for stream in listener.incoming().flatten() {
        // This clone and the first one are no connections.
        let slot = slots.clone();
        if Arc::strong_count(&slots) > MOST_CONNECTIONS + 1 {
            continue;
        }
        let (studio, token) = (studio.clone(), token.to_owned());
        // A browser may close a connection at any time.
        std::thread::spawn(move || drop(respond(&stream, port, &token, &studio, slot)));
    }
}

fn respond(mut stream: &TcpStream, port: u16, token: &str, studio: &Studio, slot: Arc<()>) -> io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let request = match Request::read(&mut BufReader::new(stream), port, token) {
        Ok(request) => request,
        Err(status) => {
            let help = "The address of the page is in the terminal in which `raykata view` runs.";
            return plain(stream, status, &format!("{status}\n{help}\n"));
        }
    };
    if request.path == "events" {
        // Pages that wait for events have a limit of their own.
        drop(slot);
        return events(stream, studio);
    }
    if request.path.is_empty() {
        return answer(&mut stream, "200 OK", "text/html; charset=utf-8", PAGE.as_bytes());
    }
    if let Some(path) = request.path.strip_prefix("out/") {
        return match reports::file(&studio.root, path) {
            Some((file, kind)) => answer(&mut stream, "200 OK", kind, &std::fs::read(file)?),
            None => plain(stream, NOT_FOUND, NO_PAGE),
        };
    }
    match data(&request, studio) {
        None => plain(stream, NOT_FOUND, NO_PAGE),
        Some(result) => {
            // The page shows the error in place of the data.
            let data = result.unwrap_or_else(|error| json!({ "error": format!("{error:#}") }));
            answer(&mut stream, "200 OK", "application/json", data.to_string().as_bytes())
        }
    }
}

const NOT_FOUND: &str = "404 Not Found";
const NO_PAGE: &str = "there is no such page\n";

fn plain(mut stream: &TcpStream, status: &str, words: &str) -> io::Result<()> {
    answer(&mut stream, status, "text/plain; charset=utf-8", words.as_bytes())
}

/// The data that a request asks for; `None` if there is no such data.
fn data(request: &Request, studio: &Studio) -> Option<Result<Value>> {
    let number = |name: &str| request.number(name).with_context(|| format!("the number `{name}` is missing"));
    Some(match request.path.as_str() {
        "reference" => studio.reference_picture(),
        "difference" => studio.difference(),
        "heat" => studio.heat(),
        "pixel" => number("x").and_then(|x| studio.pixel(x, number("y")?)),
        "level" => number("depth").and_then(|depth| studio.level(depth)),
        "reports" => Ok(studio.reports()),
        "open" => match request.value("scene") {
            Some(name) if studio.open(name) => Ok(json!({})),
            _ => Ok(json!({ "error": "there is no such scene" })),
        },
        _ => return None,
    })
}

/// Sends messages to a page until it is closed or replaced, or takes nothing for 10 s.
fn events(mut stream: &TcpStream, studio: &Studio) -> io::Result<()> {
    let replaced = stream.try_clone()?;
    let (present, later) = studio.subscribe(Box::new(move || drop(replaced.shutdown(Shutdown::Both))));
    stream.write_all(head("200 OK", "text/event-stream", None).as_bytes())?;
    // A page whose connection is lost tries again after this time.
    stream.write_all(b"retry: 500\n\n")?;
    for message in present {
        stream.write_all(message.as_bytes())?;
    }
    loop {
        match later.recv_timeout(ALIVE) {
            Ok(message) => stream.write_all(message.as_bytes())?,
            Err(RecvTimeoutError::Timeout) => stream.write_all(b": nothing new\n\n")?,
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
        }
    }
}
