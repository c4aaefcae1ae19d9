//! The `rins` command from the view of its users.
#![expect(clippy::unwrap_used, reason = "in a test an unwrap is an assertion")]

mod at_rest;
mod bad_input;
mod blind;
mod certificate;
mod convert;
mod demo;
mod diagnose;
mod effects;
mod help;
mod hostile;
mod identifiability;
mod in_the_hand;
mod interrupted;
mod level_table;
mod library;
mod measured;
mod mistakes;
mod monte_carlo;
mod no_room;
mod observe;
mod population;
mod prior_consistency;
mod repairs;
mod replaced;
mod round_trip;
mod spin_axes;
mod statics;
mod support;
mod synthetic;
mod temperature;
mod turned_over;
mod unobservable;
mod unread;
mod verdicts;
mod wheel;
