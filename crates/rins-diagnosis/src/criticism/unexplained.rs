//! What no effect of the catalogue explains: found, described, and given no name.

use rins_bayes::ln_tail;
use rins_estimation::{Estimate, Evidence, Fit, Indefinite};
use rins_terms::{Term, TermInstance, Unit, catalogue};

use crate::case::Case;
use crate::criticism::periodic::modulated;
use crate::criticism::structure::{Remainder, Stratum, Structure, TableMotion, groups};
use crate::diagnosis::FALSE_ALARMS;
use crate::evidence::survey::Survey;
use crate::generic::disturbance::{CHANNELS, IN_ANGLE, IN_TIME};
use crate::generic::waveform::{WAVEFORM_ORDERS, channel_of};
use crate::proposal::candidates::Candidate;
use crate::verdict::cause::Cause;

/// What the shown quantities of an epoch are called, in the axis frame.
const SHOWN: [&str; 6] =
    ["attitude.x", "attitude.y", "attitude.z", "velocity.x", "velocity.y", "velocity.z"];

/// The figures that the paper is about.
static OF_INTEREST: [(&Term, &str); 3] = [
    (&catalogue::GYRO_MISALIGNMENT, "xz"),
    (&catalogue::GYRO_MISALIGNMENT, "yz"),
    (&catalogue::GYRO_SCALE, "z"),
];

/// The steps of either triad's biases, by what its channels begin with.
static STEPS: [(&str, &Term); 2] =
    [("gyro.", &catalogue::GYRO_BIAS_STEP), ("accel.", &catalogue::ACCEL_BIAS_STEP)];

/// In so many ways something is looked for: structure in what is shown, sensors that are noisier, heavy tails, causes that
/// change, and biases that switch. They share the false alarms.
const WAYS: f64 = 5.0;

/// A part of a run of fewer epochs is none.
const LEAST_PART: usize = 20;

/// Something that no effect explains.
#[derive(Clone, Debug, PartialEq)]
pub struct Unexplained {
    /// In which run, from zero.
    pub run: usize,
    /// On what it shows: a sensor, the encoder, or a quantity of the axis frame.
    pub channel: &'static str,
    /// What it looks like.
    pub structure: Structure,
    /// The effect that is not the same all along, if that is what was found.
    pub of: Option<&'static str>,
    /// The logarithm of the probability of anything like it by chance.
    pub ln_p: f64,
    /// How large it is, in SI units, if it is a signal.
    pub amplitude: Option<(f64, Unit)>,
    /// By how much it may have put `M_xz`, `M_yz` and `S_z` off at worst, in SI units, of those that are estimated.
    pub worst: Vec<(String, f64)>,
}

