//! A cart on a rail: filtered and smoothed, with a consistency test of a model whose noise is too small.
#![expect(clippy::print_stdout, reason = "an example prints")]

use nalgebra::{Matrix1, Matrix2, RowVector2, Vector1, Vector2};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rins_ekf::{Block, Filter, Measurement, Smoother, Step, congruence};

const POSITION: Block<1> = Block::first();
const VELOCITY: Block<1> = POSITION.then();
const STATES: usize = VELOCITY.end();

const INTERVAL: f64 = 0.1;
const STEPS: usize = 500;
/// The acceleration of the cart \[m/s²\], and the uncertainty of its measured position \[m\], both 1σ.
const ACCELERATION: f64 = 0.5;
const SIGHT: f64 = 0.2;

/// The mean NIS of the filter, and the rms position errors of filter and smoother.
fn run(believed_sight: f64) -> Result<[f64; 3], Box<dyn std::error::Error>> {
    let mut random = Pcg64::seed_from_u64(7);
    let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
    let mut transition = Matrix2::identity();
    POSITION.set(VELOCITY, &mut transition, &Matrix1::new(INTERVAL));
    let push = Vector2::new(INTERVAL * INTERVAL / 2.0, INTERVAL);
    let noise = congruence(&push, &Matrix1::new(ACCELERATION * ACCELERATION));

    let mut truth = Vector2::zeros();
    let mut filter = Filter::<STATES>::new(truth, Matrix2::identity() * 1e-4)?;
    let mut smoother = Smoother::new(filter.clone());
    let mut path = vec![truth];
    let mut nis = 0.0;
    for _ in 0..STEPS {
        truth = transition * truth + push * (ACCELERATION * normal());
        path.push(truth);
        filter.predict(&transition, &noise);
        let predicted = filter.clone();
        let seen = Measurement::new(
            Vector1::new(truth.x + SIGHT * normal()),
            RowVector2::new(1.0, 0.0),
            Matrix1::new(believed_sight * believed_sight),
        );
        nis += filter.update(&seen)?.nis();
        smoother.push(Step { transition, noise, predicted, filtered: filter.clone() });
    }
    let rms = |squares: f64| (squares / STEPS as f64).sqrt();
    let filtered = smoother.steps().iter().zip(&path[1..]);
    let filtered = filtered.map(|(step, truth)| (step.filtered.state.x - truth.x).powi(2)).sum();
    let smoothed = smoother.smoothed()?;
    let smoothed = smoothed.iter().zip(&path).map(|(at, truth)| (at.state.x - truth.x).powi(2));
    Ok([nis / STEPS as f64, rms(filtered), rms(smoothed.sum())])
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("The cart is seen to {SIGHT} m (1σ).\n");
    println!("believed [m]  mean NIS  filtered rms [m]  smoothed rms [m]");
    for believed in [0.2, 0.1] {
        let [nis, filtered, smoothed] = run(believed)?;
        println!("{believed:>12}{nis:>10.2}{filtered:>18.3}{smoothed:>18.3}");
    }
    println!("\nA right model has a mean NIS of 1, within 0.2 over these {STEPS} steps.");
    Ok(())
}
