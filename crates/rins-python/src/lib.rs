//! The extension module `rins._rins` of the Python package: the functions of the crate `rins` for Python objects.
//!
//! Each function runs on its own thread without the GIL, reports progress to a Python function, and returns on Ctrl-C. The package
//! in `python/rins` adds arrays, results and plots.

mod blind;
mod call;
mod campaign;
mod columns;
mod design;
mod error;
mod files;
mod live;
mod log;
mod logs;
mod outcome;
mod quantity;

/// The functions of the crate `rins`.
#[pyo3::pymodule]
mod _rins {
    #[pymodule_export]
    use super::blind::{blind_page, blind_trials};
    #[pymodule_export]
    use super::call::command;
    #[pymodule_export]
    use super::campaign::{merge, monte_carlo};
    #[pymodule_export]
    use super::columns::table;
    #[pymodule_export]
    use super::design::design;
    #[pymodule_export]
    use super::files::{apply, compare, convert, history, init, mission, observe, simulate};
    #[pymodule_export]
    use super::live::LiveCalibration;
    #[pymodule_export]
    use super::log::{Log, check_rig};
    #[pymodule_export]
    use super::logs::{align, allan, calibrate, check, demo, diagnose, navigate};
    #[pymodule_export]
    use super::outcome::Outcome;

    /// The version of the package.
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}
