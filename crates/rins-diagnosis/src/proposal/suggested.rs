//! Where events, slow lines and orders of no known cause may be: where the innovations are strongest.

use std::ops::Range;

use nalgebra::SVector;
use rins_estimation::{Fit, Reference};
use rins_terms::{Need, SettingKind, Term, TermInstance, catalogue};

use crate::case::Case;
use crate::criticism::structure::{CHANNELS, Remainder, Structure, TableMotion};
use crate::generic::disturbance::IN_ANGLE;
use crate::generic::waveform::on_channel;
use crate::proposal::candidates::{Candidate, terms};
use crate::proposal::jolt::Jolts;

/// How many slow lines are tried at once.
const SLOW: usize = 2;

/// A line has so many cycles in a run at least.
const FEWEST_CYCLES: f64 = 5.0;

/// Lines are looked for at so many places an epoch: in two frames, each at half an independent frequency an epoch, where
/// the best between two of these is larger by what four times as many have by chance (Baluev 2008, where lines of five
/// sigma are asked for).
const LOOKS: f64 = 4.0;

/// How many outliers are taken for the time of an event.
const OUTLIERS: usize = 3;

/// Innovations that are so many sigmas together are looked at: more is asked of them where they are tried.
const OUTLIER: f64 = 3.0;

/// Where within an epoch an event of the encoder is tried besides its middle, in epochs from there.
const WITHIN_EPOCH: [f64; 2] = [-0.3, 0.3];

/// Innovations of so many epochs in a row are taken together: a step that one of them does not show stands out of some.
const TOGETHER: [usize; 8] = [1, 2, 4, 8, 16, 32, 64, 128];

impl Case<'_> {
    /// The terms that have a frequency, an order of no known cause, and events, where the innovations are strongest.
    pub(crate) fn suggested(&self, present: &Fit, jolts: &Jolts) -> Vec<Candidate> {
        let mut list = Vec::new();
        for run in 0..self.runs.len() {
            let innovations = present.innovations(run);
            let motion = TableMotion::of(&present.linear[run]);
            let left = Remainder { innovations: &innovations, motion: &motion };
            let count = innovations.len() as f64;
            let length = count * motion.epoch;
            // What sways the base is a line in the axis frame, what disturbs a sensor one in the body.
            let in_body = left.in_body();
            let body = Remainder { innovations: &in_body, ..left };
            list.extend(left.strongest_order(&in_body).map(|(order, step, looks)| {
                let mut chosen = TermInstance::new(&IN_ANGLE).estimated();
                chosen.settings[0] = order;
                Candidate { chosen, looks, step: Some((0, step)), departs: None }
            }));
            list.extend(body.every_turn().and_then(|find| {
                let chosen = on_channel(find.channel)?;
                Some(Candidate { chosen, looks: CHANNELS as f64, step: None, departs: None })
            }));
            list.extend(self.high_harmonics(present, run));
            list.extend(self.events([&innovations, &in_body], present, run, jolts));
            // What comes back less often is a drift.
            let slowest = FEWEST_CYCLES / length;
            let frequencies =
                left.strongest_lines(SLOW).into_iter().chain(body.strongest_lines(SLOW));
            for frequency in frequencies {
                let at = at_frequency(frequency).into_iter();
                for chosen in at.filter(|line| frequency > slowest && self.shows(run, line)) {
                    // Half an independent frequency is the distance of those that were looked at, in two frames.
                    let step = Some((0, 0.5 / length));
                    list.push(Candidate { chosen, looks: LOOKS * count, step, departs: None });
                }
            }
        }
        list
    }

    /// Whether a line can be told from the table's motion: about an axis that only a command tells of it cannot.
    fn shows(&self, run: usize, line: &TermInstance) -> bool {
        let commanded = matches!(self.runs[run].rig.reference, Reference::Command { .. });
        !commanded || line.setting(SettingKind::Axis).is_none_or(|axis| axis < 3.0)
    }

    /// Every event where the innovations of some epochs, in the axis frame or in the body, are largest together: what is
    /// over in an instant shows in one or a few of them only, what the noise swallows until it has gone along with it.
    fn events(
        &self,
        innovations: [&[SVector<f64, CHANNELS>]; 2],
        present: &Fit,
        run: usize,
        jolts: &Jolts,
    ) -> Vec<Candidate> {
        let linear = &present.linear[run];
        let ends = linear.ends();
        let begin = linear.track().start();
        let epoch = linear.mean_epoch();
        let outliers = outliers(innovations);
        let count = innovations[0].len() as f64;
        let mut list = Vec::new();
        for chosen in terms(self.runs).map(|term| TermInstance::new(term).estimated()) {
            let Some(place) = chosen.term.setting(SettingKind::Time) else { continue };
            let earlier = list.len();
            for outlier in &outliers {
                let mut chosen = chosen.clone();
                let within = ends[outlier.start] - begin - 0.5 * epoch;
                chosen.settings[place] = within;
                if chosen.term.is(&catalogue::BASE_TILT_STEP) {
                    jolts.pin(&mut chosen);
                }
                let step = 2.0 * outlier.len() as f64 * epoch;
                list.push(Candidate {
                    chosen,
                    looks: count,
                    step: Some((place, step)),
                    departs: None,
                });
            }
            if chosen.term.needs.contains(&Need::TableAngle) {
                // An encoder tells the moment within an epoch.
                let beside = |middle: &Candidate| {
                    WITHIN_EPOCH.map(|part| {
                        let mut other = middle.clone();
                        other.chosen.settings[place] += part * epoch;
                        other
                    })
                };
                let beside: Vec<Candidate> = list[earlier..].iter().flat_map(beside).collect();
                list.extend(beside);
                list.extend(jolts.jumps(run).iter().map(|&time| {
                    let mut chosen = chosen.clone();
                    chosen.settings[place] = time;
                    Candidate {
                        chosen,
                        looks: linear.track().len() as f64,
                        step: None,
                        departs: None,
                    }
                }));
            }
        }
        list
    }
}

