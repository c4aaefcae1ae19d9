//! The JSON schemas of the results.

use schemars::{JsonSchema, schema_for};
use serde_json::Value;

use crate::{
    align, allan, apply, calibrate, campaign, check, compare, convert, demo, design, diagnose,
    history, init, live, mission, navigate, observe, simulate,
};

/// The JSON schema of every command's result, by the name of the command; the schema of `merge` is that of `monte-carlo`.
///
/// ```
/// let schemas = rins::schemas();
/// let (_, calibrate) = schemas.iter().find(|(command, _)| *command == "calibrate").unwrap();
/// assert!(calibrate["properties"]["parameters"]["description"].is_string());
/// ```
pub fn schemas() -> [(&'static str, Value); 18] {
    [
        ("align", schema::<align::AlignResult>()),
        ("allan", schema::<allan::AllanResult>()),
        ("apply", schema::<apply::ApplyResult>()),
        ("calibrate", schema::<calibrate::CalibrateResult>()),
        ("calibrate-live", schema::<live::LiveResult>()),
        ("check", schema::<check::CheckResult>()),
        ("compare", schema::<compare::CompareResult>()),
        ("history", schema::<history::HistoryResult>()),
        ("mission", schema::<mission::MissionResult>()),
        ("convert", schema::<convert::ConvertResult>()),
        ("demo", schema::<demo::DemoResult>()),
        ("design", schema::<design::DesignResult>()),
        ("diagnose", schema::<diagnose::DiagnoseResult>()),
        ("init", schema::<init::InitResult>()),
        ("monte-carlo", schema::<campaign::CampaignResult>()),
        ("navigate", schema::<navigate::NavigateResult>()),
        ("observe", schema::<observe::ObserveResult>()),
        ("simulate", schema::<simulate::SimulateResult>()),
    ]
}

fn schema<T: JsonSchema>() -> Value {
    let mut schema = schema_for!(T).to_value();
    unescape(&mut schema);
    schema
}

/// Removes the backslashes before brackets around units, which the documentation needs and a schema does not.
fn unescape(value: &mut Value) {
    match value {
        Value::String(text) => *text = text.replace("\\[", "[").replace("\\]", "]"),
        Value::Array(list) => list.iter_mut().for_each(unescape),
        Value::Object(map) => map.values_mut().for_each(unescape),
        _ => {}
    }
}
