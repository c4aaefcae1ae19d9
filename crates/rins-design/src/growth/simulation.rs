//! Strapdown navigation of a carried table with drawn errors, several draws side by side.

use nalgebra::{Matrix3, Vector3};
use rins_frames::{Body, Dcm};
use rins_imu::{ImuNoise, ImuNoiseSource, Seed, Span};
use rins_lanes::{Arch, Lane, Matrix, Real, Simd, Vector, WithSimd};
use rins_motion::{Mechanisation, VerticalChannel};
use rins_terms::Surroundings;

use super::sensitivity::{Affine, Sensitivity};
use super::voyage::NOISE_INTERVAL;
use super::{GrowthError, Voyage};

/// The errors of one simulated voyage.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    /// The error of each parameter \[SI units\].
    pub errors: Vec<f64>,
    /// The error `φ` of the initial attitude about east, north and up \[rad\].
    pub attitude: Vector3<f64>,
    /// The seed of its noise.
    pub seed: Seed,
}

/// What all draws have in common.
struct Simulation<'a> {
    voyage: &'a Voyage<'a>,
    draws: &'a [Draw],
    sensitivities: Vec<Sensitivity>,
    sources: Vec<ImuNoiseSource>,
    interval: f64,
    times: &'a [f64],
    progress: &'a (dyn Fn(usize) + Sync),
}

/// The draws that are navigated side by side.
struct Group<S: Simd> {
    navigators: Mechanisation<Lane<S>>,
    gyro: Readings<S>,
    accel: Readings<S>,
    /// The noise of each triad in one sample.
    noise: [Vector<Lane<S>>; 2],
}

/// The errors of a triad in each lane.
struct Readings<S: Simd> {
    constant: Vector<Lane<S>>,
    by_rate: Matrix<Lane<S>>,
    by_force: Matrix<Lane<S>>,
}

impl Voyage<'_> {
    /// The position errors east and north \[m\] of each draw at each of these times \[s\], by strapdown navigation in intervals of `interval`
    /// \[s\].
    ///
    /// Errors are the difference from the same navigation without errors. White noise and biases are drawn for every
    /// [`NOISE_INTERVAL`] and divided evenly among its samples. `progress` hears how many times are done. The result of a draw does not depend
    /// on the other draws.
    ///
    /// # Errors
    /// [`GrowthError`] if a time, the interval, a term or the noise is not as it must be.
    pub fn simulated(
        &self,
        draws: &[Draw],
        interval: f64,
        times: &[f64],
        progress: &(dyn Fn(usize) + Sync),
    ) -> Result<Vec<Vec<[f64; 2]>>, GrowthError> {
        super::check_times(times)?;
        if !(interval.is_finite() && interval > 0.0) {
            return Err(GrowthError::Time { time: interval });
        }
        let surroundings = Surroundings::new(self.table.station, self.table.mounting);
        let sensitivities = Sensitivity::of_each(self.model, self.parameters, &surroundings)?;
        let duration = times.last().copied().unwrap_or_default().max(NOISE_INTERVAL);
        let noise = ImuNoise { gyro: self.noise[0].clone(), accel: self.noise[1].clone() };
        let span = Span { interval: NOISE_INTERVAL.max(interval), duration };
        let sources = draws.iter().map(|draw| noise.source(&span, draw.seed));
        let sources = sources.collect::<Result<Vec<_>, _>>()?;
        let simulation =
            Simulation { voyage: self, draws, sensitivities, sources, interval, times, progress };
        Ok(Arch::new().dispatch(simulation))
    }
}