impl Case<'_> {
    /// What is left when all causes are in the model.
    pub(crate) fn unexplained(
        &self,
        (before, after): (&Fit, &Fit),
        causes: &[Cause],
    ) -> Result<Vec<Unexplained>, Indefinite> {
        let threshold = FALSE_ALARMS.ln() - 2.0_f64.ln() - (self.runs.len() as f64).ln();
        let mut found = Vec::new();
        for run in 0..self.runs.len() {
            let mut innovations = after.innovations(run);
            let motion = TableMotion::of(&after.linear[run]);
            let of_sensors = Remainder { innovations: &innovations, motion: &motion };
            let noisier = of_sensors.noisier().filter(|find| find.ln_p < threshold);
            if noisier.is_some() {
                innovations = of_sensors.evened();
            }
            let finds = Remainder { innovations: &innovations, motion: &motion }.finds();
            let is_signal = |structure| {
                is_steady(structure)
                    || matches!(structure, Structure::Chirp(..) | Structure::EveryTurn(_))
            };
            // The strongest signal, and the strongest of what is none: each is seen in many ways.
            let strongest = [true, false].map(|signal| {
                let strongest = finds.iter().find(|find| is_signal(find.structure) == signal);
                strongest.filter(|find| find.ln_p < threshold).copied()
            });
            for find in strongest.into_iter().chain([noisier]).flatten() {
                let names = if find.is_in_body() { &CHANNELS[..] } else { &SHOWN };
                let mut one = Unexplained {
                    run,
                    channel: names[find.channel],
                    structure: find.structure,
                    of: None,
                    ln_p: find.ln_p,
                    amplitude: None,
                    worst: Vec::new(),
                };
                if is_steady(find.structure) {
                    self.measure(&mut one, after, motion.epoch * innovations.len() as f64)?;
                }
                found.push(one);
            }
        }
        for run in 0..self.runs.len() {
            let known = |one: &Unexplained| {
                one.run == run && one.structure == Structure::Tails && is_significant(one)
            };
            if !found.iter().any(known) {
                // What a cause puts into single samples, such as the steps of a thermometer, is no noise.
                found
                    .extend(self.tails(before, run, &[]).and_then(|_| self.tails(after, run, &[])));
            }
        }
        found.extend(self.inconstant(after, causes)?);
        let mut switching = self.switching(after, 0.0)?;
        if switching.is_empty() && !causes.is_empty() {
            let explained = after.log_likelihood - before.log_likelihood;
            switching = self.switching(before, explained.max(0.0))?;
            // One that switches once has stepped, and a step was tried for every cause.
            switching.retain(|one| one.structure != Structure::Switching(1));
        }
        // A bias that switches once is one that stepped.
        let stepped = |channel: &str| {
            let step = STEPS.iter().find(|(triad, _)| channel.starts_with(triad));
            step.is_some_and(|(_, step)| causes.iter().any(|cause| cause.term.is(step)))
        };
        switching.retain(|one| one.structure != Structure::Switching(1) || !stepped(one.channel));
        found.extend(switching);
        let is_described = found.iter().any(is_significant);
        found.extend(self.waves(after, causes, is_described)?);
        found.extend(modulated(after, causes));
        found.retain(|left| is_significant(left) && !self.rounding.explains(left));
        let mut found = told_from_noise(found);
        // A few shocks look like outliers, and what else is left may look like shocks.
        if found.iter().all(|left| left.structure == Structure::Tails) {
            for run in 0..self.runs.len() {
                let Some((shock, samples)) = self.shocks(after, run) else { continue };
                // Noise that has heavy tails has them without the largest of its outliers too.
                if self.tails(after, run, &samples).is_none() {
                    found.retain(|left| left.run != run);
                    found.push(shock);
                }
            }
        }
        found.sort_by(|a, b| a.ln_p.total_cmp(&b.ln_p));
        Ok(found)
    }

    /// On which channel a signal is, how large it is there, and what harm it may do.
    fn measure(&self, one: &mut Unexplained, after: &Fit, duration: f64) -> Result<(), Indefinite> {
        let (term, setting) = match one.structure {
            Structure::Line(frequency) => (&IN_TIME, frequency),
            Structure::Order(order) => (&IN_ANGLE, order),
            _ => (&IN_TIME, 1.0 / duration),
        };
        let mut chosen = TermInstance::new(term).estimated();
        chosen.settings[0] = setting;
        let list = [Candidate { chosen, looks: 1.0, step: None, departs: None }];
        let noises = std::slice::from_ref(&after.noise);
        let survey = self.survey(after, &list, noises)?;
        let Some(left) = survey.left(0, &[], &[]) else { return Ok(()) };
        let own = survey.of_candidate(0);
        let mut strongest = 0.0;
        for (channel, pair) in own.chunks_exact(2).enumerate() {
            let of_run = |parameter: &Vec<usize>| parameter[one.run.min(parameter.len() - 1)];
            let places: Vec<usize> = pair.iter().map(of_run).collect();
            let Some((estimate, statistic)) = left.estimate(&places) else { continue };
            if statistic > strongest {
                strongest = statistic;
                let parameter = &term.parameters[2 * channel];
                one.channel = CHANNELS[channel];
                one.amplitude = Some((estimate.norm() * parameter.sigma(self.imu), parameter.unit));
            }
        }
        one.worst = worst(after, strongest);
        Ok(())
    }

    /// The causes that are not the same all along.
    fn inconstant(&self, after: &Fit, causes: &[Cause]) -> Result<Vec<Unexplained>, Indefinite> {
        let ways = [Stratum::Time, Stratum::Sense, Stratum::Rate];
        // All of one term are asked together.
        let first = |(place, cause): &(usize, &Cause)| {
            causes[..*place].iter().all(|earlier| !earlier.term.is(cause.term))
        };
        let causes: Vec<&Cause> =
            causes.iter().enumerate().filter(first).map(|(_, cause)| cause).collect();
        let tests = (causes.len() * self.runs.len() * ways.len()) as f64;
        let mut found = Vec::new();
        for cause in causes {
            for run in 0..self.runs.len() {
                for along in ways {
                    let Some(ln_p) = self.change(after, cause, run, along)? else { continue };
                    let ln_p = ln_p + tests.ln();
                    if ln_p < FALSE_ALARMS.ln() {
                        found.push(Unexplained {
                            run,
                            channel: "all",
                            structure: Structure::Inconstant(along),
                            of: Some(cause.term.id),
                            ln_p,
                            amplitude: None,
                            worst: Vec::new(),
                        });
                    }
                }
            }
        }
        Ok(found)
    }

    /// The logarithm of the chance that a cause differs as much from one part of a run to another.
    fn change(
        &self,
        after: &Fit,
        cause: &Cause,
        run: usize,
        along: Stratum,
    ) -> Result<Option<f64>, Indefinite> {
        let linear = &after.linear[run];
        let mut groups = groups(along, &TableMotion::of(linear).rates);
        let last = compact(&mut groups);
        let of_run = self.of_run(after, run);
        let own: Vec<usize> = (0..of_run.len())
            .filter(|&place| {
                let parameter = &of_run[place].parameter;
                after.models[run].terms[parameter.term].term.is(cause.term)
            })
            .collect();
        if last == 0 || own.is_empty() {
            return Ok(None);
        }
        let apart = linear.in_groups(&own, &groups, last);
        let evidence = Evidence::of(&apart, &after.noise[run])?;
        let own_scale = |&place: &usize| of_run[place].value.abs() + 3.0 * of_run[place].sigma;
        let scales = (0..last).flat_map(|_| own.iter().map(own_scale));
        let survey = Survey::of_evidence(&evidence, &of_run, scales);
        let left = survey.left(0, &[], &[]);
        let statistic = left.map(|left| left.statistic_of_all()).filter(|(_, dof)| *dof > 0);
        Ok(statistic.map(|(statistic, dof)| ln_tail(statistic, dof)))
    }

    /// The estimates that hold for a run, in the order of its model.
    pub(crate) fn of_run<'a>(&self, fit: &'a Fit, run: usize) -> Vec<&'a Estimate> {
        let holds = |estimate: &&Estimate| estimate.run.is_none_or(|own| own == run);
        let free = fit.models[run].free(self.imu);
        let of = |id: &str| fit.parameters.iter().filter(holds).find(|e| e.parameter.id == id);
        free.iter().filter_map(|parameter| of(&parameter.id)).collect()
    }
}

