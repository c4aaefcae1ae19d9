//! Campaigns: the estimates of a few parameters from several runs, one of which varies between the runs.

use nalgebra::{DMatrix, DVector};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use crate::random::{Random, random};

/// The way in which a parameter varies between the runs of a campaign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variety {
    /// No parameter varies.
    Nothing,
    /// After each power-on one of its own.
    TurnOn,
    /// Linear in the date.
    Date,
    /// Linear in the time since power-on.
    SincePowerOn,
    /// Exponential after power-on.
    WarmUp,
    /// Linear in the temperature.
    Linear,
    /// Linear and quadratic in the temperature.
    Quadratic,
    /// Another value while the temperature falls.
    Hysteresis,
    /// A change between two runs.
    Shock,
    /// One unit is unlike its fleet.
    Unit,
}

impl Variety {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Nothing,
        Self::TurnOn,
        Self::Date,
        Self::SincePowerOn,
        Self::WarmUp,
        Self::Linear,
        Self::Quadratic,
        Self::Hysteresis,
        Self::Shock,
        Self::Unit,
    ];

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Nothing => "nothing",
            Self::TurnOn => "turn-on scatter",
            Self::Date => "drift with the date",
            Self::SincePowerOn => "drift since power-on",
            Self::WarmUp => "warm-up",
            Self::Linear => "temperature, linear",
            Self::Quadratic => "temperature, quadratic",
            Self::Hysteresis => "thermal hysteresis",
            Self::Shock => "change at a date",
            Self::Unit => "unit unlike its fleet",
        }
    }
}

/// One run of a campaign.
#[derive(Clone, Debug)]
pub struct CampaignRun {
    /// Which unit.
    pub unit: usize,
    /// Which power-on.
    pub power_on: usize,
    /// The date \[days\].
    pub date: f64,
    /// Since power-on \[s\].
    pub since_power_on: f64,
    /// The temperature \[°C\].
    pub temperature: f64,
    /// 1 where the temperature rises, -1 where it falls.
    pub warming: f64,
    /// The true parameters.
    pub truth: DVector<f64>,
    /// Their estimates.
    pub estimate: DVector<f64>,
    /// The covariance of the estimates.
    pub covariance: DMatrix<f64>,
}

/// A campaign, with what is hidden in it.
#[derive(Clone, Debug)]
pub struct Campaign {
    /// The 1σ that the data sheet states of each parameter.
    pub sheet: Vec<f64>,
    /// Its runs, in the order of their dates.
    pub runs: Vec<CampaignRun>,
    /// What varies.
    pub variety: Variety,
    /// Which parameter does.
    pub parameter: usize,
    /// The root of the squares that this adds to what constant parameters leave: what the estimator of a known shape sees.
    pub strength: f64,
}

impl Campaign {
    /// Campaign number `index` of those under `seed`; what is hidden in it has this strength.
    pub fn draw(seed: u64, index: u64, variety: Variety, strength: f64) -> Self {
        let mut random = random(seed, index);
        let parameters = random.random_range(3..=6);
        let parameter = random.random_range(0..parameters);
        let sheet: Vec<f64> = (0..parameters).map(|_| between(&mut random, 1e-8, 1e-3)).collect();
        // The runs are more exact than the sheet, each in its own way.
        let exact: Vec<f64> =
            sheet.iter().map(|sheet| sheet * between(&mut random, 1e-4, 0.1)).collect();
        let mut runs = conditions(variety, &mut random);
        for run in &mut runs {
            run.covariance = covariance(&exact, &mut random);
        }
        let spread = if variety == Variety::Unit { between(&mut random, 0.5, 5.0) } else { 0.0 };
        let units = runs.iter().map(|run| run.unit).max().unwrap_or_default() + 1;
        let mean = |of: f64, random: &mut Random| {
            let z: f64 = StandardNormal.sample(random);
            of * z
        };
        let common: Vec<f64> = sheet.iter().map(|sheet| mean(*sheet, &mut random)).collect();
        let of_units: Vec<Vec<f64>> = (0..units)
            .map(|_| exact.iter().map(|exact| mean(spread * exact, &mut random)).collect())
            .collect();
        let mut pattern = pattern(variety, &runs, &mut random);
        let seen = seen(&pattern, parameter, &runs, spread * exact[parameter]);
        pattern *= if seen > 0.0 { strength / seen } else { 0.0 };
        for (run, added) in runs.iter_mut().zip(pattern.iter()) {
            let own = &of_units[run.unit];
            run.truth = DVector::from_fn(parameters, |at, _| common[at] + own[at]);
            run.truth[parameter] += added;
            let factor = run.covariance.clone().cholesky().map(nalgebra::Cholesky::unpack);
            let white = DVector::from_fn(parameters, |_, _| StandardNormal.sample(&mut random));
            run.estimate =
                factor.map_or_else(|| run.truth.clone(), |factor| &run.truth + factor * white);
        }
        Self { sheet, runs, variety, parameter, strength: if seen > 0.0 { strength } else { 0.0 } }
    }
}

