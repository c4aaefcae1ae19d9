//! Structures outside the catalogue: how strong they are, and what is most like them.

use std::f64::consts::{PI, TAU};

use rand::RngExt;
use rins_blind::{Channel, Random, Shape, Unknown, record};
use rins_terms::{SettingKind, TermInstance, catalogue};
use serde::{Deserialize, Serialize};

use crate::catalogue::rivals;
use crate::hide::{Ground, explained, quiet};
use crate::laboratory::log_uniform;
use crate::stand::StandError;

/// A structure outside the catalogue that was hidden.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outside {
    /// What it is, in words.
    pub name: String,
    /// The sensor that it is on.
    pub channel: String,
    /// How strong it is, in sigmas.
    pub strength: f64,
    /// How much of that is left beside the effect that is most like it; none for a matter of scatter.
    pub remainder: Option<f64>,
    /// The effect that is most like it.
    pub nearest: String,
}

impl Ground {
    /// A structure outside the catalogue of which `remainder` sigmas are left beside any effect.
    pub(crate) fn outside(
        &self,
        remainder: f64,
        random: &mut Random,
    ) -> Result<(Unknown, Outside), StandError> {
        let mut unknown = self.unknown(random);
        let name = unknown.shape.name().to_owned();
        let axes = ["x", "y", "z"];
        let channel = match unknown.channel {
            Channel::Gyro(axis) => format!("gyro.{}", axes[axis]),
            Channel::Accel(axis) => format!("accel.{}", axes[axis]),
        };
        if !unknown.shape.is_signal() {
            let nearest = String::new();
            return Ok((
                unknown,
                Outside { name, channel, strength: 0.0, remainder: None, nearest },
            ));
        }
        let mut quiet = quiet(&self.laboratory);
        quiet.unknowns.push(unknown.clone());
        let run = self.stand.run(&record(&quiet), quiet.interval)?;
        let mut all = rivals(self.duration);
        all.extend(self.lines(&unknown));
        let told = self.stand.told(&run, &all)?;
        let gains = (0..all.len()).map(|number| explained(&told, number));
        let best =
            gains.enumerate().fold(
                (0, 0.0),
                |best: (usize, f64), (number, gain)| {
                    if gain > best.1 { (number, gain) } else { best }
                },
            );
        let left = (told.square - best.1).max(0.0).sqrt();
        let times = remainder / left;
        unknown.size *= times;
        let strength = times * told.square.sqrt();
        let nearest = all[best.0].term.id.to_owned();
        Ok((unknown, Outside { name, channel, strength, remainder: Some(remainder), nearest }))
    }

    /// Lines on the axis of a structure, at the frequencies that it might be taken for.
    fn lines(&self, unknown: &Unknown) -> Vec<TermInstance> {
        let turns: Vec<f64> =
            self.laboratory.experiment.drive.segments.iter().map(|s| s.rate.abs() / TAU).collect();
        let frequencies: Vec<f64> = match &unknown.shape {
            Shape::Sawtooth { period } => vec![1.0 / period, 2.0 / period],
            Shape::Order { order, .. } => turns.iter().map(|turn| order * turn).collect(),
            Shape::Modulated { period, .. } => {
                turns.iter().flat_map(|turn| [turn - 1.0 / period, turn + 1.0 / period]).collect()
            }
            Shape::Bump { .. } => turns.iter().flat_map(|turn| [*turn, 2.0 * turn]).collect(),
            _ => Vec::new(),
        };
        let (Channel::Gyro(axis) | Channel::Accel(axis)) = unknown.channel;
        let line = |frequency: f64| {
            TermInstance::new(&catalogue::INTERFERENCE_LINE)
                .estimated()
                .with_setting(SettingKind::Frequency, frequency)
                .with_setting(SettingKind::Axis, axis as f64 + 1.0)
        };
        frequencies.into_iter().filter(|frequency| *frequency > 0.0).map(line).collect()
    }

    fn unknown(&self, random: &mut Random) -> Unknown {
        let duration = self.duration;
        let axis = random.random_range(0..3);
        let gyro = random.random_bool(0.5);
        let channel = if gyro { Channel::Gyro(axis) } else { Channel::Accel(axis) };
        let phase = TAU * random.random::<f64>();
        // At one constant rate what comes with the turn is a line of a fixed frequency, or two.
        let several = self.laboratory.experiment.drive.segments.len() > 1;
        let kinds: &[u8] = if several { &[0, 1, 2, 3, 4, 5, 6, 7] } else { &[0, 2, 3, 5, 6, 7] };
        let (shape, size) = match kinds[random.random_range(0..kinds.len())] {
            0 => (Shape::Sawtooth { period: log_uniform(random, 0.04, 0.3) * duration }, 1.0),
            1 => (Shape::Order { order: 1.37, phase }, 1.0),
            2 => {
                let from = log_uniform(random, 2.0, 10.0) / duration;
                (Shape::Chirp { from, growth: 4.0 * from / duration }, 1.0)
            }
            3 => (Shape::telegraph(0.06 * duration, duration, random.random()), 1.0),
            4 => (Shape::Modulated { period: 0.61 * duration, phase }, 1.0),
            5 => (Shape::Bump { at: phase, width: 10.0 * PI / 180.0 }, 1.0),
            6 => {
                let from = 0.6 * random.random::<f64>() * duration;
                (Shape::Burst { from, to: from + 0.15 * duration }, 3.0)
            }
            _ => (Shape::Tails, 1.0),
        };
        let known = if gyro { &self.laboratory.known.gyro } else { &self.laboratory.known.accel };
        let unit = if shape.is_signal() { known.noise } else { 1.0 };
        Unknown { channel, shape, size: size * unit }
    }
}
