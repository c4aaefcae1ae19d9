//! The filter over the epochs of a run, and the recursions of its columns.
#![expect(
    clippy::inline_always,
    reason = "what is not inlined is compiled without the vector instructions"
)]

use nalgebra::{Cholesky, DMatrix, SMatrix, Vector3};
use rins_lanes::{Arch, Lane, Simd, WithSimd};

use crate::epoch::Epoch;
use crate::gains::{Gains, WIDEST};
use crate::space::Space;
use crate::step::{CARRIED_OF, FOLLOWING, NAVIGATION, SHOWN, SHOWN_OF, Step};

type Square = SMatrix<f64, SHOWN, SHOWN>;

/// The covariance of the filter, and the recursions of the columns.
///
/// Everything is stored in rows of whole SIMD vectors, one for each state: the covariances of the states, and the columns.
#[derive(Clone, Debug)]
pub(crate) struct Pass {
    step: Step,
    pub(crate) covariance: DMatrix<f64>,
    pub(crate) columns: DMatrix<f64>,
    /// The covariances of the states with the linear functions of the states in an epoch, in rows.
    of_states: Vec<f64>,
    /// `C L⁻ᵀ`, where `C` is the covariance of the next states with the measurement, in rows.
    gain: Vec<f64>,
    /// The same in the order of the states.
    gain_of_states: Vec<[f64; SHOWN]>,
    whitened: Vec<f64>,
}

impl Pass {
    /// The filter at the start of a run.
    pub(crate) fn new(space: &Space, columns: usize) -> Self {
        let (states, columns) = (space.states(), columns.next_multiple_of(WIDEST));
        let length = states.next_multiple_of(WIDEST);
        Self {
            step: space.blank(length),
            covariance: space.start().resize_vertically(length, 0.0),
            columns: DMatrix::zeros(columns, states),
            of_states: vec![0.0; FOLLOWING * length],
            gain: vec![0.0; SHOWN * length],
            gain_of_states: vec![[0.0; SHOWN]; states],
            whitened: vec![0.0; SHOWN * columns],
        }
    }

    /// The whitened measurement of every column in the last epoch: a row for each measurement.
    pub(crate) fn whitened(&self) -> &[f64] {
        &self.whitened
    }

    /// The current attitude in the first column: a rotation vector in the axis frame \[rad\].
    pub(crate) fn attitude(&self) -> Vector3<f64> {
        Vector3::from_fn(|axis, _| self.columns[(0, axis)])
    }

    /// Processes an epoch, with new initial values if `anew`. The result is half the log-determinant of the innovation
    /// covariance.
    pub(crate) fn step(
        &mut self,
        space: &Space,
        epoch: &Epoch,
        gains: &Gains,
        anew: bool,
    ) -> Option<f64> {
        self.begin(space, epoch, gains, anew);
        Arch::new().dispatch(Onward { pass: self, gains })
    }

    fn begin(&mut self, space: &Space, epoch: &Epoch, gains: &Gains, anew: bool) {
        space.set(epoch, &mut self.step);
        if anew {
            space.forget_navigation(&mut self.covariance);
            self.start(gains);
        }
    }

    /// Propagates the colored noise over an excluded epoch; navigation starts again afterwards.
    pub(crate) fn pass_over(&mut self, space: &Space, epoch: &Epoch) {
        space.set(epoch, &mut self.step);
        let Step { decay, colour_noise, .. } = &self.step;
        for state in NAVIGATION..self.columns.ncols() {
            self.columns.column_mut(state).scale_mut(decay[state]);
            for other in NAVIGATION..self.columns.ncols() {
                self.covariance[(other, state)] *= decay[state] * decay[other];
            }
            self.covariance[(state, state)] += colour_noise[state];
        }
    }

    /// Initializes attitude and velocity from the epoch's own readings, so that the initial values contain no other
    /// information.
    fn start(&mut self, gains: &Gains) {
        let width = self.columns.nrows();
        let (attitude, rest) = self.columns.as_mut_slice().split_at_mut(3 * width);
        for (start, shown) in attitude.iter_mut().zip(gains.shown()) {
            *start = -shown;
        }
        rest[..3 * width].fill(0.0);
        if !self.step.shows_angle {
            attitude[2 * width..].fill(0.0);
        }
    }
}

