//! Eq. (A.5): the velocity errors due to accelerometer errors after whole turns.

use std::fmt::Write;

use rins_frames::units::{DEG, MICRO_G};

use super::number::{Table, fixed};
use super::results::Results;
use crate::accelerometers::{Left, along_the_axis};
use crate::grid::{ATTITUDES, RATES, turn};

pub(super) fn section(results: &Results) -> String {
    let [tilted, level] = &results.accelerometers;
    let mut out = String::new();
    let attitude = turn(ATTITUDES[0], RATES[0]);
    let tilt = attitude.nav_from_table.matrix()[(2, 2)].acos() / DEG;
    let bias = results.simulation.scenario.imu_error.accel.bias.z;
    let along = along_the_axis(&attitude, bias, 360.0);
    // Writing to a string cannot fail.
    let _ = write!(
        out,
        "\n## Accelerometer errors and whole turns {{#accelerometers}}\n\n\
         (A.5) drops $\\delta f$ from (A.4), because \"accelerometer error $\\delta f$ can be modulated by 2π rotation\". \
         Below, $\\int C_b^n\\,\\delta f^b\\,dt$ over ten turns (360 s) for each error of Table 1 alone, by quadrature and by a \
         navigator that has perfect gyros. `cargo xtask verify` repeats it at all attitudes and rates of its grid.\n\n",
    );
    let mut table = Table::new(&[
        "error of Table 1",
        "Table 4's axis: east [m/s]>",
        "north [m/s]>",
        "navigator: east>",
        "north>",
        "level axis: horizontal [m/s]>",
    ]);
    for (one, flat) in tilted.iter().zip(level) {
        table.row(&[
            one.name.clone(),
            fixed(one.integrated.x, 4),
            fixed(one.integrated.y, 4),
            fixed(one.navigated.x, 4),
            fixed(one.navigated.y, 4),
            fixed(flat.horizontal(), 4),
        ]);
    }
    out.push_str(&table.finish());
    let horizontal = tilted.first().map_or(f64::NAN, Left::horizontal);
    let _ = write!(
        out,
        "> **Erratum.** Rotation averages only what lies across its axis. A bias along the axis stays, and so do $K_z$ \
         against the mean of $K_x$ and $K_y$, and $E_{{xy}} - E_{{yx}}$. On a level axis none of these is horizontal, and (A.5) holds. \
         On the paper's own axis, tilted by {}°, {} µg along it leave ({}, {}) m/s after ten turns, {} m/s in all: more than either velocity that \
         Table 4 shows after compensation. The scale errors of Table 1 cancel only because they are equal.\n\n",
        fixed(tilt, 1),
        fixed(bias / MICRO_G, 0),
        fixed(along.components().x, 3),
        fixed(along.components().y, 3),
        fixed(horizontal, 3),
    );
    out
}
