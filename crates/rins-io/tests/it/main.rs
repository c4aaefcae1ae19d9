//! Files of users, valid and invalid.
#![expect(
    clippy::float_cmp,
    clippy::format_collect,
    clippy::format_push_string,
    clippy::unwrap_used,
    reason = "tests expect bits that are the same, write small files and are meant to panic"
)]

mod calibration;
mod campaign;
mod convert;
mod damaged;
mod draft;
mod faults;
mod formats;
mod grid;
mod live;
mod log_refusals;
mod logs;
mod lost_rows;
mod model;
mod output;
mod preamble;
mod rig;
mod rig_page;
mod round_trip;
mod rows;
mod scenario;
mod split_time;
mod spoilt_parquet;
mod support;
mod table_clock;
mod terms;
mod text_form;