/// The processing of one epoch, with as many states or columns in parallel as a SIMD vector holds.
struct Onward<'a> {
    pass: &'a mut Pass,
    gains: &'a Gains,
}

impl WithSimd for Onward<'_> {
    type Output = Option<f64>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Option<f64> {
        let Self { pass, gains } = self;
        pass.follow_states(simd);
        let following = pass.following();
        let shown = Square::from_fn(|row, column| {
            let (row, column) = (SHOWN_OF[row], SHOWN_OF[column]);
            0.5 * (following[(row, column)] + following[(column, row)])
        });
        let factor = Cholesky::new(shown + pass.step.shown)?.unpack();
        pass.set_gain(simd, &following, &factor);
        pass.carry_columns(simd, gains, &factor);
        pass.carry_covariance(simd, &following);
        Some(factor.diagonal().iter().map(|x| x.ln()).sum())
    }
}

/// The covariance of the linear functions of the states in an epoch.
type Following = SMatrix<f64, FOLLOWING, FOLLOWING>;

impl Pass {
    /// Calculates the covariances of the states with the linear functions of the states.
    #[inline(always)]
    fn follow_states<S: Simd>(&mut self, simd: S) {
        let rows = S::as_simd_f64s(self.covariance.as_slice()).0;
        let to = S::as_mut_simd_f64s(&mut self.of_states).0;
        let width = to.len() / FOLLOWING;
        for place in 0..width {
            let of = self.step.follow(|state| Lane::new(simd, rows[state * width + place]));
            for (row, lane) in of.into_iter().flat_map(|vector| vector.0).enumerate() {
                to[row * width + place] = lane.values();
            }
        }
    }

    /// The covariance of the linear functions of the states.
    #[inline(always)]
    fn following(&self) -> Following {
        let length = self.covariance.nrows();
        let mut covariance = Following::zeros();
        for (mut column, of) in
            covariance.column_iter_mut().zip(self.of_states.chunks_exact(length))
        {
            let following = self.step.follow(|state| of[state]);
            for (to, value) in column.iter_mut().zip(following.iter().flat_map(|vector| vector.0)) {
                *to = value;
            }
        }
        covariance
    }

    /// `C = Φ P Hᵀ + cov(w, e)`, and `C L⁻ᵀ`.
    #[inline(always)]
    fn set_gain<S: Simd>(&mut self, simd: S, following: &Following, factor: &Square) {
        let Step { decay, cross, .. } = &self.step;
        let length = decay.len();
        let rows = self.gain.chunks_exact_mut(length).zip(cross.as_slice().chunks_exact(length));
        for (part, (row, cross)) in rows.enumerate() {
            let of = &self.of_states[SHOWN_OF[part] * length..][..length];
            for (((gain, of), decay), cross) in row.iter_mut().zip(of).zip(decay).zip(cross) {
                *gain = of * decay + cross;
            }
            for state in 0..NAVIGATION {
                row[state] = following[(CARRIED_OF[state], SHOWN_OF[part])] + cross[state];
            }
        }
        let rows = S::as_mut_simd_f64s(&mut self.gain).0;
        let width = rows.len() / SHOWN;
        for place in 0..width {
            let mut gain = std::array::from_fn(|part| Lane::new(simd, rows[part * width + place]));
            whiten(&mut gain, factor);
            for part in 0..SHOWN {
                rows[part * width + place] = gain[part].values();
            }
        }
        for (part, row) in self.gain.chunks_exact(length).enumerate() {
            for (to, gain) in self.gain_of_states.iter_mut().zip(row) {
                to[part] = *gain;
            }
        }
    }

    /// Calculates the whitened measurements of the columns, and propagates the columns.
    #[inline(always)]
    fn carry_columns<S: Simd>(&mut self, simd: S, gains: &Gains, factor: &Square) {
        // Two vectors in parallel share the loaded common factors; of the widest vectors there may be only one.
        if S::F64_LANES < WIDEST {
            self.carry_vectors::<S, 2>(simd, gains, factor);
        } else {
            self.carry_vectors::<S, 1>(simd, gains, factor);
        }
    }

