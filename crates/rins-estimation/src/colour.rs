//! Colored noise: bias instability and random walk as sums of first-order Gauss-Markov processes.

use crate::noise_parameters::TriadStrengths;

/// The ratio of successive correlation times of the processes that represent flicker noise: the power spectral density
/// deviates by 4 %, whereas a bias instability is rarely known to 20 %.
const LADDER: f64 = 8.0;

/// The largest correlation time relative to the run: longer ones are a constant bias, which is a parameter.
const LONGEST: f64 = 4.0;

/// A first-order Gauss-Markov process, one for each axis of a triad: `b' = -b/τ + white noise`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Process {
    /// The correlation time τ \[s\]; infinite for a random walk.
    time: f64,
    /// The variance of `b`; for a random walk, its increase per second.
    strength: f64,
}

/// The exact transition of a process over an epoch.
///
/// For `b` at the start of the epoch, the value at the end is `decay · b`, the integral is `mean · b` times the duration, and
/// the mean over time of the running integral is `half_mean · b` times half the duration. Each has a random part: those of
/// the end value, of the integral and of the integral's mean have these covariances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Passage {
    pub(crate) decay: f64,
    pub(crate) mean: f64,
    pub(crate) half_mean: f64,
    pub(crate) end: f64,
    pub(crate) end_integral: f64,
    pub(crate) end_half: f64,
    pub(crate) integral: f64,
    pub(crate) integral_half: f64,
    pub(crate) half: f64,
}

/// Nodes and weights of ten-point Gauss-Legendre quadrature on [-1, 1].
const GAUSS: [(f64, f64); 5] = [
    (0.14887433898163122, 0.29552422471475287),
    (0.4333953941292472, 0.26926671930999635),
    (0.6794095682990244, 0.21908636251598204),
    (0.8650633666889845, 0.1494513491505806),
    (0.9739065285171717, 0.06667134430868814),
];

impl Process {
    /// The variance at the start of a run.
    ///
    /// A random walk starts at zero: the turn-on bias is a parameter.
    pub(crate) fn initial_variance(&self) -> f64 {
        if self.time.is_finite() { self.strength } else { 0.0 }
    }

    /// The covariance of the values at two times that are `apart`, the earlier of which is `since` after the start of a walk
    /// \[s\].
    pub(crate) fn covariance(&self, apart: f64, since: f64) -> f64 {
        if self.time.is_finite() {
            self.strength * (-apart / self.time).exp()
        } else {
            self.strength * since
        }
    }

    /// The response to a unit impulse after `elapsed` \[s\], its integral, and the integral of that.
    fn response(&self, elapsed: f64) -> [f64; 3] {
        if self.time.is_infinite() {
            return [1.0, elapsed, 0.5 * elapsed * elapsed];
        }
        let x = elapsed / self.time;
        // x - 1 + exp(-x), by series where it would cancel.
        let twice = if x < 1e-2 {
            x * x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x / 120.0)))
        } else {
            x + (-x).exp_m1()
        };
        [(-x).exp(), -(-x).exp_m1() * self.time, twice * self.time * self.time]
    }

    /// The transition over `interval` \[s\].
    pub(crate) fn passage(&self, interval: f64) -> Passage {
        let density =
            if self.time.is_infinite() { self.strength } else { 2.0 * self.strength / self.time };
        let mut products = [[0.0; 3]; 3];
        for (node, weight) in
            GAUSS.iter().flat_map(|&(node, weight)| [(node, weight), (-node, weight)])
        {
            let mut response = self.response(0.5 * interval * (1.0 + node));
            response[2] /= interval;
            let weight = density * 0.5 * interval * weight;
            for (row, one) in response.iter().enumerate() {
                for (column, other) in response.iter().enumerate() {
                    products[row][column] += weight * one * other;
                }
            }
        }
        let [decay, integral, twice] = self.response(interval);
        Passage {
            decay,
            mean: integral / interval,
            half_mean: twice / interval / (0.5 * interval),
            end: products[0][0],
            end_integral: products[0][1],
            end_half: products[0][2],
            integral: products[1][1],
            integral_half: products[1][2],
            half: products[2][2],
        }
    }
}