/// A number of which the logarithm is uniform.
fn between(random: &mut Random, low: f64, high: f64) -> f64 {
    random.random_range(low.ln()..high.ln()).exp()
}

/// The runs without parameters: one unit in some outings, or a fleet.
fn conditions(variety: Variety, random: &mut Random) -> Vec<CampaignRun> {
    let fleet = variety == Variety::Unit;
    let number = if fleet { random.random_range(10..=16) } else { random.random_range(5..=15) };
    let units = if fleet { random.random_range(6..=number) } else { 1 };
    // Runs of one outing have one power-on; for repeatability there have to be some power-ons.
    let outing = match variety {
        Variety::TurnOn | Variety::Unit => 0.3,
        _ => random.random_range(0.0..0.9),
    };
    let chamber =
        random.random_bool(0.5) || matches!(variety, Variety::Linear | Variety::Quadratic);
    let mut runs: Vec<CampaignRun> = Vec::new();
    let (mut date, mut power_on, mut since) = (0.0, 0, 0.0);
    for place in 0..number {
        let goes_on = place > 0 && !fleet && random.random_bool(outing);
        if goes_on {
            let later = between(random, 300.0, 3000.0);
            since += later;
            date += later / 86_400.0;
        } else {
            power_on += usize::from(place > 0);
            since = between(random, 100.0, 5000.0);
            date += between(random, 0.5, 60.0);
        }
        let temperature = if chamber {
            random.random_range(-20.0..60.0)
        } else {
            21.0 + random.random_range(-2.0..2.0)
        };
        runs.push(CampaignRun {
            unit: place % units,
            power_on,
            date,
            since_power_on: since,
            temperature,
            warming: if random.random_bool(0.5) { 1.0 } else { -1.0 },
            truth: DVector::zeros(0),
            estimate: DVector::zeros(0),
            covariance: DMatrix::zeros(0, 0),
        });
    }
    runs
}

/// The covariance of one run: correlated, and some runs twice as exact as others.
fn covariance(exact: &[f64], random: &mut Random) -> DMatrix<f64> {
    let n = exact.len();
    let longer = between(random, 0.5, 2.0);
    let loads = DMatrix::from_fn(n, n, |_, _| {
        let z: f64 = StandardNormal.sample(random);
        0.5 * z
    });
    let mixed = &loads * loads.transpose() / n as f64 + DMatrix::identity(n, n);
    DMatrix::from_fn(n, n, |a, b| {
        let unit = (mixed[(a, a)] * mixed[(b, b)]).sqrt();
        longer * longer * mixed[(a, b)] / unit * exact[a] * exact[b]
    })
}

