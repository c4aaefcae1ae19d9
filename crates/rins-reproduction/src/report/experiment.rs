//! Section 5: Tables 5 and 6 compared with an emulation, and possible causes of the remaining differences.

use std::fmt::Write;

use super::number::{Table, fixed, signed, significant, spread, tuple, with_unit};
use super::ranking::{self, CHANCE, FIGURES, HOPELESS, needed};
use super::results::Results;
use super::{enhancement, roll, uncertainty};
use crate::causes::{Cause, Graded};
use crate::monte_carlo::UNITS;
use crate::printed;
use crate::real_test::{self, Emulated};
use crate::statistics::Sample;

/// The decimals of each figure that exceed the spread of the emulation.
const DECIMALS: [usize; 5] = [2, 2, 4, 4, 4];

pub(super) fn section(results: &Results) -> String {
    let mut out = String::new();
    table_5(&mut out, results);
    out.push_str(&uncertainty::section(results));
    table_6(&mut out, results);
    out.push_str(&enhancement::section(results));
    after(&mut out, results);
    out.push_str(&roll::section(results));
    between(&mut out, results);
    out
}

fn table_5(out: &mut String, results: &Results) {
    let of = |which: &dyn Fn(&Emulated) -> f64, place: usize| {
        Sample::of(results.emulated.iter().map(|run| which(run) / UNITS[place]))
    };
    let estimated = |place: usize| spread(&of(&|run| run.estimate[place], place), 3);
    let truth = |place: usize| spread(&of(&|run| run.truth[place], place), 1);
    let _ = write!(
        out,
        "## Section 5: the real test, emulated {{#real-test}}\n\n\
         The log was not published. [scenarios/paper/real-test.toml] emulates it: 100 Hz, 140 s static, 900 s at 10 °/s \
         near the level, biases drawn from 0.1 °/h and 100 µg (1σ), the table's rate within 0.0001 °/s of its command, the noise \
         of Tables 1 and 2 because section 5 gives none. Each of {} runs is aligned on its static interval, calibrated on 100 s of its turn against the \
         commanded rate, and navigated over all of it. Attitudes are compared with those at the start, at the table's true \
         position: the paper has the table \"rotated to its original position after navigation\".\n\n\
         ### Table 5: the estimates {{#table-5}}\n\n\
         Printed {}. These are estimates, so each run has the true errors that its biases and its table turn into them: \
         emulated estimates are {}, {} and {} (noise alone), and the true errors behind them {}, {} and {}. \
         One and the same Table 5 can come from any of these.\n\n",
        results.scale.emulated,
        tuple(&printed::TABLE_5, 4),
        estimated(0),
        estimated(1),
        estimated(2),
        truth(0),
        truth(1),
        truth(2),
    );
}

fn table_6(out: &mut String, results: &Results) {
    out.push_str(
        "### Table 6: navigation before and after {#table-6}\n\n\
         *Model* has the errors of Table 5 and no other; *emulated* is mean ± spread over the runs; *σ* is the distance of the \
         printed figure from that mean, in spreads.\n\n",
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
                if off.abs() < CHANCE { "within the data sheet" } else { "**outside**" }.to_owned(),
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
         The velocities are within the data sheet, which allows much: an east gyro bias of 0.1 °/h turns the \
         aligned azimuth by half a degree, which makes 1.7 m/s of north velocity. The yaws spread with the table's rate. Figures 6 \
         and 8 show the velocities of Table 6 against time, Figure 7 the estimates of Table 5; their shapes are those of Figures 5 and 4.\n\n\
         > **Errata.** The text of section 5.2 has attitude errors that are not Table 6's: a pitch of 0.0426° before (0.0413° \
         in the table), a yaw of 0.8712° before (0.8612°), a roll of 0.0834° after (0.0734°). It sends the reader to \
         Figure 3 for the estimates, which are Figure 7, and to Figure 7 for the velocity, which is Figure 8.\n\n",
    );
}

