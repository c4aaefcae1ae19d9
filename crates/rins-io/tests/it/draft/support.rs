//! A motion in closed form for test logs, and drafts to be filled in.

use std::path::Path;

use nalgebra::{Rotation3, Vector3};
use rins_io::{Draft, draft_rig};

/// A site for the keys that a draft leaves open.
pub(super) const SITE: [(&str, &str); 2] =
    [("site.latitude", "\"34.25 deg\""), ("site.height", "\"400 m\"")];

/// Static intervals of 20 s before and between rotations of 20 s at 10 and -25 deg/s, about a tilted axis.
pub(super) struct Motion {
    /// The sampling rate \[Hz\].
    pub(super) rate: u32,
    /// The tilt of the axis \[rad\].
    pub(super) tilt: f64,
}

/// The signals in a row.
pub(super) struct Row {
    /// The time \[s\].
    pub(super) time: f64,
    /// The table angle \[rad\].
    pub(super) table: f64,
    /// The angular rate including the Earth rate \[rad/s\].
    pub(super) rate: Vector3<f64>,
    /// The specific force \[m/s²\].
    pub(super) force: Vector3<f64>,
}

impl Default for Motion {
    fn default() -> Self {
        Self { rate: 50, tilt: 0.5 }
    }
}

impl Motion {
    pub(super) fn rows(&self) -> impl Iterator<Item = Row> {
        let (interval, tilt) = (1.0 / f64::from(self.rate), self.tilt);
        let speed = |time: f64| {
            let leg = (time / 20.0).floor();
            if leg == 1.0 {
                10_f64
            } else if leg == 3.0 {
                -25.0
            } else {
                0.0
            }
        };
        let mut table = 0.3;
        (1..=80 * self.rate).map(move |index| {
            let middle = (f64::from(index) - 0.5) * interval;
            let spin = speed(middle).to_radians();
            let half = spin * interval / 2.0;
            let turned = Rotation3::from_axis_angle(&Vector3::z_axis(), -(table + half));
            table += 2.0 * half;
            let earth = turned * Vector3::new(3e-5, 5e-5, 4.35e-5);
            Row {
                time: f64::from(index) * interval,
                table,
                // A little noise prevents a gyro from being treated as stuck.
                rate: earth + Vector3::new(1e-9 * f64::from(index % 5), 0.0, spin),
                force: turned * Vector3::new(tilt.sin(), 0.0, tilt.cos()) * 9.797,
            }
        })
    }
}

/// The draft of the log `name` in `folder`, for a rig file there.
pub(super) fn draft(folder: &Path, name: &str) -> Draft {
    let draft = draft_rig(&folder.join(name), folder).unwrap();
    // Every draft is valid TOML, and each guess is marked on its line.
    let _: toml::Table = draft.text.parse().unwrap();
    assert_eq!(draft.text.matches("# GUESS: ").count(), draft.guesses.len());
    assert_eq!(draft.text.matches("; confirm\n").count(), draft.guesses.len());
    assert_eq!(draft.text.matches("# TO FILL IN: ").count(), draft.to_fill_in.len());
    draft
}
