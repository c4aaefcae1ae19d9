//! A held-out run beside the estimate from other runs: which parameters differ.

use rins_diagnosis::same_in_all_runs;
use rins_estimation::{Fit, Run};
use rins_frames::SignedAxes;
use rins_history::{Conditions, History, Homogeneity};
use rins_report::number::figure;
use rins_report::{Item, Section};
use rins_terms::{Model, Owner, Role};

use super::comparison::{RunComparison, by_itself, estimate, is_significant, of_log, quantities};
use super::conditions::conditions;
use super::words::p_value;
use crate::preparation::{EstimationProblem, Prepared};
use crate::table::captioned;

/// The probability of the interval of a forecast.
pub(crate) const INTERVAL: f64 = 0.95;

/// The maximum number of parameters in the summary.
const TOLD: usize = 3;

/// The sensor errors of a held-out run, estimated by itself, beside those of the other runs.
#[derive(Clone, Debug)]
pub(crate) struct HeldOutComparison {
    /// The name of the held-out run.
    pub(crate) name: String,
    /// Each parameter that both determine.
    pub(crate) parameters: Vec<HeldOutParameter>,
}

/// A parameter of a held-out run.
#[derive(Clone, Debug)]
pub(crate) struct HeldOutParameter {
    /// The test of equality; its values are those of the other runs together, and of the held-out run.
    pub(crate) test: Homogeneity,
    /// The unit of the values.
    pub(crate) unit: &'static str,
    /// The estimate of the other runs, with its 1σ.
    pub(crate) expected: (f64, f64),
    /// The estimate of the held-out run, with its 1σ.
    pub(crate) found: (f64, f64),
    /// Of several other runs, the forecast for the held-out run.
    pub(crate) forecast: Option<Forecasted>,
}

/// A parameter of a held-out run, forecast from the differences between the other runs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Forecasted {
    /// The interval that contains the estimate with a probability of [`INTERVAL`].
    pub(crate) interval: (f64, f64),
    /// The estimate of the held-out run with the given model, as those of the other runs that were compared, with its 1σ.
    pub(crate) found: (f64, f64),
}

impl Forecasted {
    /// Whether the interval contains the estimate.
    pub(crate) fn holds(&self) -> bool {
        (self.interval.0..=self.interval.1).contains(&self.found.0)
    }
}

impl HeldOutParameter {
    /// By how many of the 1σ of the difference the estimates differ.
    pub(crate) fn sigmas(&self) -> f64 {
        (self.found.0 - self.expected.0) / f64::hypot(self.found.1, self.expected.1)
    }

    /// Whether both estimates are better than what is typical of the parameter.
    fn is_determined(&self, typical: f64) -> bool {
        self.expected.1.max(self.found.1) < typical
    }
}

impl HeldOutComparison {
    /// Compares a held-out run with a fit of the runs of an estimation problem, and with the forecast from `comparison`. `None` if the
    /// held-out run cannot be estimated by itself.
    pub(crate) fn of(
        problem: &EstimationProblem,
        together: &Fit,
        held_out: &Prepared,
        comparison: Option<&RunComparison>,
    ) -> Option<Self> {
        let runs: Vec<Run> = held_out.rests().cloned().collect();
        let by_itself = |model: &Model| by_itself(problem, &runs, model);
        let own = by_itself(&of_another_run(together.model(), &problem.model))?;
        let together = together.without_linear().along(SignedAxes::IDENTITY);
        let found = quantities([&together, &own], problem.imu());
        let conditions = {
            let logs = problem.runs.iter().chain([held_out]);
            conditions(&logs.map(of_log).collect::<Vec<_>>())
        };
        let of_held_out = *conditions.last()?;
        let alone = comparison.and_then(|_| by_itself(&problem.model));
        let alone = alone.and_then(|fit| estimate(&fit, &found, of_held_out));
        let each = [
            estimate(&together, &found, Conditions::default())?,
            estimate(&own, &found, of_held_out)?,
        ];
        let (units, found): (Vec<_>, Vec<_>) =
            found.into_iter().map(|(unit, of)| (unit.1, of)).unzip();
        let typical: Vec<f64> = found.iter().map(|one| one.typical.1).collect();
        let pair = History::new(found, each.to_vec()).ok()?;
        let forecast = |place: usize, id: &str| {
            let found = alone.as_ref()?.value(place)?;
            let forecast = comparison?.forecast(id, of_held_out)?.estimated_within(found.1);
            Some(Forecasted { interval: forecast.interval(INTERVAL), found })
        };
        let tests = pair.homogeneity().into_iter().zip(units).enumerate();
        let parameters = tests.filter_map(|(place, (test, unit))| {
            let [expected, found] = [test.values[0]?, test.values[1]?];
            let forecast = forecast(place, &test.id);
            let one = HeldOutParameter { test, unit, expected, found, forecast };
            one.is_determined(typical[place]).then_some(one)
        });
        let mut parameters: Vec<HeldOutParameter> = parameters.collect();
        parameters.sort_by(|a, b| a.test.ln_p.total_cmp(&b.test.ln_p));
        Some(Self { name: held_out.name.clone(), parameters })
    }