    /// The same for `BESIDE` vectors in parallel.
    #[inline(always)]
    fn carry_vectors<S: Simd, const BESIDE: usize>(
        &mut self,
        simd: S,
        gains: &Gains,
        factor: &Square,
    ) {
        let Self { step, columns, gain_of_states, whitened, .. } = self;
        let columns = S::as_mut_simd_f64s(columns.as_mut_slice()).0;
        let whitened = S::as_mut_simd_f64s(whitened).0;
        let navigation = S::as_simd_f64s(gains.navigation()).0;
        let shown = S::as_simd_f64s(gains.shown()).0;
        let width = whitened.len() / SHOWN;
        let (gain_of_navigation, gain_of_others) = gain_of_states.split_at(NAVIGATION);
        for first in (0..width).step_by(BESIDE) {
            let mut all_seen = [[Lane::splat(simd, 0.0); SHOWN]; BESIDE];
            for (beside, all_seen) in all_seen.iter_mut().enumerate() {
                let place = first + beside;
                let at = |rows: &[S::f64s], row: usize| Lane::new(simd, rows[row * width + place]);
                let [mean, end, velocity] = step.follow(|state| at(columns, state));
                let mut carried = [end[0], end[1], end[2], velocity[0], velocity[1], velocity[2]];
                for (row, carried) in carried.iter_mut().enumerate() {
                    *carried = *carried + at(navigation, row);
                }
                let mut seen: [Lane<S>; SHOWN] = std::array::from_fn(|part| {
                    if part < 3 { mean[part] + at(shown, part) } else { carried[part] }
                });
                if !step.shows_angle {
                    seen[2] = Lane::splat(simd, 0.0);
                }
                whiten(&mut seen, factor);
                for (part, seen) in seen.iter().enumerate() {
                    whitened[part * width + place] = seen.values();
                }
                for (state, (carried, gain)) in
                    carried.into_iter().zip(gain_of_navigation).enumerate()
                {
                    columns[state * width + place] = (carried - explained(&seen, gain)).values();
                }
                *all_seen = seen;
            }
            let rows = columns[NAVIGATION * width..].chunks_exact_mut(width);
            for ((row, gain), decay) in rows.zip(gain_of_others).zip(&step.decay[NAVIGATION..]) {
                for (value, seen) in row[first..first + BESIDE].iter_mut().zip(&all_seen) {
                    let decayed = Lane::new(simd, *value) * *decay;
                    *value = (decayed - explained(seen, gain)).values();
                }
            }
        }
    }

    /// `Φ P Φᵀ + Q - W Wᵀ`.
    #[inline(always)]
    fn carry_covariance<S: Simd>(&mut self, simd: S, following: &Following) {
        let Self { step, covariance, of_states, gain, gain_of_states, .. } = self;
        let Step { decay, noise, colour_noise, .. } = step;
        let (length, states) = covariance.shape();
        for (state, mut row) in covariance.column_iter_mut().enumerate().take(NAVIGATION) {
            let carried = CARRIED_OF[state];
            let of = &of_states[carried * length..][..length];
            let noise = noise.column(state);
            for (((to, of), decay), noise) in row.iter_mut().zip(of).zip(&*decay).zip(noise.iter())
            {
                *to = of * decay + noise;
            }
            for other in 0..NAVIGATION {
                let other_carried = CARRIED_OF[other];
                let both =
                    following[(carried, other_carried)] + following[(other_carried, carried)];
                row[other] = 0.5 * both + noise[other];
            }
        }
        let rows = S::as_mut_simd_f64s(covariance.as_mut_slice()).0;
        let gains = S::as_simd_f64s(gain).0;
        let decays = S::as_simd_f64s(decay).0;
        let width = decays.len();
        for place in 0..width {
            let seen: [Lane<S>; SHOWN] =
                std::array::from_fn(|part| Lane::new(simd, gains[part * width + place]));
            let decays = Lane::new(simd, decays[place]);
            let rows = rows.chunks_exact_mut(width).zip(&*gain_of_states).zip(&*decay);
            for (state, ((row, gain), decay)) in rows.enumerate() {
                let carried = Lane::new(simd, row[place]);
                let predicted =
                    if state < NAVIGATION { carried } else { carried * (decays * *decay) };
                row[place] = (predicted - explained(&seen, gain)).values();
            }
        }
        for state in NAVIGATION..states {
            covariance[(state, state)] += colour_noise[state];
            for other in 0..NAVIGATION {
                covariance[(other, state)] = covariance[(state, other)];
            }
        }
    }
}

