//! The roll error that remains after compensation, which no statement of the paper explains.

use std::fmt::Write;

use rins_frames::units::DEG;

use super::number::{Table, fixed, significant, with_unit};
use super::ranking::{CHANCE, HOPELESS, needed};
use super::results::Results;
use crate::causes::{Cause, ranked};
use crate::{printed, real_test};

/// The index of roll among the five figures.
const ROLL: usize = 2;

/// The possible causes of the roll error, and the other effects of each.
pub(super) fn section(results: &Results) -> String {
    let mut out = causes(results);
    out.push_str(&conclusion(results));
    out
}

/// A table of the causes.
fn causes(results: &Results) -> String {
    let after = printed::TABLE_6_AFTER.figures();
    let wanted = after[ROLL];
    let mut out = String::from(
        "### The roll that stays {#table-6-roll}\n\n\
         Each cause that can make the roll after compensation with less than a thousand times the size allowed it, ranked by that multiple, \
         and what it would make of the other figures at that size. *Excluded*: one of these would be more than 3 spreads of the \
         emulation from the printed one. *Random*: 1σ of each figure by itself.\n\n",
    );
    let size = format!("size for {}° of roll>", fixed(wanted, 4));
    let titles =
        ["cause", size.as_str(), "then $V_x$ [m/s]>", "$V_y$ [m/s]>", "pitch [°]>", "yaw [°]>", ""];
    let mut table = Table::new(&titles);
    table.row(&[
        "**printed after**".to_owned(),
        String::new(),
        format!("**{}**", fixed(after[0], 2)),
        format!("**{}**", fixed(after[1], 2)),
        format!("**{}**", fixed(after[3], 4)),
        format!("**{}**", fixed(after[4], 4)),
        String::new(),
    ]);
    for (graded, share) in ranked(&results.causes_after, ROLL, wanted) {
        if share * HOPELESS < 1.0 {
            continue;
        }
        let mut size = graded.needed(ROLL, wanted);
        if graded.cause == Cause::GyroNoise {
            size = size.abs();
        }
        let made = graded.effect * size;
        // Random causes affect each figure independently.
        let excluded = graded.cause != Cause::GyroNoise
            && (0..5).any(|figure| {
                let spread =
                    real_test::spread(&results.emulated, |run| run.after.figures(), figure);
                figure != ROLL && (made[figure] - after[figure]).abs() > CHANCE * spread.deviation
            });
        table.row(&[
            graded.cause.name(),
            format!(
                "{} ({}×)",
                with_unit(&significant(size, 3), graded.cause.unit().0),
                significant(share.recip(), 2)
            ),
            fixed(made[0], 2),
            fixed(made[1], 2),
            fixed(made[3], 4),
            fixed(made[4], 4),
            match (graded.cause, excluded) {
                (Cause::GyroNoise, _) => "random",
                (_, true) => "excluded",
                (_, false) => "possible",
            }
            .to_owned(),
        ]);
    }
    out.push_str(&table.finish());
    out
}

/// The causes that the table does not exclude.
fn conclusion(results: &Results) -> String {
    let mut out = String::new();
    let (before, after) = (printed::TABLE_6_BEFORE.figures(), printed::TABLE_6_AFTER.figures());
    let wanted = after[ROLL];
    // The Schuler oscillation converts an initial tilt φ to a velocity of sqrt(g R) sin(ω t) φ, and one that grows to φ to
    // sqrt(g R) tan(ω t / 2) φ.
    let scenario = &results.real_test.scenario;
    let site = scenario.station.site;
    let (gravity, radius) = (scenario.station.gravity, site.transverse_radius() + site.height);
    let profile = &scenario.profile;
    let time = profile.angle(profile.duration()) / profile.rate(profile.duration());
    let phase = time * (gravity / radius).sqrt();
    let speed = (gravity * radius).sqrt() * (wanted * DEG).abs();
    let reference = scenario.nav_from_table.euler_angles();
    let (start_roll, start_pitch) = (reference.roll / DEG, reference.pitch / DEG);
    let misfit = before[ROLL] - results.predicted.figures()[ROLL];
    // Both rows are differences from the initial roll.
    let other_sign = [misfit, wanted].map(|roll| roll + 2.0 * start_roll);
    let deviation = real_test::spread(&results.emulated, |run| run.after.figures(), ROLL).deviation;
    let _ = write!(
        out,
        "A sensor error makes a roll only by tilting the computed level, and a tilted level shows in the velocity. A tilt of {}° that was there at \
         the start makes {} m/s of $V_x$ in {} s, one that grows to it over the whole time {} m/s; printed are {} m/s. So the attitude \
         that was read changed and the computed level did not. The roll is also there before compensation ({}° less the model's {}°, which leaves \
         {}°): no compensation made it. What remains, in order:\n\n\
         1. The axis itself had tilted by {}″ about north at the end (table, floor or fixture). The paper states 2″ of \
         position for the table, and nothing for its axis, which roll and pitch at the start show to be {}° off the vertical. Nothing in Table 6 contradicts it.\n\
         2. The IMU is mounted off the axis by at least {}° (half the roll), and the roll was read at another table angle than at the start, with the yaw \
         reduced by that angle. The paper states neither. (On a table that is a quarter turn further, the tilt of the start reads as a roll of {}°, where {}° is printed \
         after compensation, but as a pitch of {}°, where {}° is printed.)\n\
         3. A misprint of the roll at the start, which both rows are compared with. A lost minus would leave {}° before and {}° after, \
         which is {} and {} spreads of the emulation.\n\n\
         **Unexplained** by anything that the paper states.\n\n",
        fixed(wanted, 4),
        significant(speed * phase.sin(), 2),
        fixed(time, 0),
        significant(speed * (0.5 * phase).tan(), 2),
        fixed(after[0], 2),
        fixed(before[ROLL], 4),
        fixed(results.predicted.figures()[ROLL], 4),
        fixed(misfit, 4),
        significant(needed(&results.causes_after, Cause::Tilt(1), ROLL, wanted).abs(), 3),
        fixed(scenario.nav_from_table.matrix()[(2, 2)].acos() / DEG, 3),
        fixed(0.5 * wanted.abs(), 3),
        fixed(-start_pitch, 4),
        fixed(wanted + start_roll, 4),
        fixed(start_roll, 4),
        fixed(after[3] + start_pitch, 4),
        fixed(other_sign[0], 4),
        fixed(other_sign[1], 4),
        significant((other_sign[0] / deviation).abs(), 2),
        significant((other_sign[1] / deviation).abs(), 2),
    );
    out
}
