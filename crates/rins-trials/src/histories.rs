//! Trials of the histories: simulated campaigns of runs, what varies in them, and how well the last run is predicted.

use std::fmt::Write as _;

use rins_blind::{Campaign, CampaignRun, Variety};
use rins_history::{
    Conditions, Explanation, Forecast, History, HistoryError, Kind, Past, Quantity, RunEstimate,
    baselines,
};

use crate::statistics::Share;

/// The strengths of what varies, in sigmas.
const STRENGTHS: [f64; 3] = [5.0, 8.0, 20.0];

/// The probability of the intervals that are checked.
const INTERVAL: f64 = 0.95;

/// The typical variation of a parameter, relative to the 1σ that its data sheet states.
const TYPICAL: (f64, f64) = (0.01, 3.0);

const HEAD: &str = "# Trials of histories

How well `rins history` names what varies between runs, and predicts the next run. Campaigns of 5 to 16 runs are simulated apart from
the code that analyzes them: 3 to 6 parameters with correlated estimates, power-ons of one or several runs, dates, times since power-on,
temperatures, one unit or a fleet of 6 to 16. One parameter varies; the tables state how many sigmas of its variation a constant does
not explain. The last run is predicted from the runs before it. `cargo xtask histories` runs them and writes this page.

";

/// What came of one campaign.
#[derive(Clone, Debug)]
pub struct HistoryTrial {
    variety: Variety,
    strength: f64,
    /// Whether anything is named, and whether the truth is named or in a credible set.
    named: bool,
    in_set: bool,
    first: bool,
    /// How many parameters are named that do not vary.
    false_names: usize,
    /// Of every parameter of the last run: whether the interval contains its estimate, and the scores of the forecasts.
    predicted: Vec<Predicted>,
    /// The credible sets of what is named.
    sets: Vec<String>,
}

/// The forecast of one parameter of the last run.
#[derive(Clone, Debug)]
struct Predicted {
    varies: bool,
    covered: bool,
    /// In units of the data sheet's 1σ: ours, and those of the last value, the mean, and a line over the date.
    crps: [f64; 4],
}

impl std::fmt::Display for HistoryTrial {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let covered = self.predicted.iter().filter(|one| one.covered).count();
        let [named, set, first] = [self.named, self.in_set, self.first].map(u8::from);
        write!(
            f,
            "{:24} {:4.0} sigma: named {named}, in a set {set}, first {first}, false {}, {covered} of {} covered [{}]",
            self.variety.name(),
            self.strength,
            self.false_names,
            self.predicted.len(),
            self.sets.join("; ")
        )
    }
}

/// Draws, explains and predicts campaign number `index` of those under `seed`.
///
/// # Errors
/// [`HistoryError`] if the campaign cannot be analyzed.
pub fn history_trial(seed: u64, index: u64) -> Result<HistoryTrial, HistoryError> {
    let place = usize::try_from(index).unwrap_or_default();
    let variety = Variety::ALL[place % Variety::ALL.len()];
    let strength = STRENGTHS[place / Variety::ALL.len() % STRENGTHS.len()];
    let campaign = Campaign::draw(seed, index, variety, strength);
    let whole = history(&campaign, campaign.runs.len())?.explain();
    let id = campaign.parameter.to_string();
    let is_true = |own: &str, kind: Kind| own == id && is_of(variety, kind);
    let in_set = |explanation: &Explanation| {
        explanation.causes().iter().any(|cause| {
            is_true(&cause.id, cause.variation.kind())
                || cause.alternatives.iter().any(|one| is_true(&one.id, one.kind))
        })
    };
    let named = !whole.causes().is_empty();
    let first = whole.causes().first();
    let other = |cause: &&rins_history::Cause| {
        variety == Variety::Nothing || cause.alternatives.iter().all(|one| one.id != id)
    };
    Ok(HistoryTrial {
        variety,
        strength: campaign.strength,
        named,
        in_set: in_set(&whole),
        first: first.is_some_and(|cause| is_true(&cause.id, cause.variation.kind())),
        false_names: whole.causes().iter().filter(other).count(),
        predicted: predicted(&campaign)?,
        sets: whole.causes().iter().map(|cause| set(&id, cause)).collect(),
    })
}

