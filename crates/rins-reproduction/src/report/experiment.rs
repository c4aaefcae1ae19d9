//! Section 5: Tables 5 and 6 beside an emulation, and named causes for what it leaves.

use std::fmt::Write;

use rins_frames::units::{ARCSEC, DEG};

use super::number::{Table, fixed, signed, significant, spread, tuple, with_unit};
use super::results::Results;
use crate::causes::{Cause, Graded};
use crate::monte_carlo::UNITS;
use crate::real_test::{self, Emulated};
use crate::{Sample, printed};

const FIGURES: [&str; 5] = ["$V_x$ [m/s]", "$V_y$ [m/s]", "roll [°]", "pitch [°]", "yaw [°]"];
/// The decimals that the emulation's spread leaves sense in.
const DECIMALS: [usize; 5] = [2, 2, 4, 4, 4];

/// How many deviations from the emulation's mean still pass for chance.
const CHANCE: f64 = 3.0;

pub(super) fn section(results: &Results) -> String {
    let mut out = String::new();
    let estimates: Vec<String> = (0..3)
        .map(|place| {
            spread(
                &Sample::of(results.emulated.iter().map(|run| run.estimate[place] / UNITS[place])),
                1,
            )
        })
        .collect();
    let _ = write!(
        out,
        "## Section 5: the real test, emulated {{#real-test}}\n\n\
         The log was not published. [scenarios/paper/real-test.toml] emulates it: 100 Hz, 140 s at rest, 900 s at 10 °/s \
         near the level, the errors of Table 5, biases drawn from 0.1 °/h and 100 µg, the noise of Tables 1 and 2 for want \
         of any. Each of {} runs is aligned on its rest, calibrated on 100 s of its turn, and navigated over all of it; attitudes are \
         compared with the start, as there.\n\n\
         ### Table 5: the estimates {{#table-5}}\n\n\
         Printed {}; emulated, with these as the truth, {}, {} and {}. The spread is what the biases of the grade hide in \
         an estimate: of Table 5's four decimals not the first is sure.\n\n",
        results.scale.emulated,
        tuple(&printed::TABLE_5, 4),
        estimates[0],
        estimates[1],
        estimates[2],
    );
    table_6(&mut out, results);
    after(&mut out, results);
    between(&mut out, results);
    out
}

fn table_6(out: &mut String, results: &Results) {
    out.push_str(
        "### Table 6: navigation before and after {#table-6}\n\n\
         *Model* has the errors of Table 5 and no other; the emulation is mean ± spread over its runs; *σ* is how far the \
         printed figure lies from that mean.\n\n",
    );
    let mut table = Table::new(&["", "", "printed>", "model>", "emulated>", "σ>", ""]);
    let mut rows = |when: &str,
                    printed: &printed::Navigation,
                    model: [f64; 5],
                    of: &dyn Fn(&Emulated) -> [f64; 5]| {
        for (place, name) in FIGURES.into_iter().enumerate() {
            let said = printed.figures()[place];
            let sample = real_test::spread(&results.emulated, of, place);
            let off = sample.deviations_to(said);
            table.row(&[
                when.to_owned(),
                name.to_owned(),
                format!("**{}**", fixed(said, 4)),
                fixed(model[place], 4),
                spread(&sample, DECIMALS[place]),
                signed(off, 1),
                if off.abs() < CHANCE { "within the grade" } else { "**outside**" }.to_owned(),
            ]);
        }
    };
    rows("before", &printed::TABLE_6_BEFORE, results.predicted.figures(), &|run| {
        run.before.figures()
    });
    rows("after", &printed::TABLE_6_AFTER, [0.0; 5], &|run| run.after.figures());
    out.push_str(&table.finish());
    out.push_str(
        "![Velocities of the emulated runs and of Table 6](figures/table-6.svg)\n\n\
         The velocities are within what the grade allows, though it allows much: an east gyro bias of 0.1 °/h turns the \
         aligned azimuth by half a degree, which makes 1.7 m/s of north velocity. Figures 6 and 8 show the velocities of \
         Table 6 on the way, Figure 7 the estimates of Table 5; their shapes are those of Figures 5 and 4.\n\n\
         > **Errata.** The text of section 5.2 has attitude errors that are not Table 6's: a pitch of 0.0426° before (0.0413° \
         in the table), a yaw of 0.8712° before (0.8612°), a roll of 0.0834° after (0.0734°). It sends the reader to \
         Figure 3 for the estimates, which are Figure 7, and to Figure 7 for the velocity, which is Figure 8.\n\n",
    );
}

/// A table of causes: the size that each needs for one figure alone, over what it is allowed.
fn sizes(out: &mut String, causes: &[Graded], wanted: [f64; 5]) {
    let titles = ["cause", "allowed>", "$V_x$>", "$V_y$>", "roll>", "pitch>", "yaw>"];
    let mut table = Table::new(&titles);
    let mut ranked: Vec<&Graded> = causes.iter().collect();
    let least = |graded: &Graded| {
        (0..5).map(|figure| graded.multiple(figure, wanted[figure])).fold(f64::INFINITY, f64::min)
    };
    ranked.sort_by(|one, other| least(one).total_cmp(&least(other)));
    for graded in ranked {
        let unit = graded.cause.unit().0;
        let cell = |figure: usize| {
            let multiple = graded.multiple(figure, wanted[figure]);
            if multiple < 1000.0 {
                format!("{}×", significant(multiple, 2))
            } else {
                "–".to_owned()
            }
        };
        table.row(&[
            graded.cause.name(),
            with_unit(&significant(graded.grade, 2), unit),
            cell(0),
            cell(1),
            cell(2),
            cell(3),
            cell(4),
        ]);
    }
    out.push_str(&table.finish());
}

