//! Requests and answers of HTTP/1.1, as far as the page needs them.
//!
//! A browser sends requests of any web site to this machine. So a request is answered only if its path begins with the token,
//! and if its `Host` is this address: a name that an attacker points to 127.0.0.1 (DNS rebinding) is refused.

use std::io::{self, BufRead, Read, Write};

/// The longest head of a request, in bytes.
const LONGEST_HEAD: u64 = 16 << 10;

/// A request that may be answered: its path after the token, and its query.
#[derive(Debug, PartialEq)]
pub struct Request {
    /// The path without the token and the slash after it.
    pub path: String,
    query: String,
}

/// The reason why a request is refused, as a status line of HTTP.
pub type Refusal = &'static str;

const FORBIDDEN: Refusal = "403 Forbidden";
const BAD: Refusal = "400 Bad Request";

impl Request {
    /// Reads the head of a request.
    /// The error is the status of the answer to a request that must be refused.
    pub fn read(from: &mut impl BufRead, port: u16, token: &str) -> Result<Request, Refusal> {
        // Read the head, up to the empty line.
        let mut head = from.take(LONGEST_HEAD);
        let mut line = || {
            let mut line = Vec::new();
            head.read_until(b'\n', &mut line).map_err(|_| BAD)?;
            let line = String::from_utf8(line).map_err(|_| BAD)?;
            // Without an end the head was cut off or is too long.
            line.strip_suffix('\n').map(|line| line.trim_end_matches('\r').to_owned()).ok_or(BAD)
        };
        let first = line()?;
        let mut hosts = Vec::new();
        loop {
            let header = line()?;
            if header.is_empty() {
                break;
            }
            let (name, value) = header.split_once(':').ok_or(BAD)?;
            if name.eq_ignore_ascii_case("host") {
                hosts.push(value.trim().to_owned());
            }
        }
        // Refuse other hosts and other tokens.
        let [method, target, version] = first.split(' ').collect::<Vec<_>>()[..] else { return Err(BAD) };
        let own = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
        if !matches!(&hosts[..], [host] if own.contains(host)) {
            return Err(FORBIDDEN);
        }
        let (path, query) = target.split_once('?').unwrap_or((target, ""));
        let rest = path.strip_prefix('/').ok_or(BAD)?;
        let (given, path) = rest.split_once('/').unwrap_or((rest, ""));
        if !is_same(given, token) {
            return Err(FORBIDDEN);
        }
        if !version.starts_with("HTTP/1.") {
            return Err(BAD);
        }
        if method != "GET" {
            return Err("405 Method Not Allowed");
        }
        Ok(Request { path: path.to_owned(), query: query.to_owned() })
    }

    /// A value of the query. Values are numbers and names without escapes.
    pub fn value(&self, name: &str) -> Option<&str> {
        let mut pairs = self.query.split('&').filter_map(|pair| pair.split_once('='));
        pairs.find(|(key, _)| *key == name).map(|(_, value)| value)
    }

    /// A number of the query.
    pub fn number(&self, name: &str) -> Option<u32> {
        self.value(name)?.parse().ok()
    }
}

/// Compares all bytes, so that the time does not depend on the first one that differs.
fn is_same(given: &str, token: &str) -> bool {
    let differences = given.bytes().zip(token.bytes()).fold(0, |sum, (a, b)| sum | (a ^ b));
    given.len() == token.len() && differences == 0
}

/// The head of an answer. `length` is that of the body, if it is known.
pub fn head(status: &str, kind: &str, length: Option<usize>) -> String {
    let length = length.map_or(String::new(), |length| format!("Content-Length: {length}\r\n"));
    format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\n{length}Cache-Control: no-store\r\nConnection: close\r\n\
         X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n\
         Cross-Origin-Resource-Policy: same-origin\r\n\
         Content-Security-Policy: default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; \
         img-src 'self' data:; connect-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'\r\n\r\n"
    )
}

/// Writes a complete answer.
pub fn answer(to: &mut impl Write, status: &str, kind: &str, body: &[u8]) -> io::Result<()> {
    to.write_all(head(status, kind, Some(body.len())).as_bytes())?;
    to.write_all(body)?;
    to.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Request, Refusal> {
        Request::read(&mut text.as_bytes(), 80, "secret")
    }

    fn with(first: &str, host: &str) -> String {
        format!("{first}\r\nAccept: */*\r\n{host}\r\n\r\n")
    }

    #[test]
    fn a_request_with_token_and_host_is_read() {
        let request = read(&with("GET /secret/pixel?x=3&y=40 HTTP/1.1", "host: 127.0.0.1:80")).unwrap();
        assert_eq!(
            (request.path.as_str(), request.number("x"), request.number("y")),
            ("pixel", Some(3), Some(40))
        );
        assert_eq!((request.number("z"), request.value("x")), (None, Some("3")));
        assert_eq!(read(&with("GET /secret/ HTTP/1.1", "Host: localhost:80")).unwrap().path, "");
    }

    #[test]
    fn other_tokens_and_other_hosts_are_forbidden() {
        for first in [
            "GET / HTTP/1.1",
            "GET /secre/ HTTP/1.1",
            "GET /secrets/ HTTP/1.1",
            "GET /SECRET/ HTTP/1.1",
            "GET //secret/ HTTP/1.1",
        ] {
            assert_eq!(read(&with(first, "Host: 127.0.0.1:80")), Err(FORBIDDEN), "{first}");
        }
        let first = "GET /secret/ HTTP/1.1";
        for host in [
            "Host: example.org",
            "Host: 127.0.0.1",
            "Host: 127.0.0.1:81",
            "Host: 127.0.0.1:80.example.org",
            "Host: 127.0.0.1:80\r\nHost: example.org",
            "X-Forwarded-Host: 127.0.0.1:80",
        ] {
            assert_eq!(read(&with(first, host)), Err(FORBIDDEN), "{host}");
        }
    }

    #[test]
    fn what_is_malformed_too_long_or_no_get_is_refused() {
        for text in [
            "",
            "GET",
            "GET /secret/ HTTP/1.1",
            "GET /secret/ HTTP/1.1\r\n",
            "GET /secret/ HTTP/1.1\r\nno colon\r\n\r\n",
        ] {
            assert_eq!(read(text), Err(BAD), "{text:?}");
        }
        let long = format!("GET /secret/{} HTTP/1.1\r\n", "x".repeat(1 << 20));
        assert_eq!(read(&long), Err(BAD));
        assert_eq!(
            read(&with("POST /secret/ HTTP/1.1", "Host: 127.0.0.1:80")),
            Err("405 Method Not Allowed")
        );
        assert_eq!(read(&with("GET /secret/ HTTP/2", "Host: 127.0.0.1:80")), Err(BAD));
    }
}
