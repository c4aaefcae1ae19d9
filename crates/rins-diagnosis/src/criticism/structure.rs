//! What whitened innovations still hold: lines, orders of the table angle, unequal spread, heavy tails.

use nalgebra::SVector;
use rayon::prelude::*;
use rins_bayes::ln_tail;
use rins_estimation::Linear;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

/// The shown quantities of an epoch: three of attitude, three of velocity, in the axis frame.
pub(crate) const CHANNELS: usize = 6;

/// The spectrum is taken at so many times the frequencies that are independent, so that no line falls between two.
const FINER: usize = 2;

/// The highest order of the table angle that is looked for.
const HIGHEST_ORDER: f64 = 24.0;

/// A run is also looked at in so many parts, for what comes and goes.
const PARTS: usize = 3;

/// So many epochs times ways of changing a frequency are looked at: in a run of a day, slow changes only.
const MOST_CHANGES: usize = 400_000;

/// A shape that is left in the innovations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Structure {
    /// A line of this frequency \[Hz\].
    Line(f64),
    /// A line whose frequency goes from one to another, evenly \[Hz\].
    Chirp(f64, f64),
    /// This order of the table angle, in body axes; negative where it goes against the table.
    Order(f64),
    /// This order of the table angle, which comes and goes.
    Modulated(f64),
    /// Something slower than three times in the run.
    Drift,
    /// Lines whose frequencies are multiples of this one \[Hz\]: it comes back, and is no sine.
    Waveform(f64),
    /// Harmonic orders of the table angle up to this one together, in body axes: it repeats every revolution, and is no sine.
    EveryTurn(u32),
    /// A bias that switches between two levels, so many times.
    Switching(usize),
    /// A spread that is not the same all along.
    Spread(Stratum),
    /// A sensor whose noise is so many times that of the other one of its kind across the axis.
    Noisier(f64),
    /// More large innovations than normal ones have.
    Tails,
    /// So many shocks, the strongest of them at this time \[s\] of the run.
    Shocks(usize, f64),
    /// An effect that was named, and is not the same all along.
    Inconstant(Stratum),
}

/// What changes along a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stratum {
    /// Thirds of the time.
    Time,
    /// The sense in which the table turns.
    Sense,
    /// The magnitude of its rate.
    Rate,
}

/// Something that was found in one run's innovations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Find {
    /// What.
    pub(crate) structure: Structure,
    /// The shown quantity in which it is strongest.
    pub(crate) channel: usize,
    /// The logarithm of the probability of anything like it by chance, over all that was looked at here.
    pub(crate) ln_p: f64,
}

impl Find {
    /// Whether it was found in body axes, so that its channel is a sensor.
    pub(crate) const fn is_in_body(&self) -> bool {
        matches!(self.structure, Structure::EveryTurn(_) | Structure::Noisier(_))
    }
}

/// How the table moved during a run, epoch by epoch.
pub(crate) struct TableMotion {
    /// The table angle in the middle of each epoch \[rad\].
    pub(crate) angles: Vec<f64>,
    /// The table's rate \[rad/s\].
    pub(crate) rates: Vec<f64>,
    /// The length of an epoch \[s\].
    pub(crate) epoch: f64,
}

impl TableMotion {
    pub(crate) fn of(linear: &Linear) -> Self {
        let (angles, rates) = linear.motion().into_iter().unzip();
        Self { angles, rates, epoch: linear.mean_epoch() }
    }
}

/// The innovations of a run, and where the table was.
#[derive(Clone, Copy)]
pub(crate) struct Remainder<'a> {
    /// Whitened, an epoch each.
    pub(crate) innovations: &'a [SVector<f64, CHANNELS>],
    pub(crate) motion: &'a TableMotion,
}