fn after(out: &mut String, results: &Results) {
    let wanted = printed::TABLE_6_AFTER.figures();
    out.push_str(
        "### What stays after compensation {#table-6-causes}\n\n\
         How large each cause would have to be to make one of the figures after compensation by itself, as a multiple of \
         what is allowed it: the IMU's stated grade, the table's 2″, half a sample of timing, and for an estimate what a bias \
         of the grade hides in it. A dash is more than a thousand times. Causes are ranked by the figure that they explain \
         most cheaply.\n\n",
    );
    sizes(out, &results.causes_after, wanted);
    let needed = |name: &str, figure: usize| {
        let found = results.causes_after.iter().find(|graded| graded.cause.name() == name);
        found.map_or(f64::NAN, |graded| graded.needed(figure, wanted[figure]))
    };
    let early = needed("attitude older than its reference", 4);
    // What the start attitude's error about north, as large as this roll, makes of the east velocity.
    let start = results.causes_between.iter().find(|graded| graded.cause == Cause::Start(1));
    let tilted_velocity =
        start.map_or(f64::NAN, |graded| graded.effect[0] * wanted[2] * DEG / ARCSEC);
    let _ = write!(
        out,
        "- **Velocity**: an accelerometer bias of {} µg on x during the alignment, and either {} µg on y or an x gyro bias of \
         {} °/h that turned the azimuth. All are well within the grade.\n\
         - **Yaw** (0.0771°, three times what a drift of 0.1 °/h makes in 900 s): a constant drift is no cause, because the \
         calibration on the same turn takes it for scale and removes it. It takes a drift that *changed* by {} °/h, or \
         {} ppm of scale error, or an attitude {} ms newer than its reference ({} of a sample).\n\
         - **Roll** (−0.0734°) is the figure that no sensor error of the grade makes: a tilt of the computed level that large \
         at the start would show as {} m/s. It needs an axis that stood {}″ off at the end, more than a hundred times the table's \
         accuracy, or a table that was not back at its start with an IMU mounted off the axis by at least {}°.\n\n",
        significant(needed("accelerometer bias x, aligned with it", 0), 2),
        significant(needed("accelerometer bias y, aligned with it", 1), 2),
        significant(needed("gyro bias x, aligned with it", 1), 2),
        significant(needed("gyro bias z", 4), 2),
        significant(needed("$S_z$ not compensated", 4), 2),
        significant(-early, 2),
        significant(-early * 1e-3 / 0.01, 2),
        fixed(tilted_velocity.abs(), 0),
        significant(needed("axis tipped about north", 2).abs(), 3),
        fixed(0.5 * wanted[2].abs(), 3),
    );
}

fn between(out: &mut String, results: &Results) {
    let (before, after) = (printed::TABLE_6_BEFORE.figures(), printed::TABLE_6_AFTER.figures());
    let model = results.predicted.figures();
    out.push_str(
        "### What the compensation changed {#table-6-difference}\n\n\
         Before less after is a sharper test. Both navigate one log from one alignment, so that sensor errors, noise and \
         alignment drop out to first order, and only what was compensated is left: Table 5.\n\n",
    );
    let mut table = Table::new(&[
        "before − after",
        "printed>",
        "Table 5's errors>",
        "left>",
        "printed / model>",
    ]);
    let mut left = [0.0; 5];
    for (place, name) in FIGURES.into_iter().enumerate() {
        let said = before[place] - after[place];
        left[place] = said - model[place];
        table.row(&[
            name.to_owned(),
            fixed(said, 4),
            fixed(model[place], 4),
            signed(left[place], 4),
            fixed(said / model[place], 3),
        ]);
    }
    out.push_str(&table.finish());
    let percent = |place: usize| fixed(100.0 * (left[place] / model[place]).abs(), 0);
    let needed = |name: &str, figure: usize| {
        let found = results.causes_between.iter().find(|graded| graded.cause.name() == name);
        found.map_or(f64::NAN, |graded| graded.needed(figure, left[figure]))
    };
    let _ = write!(
        out,
        "Signs and sizes are right, and no figure is: the velocities are {} and {} % below, yaw {} % and tilt {} % above what \
         Table 5 must change in 900 s. So the two navigations differed in something else too. By size: start attitudes \
         that differ by {}″ about east and {}″ about north make the velocities; a z drift of {} °/h that one of \
         them also had compensated makes the yaw, and so would {} s more (the paper says \"at least 900 s\"), which would \
         take the velocities further away. The tilt is made by neither.\n\n",
        percent(0),
        percent(1),
        percent(4),
        percent(2),
        significant(needed("start attitude off about east", 1), 2),
        significant(needed("start attitude off about north", 0), 2),
        significant(needed("gyro bias z", 4), 2),
        significant(needed("a longer navigation", 4), 2),
    );
}