/// A credible set in one line; parameters other than this one with their ids.
fn set(id: &str, cause: &rins_history::Cause) -> String {
    let of = |one: &rins_history::Alternative| {
        let of = if one.id == id { String::new() } else { format!("{} ", one.id) };
        format!("{of}{} {:.2}", one.kind.id(), one.probability)
    };
    cause.alternatives.iter().map(of).collect::<Vec<_>>().join(" | ")
}

/// Whether a variation is what was hidden.
fn is_of(variety: Variety, kind: Kind) -> bool {
    match variety {
        Variety::Nothing => false,
        Variety::TurnOn => kind == Kind::TurnOn,
        Variety::Date => kind == Kind::Drift,
        Variety::SincePowerOn => kind == Kind::DriftSincePowerOn,
        Variety::WarmUp => kind == Kind::WarmUp,
        Variety::Linear => kind == Kind::Linear,
        Variety::Quadratic => kind == Kind::Quadratic,
        Variety::Hysteresis => kind == Kind::Hysteresis,
        Variety::Shock => kind == Kind::Change,
        Variety::Unit => kind == Kind::Unit,
    }
}

/// The history of the first so many runs.
fn history(campaign: &Campaign, runs: usize) -> Result<History, HistoryError> {
    let of = |(place, sheet): (usize, &f64)| Quantity {
        id: place.to_string(),
        typical: (TYPICAL.0 * sheet, TYPICAL.1 * sheet),
    };
    let quantities = campaign.sheet.iter().enumerate().map(of).collect();
    let places: Vec<usize> = (0..campaign.sheet.len()).collect();
    let estimate = |run: &CampaignRun| {
        let values = run.estimate.as_slice();
        RunEstimate::measured(conditions(run), (places.len(), &places), values, &run.covariance)
    };
    let runs = campaign.runs[..runs].iter().map(estimate).collect::<Result<_, _>>()?;
    History::new(quantities, runs)
}

fn conditions(run: &CampaignRun) -> Conditions {
    Conditions {
        unit: run.unit,
        power_on: run.power_on,
        date: Some(run.date),
        since_power_on: Some(run.since_power_on),
        temperature: Some(run.temperature),
        warming: Some(run.warming),
    }
}

/// The parameters of the last run, predicted from the others.
fn predicted(campaign: &Campaign) -> Result<Vec<Predicted>, HistoryError> {
    let before = campaign.runs.len() - 1;
    let explanation = history(campaign, before)?.explain();
    let last = &campaign.runs[before];
    let mut all = Vec::new();
    for (place, sheet) in campaign.sheet.iter().enumerate() {
        let Some(forecast) = explanation.forecast(place, conditions(last))? else { continue };
        let own = last.covariance[(place, place)].sqrt();
        let forecast = forecast.estimated_within(own);
        let outcome = last.estimate[place];
        let (low, high) = forecast.interval(INTERVAL);
        let of = |forecast: &Forecast| forecast.crps(outcome) / sheet;
        let past = campaign.runs[..before]
            .iter()
            .map(|run| Past { date: run.date, value: run.estimate[place] });
        let Some(simple) = baselines(&past.collect::<Vec<_>>(), last.date, own) else { continue };
        all.push(Predicted {
            varies: campaign.variety != Variety::Nothing && place == campaign.parameter,
            covered: low < outcome && outcome < high,
            crps: [of(&forecast), of(&simple[0]), of(&simple[1]), of(&simple[2])],
        });
    }
    Ok(all)
}