impl Remainder<'_> {
    /// Everything that is looked for, most significant first.
    pub(crate) fn finds(&self) -> Vec<Find> {
        let in_body = self.in_body();
        let body = Remainder { innovations: &in_body, ..*self };
        let ways: [&(dyn Fn() -> Option<Find> + Sync); _] = [
            &|| Some(self.tails()),
            &|| self.line(),
            &|| body.line(),
            &|| self.chirp(),
            &|| body.chirp(),
            &|| self.order(&in_body),
            &|| body.every_turn(),
            &|| Some(self.spread(Stratum::Time)),
            &|| Some(self.spread(Stratum::Sense)),
            &|| Some(self.spread(Stratum::Rate)),
        ];
        let mut finds: Vec<Find> = ways.par_iter().filter_map(|way| way()).collect();
        let kinds = finds.len() as f64;
        for find in &mut finds {
            find.ln_p = (find.ln_p + kinds.ln()).min(0.0);
        }
        finds.sort_by(|a, b| a.ln_p.total_cmp(&b.ln_p));
        finds
    }

    /// The innovations turned into body axes.
    pub(crate) fn in_body(&self) -> Vec<SVector<f64, CHANNELS>> {
        let each = self.innovations.iter().zip(&self.motion.angles);
        each.map(|(nu, angle)| turned(nu, *angle)).collect()
    }

    /// The strongest line of any frequency, all along or in a part of the run.
    fn line(&self) -> Option<Find> {
        let n = self.innovations.len();
        let whole = [(0, n)];
        let parts: Vec<(usize, usize)> =
            (0..PARTS).map(|part| (part * n / PARTS, (part + 1) * n / PARTS)).collect();
        let mut best: Option<Find> = None;
        for spans in [&whole[..], &parts[..]] {
            for &(first, end) in spans {
                let length = end - first;
                if length < 8 {
                    continue;
                }
                let power = self.spectrum(first, end);
                let looks = (power.len() * spans.len()) as f64;
                let longest = n as f64 * self.motion.epoch;
                for (bin, power) in power.iter().enumerate().skip(1) {
                    let frequency = self.frequency(bin as f64, length);
                    let slow = frequency * longest < 3.0;
                    let structure =
                        if slow { Structure::Drift } else { Structure::Line(frequency) };
                    let find = of_bin(structure, looks, power);
                    if best.is_none_or(|best| find.ln_p < best.ln_p) {
                        best = Some(find);
                    }
                }
            }
        }
        best
    }

    /// The strongest line whose frequency changes evenly, from one end of the run to the other.
    fn chirp(&self) -> Option<Find> {
        let n = self.innovations.len();
        let count = n as f64;
        // By two periods of the run and more, up to the highest frequency there is.
        let steps = (n / 4).min(MOST_CHANGES / n.max(1));
        if steps == 0 {
            return None;
        }
        let fft = FftPlanner::new().plan_fft_forward(n);
        let growths = (1..=steps).flat_map(|step| [2.0, -2.0].map(|sign| sign * step as f64));
        let looks = count * 2.0 * steps as f64;
        let mut best: Option<Find> = None;
        for grown in growths {
            let mut power = vec![[0.0; CHANNELS]; n];
            for channel in 0..CHANNELS {
                let slowed = |(place, nu): (usize, &SVector<f64, CHANNELS>)| {
                    let part = place as f64 / count;
                    Complex::from_polar(nu[channel], -std::f64::consts::PI * grown * part * part)
                };
                let mut series: Vec<_> = self.innovations.iter().enumerate().map(slowed).collect();
                fft.process(&mut series);
                for (bin, value) in power.iter_mut().zip(series) {
                    bin[channel] = value.norm_sqr() / count;
                }
            }
            for (bin, power) in power.iter().enumerate() {
                let from = bin as f64;
                let to = from + grown;
                if to < 0.0 || from.max(to) > 0.5 * count {
                    continue;
                }
                let frequency = |periods: f64| periods / (count * self.motion.epoch);
                let find = of_bin(Structure::Chirp(frequency(from), frequency(to)), looks, power);
                if best.is_none_or(|best| find.ln_p < best.ln_p) {
                    best = Some(find);
                }
            }
        }
        best
    }

    /// The periodograms of all quantities over some epochs, bin by bin.
    pub(crate) fn spectrum(&self, first: usize, end: usize) -> Vec<[f64; CHANNELS]> {
        let mut power = vec![[0.0; CHANNELS]; FINER * (end - first) / 2];
        for channel in 0..CHANNELS {
            let series = self.innovations[first..end].iter().map(|nu| nu[channel]);
            for (bin, of_channel) in power.iter_mut().zip(periodogram(series.collect())) {
                bin[channel] = of_channel;
            }
        }
        power
    }

    /// The frequency of a bin of a spectrum over so many epochs, or of a place between two \[Hz\].
    pub(crate) fn frequency(&self, bin: f64, length: usize) -> f64 {
        bin / ((FINER * length) as f64 * self.motion.epoch)
    }

    /// The strongest order of the table angle: on a sensor, where both senses are one, or of a vector that turns.
    pub(crate) fn order(&self, in_body: &[SVector<f64, CHANNELS>]) -> Option<Find> {
        let (step, count) = self.orders()?;
        // On sensors, and of vectors in two senses.
        let looks = 3.0 * count;
        let mut best: Option<Find> = None;
        let mut place = 0.0;
        while place < count {
            place += 1.0;
            let order = step * place;
            let sensors = of_bin(Structure::Order(order), looks, &self.turning(in_body, order));
            let vectors = [order, -order].map(|order| self.vector(order, looks));
            for find in [sensors].into_iter().chain(vectors) {
                if best.is_none_or(|best| find.ln_p < best.ln_p) {
                    best = Some(find);
                }
            }
        }
        best
    }

    /// The step between the orders that are looked at, and how many there are; none if the table does not turn.
    pub(crate) fn orders(&self) -> Option<(f64, f64)> {
        let first = self.motion.angles.first()?;
        let most =
            self.motion.angles.iter().fold(0.0_f64, |most, angle| most.max((angle - first).abs()));
        let turns = most / std::f64::consts::TAU;
        if turns < 1.0 {
            return None;
        }
        let step = 0.5 / turns.max(2.0);
        let count = (self.highest_order() / step).floor();
        Some((step, count))
    }

    /// The highest order that epochs show where the table turns fastest.
    pub(crate) fn highest_order(&self) -> f64 {
        let fastest = self.motion.rates.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
        HIGHEST_ORDER.min(std::f64::consts::PI / (fastest * self.motion.epoch))
    }

    /// The power of an order of the table angle in each quantity.
    fn turning(&self, series: &[SVector<f64, CHANNELS>], order: f64) -> [f64; CHANNELS] {
        let mut sums = [Complex::new(0.0, 0.0); CHANNELS];
        for (nu, angle) in series.iter().zip(&self.motion.angles) {
            let turned = Complex::from_polar(1.0, -order * angle);
            for (sum, part) in sums.iter_mut().zip(nu.iter()) {
                *sum += turned * *part;
            }
        }
        sums.map(|sum| sum.norm_sqr() / series.len() as f64)
    }

    /// The power of a vector across the axis that turns with an order of the table angle: of attitude or of velocity.
    fn vector(&self, order: f64, looks: f64) -> Find {
        let mut sums = [Complex::new(0.0, 0.0); 2];
        for (nu, angle) in self.innovations.iter().zip(&self.motion.angles) {
            let turned = Complex::from_polar(1.0, -order * angle);
            sums[0] += Complex::new(nu[0], nu[1]) * turned;
            sums[1] += Complex::new(nu[3], nu[4]) * turned;
        }
        let n = self.innovations.len() as f64;
        let [attitude, velocity] = sums.map(|sum| sum.norm_sqr() / (2.0 * n));
        let (channel, power) = if attitude > velocity { (0, attitude) } else { (3, velocity) };
        // What stands still in the body has order one in the axis frame.
        let structure = Structure::Order(order - 1.0);
        Find { structure, channel, ln_p: (2.0 * looks).ln() - power }
    }

    /// Whether the spread is the same all along: the likelihood ratio of a variance for each group.
    fn spread(&self, along: Stratum) -> Find {
        let groups = groups(along, &self.motion.rates);
        let mut best = Find { structure: Structure::Spread(along), channel: 0, ln_p: 0.0 };
        for channel in 0..CHANNELS {
            let mut sums = vec![(0.0, 0.0); groups.iter().max().map_or(0, |most| most + 1)];
            for (nu, &group) in self.innovations.iter().zip(&groups) {
                sums[group].0 += 1.0;
                sums[group].1 += nu[channel] * nu[channel];
            }
            // A part of few epochs, such as a ramp, is left out.
            sums.retain(|(count, _)| *count > 20.0);
            let total = sums.iter().fold((0.0, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
            if sums.len() < 2 || total.1 <= 0.0 {
                continue;
            }
            let mean = total.1 / total.0;
            let statistic: f64 =
                sums.iter().map(|(count, sum)| count * (mean * count / sum).ln()).sum();
            let ln_p = ln_tail(statistic.max(0.0), sums.len() - 1) + (CHANNELS as f64).ln();
            if ln_p < best.ln_p {
                best = Find { channel, ln_p, ..best };
            }
        }
        best
    }

    /// Whether the largest innovation is larger than the largest of so many normal ones.
    fn tails(&self) -> Find {
        let mut best = Find { structure: Structure::Tails, channel: 0, ln_p: 0.0 };
        let figures = (self.innovations.len() * CHANNELS) as f64;
        for channel in 0..CHANNELS {
            let largest =
                self.innovations.iter().fold(0.0_f64, |most, nu| most.max(nu[channel].abs()));
            let ln_p = ln_tail(largest * largest, 1) + figures.ln();
            if ln_p < best.ln_p {
                best = Find { channel, ln_p, ..best };
            }
        }
        best
    }
}

/// Turned by an angle about the axis.
pub(crate) fn turned(nu: &SVector<f64, CHANNELS>, angle: f64) -> SVector<f64, CHANNELS> {
    let (sin, cos) = angle.sin_cos();
    let mut turned = *nu;
    for x in [0, 3] {
        turned[x] = nu[x] * cos + nu[x + 1] * sin;
        turned[x + 1] = nu[x + 1] * cos - nu[x] * sin;
    }
    turned
}

/// The group of each epoch.
pub(crate) fn groups(along: Stratum, rates: &[f64]) -> Vec<usize> {
    /// Rates that differ by less are one level \[rad/s\].
    const LEVEL: f64 = 0.02;
    let n = rates.len();
    let mut levels: Vec<f64> = Vec::new();
    rates
        .iter()
        .enumerate()
        .map(|(place, rate)| match along {
            Stratum::Time => PARTS * place / n,
            Stratum::Sense => usize::from(*rate < -LEVEL),
            Stratum::Rate => {
                let rate = rate.abs();
                levels.iter().position(|level| (level - rate).abs() < LEVEL).unwrap_or_else(|| {
                    levels.push(rate);
                    levels.len() - 1
                })
            }
        })
        .collect()
}

/// What a bin of the spectra shows, in one channel or in all.
fn of_bin(structure: Structure, looks: f64, power: &[f64; CHANNELS]) -> Find {
    let (channel, largest) = power
        .iter()
        .copied()
        .enumerate()
        .fold((0, 0.0), |most, one| if one.1 > most.1 { one } else { most });
    let alone = (looks * CHANNELS as f64).ln() - largest;
    let together = looks.ln() + ln_tail(2.0 * power.iter().sum::<f64>(), 2 * CHANNELS);
    // Two ways of looking.
    Find { structure, channel, ln_p: alone.min(together) + 2.0_f64.ln() }
}

/// The periodogram of white noise of variance one: exponential, with mean one.
fn periodogram(series: Vec<f64>) -> Vec<f64> {
    let n = series.len();
    let mut spectrum: Vec<Complex<f64>> =
        series.into_iter().map(|x| Complex::new(x, 0.0)).collect();
    spectrum.resize(FINER * n, Complex::new(0.0, 0.0));
    FftPlanner::new().plan_fft_forward(spectrum.len()).process(&mut spectrum);
    spectrum[..spectrum.len() / 2].iter().map(|value| value.norm_sqr() / n as f64).collect()
}
