//! Functions that run `rins` in a folder and read its output.

use std::path::Path;
use std::process::Output;

use rins_tests::rins;
use serde_json::Value;

/// The output of a run of `rins`.
#[derive(Debug)]
pub(crate) struct Finished {
    /// Its exit code.
    pub(crate) code: Option<i32>,
    /// Its standard output.
    pub(crate) out: String,
    /// Its standard error.
    pub(crate) err: String,
}

impl From<Output> for Finished {
    fn from(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).expect("rins writes UTF-8");
        Self { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
    }
}

/// Runs `rins` in `folder` with these arguments, separated by blanks.
pub(crate) fn rins_in(folder: &Path, arguments: &str) -> Finished {
    let words: Vec<String> = arguments.split_whitespace().map(str::to_owned).collect();
    rins_words(folder, &words)
}

/// The same with arguments that may contain blanks.
pub(crate) fn rins_words(folder: &Path, words: &[String]) -> Finished {
    let mut command = rins();
    command.args(words).current_dir(folder);
    command.output().expect("rins starts").into()
}

/// The output of `rins --json` in `folder`, after success without any output on standard error.
pub(crate) fn result_in(folder: &Path, arguments: &str) -> Value {
    let finished = rins_in(folder, &format!("{arguments} --json"));
    assert_eq!((finished.code, finished.err.as_str()), (Some(0), ""), "rins {arguments}");
    object(&finished)
}

/// The one JSON object of standard output.
pub(crate) fn object(finished: &Finished) -> Value {
    let value: Value = serde_json::from_str(&finished.out)
        .unwrap_or_else(|error| panic!("{error} in {:?}", finished.out));
    assert!(value.is_object(), "{value}");
    assert_eq!(value["schema"], 2);
    value
}

/// The number at `pointer`, as in `/apparent/latitude_deg`.
pub(crate) fn number(value: &Value, pointer: &str) -> f64 {
    let found = value.pointer(pointer).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("no number at {pointer} of {value:#}"))
}

/// The list at `pointer`.
pub(crate) fn list<'v>(value: &'v Value, pointer: &str) -> &'v [Value] {
    let found = value.pointer(pointer).and_then(Value::as_array);
    found.unwrap_or_else(|| panic!("no list at {pointer} of {value:#}"))
}

/// The numbers of the list at `pointer`.
pub(crate) fn numbers(value: &Value, pointer: &str) -> Vec<f64> {
    list(value, pointer).iter().map(|item| item.as_f64().expect("a list of numbers")).collect()
}

/// The texts of the list at `pointer`.
pub(crate) fn texts<'v>(value: &'v Value, pointer: &str) -> Vec<&'v str> {
    list(value, pointer).iter().map(|item| item.as_str().expect("a list of texts")).collect()
}

/// The magnitude of the vector at `pointer`.
pub(crate) fn magnitude(value: &Value, pointer: &str) -> f64 {
    numbers(value, pointer).iter().map(|component| component * component).sum::<f64>().sqrt()
}

/// The parameter `id` of a calibration.
pub(crate) fn parameter<'r>(result: &'r Value, id: &str) -> &'r Value {
    let found = list(result, "/parameters").iter().find(|parameter| parameter["id"] == id);
    found.unwrap_or_else(|| panic!("no {id}"))
}

/// Asserts that the estimate of the parameter `id`, in the unit of the result, is within four sigmas of the truth.
pub(crate) fn assert_found(result: &Value, id: &str, truth: f64) {
    let found = parameter(result, id);
    let (value, sigma) = (number(found, "/value"), number(found, "/sigma"));
    assert!((value - truth).abs() < 4.0 * sigma, "{id}: {truth} found as {value} ± {sigma}");
}