/// `x` becomes `L⁻¹ x`.
#[inline(always)]
fn whiten<S: Simd>(x: &mut [Lane<S>; SHOWN], factor: &Square) {
    for part in 0..SHOWN {
        for before in 0..part {
            x[part] = x[part] - x[before] * factor[(part, before)];
        }
        x[part] = x[part] * factor[(part, part)].recip();
    }
}

/// The sum of the whitened measurements, each times its gain.
#[inline(always)]
fn explained<S: Simd>(seen: &[Lane<S>; SHOWN], gain: &[f64; SHOWN]) -> Lane<S> {
    let [mean_x, mean_y, mean_z, x, y, z] = *seen;
    mean_x * gain[0] + mean_y * gain[1] + mean_z * gain[2] + x * gain[3] + y * gain[4] + z * gain[5]
}

#[cfg(test)]
mod tests {
    use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G};
    use rins_frames::{EulerAngles, Site};
    use rins_lanes::Scalar;
    use rins_motion::{Profile, Segment, Station};
    use rins_simulation::{Scenario, simulate};
    use rins_terms::Model;

    use super::*;
    use crate::linear::linearise_coarsely;
    use crate::noise_parameters::{Noise, NoiseParameters, TriadStrengths};
    use crate::run::{Reference, Rig, Run};

    /// A run of one minute on a tilted axis.
    fn run() -> Run {
        let site = Site { latitude: 45.0 * DEG, longitude: 0.0, height: 0.0 };
        let station = Station::with_normal_gravity(site);
        let nav_from_table = EulerAngles { roll: 20.0 * DEG, pitch: 0.0, yaw: 0.0 }.dcm();
        let turn = Segment { rate: 10.0 * DEG_PER_SECOND, duration: 60.0 };
        let scenario =
            Scenario::perfect(station, nav_from_table, Profile::new(&[turn], None).unwrap(), 0.02);
        let reference = Reference::Encoder { noise: ARCSEC };
        let rig = Rig { station, nav_from_table, reference, wobble: ARCSEC, velocity: 1e-6 };
        Run::new(rig, simulate(&scenario).unwrap().recording).unwrap()
    }

    #[test]
    fn width_of_the_vectors_changes_no_bit() {
        let run = run();
        let model = Model::full();
        let free: Vec<(usize, usize)> = (0..3).flat_map(|term| [(term, 0), (term, 2)]).collect();
        let linear = linearise_coarsely(&run, &model, &free);
        let triad = |white| TriadStrengths { white, flicker: 0.1 * white, walk: 0.0 };
        let imu = NoiseParameters {
            gyro: triad(1e-3 * DEG_PER_HOUR),
            accel: triad(10.0 * MICRO_G),
            jitter: 0.0,
        };
        let noise = Noise::on(&run.rig, &imu);
        let space = Space::new(&linear, &noise);
        let [mut wide, mut narrow] = [(); 2].map(|()| Pass::new(&space, free.len() + 1));
        for (index, epoch) in linear.epochs.iter().enumerate() {
            let gains = &epoch.gains;
            for pass in [&mut wide, &mut narrow] {
                pass.begin(&space, epoch, gains, linear.starts_anew(index));
            }
            let determinant = Arch::new().dispatch(Onward { pass: &mut wide, gains });
            let narrow = Onward { pass: &mut narrow, gains }.with_simd(Scalar::new());
            assert!(narrow.is_some() && narrow == determinant);
        }
        assert!(wide.whitened().iter().any(|value| *value != 0.0), "nothing is shown");
        assert_eq!(wide.whitened(), narrow.whitened());
        assert_eq!(wide.columns, narrow.columns);
        assert_eq!(wide.covariance, narrow.covariance);
        assert_eq!(
            wide.covariance.columns(0, space.states()).rows(0, space.states()).transpose(),
            wide.covariance.rows(0, space.states())
        );
    }
}
