//! Drawing a trial.

use rand::RngExt;
use rins_blind::{Experiment, Known, Random, random};
use serde::{Deserialize, Serialize};

use crate::catalogue::hidden;
use crate::hide::{Ground, Hidden, hideable};
use crate::laboratory::{Grade, Laboratory, Length, Level, Schedule, log_uniform};
use crate::outside::Outside;
use crate::stand::StandError;

/// How many times its bound an effect is strong; more often as much as a target speaks of.
const STRENGTHS: [f64; 18] = [
    2.0, 3.0, 4.0, 5.0, 6.0, 6.5, 6.5, 6.5, 8.0, 8.0, 8.0, 9.0, 9.0, 12.0, 12.0, 20.0, 40.0, 100.0,
];

/// How strong each of two effects is.
const BOTH: f64 = 10.0;

/// How many sigmas of a structure outside the catalogue are left beside any effect.
const REMAINDERS: [f64; 6] = [8.0, 12.0, 16.0, 20.0, 30.0, 50.0];

/// How often an effect is drawn before a schedule is said to show none.
const DRAWS: usize = 200;

/// The range of the bias instability of a run without an unmodeled error, relative to the usual one.
const FLICKER: (f64, f64) = (0.2, 5.0);

/// What is hidden in a trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Nothing.
    Nothing,
    /// One effect.
    One,
    /// Two effects.
    Two,
    /// Something outside the catalogue.
    Outside,
}

/// A trial: what is true, what is known, and what is hidden.
#[derive(Clone, Debug)]
pub struct Trial {
    /// What is hidden in it.
    pub kind: Kind,
    /// How the table turns.
    pub schedule: Schedule,
    /// How real it is.
    pub level: Level,
    /// The grade of the IMU.
    pub grade: Grade,
    /// The run.
    pub experiment: Experiment,
    /// What the laboratory knows of it.
    pub known: Known,
    /// The effects that are hidden.
    pub hidden: Vec<Hidden>,
    /// What is hidden and in no catalogue.
    pub outside: Option<Outside>,
    /// Effects that are there because no table and no data sheet is perfect.
    pub present: Vec<String>,
}

impl Trial {
    /// Trial number `index` of those under `seed`.
    ///
    /// # Errors
    /// [`StandError`] if the run cannot be looked at.
    pub fn draw(seed: u64, index: u64, length: Length) -> Result<Self, StandError> {
        let mut random = random(seed, index);
        let kind = kind(&mut random);
        let schedule = Schedule::ALL[random.random_range(0..3)];
        let level = match random.random_range(0..20_u8) {
            0..9 => Level::White,
            9..17 => Level::Flicker,
            17..19 => Level::Table,
            _ => Level::Coarse,
        };
        let own = random.random();
        let laboratory =
            Laboratory::draw((schedule, length), (level, Grade::Navigation), own, &mut random);
        let mut trial = Self::clean(kind, schedule, level, &laboratory);
        match kind {
            Kind::Nothing => {}
            Kind::One => {
                let meant = STRENGTHS[random.random_range(0..STRENGTHS.len())];
                trial.hide(&Ground::of(laboratory)?, 1, meant, &mut random)?;
            }
            Kind::Two => trial.hide(&Ground::of(laboratory)?, 2, BOTH, &mut random)?,
            Kind::Outside => {
                let remainder = REMAINDERS[random.random_range(0..REMAINDERS.len())];
                let (unknown, outside) = Ground::of(laboratory)?.outside(remainder, &mut random)?;
                trial.experiment.unknowns.push(unknown);
                trial.outside = Some(outside);
            }
        }
        Ok(trial)
    }

    /// Run number `index` of those under `seed` without an unmodeled error, with an IMU of any grade, white noise or bias instability
    /// of any strength.
    pub fn null(seed: u64, index: u64) -> Self {
        let mut random = random(seed, index);
        let schedule = Schedule::ALL[random.random_range(0..Schedule::ALL.len())];
        let grade = Grade::ALL[random.random_range(0..Grade::ALL.len())];
        let level = if random.random_bool(0.5) { Level::White } else { Level::Flicker };
        let own = random.random();
        let mut laboratory =
            Laboratory::draw((schedule, Length::Drawn), (level, grade), own, &mut random);
        let Experiment { gyro, accel, .. } = &mut laboratory.experiment;
        for sensors in [gyro, accel] {
            sensors.noise.flicker *= log_uniform(&mut random, FLICKER.0, FLICKER.1);
        }
        Self { grade, ..Self::clean(Kind::Nothing, schedule, level, &laboratory) }
    }