impl WithSimd for Simulation<'_> {
    type Output = Vec<Vec<[f64; 2]>>;

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it is compiled with the machine's instructions")]
    fn with_simd<S: Simd>(mut self, simd: S) -> Self::Output {
        let like = Lane::splat(simd, 0.0);
        let width = like.lanes();
        let table = self.voyage.table;
        let station = &table.station;
        let site = station.site;
        let first = table.state(0.0, &site);
        let start = [site.latitude, site.longitude, site.height];
        let mut reference = Mechanisation::new(
            start,
            Vector::from(first.velocity),
            Matrix::from(&first.nav_from_body),
            station,
            VerticalChannel::Held,
        );
        let mut groups: Vec<Group<S>> = self
            .draws
            .chunks(width)
            .map(|draws| {
                let of =
                    |lane: usize| draws.get(lane).map(|draw| attitude(draw, &first.nav_from_body));
                let attitudes: Vec<Matrix3<f64>> =
                    (0..width).map(|lane| of(lane).unwrap_or(first.nav_from_body)).collect();
                let attitude =
                    Matrix::from_fn(|row, column| like.each(|lane| attitudes[lane][(row, column)]));
                let sums: Vec<Sensitivity> = draws
                    .iter()
                    .map(|draw| Sensitivity::sum(&self.sensitivities, &draw.errors))
                    .collect();
                Group {
                    navigators: Mechanisation::new(
                        start.map(|value| like.constant(value)),
                        Vector::constant(like, first.velocity.into()),
                        attitude,
                        station,
                        VerticalChannel::Held,
                    ),
                    gyro: Readings::of(like, &sums, |one| &one.gyro),
                    accel: Readings::of(like, &sums, |one| &one.accel),
                    noise: [Vector::zeros(like); 2],
                }
            })
            .collect();
        let mut found: Vec<Vec<[f64; 2]>> =
            self.draws.iter().map(|_| Vec::with_capacity(self.times.len())).collect();
        let per_block = (NOISE_INTERVAL / self.interval).round().max(1.0);
        let mut left = 0.0;
        let mut samples = table.samples(self.interval);
        for (done, &time) in self.times.iter().enumerate() {
            let mut now = self.interval * 0.5;
            while now < time {
                let Some(sample) = samples.next() else { break };
                now = sample.time + self.interval * 0.5;
                let increments = sample.increments;
                let interval = increments.interval;
                if left < 0.5 {
                    left = per_block;
                    self.draw_noise(
                        like,
                        &mut groups,
                        (per_block * self.interval, 1.0 / per_block),
                    );
                }
                left -= 1.0;
                let [angle, velocity] =
                    [increments.angle, increments.velocity].map(|of| *of.components());
                reference.step(&angle.into(), &velocity.into(), interval);
                let [rate, force] =
                    [&angle, &velocity].map(|of| Vector::constant(like, (*of).into()));
                for group in &mut groups {
                    let angle = rate + group.gyro.errors(&rate, &force, interval) + group.noise[0];
                    let velocity =
                        force + group.accel.errors(&rate, &force, interval) + group.noise[1];
                    group.navigators.step(&angle, &velocity, interval);
                }
            }
            let [latitude, longitude, height] = reference.place;
            let here = rins_frames::Site { latitude, longitude, height };
            let [north, east] = [
                here.meridian_radius() + height,
                (here.transverse_radius() + height) * latitude.cos(),
            ];
            for (found, draws) in groups.iter().zip(found.chunks_mut(width)) {
                let [latitudes, longitudes, _] = found.navigators.place;
                for (lane, draw) in draws.iter_mut().enumerate() {
                    draw.push([
                        (longitudes.lane(lane) - longitude) * east,
                        (latitudes.lane(lane) - latitude) * north,
                    ]);
                }
            }
            (self.progress)(done + 1);
        }
        found
    }
}

impl Simulation<'_> {
    /// Draws the noise of the next samples, of which each has this part of it.
    #[inline(always)]
    fn draw_noise<S: Simd>(
        &mut self,
        like: Lane<S>,
        groups: &mut [Group<S>],
        (duration, part): (f64, f64),
    ) {
        use rins_frames::{InFrame, Increments};
        let none =
            Increments { angle: InFrame::zeros(), velocity: InFrame::zeros(), interval: duration };
        let width = like.lanes();
        for (group, sources) in groups.iter_mut().zip(self.sources.chunks_mut(width)) {
            let drawn: Vec<Increments> =
                sources.iter_mut().map(|source| source.corrupt(&none)).collect();
            let of = |triad: usize, axis: usize, lane: usize| {
                drawn.get(lane).map_or(0.0, |one| {
                    part * [one.angle.components(), one.velocity.components()][triad][axis]
                })
            };
            for (triad, noise) in group.noise.iter_mut().enumerate() {
                for axis in 0..3 {
                    noise[axis] = like.each(|lane| of(triad, axis, lane));
                }
            }
        }
    }
}

/// The attitude with the error of a draw: `(I - φ×) C`.
fn attitude(draw: &Draw, nav_from_body: &Matrix3<f64>) -> Matrix3<f64> {
    let error = Dcm::<Body, Body>::from_rotation_vector(&-draw.attitude);
    error.matrix() * nav_from_body
}

impl<S: Simd> Readings<S> {
    /// Those of the draws in the lanes; lanes without a draw have none.
    fn of(like: Lane<S>, sums: &[Sensitivity], triad: fn(&Sensitivity) -> &Affine) -> Self {
        let parts = |lane: usize| sums.get(lane).map(|sum| triad(sum).parts());
        let matrix = |which: usize| {
            Matrix::from_fn(|row, column| {
                like.each(|lane| parts(lane).map_or(0.0, |(_, by)| by[which][(row, column)]))
            })
        };
        let mut constant = Vector::zeros(like);
        for axis in 0..3 {
            constant[axis] =
                like.each(|lane| parts(lane).map_or(0.0, |(constant, _)| constant[axis]));
        }
        Self { constant, by_rate: matrix(0), by_force: matrix(1) }
    }

    /// The error of an increment, from the true increments of angle \[rad\] and velocity \[m/s\].
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it is compiled with the machine's instructions")]
    fn errors(
        &self,
        angle: &Vector<Lane<S>>,
        velocity: &Vector<Lane<S>>,
        interval: f64,
    ) -> Vector<Lane<S>> {
        self.constant.scaled(interval) + self.by_rate * *angle + self.by_force * *velocity
    }
}