/// The epochs, one or some in a row, whose innovations are largest together in one channel.
fn outliers(innovations: [&[SVector<f64, CHANNELS>]; 2]) -> Vec<Range<usize>> {
    let mut found: Vec<(f64, Range<usize>)> = Vec::new();
    for innovations in innovations {
        let mut sums = vec![SVector::<f64, CHANNELS>::zeros()];
        for innovation in innovations {
            sums.push(sums[sums.len() - 1] + innovation);
        }
        for width in TOGETHER {
            for first in 0..(innovations.len() + 1).saturating_sub(width) {
                let size = (sums[first + width] - sums[first]).amax() / (width as f64).sqrt();
                if size > OUTLIER {
                    found.push((size, first..first + width));
                }
            }
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut outliers: Vec<Range<usize>> = Vec::new();
    for (_, range) in found {
        let apart = |other: &Range<usize>| range.start >= other.end || other.start >= range.end;
        if outliers.len() < OUTLIERS && outliers.iter().all(apart) {
            outliers.push(range);
        }
    }
    outliers
}

/// Every term that has a frequency, at this one.
pub(crate) fn at_frequency(frequency: f64) -> Vec<TermInstance> {
    let with = |term: &'static Term| {
        TermInstance::new(term).estimated().with_setting(SettingKind::Frequency, frequency)
    };
    let line = || with(&catalogue::INTERFERENCE_LINE);
    let axes = [1.0, 2.0, 3.0].map(|axis| line().with_setting(SettingKind::Axis, axis));
    axes.into_iter().chain([with(&catalogue::BASE_SWAY)]).collect()
}

impl Remainder<'_> {
    /// The order at which most is left on a sensor, the step to the next that was looked at, and how many there were.
    fn strongest_order(&self, in_body: &[SVector<f64, CHANNELS>]) -> Option<(f64, f64, f64)> {
        let (step, count) = self.orders()?;
        let find = self.order(in_body)?;
        let Structure::Order(order) = find.structure else { return None };
        Some((order.abs(), step, 2.0 * count))
    }

    /// The frequencies at which most is left \[Hz\], strongest first.
    fn strongest_lines(&self, count: usize) -> Vec<f64> {
        let spectrum = self.spectrum(0, self.innovations.len());
        let total = |bin: usize| spectrum[bin].iter().sum::<f64>();
        let mut peaks: Vec<usize> = (1..spectrum.len().saturating_sub(1))
            .filter(|&bin| total(bin) >= total(bin - 1) && total(bin) >= total(bin + 1))
            .collect();
        peaks.sort_by(|a, b| total(*b).total_cmp(&total(*a)));
        peaks.truncate(count);
        // A line that falls between two bins loses a fifth of its square in either.
        let summit = |bin: usize| bin as f64 + summit([total(bin - 1), total(bin), total(bin + 1)]);
        let lines =
            peaks.into_iter().map(|bin| self.frequency(summit(bin), self.innovations.len()));
        lines.collect()
    }
}

/// Where the parabola through a peak and its two neighbours is highest, in steps from the peak: within half of one.
fn summit([before, peak, after]: [f64; 3]) -> f64 {
    let bend = 2.0 * peak - before - after;
    if bend > 0.0 { 0.5 * (after - before) / bend } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rins_testing::assert_close;

    #[test]
    fn a_line_between_two_bins_is_found_where_it_is() {
        for periods in [20.0, 20.1, 20.25, 20.4, 20.5] {
            let innovations: Vec<SVector<f64, CHANNELS>> = (0..400)
                .map(|epoch| {
                    let phase = std::f64::consts::TAU * periods * f64::from(epoch) / 400.0;
                    SVector::from_fn(|row, _| (phase + row as f64).sin())
                })
                .collect();
            let still = vec![0.0; innovations.len()];
            let motion = TableMotion { angles: still.clone(), rates: still, epoch: 1.0 / 400.0 };
            let left = Remainder { innovations: &innovations, motion: &motion };
            let found = left.strongest_lines(1);
            assert_close!(found[0], periods, 0.03);
        }
    }

    #[test]
    fn a_step_that_no_epoch_shows_by_itself_stands_out_of_some() {
        let mut innovations: Vec<SVector<f64, CHANNELS>> = (0..300)
            .map(|epoch| SVector::from_fn(|row, _| (f64::from(epoch) * 1.7 + row as f64).sin()))
            .collect();
        assert!(outliers([&innovations, &[]]).is_empty());
        for innovation in &mut innovations[120..128] {
            innovation[2] += 3.0;
        }
        let found = outliers([&innovations, &[]]);
        assert!(found[0].start.abs_diff(120) <= 2, "{found:?}");
    }
}