    /// A short run in which these effects are hidden, each so many times its bound strong.
    ///
    /// Effects that the schedule does not show so strong are left out.
    ///
    /// # Errors
    /// [`StandError`] if the run cannot be looked at.
    pub fn hiding(
        effects: &[(&str, f64)],
        schedule: Schedule,
        level: Level,
        seed: u64,
    ) -> Result<Self, StandError> {
        let mut random = random(seed, 0);
        let own = random.random();
        let laboratory = Laboratory::draw(
            (schedule, Length::Short),
            (level, Grade::Navigation),
            own,
            &mut random,
        );
        let kind = match effects.len() {
            0 => Kind::Nothing,
            1 => Kind::One,
            _ => Kind::Two,
        };
        let mut trial = Self::clean(kind, schedule, level, &laboratory);
        if !effects.is_empty() {
            let ground = Ground::of(laboratory)?;
            for (id, meant) in effects {
                let term = hideable().into_iter().find(|term| term.id == *id);
                let made = term.map(|term| ground.effect(term, *meant, &mut random)).transpose()?;
                if let Some((chosen, record)) = made.flatten() {
                    trial.experiment.effects.push(hidden(&chosen));
                    trial.hidden.push(record);
                }
            }
        }
        Ok(trial)
    }

    /// A short run with a structure outside the catalogue, so many sigmas of it left beside any effect.
    ///
    /// # Errors
    /// [`StandError`] if the run cannot be looked at.
    pub fn outside(
        remainder: f64,
        schedule: Schedule,
        level: Level,
        seed: u64,
    ) -> Result<Self, StandError> {
        let mut random = random(seed, 0);
        let own = random.random();
        let laboratory = Laboratory::draw(
            (schedule, Length::Short),
            (level, Grade::Navigation),
            own,
            &mut random,
        );
        let mut trial = Self::clean(Kind::Outside, schedule, level, &laboratory);
        let (unknown, outside) = Ground::of(laboratory)?.outside(remainder, &mut random)?;
        trial.experiment.unknowns.push(unknown);
        trial.outside = Some(outside);
        Ok(trial)
    }

    fn clean(kind: Kind, schedule: Schedule, level: Level, laboratory: &Laboratory) -> Self {
        let worn = laboratory.experiment.effects.iter().map(|effect| effect.id.clone());
        let scatter = level.scatter().iter().map(|term| term.id.to_owned());
        Self {
            kind,
            schedule,
            level,
            grade: Grade::Navigation,
            present: worn.chain(scatter).collect(),
            experiment: laboratory.experiment.clone(),
            known: laboratory.known.clone(),
            hidden: Vec::new(),
            outside: None,
        }
    }

    /// What is hidden in trial number `index` of those under `seed`.
    pub fn kind_of(seed: u64, index: u64) -> Kind {
        kind(&mut random(seed, index))
    }

    /// Hides so many different effects, each of this strength.
    fn hide(
        &mut self,
        ground: &Ground,
        count: usize,
        meant: f64,
        random: &mut Random,
    ) -> Result<(), StandError> {
        let terms = hideable();
        for _ in 0..DRAWS {
            if self.hidden.len() == count {
                break;
            }
            let term = terms[random.random_range(0..terms.len())];
            if self.hidden.iter().any(|other| other.id == term.id) {
                continue;
            }
            if let Some((chosen, record)) = ground.effect(term, meant, random)? {
                self.experiment.effects.push(hidden(&chosen));
                self.hidden.push(record);
            }
        }
        Ok(())
    }
}

fn kind(random: &mut Random) -> Kind {
    match random.random_range(0..100_u8) {
        0..35 => Kind::Nothing,
        35..75 => Kind::One,
        75..85 => Kind::Two,
        _ => Kind::Outside,
    }
}
