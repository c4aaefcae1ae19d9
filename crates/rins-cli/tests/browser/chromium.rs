//! A page opened in headless Chromium with the network cut, and what was seen of it.

use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::net::{SocketAddr, TcpListener};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;

const RECORDER: &str = include_str!("recorder.js");
const PROBE: &str = include_str!("probe.js");

/// A page that takes longer than this hangs.
const PATIENCE: Duration = Duration::from_secs(90);

/// A curve across a plot colours more pixels than this; a stray mark does not.
pub(crate) const CURVE: u64 = 100;

/// Whom Chromium asks on its own account, whatever page is open.
const CHROMIUM_ASKS: [&str; 3] = ["google.com", "googleapis.com", "gvt1.com"];

/// The colours that the reader's system prefers.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Scheme {
    Light,
    Dark,
}

/// What was seen of a page.
#[derive(Debug)]
pub(crate) struct Visit {
    /// What `probe.js` found.
    pub(crate) probe: Value,
    /// The first line of each request that would have left the machine.
    pub(crate) requests: Vec<String>,
}

impl Visit {
    /// Everything that went wrong, in words.
    pub(crate) fn complaints(&self) -> Vec<String> {
        let mut complaints: Vec<String> =
            self.requests.iter().map(|line| format!("request: {line}")).collect();
        for kind in ["errors", "violations", "loads"] {
            let noted = self.probe[kind].as_array().into_iter().flatten();
            complaints.extend(noted.map(|what| format!("{kind}: {what}")));
        }
        complaints
    }
}

/// Opens the page in a window `width` pixels wide and handles it as a reader would.
pub(crate) fn open(page: &str, width: u32, scheme: Scheme) -> Visit {
    visit(&find(), page, width, scheme)
}

/// That every plot of the page is drawn, and nothing went wrong or was asked for.
pub(crate) fn assert_sound(visit: &Visit, page: &str, least_ink: u64) {
    assert_eq!(visit.complaints(), Vec::<String>::new());
    let probe = &visit.probe;
    assert_ne!(probe["title"], "", "the page has no title");
    assert_eq!(probe["excuses"], 0, "a plot says that it was not drawn");
    let plots = probe["plots"].as_array().unwrap();
    assert_eq!(plots.len(), page.matches("<script type=\"application/json\">").count());
    for plot in plots {
        let ink: Vec<u64> =
            plot["ink"].as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).collect();
        assert!(matches!(ink[..], [n] if n >= least_ink), "{plot} is not one drawn canvas");
    }
    assert!(probe["overflow"].as_i64().unwrap() <= 0, "wider than the screen: {probe}");
}

/// The browser.
fn find() -> PathBuf {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let names = ["chromium", "chromium-browser", "google-chrome"];
    std::env::split_paths(&folders)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|path| path.is_file())
        .expect("there is a Chromium: apt-get install chromium")
}

fn visit(chromium: &Path, page: &str, width: u32, scheme: Scheme) -> Visit {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("page.html"), with_probe(page)).unwrap();
    let (proxy, requests) = cut_network();
    let preferred = match scheme {
        Scheme::Dark => 0,
        Scheme::Light => 1,
    };
    let mut child = Command::new(chromium)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"])
        .args(["--disable-background-networking", "--disable-component-update", "--disable-sync"])
        .args(["--disable-dev-shm-usage", "--dump-dom", "--virtual-time-budget=10000"])
        .arg(format!("--user-data-dir={}", at("profile").display()))
        .arg(format!("--proxy-server=http://{proxy}"))
        .arg(format!("--blink-settings=preferredColorScheme={preferred}"))
        // A plain window is never narrower than 500 pixels, a kiosk has the width of its screen.
        .args(["--kiosk".to_owned(), format!("--screen-info={{{width}x900}}")])
        .arg(format!("file://{}", at("page.html").display()))
        .stdout(File::create(at("dom.html")).unwrap())
        .stderr(File::create(at("log.txt")).unwrap())
        .spawn()
        .unwrap();
    let start = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if start.elapsed() > PATIENCE {
            child.kill().unwrap();
            child.wait().unwrap();
            panic!("the page hangs: {}", fs::read_to_string(at("log.txt")).unwrap_or_default());
        }
        thread::sleep(Duration::from_millis(50));
    }
    let dom = fs::read_to_string(at("dom.html")).unwrap();
    let probe = dom
        .split_once("<pre id=\"probe\">")
        .and_then(|(_, rest)| rest.split_once("</pre>"))
        .unwrap_or_else(|| {
            panic!("the probe did not run: {}", fs::read_to_string(at("log.txt")).unwrap())
        })
        .0;
    let requests = requests.lock().unwrap().clone();
    Visit { probe: serde_json::from_str(probe).unwrap(), requests }
}

fn with_probe(page: &str) -> String {
    let (before, after) = page.split_once("<head>").expect("a page with a head");
    let (body, end) = after.rsplit_once("</body>").expect("a page with a body");
    format!("{before}<head><script>{RECORDER}</script>{body}<script>{PROBE}</script></body>{end}")
}

/// A proxy that answers nobody and notes who asked, so that "offline" is observed and not assumed.
fn cut_network() -> (SocketAddr, Arc<Mutex<Vec<String>>>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let requests = Arc::new(Mutex::new(Vec::new()));
    let noted = Arc::clone(&requests);
    thread::spawn(move || {
        for stream in listener.incoming().flatten() {
            stream.set_read_timeout(Some(Duration::from_secs(2))).ok();
            let mut line = String::new();
            let asked = BufReader::new(stream).read_line(&mut line).is_ok_and(|n| n > 0);
            if asked && !is_chromium_itself(&line) {
                noted.lock().unwrap().push(line.trim().to_owned());
            }
        }
    });
    (address, requests)
}

/// Whether a request line asks one of the browser's own hosts.
fn is_chromium_itself(line: &str) -> bool {
    let target = line.split(' ').nth(1).unwrap_or_default();
    let host = target.trim_start_matches("http://");
    let host = host.split(['/', ':']).next().unwrap_or_default();
    CHROMIUM_ASKS.iter().any(|own| host == *own || host.ends_with(&format!(".{own}")))
}
