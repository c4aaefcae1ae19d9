//! "Converges quickly": convergence times and sigmas, compared with the limit of gyro noise.

use std::fmt::Write;

use rins_motion::median;

use super::number::{Table, fixed, significant, spread};
use super::results::Results;
use crate::convergence::{
    WITHIN, ideal_mean_ratio, ideal_median_share, information_bound, spin_rate,
};
use crate::experiment::Experiment;
use crate::monte_carlo::UNITS;
use crate::running::TIMES;
use crate::statistics::Sample;

const NAMES: [&str; 3] = ["$M_{xz}$ [″]", "$M_{yz}$ [″]", "$S_z$ [ppm]"];

pub(super) fn section(results: &Results) -> String {
    let runs = &results.followed;
    let Experiment { scenario, setup } = &results.simulation;
    let duration = scenario.profile.duration();
    let ideal_median = duration * ideal_median_share(WITHIN);
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = write!(
        out,
        "### \"Converges quickly\" {{#convergence}}\n\n\
         The convergence time $t_c$ of a parameter is the time from which on its estimate stays within {within} final sigmas of its \
         final value; the final sigma is the filter's 1σ at the end, {duration} s. {} runs, followed sample by sample. The bound \
         is that of an ideal estimator: the gyro shows $M w$ in white noise of density $N$ while the rate $w$ is known, so that \
         no estimate has a smaller 1σ than $N\\,t^{{-1/2}} / w$ (and the prior's at first).\n\n",
        runs.len(),
        within = fixed(WITHIN, 0),
        duration = fixed(duration, 0),
    );
    let mut table = Table::new(&["", "median of $t_c$ [s]>", "mean of $T / t_c$>"]);
    for (row, name) in NAMES.into_iter().enumerate() {
        let times = runs.iter().map(|run| run.converged[row]);
        let ratios = Sample::of(times.clone().map(|time| duration / time));
        table.row(&[
            name.split(' ').next().unwrap_or(name).to_owned(),
            fixed(median(times).unwrap_or(f64::NAN), 0),
            spread(&ratios, 1),
        ]);
    }
    let deviation = WITHIN.powi(2) * (2.0_f64 / 3.0).sqrt();
    table.row(&[
        "ideal estimator".to_owned(),
        fixed(ideal_median, 0),
        [fixed(ideal_mean_ratio(WITHIN), 1), fixed(deviation, 1)].join("\u{a0}±\u{a0}"),
    ]);
    out.push_str(&table.finish());
    out.push_str(
        "The 1σ against time: claimed by the filter, the spread of the runs, and the bound.\n\n",
    );

    let gyro = &setup.imu.gyro;
    let mut table = Table::new(&[
        "time [s]>",
        "$M_{xz}$ [″]: claimed>",
        "spread>",
        "bound>",
        "$S_z$ [ppm]: claimed>",
        "spread>",
        "bound>",
    ]);
    for (place, time) in TIMES.into_iter().enumerate() {
        let mut cells = vec![significant(time, 2)];
        for (row, prior) in [(0, gyro.misalignment_sigma), (2, gyro.scale_sigma)] {
            let of = |what: usize| {
                Sample::of(runs.iter().map(|run| run.kept[place][what][row] / UNITS[row]))
            };
            let bound = information_bound(gyro.noise_density, spin_rate(scenario), prior, time);
            cells.extend([
                significant(of(1).mean, 3),
                significant(of(0).deviation, 2),
                significant(bound / UNITS[row], 3),
            ]);
        }
        table.row(&cells);
    }
    out.push_str(&table.finish());
    let _ = write!(
        out,
        "The claim holds in this sense: the filter attains the bound within the first second, and no estimator converges faster \
         on these data. It says nothing of the table's or the biases' share of the error, which does not decrease \
         with time. In units of the final sigma the time is a property of the run's length: by any \
         estimator that gyro noise limits, $T / t_c$ is {} on average, whatever the noise.\n\n",
        fixed(ideal_mean_ratio(WITHIN), 0),
    );
    out
}