/// The processes of a triad, and the noise density of those that are white at the epochs' resolution.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Colours {
    pub(crate) processes: Vec<Process>,
    /// The addition to the power spectral density of white noise \[per Hz\].
    pub(crate) white: f64,
}

impl Colours {
    /// The processes for a run of `duration` in epochs of `epoch` \[s\].
    ///
    /// Flicker noise of power spectral density `B²/2πf` is the sum of processes whose correlation times have the ratio `r`,
    /// each of variance `B² ln r / π`. Processes faster than an epoch are white at the epochs' resolution.
    pub(crate) fn of(strengths: &TriadStrengths, epoch: f64, duration: f64) -> Self {
        let mut colours = Self::default();
        if strengths.flicker > 0.0 {
            let variance =
                strengths.flicker * strengths.flicker * LADDER.ln() / std::f64::consts::PI;
            let mut time = 0.75 * epoch;
            // The faster processes: 2 σ² (τ/4 + τ/16 + ...).
            colours.white = 2.0 * variance * time / (LADDER - 1.0);
            while time < LONGEST * duration {
                colours.processes.push(Process { time, strength: variance });
                time *= LADDER;
            }
        }
        if strengths.walk > 0.0 {
            let strength = strengths.walk * strengths.walk;
            colours.processes.push(Process { time: f64::INFINITY, strength });
        }
        colours
    }

    /// The processes that a run of `duration` \[s\] does not have, and the random walk.
    pub(crate) fn slower_than(&self, duration: f64) -> Vec<Process> {
        self.processes
            .iter()
            .filter(|process| process.time >= LONGEST * duration)
            .copied()
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rins_testing::assert_close;

    /// Two successive transitions equal one of twice the duration.
    #[test]
    fn two_short_passages_make_a_long_one() {
        for time in [0.3, 2.0, 500.0, f64::INFINITY] {
            let process = Process { time, strength: 2.5 };
            let (one, long) = (process.passage(0.25), process.passage(0.5));
            let gain = one.mean * 0.25;
            let half_gain = one.half_mean * 0.125;
            assert_close!(one.decay * one.decay, long.decay, 1e-14);
            assert_close!(0.5 * (one.mean + one.decay * one.mean), long.mean, 1e-13);
            // The mean over both halves: that of the first, and that of the second added to the end value of the first.
            let half = 0.5 * (half_gain + gain + one.decay * half_gain);
            assert_close!(half, long.half_mean * 0.25, 1e-13);
            let close = |got: f64, want: f64| assert_close!(got, want, 1e-9 * want);
            close(one.end * (1.0 + one.decay * one.decay), long.end);
            close(
                2.0 * one.integral + gain * gain * one.end + 2.0 * gain * one.end_integral,
                long.integral,
            );
            close(
                one.end_integral * (1.0 + one.decay) + gain * one.decay * one.end,
                long.end_integral,
            );
            // The end after both: decay n₁ + n₂; the mean: (j₁ + i₁ + h n₁ + j₂) / 2.
            let end_half = 0.5
                * (one.decay * (one.end_half + one.end_integral + half_gain * one.end)
                    + one.end_half);
            close(end_half, long.end_half);
        }
    }

    #[test]
    fn ladder_has_the_density_of_flicker() {
        let strengths = TriadStrengths { flicker: 3.0, ..TriadStrengths::default() };
        let (epoch, duration) = (0.5, 1000.0);
        let colours = Colours::of(&strengths, epoch, duration);
        for frequency in [2e-3, 1e-2, 0.05, 0.2_f64] {
            let w = std::f64::consts::TAU * frequency;
            let of = |p: &Process| 2.0 * p.strength * p.time / (1.0 + w * w * p.time * p.time);
            let density: f64 = colours.processes.iter().map(of).sum::<f64>() + colours.white;
            // Two-sided: half of B²/2πf. The ripple of the sum is 3 %.
            assert_close!(density * w / 9.0, 1.0, 0.1);
        }
    }
}