/// A disturbance that had to be put into the model beside the causes, for want of one.
pub(crate) fn described(cause: &Cause, after: &Fit) -> Unexplained {
    let of = |channel: usize, estimate: &Estimate| estimate.parameter.parameter / 2 == channel;
    let mut one = Unexplained {
        run: 0,
        channel: CHANNELS[0],
        structure: Structure::Order(cause.settings[0]),
        of: None,
        ln_p: cause.ln_p,
        amplitude: None,
        worst: worst(after, 2.0 * cause.gain),
    };
    if let Some(channel) = channel_of(cause.term, &cause.settings) {
        one.channel = CHANNELS[channel];
        one.structure = Structure::EveryTurn(WAVEFORM_ORDERS);
        let square: f64 = cause.parameters.iter().map(|estimate| estimate.value.powi(2)).sum();
        let first = cause.parameters.first();
        one.amplitude = first.map(|estimate| (square.sqrt(), estimate.parameter.unit));
        one.run = first.and_then(|estimate| estimate.run).unwrap_or_default();
        return one;
    }
    let mut strongest = 0.0;
    for (channel, name) in CHANNELS.iter().enumerate() {
        let own = cause.parameters.iter().filter(|estimate| of(channel, estimate));
        let (mut square, mut sigmas, mut unit) = (0.0, 0.0_f64, None);
        for estimate in own {
            square += estimate.value.powi(2);
            sigmas += (estimate.value / estimate.sigma).powi(2);
            unit = Some(estimate.parameter.unit);
            one.run = estimate.run.unwrap_or_default();
        }
        if sigmas > strongest {
            strongest = sigmas;
            one.channel = name;
            one.amplitude = unit.map(|unit| (square.sqrt(), unit));
        }
    }
    one
}

/// How far a disturbance of this square may have put off what is of interest: no estimate by more of its own sigmas
/// than the disturbance has.
pub(crate) fn worst(after: &Fit, statistic: f64) -> Vec<(String, f64)> {
    let of = |(term, name): &(&Term, &str)| {
        let id = format!("{}.{name}", term.id);
        let sigma = after.parameter(&id)?.sigma;
        Some((id, sigma * statistic.sqrt()))
    };
    OF_INTEREST.iter().filter_map(of).collect()
}

/// Without what is another of the same sensor: a bias that switches and noise with heavy tails spread more than the other sensor
/// of a kind, and noise that is larger looks like them. What is least likely by chance stays.
fn told_from_noise(mut found: Vec<Unexplained>) -> Vec<Unexplained> {
    let scatters =
        |one: &Unexplained| matches!(one.structure, Structure::Switching(_) | Structure::Tails);
    let is_noisier = |one: &Unexplained| matches!(one.structure, Structure::Noisier(_));
    let all = found.clone();
    found.retain(|one| {
        let other = |other: &&Unexplained| {
            (one.run, one.channel) == (other.run, other.channel)
                && (is_noisier(one) && scatters(other) || scatters(one) && is_noisier(other))
        };
        all.iter().filter(other).all(|other| one.ln_p <= other.ln_p)
    });
    found
}

/// Whether chance makes nothing like it, of all ways in which something is looked for.
fn is_significant(left: &Unexplained) -> bool {
    left.ln_p < (FALSE_ALARMS / WAYS).ln()
}

/// Whether it is a signal of one shape all along, whose size can be told.
fn is_steady(structure: Structure) -> bool {
    matches!(structure, Structure::Line(_) | Structure::Order(_) | Structure::Drift)
}

/// Leaves out groups of few epochs, and numbers the others from zero; the last number.
fn compact(groups: &mut [usize]) -> usize {
    let most = groups.iter().max().map_or(0, |most| most + 1);
    let mut counts = vec![0; most];
    for &group in &*groups {
        counts[group] += 1;
    }
    let large: Vec<usize> = (0..most).filter(|&group| counts[group] >= LEAST_PART).collect();
    for group in &mut *groups {
        *group = large.iter().position(|one| one == group).unwrap_or(0);
    }
    large.len().saturating_sub(1)
}