/// A table of causes: the ratio of the size that each needs for one figure to its permitted size.
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
            if multiple < HOPELESS {
                format!("{}×", significant(multiple, 2))
            } else {
                "–".to_owned()
            }
        };
        table.row(&[
            ranking::cause_name(graded),
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
    let causes = &results.causes_after;
    out.push_str(
        "### What stays after compensation {#table-6-causes}\n\n\
         For each figure after compensation: the causes that make most of it at the sizes allowed them, as shares of the figure, and \
         whether the causes whose size the paper states are enough. *Together* is the root sum of squares of their shares.\n\n",
    );
    out.push_str(&ranking::table(causes, wanted, "printed after"));
    out.push_str(
        "How large each cause would have to be to make one of the figures by itself, as a multiple of \
         the size allowed it. Stated are the IMU's 0.1 °/h and 100 µg, the table's 2″ and 0.0001 °/s, half a sample of timing, and \
         for an estimate what a bias of 0.1 °/h hides in it. The paper states no clock and no noise: a common quartz clock and the noise of a \
         common gyro of 0.1 °/h are assumed. \
         A dash is more than a thousand times.\n\n",
    );
    sizes(out, causes, wanted);
    let needed = |cause: Cause, figure: usize| needed(causes, cause, figure, wanted[figure]);
    let early = needed(Cause::Readout, 4);
    let rate = needed(Cause::TableRate, 4);
    let of_yaw = |printed: &printed::Navigation, model: f64| {
        // The part that the model does not explain is that of the table: its rate is the only cause of a pure yaw error.
        (printed.figures()[4] - model) / wanted[4] * -rate
    };
    let before = of_yaw(&printed::TABLE_6_BEFORE, results.predicted.figures()[4]);
    let scale = printed::TABLE_5[2];
    let _ = write!(
        out,
        "- **Velocity**: an accelerometer bias of {} µg on x during the alignment, and either {} µg on y or an x gyro bias of \
         {} °/h that turned the azimuth. All are within the data sheet.\n\
         - **Yaw** (0.0771°): a table {} ppm slower than commanded makes all of it, and the accuracy that section 5.1 states allows {} ppm. \
         The calibration takes the commanded rate for the true one, so the table's error is in $S_z$ and comes back \
         where attitude is compared with the table's position. (Compared with the commanded angle it would cancel.) \
         A constant drift is no cause, because the calibration on the same turn takes it for scale and removes it. Without \
         the table it takes a drift that *changed* by {} °/h, or an attitude {} ms newer than its reference ({} of a sample).\n\
         - **What this makes of $S_z$**: Table 6's yaws are a second measurement of it, against the table's position \
         (2″ in 9000°) in place of its rate. The yaw after gives {} ppm, the yaw before {} ppm, Table 5 {} ppm. The first is \
         inside the {} that Table 5 is worth, the second at its edge; the {} ppm between the two are what [the compensation changed](#table-6-difference).\n\n",
        significant(needed(Cause::AccelBias(0), 0), 2),
        significant(needed(Cause::AccelBias(1), 1), 2),
        significant(needed(Cause::GyroBias(0), 1), 2),
        significant(-rate, 2),
        significant(real_test::rate_accuracy(&results.real_test.scenario) / UNITS[2], 2),
        significant(needed(Cause::GyroBiasChange(2), 4), 2),
        significant(-early, 2),
        significant(-early * 1e-3 / results.real_test.scenario.interval, 2),
        fixed(scale - rate, 1),
        fixed(scale + before, 1),
        fixed(scale, 1),
        uncertainty::supported(results)[2],
        fixed(before + rate, 1),
    );
}

fn between(out: &mut String, results: &Results) {
    let (before, after) = (printed::TABLE_6_BEFORE.figures(), printed::TABLE_6_AFTER.figures());
    let model = results.predicted.figures();
    out.push_str(
        "### What the compensation changed {#table-6-difference}\n\n\
         Before less after is a sharper test. Both navigate one log from one alignment, so that sensor errors, noise, \
         alignment and the table's rate cancel to first order, and only what was compensated remains: Table 5.\n\n",
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
    let needed =
        |cause: Cause, figure: usize| needed(&results.causes_between, cause, figure, left[figure]);
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
        significant(needed(Cause::Start(0), 1), 2),
        significant(needed(Cause::Start(1), 0), 2),
        significant(needed(Cause::GyroBiasChange(2), 4), 2),
        significant(needed(Cause::Duration, 4), 2),
    );
}
