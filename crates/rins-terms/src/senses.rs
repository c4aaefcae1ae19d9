//! The way a table turned last.

/// How far a table has to turn, or to turn back, for that to be more than a servo that holds or a reading's noise \[rad\].
const LEAST_TURN: f64 = 1e-3;

/// The part of the rate of a table under way at which it begins to turn.
const STILL: f64 = 0.01;

/// The way the table turned last at the end of each sample: 1, -1, or 0 before it ever turned.
///
/// `angles` are that before the first sample and that at the end of each \[rad\], `rate` is the mean one over a sample;
/// after the last there is none but the last's \[rad/s\]. That it turns is seen after it has turned by a milliradian, and
/// dated back to when it began: between two samples a turning table comes to rest for an instant, which the rates after
/// it tell.
pub(crate) fn senses(angles: &[f64], rate: impl Fn(usize) -> f64) -> Vec<i8> {
    let Some((&(mut furthest), ends)) = angles.split_first() else { return Vec::new() };
    let mut senses = vec![0_i8; ends.len()];
    let mut sense = 0_i8;
    for (sample, &angle) in ends.iter().enumerate() {
        let beyond = angle - furthest;
        let onward = f64::from(sense) * beyond;
        if onward < -LEAST_TURN || sense == 0 && beyond.abs() > LEAST_TURN {
            sense = if beyond > 0.0 { 1 } else { -1 };
            let began = beginning(sample, |of| f64::from(sense) * rate(of));
            senses[began..sample].fill(sense);
            furthest = angle;
        } else if onward > 0.0 {
            furthest = angle;
        }
        senses[sample] = sense;
    }
    senses
}

/// The first sample at whose end the table, which at the end of `sample` is under way, turns already; rates are
/// positive in the sense in which it does.
fn beginning(sample: usize, rate: impl Fn(usize) -> f64) -> usize {
    let least = STILL * rate(sample);
    let turns = |of: &usize| {
        // The rate at its end if it changes evenly before, and if it does after it: at a start from rest one is none.
        let before = 1.5 * rate(*of) - 0.5 * rate(of.saturating_sub(1));
        let after = 1.5 * rate(of + 1) - 0.5 * rate(of + 2);
        *of == sample || before.min(after) > least
    };
    (0..=sample).rev().take_while(turns).last().unwrap_or(sample)
}

#[cfg(test)]
mod tests {
    use super::*;

    const INTERVAL: f64 = 0.01;

    /// Angles of a table at these rates, each from a time on \[s, rad/s\], between which its rate changes evenly.
    fn angles(samples: usize, rates: &[(f64, f64)]) -> Vec<f64> {
        let rate = |time: f64| {
            let next = rates.iter().position(|(from, _)| *from > time);
            let Some(next) = next.filter(|next| *next > 0) else {
                return next.map_or(rates[rates.len() - 1].1, |first| rates[first].1);
            };
            let ((start, from), (end, to)) = (rates[next - 1], rates[next]);
            from + (to - from) * (time - start) / (end - start)
        };
        let steps = 100;
        let mut angle = 0.0;
        let mut angles = vec![angle];
        for sample in 0..samples {
            for step in 0..steps {
                let share = (f64::from(step) + 0.5) / f64::from(steps);
                angle += rate((sample as f64 + share) * INTERVAL) * INTERVAL / f64::from(steps);
            }
            angles.push(angle);
        }
        angles
    }

    fn of(angles: &[f64]) -> Vec<i8> {
        let last = angles.len() - 2;
        senses(angles, |sample| {
            let sample = sample.min(last);
            (angles[sample + 1] - angles[sample]) / INTERVAL
        })
    }

    /// The samples at whose ends the sense is another than at the end of the one before.
    fn changes(senses: &[i8]) -> Vec<(usize, i8)> {
        let changed = |at: &usize| senses[*at] != senses[at - 1];
        (1..senses.len()).filter(changed).map(|at| (at, senses[at])).collect()
    }

    /// Wherever within a sample a table turns back, the reading at that sample's end is the first that knows.
    #[test]
    fn a_table_that_turns_back_has_its_new_sense_from_that_instant_on() {
        for share in [0.05, 0.3, 0.5, 0.7, 0.95] {
            let back = 1.0 + share * INTERVAL;
            let rates = [(0.0, 0.2), (back - 0.2, 0.2), (back + 0.2, -0.2)];
            let senses = of(&angles(200, &rates));
            assert_eq!(senses[0], 1, "{share}");
            assert_eq!(changes(&senses), [(100, -1)], "{share}");
        }
    }

    /// Evenly, and at once; at a rate of 0.03 deg/s too.
    #[test]
    fn a_rest_keeps_the_sense_before_it() {
        for (rate, ramp) in [(0.2, 0.3), (-0.2, 1e-9), (5e-4, 1e-9)] {
            let sense = if rate > 0.0 { 1 } else { -1 };
            let rates = [
                (0.0, 0.0),
                (2.0, 0.0),
                (2.0 + ramp, rate),
                (8.0, rate),
                (8.0 + ramp, 0.0),
                (12.0, 0.0),
                (12.0 + ramp, -rate),
            ];
            let senses = of(&angles(2000, &rates));
            let [start, back] = changes(&senses)[..] else { panic!("{:?}", changes(&senses)) };
            assert_eq!((start.1, back.1), (sense, -sense), "{rate}");
            // The table's first steps are too slow to be told from rest.
            assert!((200..=202).contains(&start.0), "{rate}: {start:?}");
            assert!((1200..=1202).contains(&back.0), "{rate}: {back:?}");
        }
    }

    #[test]
    fn a_servo_that_holds_does_not_turn() {
        let hunting: Vec<f64> = (0..1000_i32).map(|at| 4e-4 * f64::from(at).sin()).collect();
        assert_eq!(of(&hunting), vec![0; 999]);
    }
}