    /// The parameters whose estimates contradict each other, the most significant first.
    pub(crate) fn contradicting(&self) -> impl Iterator<Item = &HeldOutParameter> {
        let among = self.parameters.len();
        self.parameters.iter().filter(move |one| is_significant(&one.test, among))
    }
}

/// A model for another run of the same IMU: effects of the sensors beyond the given model are held as found; those of a run, of its
/// placement, and of differences between runs are left out.
fn of_another_run(extended: &Model, given: &Model) -> Model {
    let mut model = given.clone();
    let lasts = extended.terms[given.terms.len()..].iter().filter(|one| {
        one.term.owner == Owner::Sensor
            && one.term.is_signal()
            && same_in_all_runs(one.term).is_none()
    });
    model.terms.extend(lasts.cloned().map(|mut one| {
        one.roles.fill(Role::Held);
        one
    }));
    model
}

impl HeldOutComparison {
    /// The result in words.
    pub(crate) fn summary(&self) -> Vec<String> {
        let name = &self.name;
        let mut sentences: Vec<String> =
            self.contradicting().take(TOLD).map(|one| one.contradiction(name)).collect();
        let more = self.contradicting().skip(TOLD).count();
        if more > 0 {
            sentences.push(format!("{more} more parameters of {name} differ significantly."));
        }
        if sentences.is_empty() {
            sentences.push(match self.parameters.len() {
                0 => format!(
                    "{name} and the other runs have no parameter of the sensors in common that both determine."
                ),
                total => format!(
                    "None of {total} parameters differs significantly between {name} and the other runs (p > 0.01, family-wise)."
                ),
            });
        }
        sentences
    }

    /// The section of a report page.
    pub(crate) fn section(&self) -> Section {
        let mut rows = vec![
            [
                "parameter",
                "other runs",
                "held-out run",
                "difference",
                "p",
                "p beside others",
                "forecast (95 %)",
                "unit",
            ]
            .map(String::from)
            .to_vec(),
        ];
        for one in &self.parameters {
            rows.push(vec![
                one.test.id.clone(),
                with_sigma(one.expected),
                with_sigma(one.found),
                format!("{:.1}σ", one.sigmas()),
                p_value(one.test.ln_p),
                p_value(one.test.ln_p_beside),
                one.forecast.map_or_else(
                    || "–".into(),
                    |of| {
                        let (low, high) = of.interval;
                        format!(
                            "{} in {} to {}",
                            with_sigma(of.found),
                            figure(low, 4),
                            figure(high, 4)
                        )
                    },
                ),
                one.unit.into(),
            ]);
        }
        let caption = "Estimates of the sensor errors from the held-out run by itself and from the other runs together";
        let table = captioned(caption, &rows);
        Section {
            heading: "Held-out run".into(),
            intro: self.summary().join(" "),
            items: vec![Item::Table(table)],
        }
    }
}

impl HeldOutParameter {
    fn contradiction(&self, name: &str) -> String {
        let Self { test, unit, expected, found, .. } = self;
        let difference = figure(found.0 - expected.0, 3).replace('-', "−");
        let forecast = self.forecast.map_or_else(String::new, |of| {
            format!(
                ". The forecast from the differences between the other runs, {} to {} {unit} (95 %), {} it",
                figure(of.interval.0, 3),
                figure(of.interval.1, 3),
                if of.holds() { "includes" } else { "does not include" }
            )
        });
        format!(
            "In {name} {} is {} {unit}, in the other runs {} {unit}: a difference of {difference} {unit} ({:.0}σ){forecast}.",
            test.id,
            with_sigma(*found),
            with_sigma(*expected),
            self.sigmas().abs()
        )
    }
}

fn with_sigma((value, sigma): (f64, f64)) -> String {
    let (value, sigma) = rins_report::number::estimate(value, sigma);
    format!("{value} ± {sigma}")
}