/// The page of some trials, analyzed by the program of this revision.
pub fn history_page(trials: &[HistoryTrial], seed: u64, revision: &str) -> String {
    let mut page = String::from(HEAD);
    let _ = writeln!(
        page,
        "{} campaigns of seed {seed} at revision {revision}. Brackets give counts and the bounds of Clopper and Pearson at 95 %.\n",
        trials.len()
    );
    let share = |of: &dyn Fn(&HistoryTrial) -> Option<bool>| {
        Share::count(trials.iter().filter_map(of)).text()
    };
    let strong = |trial: &HistoryTrial, strength: f64| {
        trial.strength > 0.0 && (trial.strength - strength).abs() < 1e-9
    };
    page.push_str("| what | fraction |\n| --- | --- |\n");
    let nothing =
        share(&|trial| (trial.variety == Variety::Nothing).then_some(trial.false_names > 0));
    let _ = writeln!(page, "| a variation is named where nothing varies | {nothing} |");
    let beside =
        share(&|trial| (trial.variety != Variety::Nothing).then_some(trial.false_names > 0));
    let _ = writeln!(page, "| a parameter is named beside the one that varies | {beside} |");
    for strength in STRENGTHS {
        let found = share(&|trial| strong(trial, strength).then_some(trial.named));
        let set = share(&|trial| strong(trial, strength).then_some(trial.in_set));
        let first = share(&|trial| strong(trial, strength).then_some(trial.first));
        let _ = writeln!(page, "| {strength} sigma: something is named | {found} |");
        let _ =
            writeln!(page, "| {strength} sigma: the truth is named or in a credible set | {set} |");
        let _ = writeln!(page, "| {strength} sigma: the truth is named first | {first} |");
    }
    page.push_str("\n| what varies | in the set at 8 sigma | at 20 sigma |\n| --- | --- | --- |\n");
    for variety in Variety::ALL.into_iter().skip(1) {
        let at = |strength: f64| {
            share(&|trial| {
                (trial.variety == variety && strong(trial, strength)).then_some(trial.in_set)
            })
        };
        let _ = writeln!(page, "| {} | {} | {} |", variety.name(), at(8.0), at(20.0));
    }
    page.push_str(
        "\nThe strength of a unit unlike its fleet is relative to the true spread of the fleet, which has to be estimated from the other \
         units: few units show little of it.\n",
    );
    page.push_str(
        "\nThe last run, predicted from the runs before. The continuous ranked probability score (CRPS) is relative to those of \
         three simple forecasts, each with the spread of its own errors: of sums, and in parentheses the geometric mean; below one is better.\n\n\
         | parameters | 95 % interval contains the estimate | CRPS, relative to the last value | the mean | the line |\n\
         | --- | --- | --- | --- | --- |\n",
    );
    let mut row = |name: &str, of: &dyn Fn(&HistoryTrial, &Predicted) -> bool| {
        let own = |trial: &'_ HistoryTrial| {
            let all = trial.predicted.iter().filter(|one| of(trial, one));
            all.cloned().collect::<Vec<Predicted>>()
        };
        let all: Vec<Predicted> = trials.iter().flat_map(own).collect();
        let covered = Share::count(all.iter().map(|one| one.covered)).text();
        // A mean of ratios: parameters of different sizes count alike.
        let relative = |which: usize| {
            let ln: f64 = all.iter().map(|one| (one.crps[0] / one.crps[which]).ln()).sum();
            let sum = |which: usize| all.iter().map(|one| one.crps[which]).sum::<f64>();
            format!("{:.3} ({:.3})", sum(0) / sum(which), (ln / all.len() as f64).exp())
        };
        let _ = writeln!(
            page,
            "| {name} | {covered} | {} | {} | {} |",
            relative(1),
            relative(2),
            relative(3)
        );
    };
    row("those that do not vary", &|_, one| !one.varies);
    row("those that vary", &|_, one| one.varies);
    for variety in Variety::ALL.into_iter().skip(1) {
        row(variety.name(), &|trial, one| one.varies && trial.variety == variety);
    }
    page
}
