//! A local page with the estimates of a live calibration.

use std::io::{self, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use anyhow::Context;
use rins::live::LiveCalibration;
use serde_json::json;

/// The page, which loads nothing but the estimates.
const PAGE: &str = include_str!("serve.html");

/// The longest request \[bytes\], and the longest time that it may take.
const REQUEST: u64 = 8192;
const PATIENCE: Duration = Duration::from_secs(2);

/// A server of the page and of the estimates as JSON, until the program ends.
pub(crate) struct Server(Arc<Mutex<String>>);

impl Server {
    /// Starts a server at this address, and says on standard error where it is.
    pub(crate) fn start(address: SocketAddr) -> anyhow::Result<Self> {
        let failed = || format!("cannot serve a page at {address}");
        let listener = TcpListener::bind(address).with_context(failed)?;
        let own = listener.local_addr().with_context(failed)?;
        let _ = writeln!(io::stderr(), "page: http://{own}/");
        let estimates = Arc::new(Mutex::new(json!({ "parameters": [] }).to_string()));
        let shared = Arc::clone(&estimates);
        std::thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                // A visitor who leaves or is too slow is served no further.
                let _ = answer(stream, &shared);
            }
        });
        Ok(Self(estimates))
    }

    /// Sets the estimates that are shown.
    pub(crate) fn show(&self, live: &LiveCalibration) {
        let time = live.filter().and_then(rins::estimation::OnlineFilter::time);
        let samples = live.filter().map_or(0, |filter| filter.counts().0);
        let parameters = live.parameters().unwrap_or_default();
        let text = json!({ "time_s": time, "samples": samples, "parameters": parameters });
        // The text is valid even if a thread panicked while it held the lock.
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = text.to_string();
    }
}

/// Answers one request.
fn answer(mut stream: TcpStream, estimates: &Mutex<String>) -> io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let mut request = Vec::new();
    let mut byte = [0];
    let mut reader = io::BufReader::new((&stream).take(REQUEST));
    while !request.ends_with(b"\r\n\r\n") && reader.read(&mut byte)? == 1 {
        request.push(byte[0]);
    }
    let text = String::from_utf8_lossy(&request);
    let mut words = text.split_whitespace();
    let (status, kind, body) = match (words.next(), words.next()) {
        (Some("GET"), Some("/")) => ("200 OK", "text/html; charset=utf-8", PAGE.to_owned()),
        (Some("GET"), Some("/estimates.json")) => {
            let text = estimates.lock().unwrap_or_else(PoisonError::into_inner).clone();
            ("200 OK", "application/json", text)
        }
        (Some("GET"), Some(_)) => ("404 Not Found", "text/plain", "not found\n".to_owned()),
        _ => ("405 Method Not Allowed", "text/plain", "only GET\n".to_owned()),
    };
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nCache-Control: no-store\r\n\
         X-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n",
        body.len()
    );
    stream.write_all(head.as_bytes())?;
    stream.write_all(body.as_bytes())?;
    stream.flush()
}