/// How the parameter varies from run to run, but for its size.
fn pattern(variety: Variety, runs: &[CampaignRun], random: &mut Random) -> DVector<f64> {
    let of = |value: &dyn Fn(&CampaignRun) -> f64| {
        DVector::from_iterator(runs.len(), runs.iter().map(value))
    };
    match variety {
        Variety::Nothing => DVector::zeros(runs.len()),
        Variety::TurnOn => {
            let each: Vec<f64> = runs.iter().map(|_| StandardNormal.sample(random)).collect();
            of(&|run| each[run.power_on])
        }
        Variety::Date => of(&|run| run.date),
        Variety::SincePowerOn => of(&|run| run.since_power_on),
        Variety::WarmUp => {
            let constant = between(random, 200.0, 3000.0);
            of(&|run| (-run.since_power_on / constant).exp())
        }
        Variety::Linear => of(&|run| run.temperature),
        Variety::Quadratic => {
            let bend = random.random_range(0.3..1.0);
            of(&|run| {
                let x = (run.temperature - 20.0) / 40.0;
                x + bend * x * x
            })
        }
        Variety::Hysteresis => of(&|run| run.warming),
        Variety::Shock => {
            // Not before the last run: nobody foresees a shock.
            let last = random.random_range(1..runs.len() - 2);
            let date = runs[last].date;
            of(&|run| if run.date > date { 1.0 } else { 0.0 })
        }
        Variety::Unit => {
            let unlike = runs[random.random_range(0..runs.len())].unit;
            of(&|run| if run.unit == unlike { 1.0 } else { 0.0 })
        }
    }
}

/// How strong a pattern is beside constant parameters of units that spread by so much about a common value.
fn seen(pattern: &DVector<f64>, parameter: usize, runs: &[CampaignRun], spread: f64) -> f64 {
    let n = runs[0].covariance.nrows();
    let size = n * runs.len();
    let mut covariance = DMatrix::zeros(size, size);
    for (a, one) in runs.iter().enumerate() {
        covariance.view_mut((a * n, a * n), (n, n)).copy_from(&one.covariance);
    }
    for (a, one) in runs.iter().enumerate() {
        for (b, other) in runs.iter().enumerate() {
            if one.unit == other.unit {
                covariance[(a * n + parameter, b * n + parameter)] += spread * spread;
            }
        }
    }
    let mut added = DVector::zeros(size);
    let mut constant = DMatrix::zeros(size, n);
    for run in 0..runs.len() {
        added[run * n + parameter] = pattern[run];
        constant.view_mut((run * n, 0), (n, n)).fill_with_identity();
    }
    let Some(factor) = covariance.cholesky() else { return 0.0 };
    let root = factor.unpack();
    let (Some(added), Some(constant)) =
        (root.solve_lower_triangular(&added), root.solve_lower_triangular(&constant))
    else {
        return 0.0;
    };
    let q = constant.qr().q();
    (added.norm_squared() - q.tr_mul(&added).norm_squared()).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The true parameters add as many squares as was asked for, whatever constant is taken from them.
    #[test]
    fn truth_is_as_strong_as_was_asked_for() {
        for (index, variety) in (0..).zip(Variety::ALL.into_iter().skip(1)) {
            let Campaign { runs, parameter, .. } = Campaign::draw(3, index, variety, 8.0);
            if variety == Variety::Unit {
                continue; // its units spread besides
            }
            let truth =
                DVector::from_iterator(runs.len(), runs.iter().map(|run| run.truth[parameter]));
            let strength = seen(&truth, parameter, &runs, 0.0);
            assert!((strength - 8.0).abs() < 1e-6, "{variety:?}: {strength}");
        }
    }

    /// Estimates scatter about the truth as their covariance says.
    #[test]
    fn estimates_scatter_as_they_say() {
        let (mut sum, mut dof) = (0.0, 0.0);
        for index in 0..200 {
            for run in Campaign::draw(5, index, Variety::Nothing, 0.0).runs {
                let error = &run.estimate - &run.truth;
                let factor = run.covariance.cholesky().expect("positive definite");
                sum += error.dot(&factor.solve(&error));
                dof += error.len() as f64;
            }
        }
        assert!((sum / dof - 1.0).abs() < 5.0 * (2.0 / dof).sqrt(), "{}", sum / dof);
    }
}
