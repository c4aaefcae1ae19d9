//! The report page in a real browser, with the network cut.

#[cfg(test)] // so that its helpers count as tests
mod chromium;
mod sample;

use std::fs;
use std::process::Command;

use chromium::{CURVE, Scheme, assert_sound, open};

#[test]
#[ignore = "needs Chromium: cargo test --workspace --test browser -- --ignored"]
fn every_plot_is_drawn_whatever_the_names_in_it() {
    let page = rins_report::render(&sample::report());
    let visit = open(&page, 1280, Scheme::Light);
    // The plot of one sample has one dot.
    assert_sound(&visit, &page, 5);
    let plots = visit.probe["plots"].as_array().unwrap();
    assert_eq!(plots.len(), 6);
    let curves = plots.iter().filter(|plot| plot["ink"][0].as_u64() > Some(CURVE)).count();
    assert_eq!(curves, 5);
    assert!(visit.probe["title"].as_str().unwrap().starts_with("Sample </script><script>"));
}

#[test]
#[ignore = "needs Chromium: cargo test --workspace --test browser -- --ignored"]
fn plots_of_one_section_and_abscissa_share_cursor_and_zoom() {
    let page = rins_report::render(&sample::report());
    let visit = open(&page, 1280, Scheme::Light);
    let probe = &visit.probe;
    assert_eq!(probe["reading"], 4, "plots whose legend reads the cursor: {probe}");
    assert_eq!(probe["zoomed"], 4, "plots that follow a zoom: {probe}");
    assert!(probe["ink_zoomed"].as_u64() > Some(CURVE), "nothing left after a zoom: {probe}");
    assert_eq!(probe["zoomed_after_double_click"], 0, "plots that stay zoomed: {probe}");
    assert_eq!(probe["ink_hidden"], 0, "a hidden curve is still there: {probe}");
}

#[test]
#[ignore = "needs Chromium: cargo test --workspace --test browser -- --ignored"]
fn a_phone_in_the_dark_shows_the_same() {
    let page = rins_report::render(&sample::report());
    let visit = open(&page, 400, Scheme::Dark);
    assert_sound(&visit, &page, 5);
    assert_eq!(visit.probe["width"], 400);
    assert_eq!(visit.probe["background"], "rgb(17, 20, 23)");
}

#[test]
#[ignore = "needs Chromium: cargo test --workspace --test browser -- --ignored"]
fn the_demonstration_makes_a_sound_page() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("demo");
    let run = Command::new(env!("CARGO_BIN_EXE_rins")).args(["demo", "-o"]).arg(&out).output();
    let run = run.unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.len() < 3_000_000, "{} bytes", page.len());
    for (width, scheme) in [(1280, Scheme::Light), (400, Scheme::Dark)] {
        let visit = open(&page, width, scheme);
        assert_sound(&visit, &page, CURVE);
        assert_ne!(visit.probe["plots"].as_array().unwrap().len(), 0, "a page without plots");
    }
}

#[test]
#[ignore = "needs Chromium: cargo test --workspace --test browser -- --ignored"]
fn a_page_that_errs_or_asks_is_caught() {
    let policy = "<meta http-equiv=\"Content-Security-Policy\" \
                  content=\"default-src 'none'; script-src 'unsafe-inline'\">";
    let cases = [
        ("", "<script>throw new Error('planted')</script>", "errors: \"Uncaught Error: planted\""),
        ("", "<script>console.error('planted')</script>", "errors: \"planted\""),
        ("", "<script>Promise.reject('planted')</script>", "errors: \"planted\""),
        (
            policy,
            "<script>fetch('http://planted.test/').catch(() => {})</script>",
            "violations: \"connect-src http://planted.test/\"",
        ),
        ("", "<img src=\"http://planted.test/x.png\">", "request: GET http://planted.test/x.png"),
        ("", "<script src=\"https://planted.test/x.js\"></script>", "request: CONNECT planted"),
    ];
    for (head, body, complaint) in cases {
        let page = format!("<html><head>{head}</head><body>{body}</body></html>");
        let visit = open(&page, 800, Scheme::Light);
        let complaints = visit.complaints();
        assert!(
            complaints.iter().any(|found| found.starts_with(complaint)),
            "{body}: {complaints:?}"
        );
    }
}
