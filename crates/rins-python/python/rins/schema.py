"""The fields of all results as typed dicts.

Made from the JSON schemas of the results by `schema_types.py`; do not edit.
"""

from __future__ import annotations

from typing import NotRequired, TypedDict


class AboutAxes(TypedDict):
    """The 1σ about the axes of the navigation frame [deg]."""

    east: float
    """About east."""

    north: float
    """About north."""

    up: NotRequired[float | None]
    """About up; null if north was not found."""


class AccelNoiseResult(TypedDict):
    """The noise of the accelerometers."""

    bias_instability_ug: float
    """Bias instability [µg]."""

    random_walk_ug_sqrt_h: float
    """Acceleration random walk [µg/√h]."""

    white_ug_sqrt_hz: float
    """White noise [µg/√Hz]."""


class AlignResult(TypedDict):
    """The result of `rins align`."""

    accel_bias_ug: list[float]
    """The accelerometer biases along the sensor's own axes, as far as gravity shows them [µg]."""

    apparent: ApparentSite
    """What the sensors show of the site."""

    assumptions: list[str]
    """What was neither measured nor stated, and therefore assumed."""

    attitude_deg: LeveledDegrees
    """The attitude of the body frame [deg]."""

    command: str
    """`align`."""

    gyro_bias_deg_h: NotRequired[list[float] | None]
    """The gyro biases along the sensor's own axes [deg/h]; null if north was not found."""

    gyro_bias_observable: NotRequired[list[bool] | None]
    """Whether the static interval shows each, or it is what was assumed."""

    gyro_bias_sigma_deg_h: NotRequired[list[float] | None]
    """The 1σ of these [deg/h]."""

    header_attitude_deg: NotRequired[EulerDegrees | None]
    """The attitude that the header of a PSINS log has [deg]."""

    provenance: ProvenanceResult
    """The program, its inputs, the item and its measurement."""

    repairs: list[str]
    """What reading the logs has repaired or left out."""

    rig: str
    """The rig file."""

    schema: int
    """The version of this schema: 2."""

    sigma_deg: AboutAxes
    """The 1σ of the attitude error [deg]."""

    site: ExpectedSite
    """What the rig file says of it."""

    static_interval_s: list[float]
    """Start and end of the static interval that was used [s]."""

    static_intervals: list[StaticIntervalResult]
    """The static intervals of the log."""


class AllanResult(TypedDict):
    """The result of `rins allan`."""

    assumptions: list[str]
    """What was neither measured nor stated, and therefore assumed."""

    channels: list[ChannelResult]
    """The gyros, then the accelerometers, along the sensors' own axes."""

    command: str
    """`allan`."""

    confidence: float
    """The confidence of the bounds."""

    interval_s: float
    """The mean interval between samples [s]."""

    lost_samples: int
    """How many lost samples were filled in."""

    provenance: ProvenanceResult
    """The program, its inputs, the item and its measurement."""

    repairs: list[str]
    """What reading the logs has repaired or left out."""

    rig: str
    """The rig file."""

    schema: int
    """The version of this schema: 2."""

    static_interval_s: list[float]
    """Start and end of the static interval that was used [s]."""

    static_intervals: list[StaticIntervalResult]
    """The static intervals of the log."""


class AlternativeResult(TypedDict):
    """An alternative to a cause."""

    effect: str
    """The id of the effect."""

    ln_posterior_odds: float
    """The logarithm of its posterior odds against the cause."""

    name: str
    """Its name."""

    probability: float
    """Its posterior probability."""


class ApparentSite(TypedDict):
    """What the sensors show of the site."""

    earth_rate_deg_h: float
    """The magnitude of the mean angular rate [deg/h]."""

    earth_rate_sigma_deg_h: float
    """The 1σ of that [deg/h]."""

    gravity_m_s2: float
    """The magnitude of the mean specific force [m/s²]."""

    latitude_deg: NotRequired[float | None]
    """The latitude at which the rate makes this angle with gravity [deg]; null if north was not
    found."""

    latitude_sigma_deg: NotRequired[float | None]
    """The 1σ of that [deg]."""


class ApplyResult(TypedDict):
    """The result of `rins apply`."""

    assumptions: list[str]
    """What was neither measured nor stated, and therefore assumed."""

    calibration: str
    """The calibration file."""

    command: str
    """`apply`."""

    compensated: list[str]
    """The ids of the terms that were compensated."""

    exact: bool
    """Whether the new log, read again, is the same to the last bit."""

    format: str
    """The format of the new log."""

    left_out: list[str]
    """What the format has no room for."""

    log: str
    """The new log."""

    new_rig: str
    """The rig file of the new log."""

    notes: list[str]
    """The same in sentences."""

    outside_calibrated_range: NotRequired[OutsideRange | None]
    """What of the log lies outside of what the calibration covers."""

    provenance: ProvenanceResult
    """The program, its inputs, the item and its measurement."""

    repairs: list[str]
    """What reading the logs has repaired or left out."""

    rig: str
    """The rig file."""

    samples: int
    """How many samples were written."""

    schema: int
    """The version of this schema: 2."""

    time_origin_s: float
    """The time of the log from which the new one counts [s]."""


class BeforeAfterResult(TypedDict):
    """Free inertial navigation as recorded, and with what was estimated compensated; both from
    the same attitude."""

    after: NavigationResult
    """Compensated."""

    before: NavigationResult
    """As recorded."""


class CalibrateBudgetResult(TypedDict):
    """The error budget of free inertial navigation from rest."""

    after_s: float
    """The duration of free inertial navigation [s]."""

    parameters: list[ContributionResult]
    """The contribution of each parameter."""

    total_1_sigma: DriftResult
    """The 1σ of the drift due to all parameters, with their correlations."""


class CalibrateResult(TypedDict):
    """The result of `rins calibrate`."""

    assumptions: list[str]
    """What was neither measured nor stated, and therefore assumed."""

    axis_attitude_deg: EulerDegrees
    """The attitude of the axis frame of the first run, as estimated [deg]."""

    command: str
    """`calibrate`."""

    compensation: str
    """How errors are compensated."""

    conformity: NotRequired[list[ConformityResult]]
    """Whether the errors are within the tolerances that the rig file states."""

    consistency: ConsistencyResult
    """What the innovations of all runs say of the model."""

    correlation: list[list[float]]
    """Their correlation, n by n."""

    error_budget: CalibrateBudgetResult
    """The error budget of free inertial navigation over the first run."""

    homogeneity: NotRequired[list[HomogeneityResult]]
    """Of several runs, the test of each parameter of the sensors whether it is the same in all:
    each run was estimated by itself."""

    identifiability: IdentifiabilityResult
    """What is observable of all parameters together."""

    iterations: list[IterationResult]
    """The iterations of the estimate; none of the paper's filter."""

    log_likelihood: NotRequired[float | None]
    """The log-likelihood [nats]; null of the paper's filter."""

    model: str
    """The model: `paper12`, `full` or the name of a model file."""

    navigation: BeforeAfterResult
    """Free navigation of the first run before and after compensation."""

    noise: NotRequired[NoiseResult | None]
    """The noise; null of the paper's filter, which trusts the data sheet."""

    notes: list[str]
    """What else is to be known."""

    parameters: list[ParameterResult]
    """The estimates."""

    prior_consistency: list[DepartureResult]
    """What lies more than four sigmas off what was stated beforehand, the furthest first."""

    provenance: ProvenanceResult
    """The program, its inputs, the item and its measurement."""

    repairs: list[str]
    """What reading the logs has repaired or left out."""

    rig: str
    """The rig file of the first run."""

    rigs: list[str]
    """The rig files of all runs."""

    runs: list[RunResult]
    """What belongs to one run each; none of the paper's filter."""

    schema: int
    """The version of this schema: 2."""

    static_intervals: list[StaticIntervalResult]
    """The static intervals of all runs."""

    variations: NotRequired[list[VariationResult]]
    """How parameters vary between the runs, the most significant first."""


class CampaignResult(TypedDict):
    """The result of `rins monte-carlo` and `rins merge`."""

    assumptions: list[str]
    """What was neither measured nor stated, and therefore assumed."""

    cells: list[CellResult]
    """The scenarios of the grid."""

    command: str
    """`monte-carlo` or `merge`."""

    model: NotRequired[str | None]
    """The estimated model: `full` or a model file; absent for the three parameters of the
    paper's filter."""

    noise: NotRequired[str | None]
    """The noise parameters of a model's estimation: `likely` (estimated) or `given` (of the
    data sheet)."""

    provenance: ProvenanceResult
    """The program, its inputs, the item and its measurement."""

    repairs: list[str]
    """What reading the logs has repaired or left out."""

    report: str
    """The page beside it."""

    results: str
    """The file of the results."""

    runs: int
    """How many runs of each scenario."""

    scenario: str
    """The scenario file, or the shards."""

    schema: int
    """The version of this schema: 2."""

    seed: int
    """The seed."""

    shard: list[int]
    """The shard, and of how many."""

    truth: NotRequired[str | None]
    """The true values of a model's parameters: `prior` (drawn in each run) or `scenario`."""


class CauseParameterResult(TypedDict):
    """A parameter of a cause, in its unit."""

    id: str
    """Its id."""

    run: NotRequired[int | None]
    """The run to which it belongs, from 1; null if it belongs to all."""

    samples: NotRequired[float | None]
    """The same in samples, if it is a time."""

    sigma: float
    """Its 1σ."""

    typical_range: list[float]
    """The typical range of its magnitude."""

    unit: str
    """The unit."""

    value: float
    """The value."""


class CauseResult(TypedDict):
    """A cause: an effect that the model lacks."""

    across: NotRequired[str | None]
    """`runs` if the effect is an error of the sensors that differs between runs; null
    otherwise."""

    alternatives: list[AlternativeResult]
    """These with their odds."""

    cannot_tell_from: list[str]
    """The ids of the effects from which these runs do not distinguish it."""

    delta_log_likelihood: float
    """By how much the log-likelihood rises [nats]."""

    dof: int
    """How many directions of its parameters the runs show."""

    effect: str
    """The id of the effect in the catalogue."""

    equation: str
    """Its equation."""

    ln_p: float
    """Its natural logarithm."""

    meaning: str
    """Its physical cause."""

    name: str
    """Its name."""

    next_test: NotRequired[NextTestResult | None]
    """The run that would distinguish it from the likeliest of these."""

    no_next_test: NotRequired[str | None]
    """Why none could be proposed."""

    p_value: float
    """The family-wise p-value over the catalogue; zero where it is too small for a number."""

    parameters: list[CauseParameterResult]
    """Its parameters."""

    plausible: bool
    """Whether such an instrument may have it so large."""

    probability: float
    """The posterior probability that it is this effect and none of its alternatives."""

    settings: dict[str, SettingResult]
    """Its settings by name."""

    settings_in_words: str
    """The same in words."""

    sigmas: float
    """How many sigmas its parameters are from zero, all together."""

    tell_apart_by: str
    """What would distinguish it, by the catalogue."""


class CellResult(TypedDict):
    """What the runs of one scenario say together; of too few runs only `grid` and `runs` are
    there."""

    combinations: NotRequired[list[CombinationResult] | None]
    """The well-determined combinations of the parameters; of a model only."""

    consistent: NotRequired[bool | None]
    """Whether the NEES is within its bounds."""

    failed: NotRequired[int | None]
    """How many have no estimate."""

    grid: dict[str, str]
    """What distinguishes it from the others of the grid: keys and values."""

    nees: NotRequired[float | None]
    """The mean normalized estimation error squared."""

    nees_bounds_99: NotRequired[list[float] | None]
    """Its 99 % bounds then."""

    nees_dof: NotRequired[int | None]
    """How much it is if the covariances are consistent."""

    nees_dof_mean: NotRequired[float | None]
    """The mean number of degrees of freedom of `nees` of a run; of a model only."""

    nis_ratio: NotRequired[float | None]
    """The mean normalized innovation squared over its degrees of freedom."""

    not_converged: NotRequired[int | None]
    """How many runs with an estimate did not converge (their last step is 0.1 sigma or more);
    of a model only."""

    parameters: list[ScatterResult]
    """The parameters."""

    rank_band: NotRequired[RankBandResult | None]
    """The simultaneous confidence band of all `ecdf_difference`; of a model only."""

    runs: int
    """How many runs there are."""


class ChangeResult(TypedDict):
    """The change of one parameter, in its unit."""

    after: EstimateResult
    """The estimate after."""

    before: EstimateResult
    """The estimate before."""

    difference: float
    """After less before."""

    id: str
    """Its id."""

    sigma: float
    """The 1σ of the difference."""

    sigmas: float
    """The difference in sigmas."""

    unit: str
    """Its unit."""


class ChannelResult(TypedDict):
    """The noise of one sensor."""

    channel: str
    """Such as `gyro.x`."""

    deviation: list[float]
    """The Allan deviation at each."""

    disagreement: float
    """By what share of the variance the terms disagree with the deviation."""

    explained_from_s: float
    """The shortest averaging time from which on the terms explain the deviation [s]."""

    fitted: list[float]
    """What the noise terms make of it."""

    high: list[float]
    """Its upper bound."""

    low: list[float]
    """Its lower bound."""

    spectral_lines: list[LineResult]
    """The spectral lines that were taken out before."""

    tau_s: list[float]
    """The averaging times [s]."""

    terms: list[NoiseTermResult]
    """The noise terms."""

    unit: str
    """The unit of the deviation."""


class CheckResult(TypedDict):
    """The result of `rins check`."""

    assumptions: list[str]
    """What was neither measured nor stated, and therefore assumed."""

    command: str
    """`check`."""

    corrections: list[CorrectionResult]
    """Changes of the rig file of which one would put these right."""

    earth_rate_visible: bool
    """Whether the gyros are quiet enough for the Earth's rate to show."""

    expected_gravity_m_s2: float
    """Gravity at the site [m/s²]."""

    gaps: list[GapResult]
    """The gaps."""

    jitter_rms_s: float
    """The root mean square jitter of the time stamps [s]."""

    provenance: ProvenanceResult
    """The program, its inputs, the item and its measurement."""

    rate_hz: float
    """How many samples a second [Hz]."""

    remarks: list[str]
    """What is odd, each in a sentence; mistakes first."""

    repairs: list[str]
    """What reading the logs has repaired or left out."""

    rig: str
    """The rig file."""

    samples: int
    """How many samples there are."""

    schema: int
    """The version of this schema: 2."""

    spin_ratio: NotRequired[float | None]
    """What the gyro about the axis of rotation counts of the table's rotation; null without a
    table."""

    static_intervals: list[StaticIntervalResult]
    """All static intervals, stated or found, and why one is not used."""

    static_means: list[StaticMeanResult]
    """The static intervals of a second or more, with what they show."""

    suspicions: list[str]
    """Likely mistakes of units, signs and axes, each in a sentence."""

    table_latency_s: NotRequired[float | None]
    """By how much the table angle is older than the sample beside it [s]; null if the log does
    not show it."""

    table_latency_sigma_s: NotRequired[float | None]
    """The 1σ of that [s]."""

    turns: float
    """How often the IMU turns about its axis of rotation, either way."""

    verdicts: list[VerdictResult]
    """A verdict on each thing that can be wrong with a log."""


class CombinationResult(TypedDict):
    """A well-determined combination: an eigenvector of the posterior covariance of the first
    run, in units of the prior sigmas."""

    error_std: float
    """The standard deviation of the errors."""

    mean_error: float
    """The mean error."""

    posterior: PosteriorResult
    """The calibration of its posterior."""

    sigma_rms: float
    """The posterior sigma; the prior sigma is 1."""

    weights: dict[str, float]
    """The weight of each parameter, divided by its prior sigma; weights below 0.001 are
    omitted."""


class CompareResult(TypedDict):
    """The result of `rins compare`."""

    after: str
    """The calibration after."""

    assumptions: list[str]
    """What was neither measured nor stated, and therefore assumed."""

    before: str
    """The calibration before."""

    command: str
    """`compare`."""

    only_after: list[str]
    """Those of what only the second has estimated."""

    only_before: list[str]
    """The ids of what only the first has estimated."""

    parameters: list[ChangeResult]
    """What both have estimated."""

    provenance: ProvenanceResult
    """The program, its inputs, the item and its measurement."""

    repairs: list[str]
    """What reading the logs has repaired or left out."""

    schema: int
    """The version of this schema: 2."""

    together: NotRequired[TogetherResult | None]
    """All differences together; null if their covariance is singular."""


class ComparedResult(TypedDict):
    """A schedule beside the others."""

    duration_s: float
    """How long it takes [s]."""

    name: str
    """Its name."""

    observable: int
    """The number of parameters that are observable by themselves."""

    parameters: list[PredictedResult]
    """The parameters."""

    value: NotRequired[float | None]
    """The value of the criterion; null if the schedule leaves it undetermined."""


Conformity = str


class ConformityResult(TypedDict):
    """The statement on one error, in the unit of the parameter."""

    expanded: NotRequired[float | None]
    """The expanded uncertainty of 95 %; null if the error is not determined."""

    id: str
    """The id of the parameter."""

    statement: Conformity
    """The statement."""

    tolerance: float
    """The largest magnitude that is permitted."""

    unit: str
    """The unit."""

    value: NotRequired[float | None]
    """The estimate; null if the error is not determined."""


class ConsistencyResult(TypedDict):
    """What the innovations say of the model."""

    channel_rms: list[float]
    """The root mean square of each channel of the whitened innovations: 1 if the model is
    right."""

    model_fits: bool
    """Whether the verdict is no misfit."""

    nis_dof: float
    """How much it would be if the model were right: the mean number of channels of an epoch."""

    nis_mean: float
    """The mean normalized innovation squared of an epoch."""

    nis_p: float
    """The p-value of the mean NIS."""

    verdict: str
    """`fits`, `noise_overstated` or `misfit`."""

    whiteness_p: float
    """The p-value of the whiteness of the innovations."""


class ConsistentResult(TypedDict):
    """Whether held-out data are predicted within the stated uncertainty, without and with the
    causes."""

    after: bool
    """With."""

    before: bool
    """Without."""


class ContributionOfReference(TypedDict):
    """What the accuracy of one reference adds to the uncertainty."""

    contribution: float
    """By how much the estimate changes with that, in the unit of the parameter."""

    distribution: str
    """The distribution: `rectangular`."""

    reference: str
    """The key of the rig file."""

    standard_uncertainty_si: float
    """The standard uncertainty of the reference, in SI units."""


class ContributionResult(TypedDict):
    """The contribution of one parameter."""

    by_sigma: DriftResult
    """The drift due to its 1σ."""

    by_value: DriftResult
    """The drift due to its value if it is not compensated."""

    id: str
    """The id of the parameter."""


class ConvertResult(TypedDict):
    """The result of `rins convert`."""

    assumptions: list[str]
    """What was neither measured nor stated, and therefore assumed."""

    command: str
    """`convert`."""

    differences: list[DifferenceResult]
    """What differs when it is read again."""

    exact: bool
    """Whether the new log, read again, is the same to the last bit."""

    format: str
    """The format of the new log."""

    left_out: list[str]
    """What the format has no room for."""

    log: str
    """The new log."""

    new_rig: str
    """The rig file of the new log."""

    provenance: ProvenanceResult
    """The program, its inputs, the item and its measurement."""

    repairs: list[str]
    """What reading the logs has repaired or left out."""

    rig: str
    """The rig file."""

    samples: int
    """How many samples were written."""

    schema: int
    """The version of this schema: 2."""

    time_origin_s: float
    """The time of the log from which the new one counts [s]."""


class CorrectionResult(TypedDict):
    """A change of the rig file."""

    accel_axes: NotRequired[list[str] | None]
    """`axes` under `[log] accel`, if it is to change."""

    gyro_axes: NotRequired[list[str] | None]
    """`axes` under `[log] gyro`, if it is to change."""

    table_direction: NotRequired[str | None]
    """The direction of rotation in which the table's angle is counted, if it is to change."""


class CoverageResult(TypedDict):
    """The coverage of a central interval of the posteriors."""

    fraction: float
    """The fraction of the intervals that contain the true value."""

    interval_95: list[float]
    """The 95 % Clopper-Pearson interval of the fraction."""

    nominal: float
    """The probability of the interval."""


class DemoBudgetResult(TypedDict):
    """The error budget of free inertial navigation from rest."""

    after_s: float
    """The duration of free inertial navigation [s]."""

    parameters: list[ContributionResult]
    """The contribution of each parameter."""

    total_1_sigma: DriftResult
    """The 1σ of the drift due to all parameters, with their correlations."""


class DemoResult(TypedDict):
    """The result of `rins demo`."""

    assumptions: list[str]
    """What was neither measured nor stated, and therefore assumed."""

    axis_attitude_deg: EulerDegrees
    """The attitude of the axis frame of the first run, as estimated [deg]."""

    command: str
    """`calibrate`."""

    compensation: str
    """How errors are compensated."""

    conformity: NotRequired[list[ConformityResult]]
    """Whether the errors are within the tolerances that the rig file states."""

    consistency: ConsistencyResult
    """What the innovations of all runs say of the model."""

    correlation: list[list[float]]
    """Their correlation, n by n."""

    diagnosis: DiagnoseResult
    """Its diagnosis."""

    error_budget: DemoBudgetResult
    """The error budget of free inertial navigation over the first run."""

    homogeneity: NotRequired[list[HomogeneityResult]]
    """Of several runs, the test of each parameter of the sensors whether it is the same in all:
    each run was estimated by itself."""

    identifiability: IdentifiabilityResult
    """What is observable of all parameters together."""

    iterations: list[IterationResult]
    """The iterations of the estimate; none of the paper's filter."""

    log_likelihood: NotRequired[float | None]
    """The log-likelihood [nats]; null of the paper's filter."""

    model: str
    """The model: `paper12`, `full` or the name of a model file."""

    navigation: BeforeAfterResult
    """Free navigation of the first run before and after compensation."""

    noise: NotRequired[NoiseResult | None]
    """The noise; null of the paper's filter, which trusts the data sheet."""

    notes: list[str]
    """What else is to be known."""

    parameters: list[ParameterResult]
    """The estimates."""

    prior_consistency: list[DepartureResult]
    """What lies more than four sigmas off what was stated beforehand, the furthest first."""

    provenance: ProvenanceResult
    """The program, its inputs, the item and its measurement."""

    repairs: list[str]
    """What reading the logs has repaired or left out."""

    rig: str
    """The rig file of the first run."""

    rigs: list[str]
    """The rig files of all runs."""

    runs: list[RunResult]
    """What belongs to one run each; none of the paper's filter."""

    schema: int
    """The version of this schema: 2."""

    static_intervals: list[StaticIntervalResult]
    """The static intervals of all runs."""

    variations: NotRequired[list[VariationResult]]
    """How parameters vary between the runs, the most significant first."""


class DepartureResult(TypedDict):
    """A quantity that lies further off than was stated beforehand."""

    expected: float
    """What was expected."""

    id: str
    """The parameter, or `gyro.noise` or `accel.noise`."""

    sigma: float
    """The 1σ of the prior; for noise the 1σ of its logarithm times the stated value."""

    sigmas: float
    """The departure in units of its standard deviation from prior and data; for noise, that of
    the logarithm."""

    unit: str
    """The unit."""

    value: float
    """What was found."""


class DesignResult(TypedDict):
    """The result of `rins design`."""

    assumptions: list[str]
    """What was neither measured nor stated, and therefore assumed."""

    better_than_prior: NotRequired[int | None]
    """How many directions the data determine better than what was known beforehand."""

    bound: float
    """The best value that the equivalence theorem leaves possible in these orientations, in
    runs without ramps and ends."""

    candidates: int
    """The number of candidates: motions of the table in orientations of its axis."""

    combination: list[str]
    """Those that are observable only in combinations."""

    command: str
    """`design`."""

    criterion: str
    """The criterion: `variance` (c- and A-optimal), `determinant` (D-optimal) or `distance` (of
    two effects)."""

    efficiency: float
    """The efficiency of the schedule relative to the bound: the ratio of variances, or of
    squared separations."""

    files: list[str]
    """The scenario files among the files."""

    gap: float
    """The gap of the approximate design: no other schedule in these orientations gains more
    than this, relative to the variance, the geometric mean of the variances, or the squared
    separation."""

    gauges: list[GaugeResult]
    """The gauges: combinations that no schedule shows."""

    given_value: NotRequired[float | None]
    """That of the given schedule; null if it leaves it undetermined."""

    goal: str
    """What `value` is, in words."""

    least_information: NotRequired[float | None]
    """The information that the least observable direction has for itself, in units of the
    prior."""

    limits: LimitsResult
    """The limits of the table, and the duration of the schedule."""

    model: str
    """The model."""

    notes: list[str]
    """What else is to be known."""

    null_information: NotRequired[float | None]
    """That of the null space, which is rounding."""

    null_space_dimension: NotRequired[int | None]
    """How many dimensions the null space has."""

    observable: list[str]
    """The ids of the parameters that are observable."""

    orientations: int
    """The number of orientations among them."""

    provenance: ProvenanceResult
    """The program, its inputs, the item and its measurement."""

    rank: NotRequired[int | None]
    """The rank of the information of the data alone."""

    repairs: list[str]
    """What reading the logs has repaired or left out."""

    runs: list[DesignedRunResult]
    """The runs, one in each orientation, without switching off in between."""

    scale_bound: ScaleBoundResult
    """The bound of the standard deviation of gyro.scale.z."""

    schedules: list[ComparedResult]
    """The given schedule, the usual ones of the same duration, and the optimal one at the end."""

    schema: int
    """The version of this schema: 2."""

    unit: str
    """The unit of `value`; empty for a ratio."""

    unknowns: int
    """How many parameters there are."""

    unobservable: list[str]
    """Those that are unobservable."""

    value: float
    """The value of the optimal schedule, from the joint information of its runs."""


class DesignedRunResult(TypedDict):
    """A run of the schedule."""

    attitude_deg: EulerDegrees
    """The attitude of the axis frame [deg]."""

    duration_s: float
    """The duration [s]."""

    profile: list[DesignedSegmentResult]
    """What the table does."""

    shares: list[MotionResult]
    """The shares of the motions in the whole schedule, before they were rounded."""

    spin: str
    """The axis of the IMU along the spin axis, as `[axis] spin`."""

    tilt_deg: float
    """The angle of the axis from the vertical [deg]."""


class DesignedSegmentResult(TypedDict):
    """A part of a profile."""

    duration_s: float
    """How long it lasts, with the ramp at its start [s]."""

    end_angle_deg: float
    """The table angle at its end [deg], not wrapped."""

    rate_deg_s: float
    """The rate [deg/s]."""

    start_s: float
    """Its start in the run [s]."""


class DiagnoseResult(TypedDict):
    """The result of `rins diagnose`."""

    assumptions: list[str]
    """What was neither measured nor stated, and therefore assumed."""

    baseline: str
    """The model that the runs were taken to follow."""

    causes: list[CauseResult]
    """The causes, by the weight of their evidence."""

    command: str
    """`diagnose`."""

    consistency: ConsistencyResult
    """What the innovations say of the extended model."""

    false_alarms: NotRequired[FalseAlarmsResult | None]
    """The false alarm rate in simulated runs, if it was asked."""

    gain: GainResult
    """What the causes gain on held-out data."""

    held_out: NotRequired[HeldOutResult | None]
    """The held-out run beside the estimate, if one was given and can be estimated by itself."""

    homogeneity: NotRequired[list[HomogeneityResult]]
    """Of several runs, the test of each parameter of the sensors whether it is the same in all:
    each run was estimated by itself with the given model."""

    model: str
    """The file of the extended model among the files."""

    noise: NoiseResult
    """The noise."""

    not_testable: list[UntestableResult]
    """The effects that these runs cannot show."""

    notes: list[str]
    """What else is to be known."""

    prior_consistency: list[DepartureResult]
    """What lies more than four sigmas off what was stated beforehand, with the extended model,
    the furthest first."""

    provenance: ProvenanceResult
    """The program, its inputs, the item and its measurement."""

    repairs: list[str]
    """What reading the logs has repaired or left out."""

    rig: str
    """The rig file of the first run."""

    rigs: list[str]
    """The rig files of all runs."""

    schema: int
    """The version of this schema: 2."""

    seconds: float
    """How long it took [s]."""

    shifts: list[ShiftResult]
    """The estimates that were biased without the causes, the most biased first."""

    transfer: NotRequired[GainResult | None]
    """The same at the fastest rate, with what was found at slower ones, if it was asked."""

    unexplained: list[UnexplainedResult]
    """Residual structure that no effect of the catalogue explains, the most significant first."""

    variations: NotRequired[list[VariationResult]]
    """How parameters vary between the runs, the most significant first."""

    verdict: str
    """`adequate`, `named`, `ambiguous` or `unexplained`."""


class DifferenceResult(TypedDict):
    """A signal that differs when a new log is read again."""

    largest: NotRequired[float | None]
    """The largest difference, in the signal's SI unit; null if it is no number."""

    numbers: int
    """How many of its numbers differ."""

    signal: str
    """The signal."""


class DirectionResult(TypedDict):
    """A direction of an effect's parameters."""

    along: list[float]
    """The direction, in units of the priors."""

    detection_sigma: float
    """By how many sigmas it is seen without the other."""

    kappa: NotRequired[float | None]
    """By what the other effect increases its 1σ; null if it is not separated at all."""

    separation_sigma: float
    """By how many it differs from the other."""


class DriftPairResult(TypedDict):
    """Free navigation over windows of one length, root mean square."""

    after_s: float
    """The length [s]."""

    attitude_deg: PairResult
    """The attitude error [deg]."""

    velocity_m_s: PairResult
    """The velocity error [m/s]."""

    windows: int
    """How many windows there are."""


class DriftResult(TypedDict):
    """A drift of free inertial navigation."""

    attitude_deg: list[float]
    """Of the attitude, about east, north and up [deg]."""

    velocity_m_s: list[float]
    """Of the velocity, east, north and up [m/s]."""


class EstimateResult(TypedDict):
    """An estimate, in the unit of its parameter."""

    sigma: float
    """Its 1σ."""

    value: float
    """The value."""


class EulerDegrees(TypedDict):
    """Roll, pitch and yaw of `C = Rz(yaw) Rx(pitch) Ry(roll)` [deg]."""

    pitch: float
    """About the axis to the right."""

    roll: float
    """About the forward axis."""

    yaw: float
    """About the vertical, counted from north."""


class ExpectedSite(TypedDict):
    """What the rig file says of the site."""

    earth_rate_deg_h: float
    """The Earth's rate [deg/h]."""

    gravity_m_s2: float
    """Gravity [m/s²]."""

    latitude_deg: float
    """The latitude [deg]."""


class FalseAlarmsResult(TypedDict):
    """The false alarm rate in simulated runs."""

    allowed: float
    """The rate that is allowed."""

    draws: int
    """The number of simulated runs."""

    rate: float
    """The fraction of them in which an effect or residual structure was reported."""


class ForecastResult(TypedDict):
    """The forecast of a parameter."""

    id: str
    """The parameter."""

    interval_95: NotRequired[IntervalResult | None]
    """The 95 % interval."""

    unit: str
    """Its unit."""

    value: NotRequired[EstimateResult | None]
    """The mean and the standard deviation of the predictive distribution; null if there is
    none."""

    why: NotRequired[str | None]
    """Why there is none."""


class ForecastedResult(TypedDict):
    """A forecast of the estimate from a held-out run, and the estimate."""

    found: EstimateResult
    """The estimate with the given model."""

    holds: bool
    """Whether the interval contains it."""

    interval_95: list[float]
    """The 95 % interval."""


class GainResult(TypedDict):
    """What the causes gain on held-out data; of a gain that is not measurable only `held_out`,
    `verdict` and `why` are there."""

    attitude_drift_deg: NotRequired[PairResult | None]
    """Its attitude error [deg]."""

    blocks: NotRequired[int | None]
    """In how many blocks: revolutions, or pieces of a static interval."""

    consistent: NotRequired[ConsistentResult | None]
    """Whether the innovations of each model are as large as predicted."""

    drift_after_s: NotRequired[float | None]
    """How long it is [s]."""

    drifts: list[DriftPairResult]
    """Free navigation over windows of several lengths."""

    held_out: str
    """What was held out."""

    log_score_per_sample: NotRequired[PairResult | None]
    """The predictive log score of a sample [nats]."""

    log_score_rise: NotRequired[float | None]
    """By how much the log score rises [nats]."""

    log_score_rise_95: NotRequired[list[float | None] | None]
    """Its 95 % interval [nats]."""

    nis_dof: NotRequired[int | None]
    """Its expected value for a correct model."""

    nis_mean: NotRequired[PairResult | None]
    """The mean normalized innovation squared."""

    rig: NotRequired[str | None]
    """The other run on which it was measured, if it was."""

    samples: NotRequired[int | None]
    """How many samples were held out."""

    velocity_drift_m_s: NotRequired[PairResult | None]
    """The velocity error of the longest free navigation [m/s]."""

    verdict: str
    """`improved`, `no_improvement` or `not_measurable`."""

    why: NotRequired[str | None]
    """Why it is not measurable."""


class GapResult(TypedDict):
    """A gap."""

    at_s: float
    """The time of the sample after it [s]."""

    length_s: float
    """How long it is [s]."""


class GaugeResult(TypedDict):
    """A combination of parameters that no schedule shows."""

    name: str
    """What it is called."""

    parameters: list[str]
    """The ids of the parameters that are part of it."""

    why: str
    """Why no schedule shows it."""


class GuessResult(TypedDict):
    """A key of the rig file whose value was guessed."""

    key: str
    """The key."""

    value: str
    """Its value, as it stands in the file."""

    why: str
    """What the guess rests on."""


class GyroNoiseResult(TypedDict):
    """The noise of the gyros."""

    bias_instability_deg_h: float
    """Bias instability [deg/h]."""

    random_walk_deg_h_sqrt_h: float
    """Rate random walk [deg/h/√h]."""

    white_deg_h_sqrt_hz: float
    """White noise [deg/h/√Hz]."""


class HeldOutParameterResult(TypedDict):
    """A parameter of a held-out run."""

    forecast: NotRequired[ForecastedResult | None]
    """Of several other runs, the forecast from the differences between them."""

    held_out: EstimateResult
    """The estimate from the held-out run."""

    id: str
    """The parameter."""

    other_runs: EstimateResult
    """The estimate from the other runs."""

    p_value: float
    """The p-value of the test of equality, all other parameters being the same."""

    p_value_beside_others: float
    """The p-value if the more significant parameters are not."""

    sigmas: float
    """The difference over its 1σ."""

    unit: str
    """The unit of all values."""


class HeldOutResult(TypedDict):
    """A held-out run, estimated by itself, beside the estimate from the other runs."""

    consistent: bool
    """Whether no parameter differs significantly: 1 %, family-wise."""

    parameters: list[HeldOutParameterResult]
    """Each parameter of the sensors that both determine, the most significant difference first."""

    rig: str
    """The rig file of the held-out run."""


class HistoryResult(TypedDict):
    """The result of `rins history`."""

    assumptions: list[str]
    """What was neither measured nor stated, and therefore assumed."""

    causes: list[VariationResult]
    """How parameters vary between runs, the most significant first."""

    command: str
    """`history`."""

    forecast: list[ForecastResult]
    """Each parameter in the run that is predicted."""

    forecast_conditions: RunConditionsResult
    """The conditions of that run."""

    homogeneity: list[HomogeneityResult]
    """The test of each parameter whether it is the same in all runs."""

    notes: list[str]
    """What else is to be known."""

    prediction: list[PredictionResult]
    """How well runs are predicted from the runs before them."""

    provenance: ProvenanceResult
    """The program, its inputs, the item and its measurement."""

    repairs: list[str]
    """What reading the logs has repaired or left out."""

    runs: list[RunConditionsResult]
    """The runs, in order of their dates, or as they were given."""

    schema: int
    """The version of this schema: 2."""


class HomogeneityResult(TypedDict):
    """The test whether a parameter is the same in all runs."""

    chi_square: float
    """The chi-square statistic."""

    dof: int
    """Its degrees of freedom."""

    id: str
    """The parameter."""

    p_value: float
    """The p-value of the test of this parameter, all others being the same in all runs."""

    p_value_beside_others: float
    """The p-value if the more significant parameters are not: correlated estimates may make
    several differ where one does."""

    per_run: list[EstimateResult | None]
    """The estimate from each run; null where the run does not observe it."""

    unit: str
    """Its unit."""


class IdentifiabilityResult(TypedDict):
    """What is observable of all parameters together."""

    better_than_prior: NotRequired[int | None]
    """How many directions the data determine better than what was known beforehand."""

    combination: list[str]
    """Those that are observable only in combinations."""

    gauges: list[GaugeResult]
    """The gauges: combinations that no schedule shows."""

    least_information: NotRequired[float | None]
    """The information that the least observable direction has for itself, in units of the
    prior."""

    null_information: NotRequired[float | None]
    """That of the null space, which is rounding."""

    null_space_dimension: NotRequired[int | None]
    """How many dimensions the null space has."""

    observable: list[str]
    """The ids of the parameters that are observable."""

    rank: NotRequired[int | None]
    """The rank of the information of the data alone."""

    unknowns: int
    """How many parameters there are."""

    unobservable: list[str]
    """Those that are unobservable."""


class InitResult(TypedDict):
    """The result of `rins init`."""

    assumptions: list[str]
    """What was neither measured nor stated, and therefore assumed."""

    command: str
    """`init`."""

    guesses: list[GuessResult]
    """What was guessed, to be confirmed."""

    provenance: ProvenanceResult
    """The program, its inputs, the item and its measurement."""

    repairs: list[str]
    """What reading the logs has repaired or left out."""

    rig: str
    """The rig file that is written, or its text where none is."""

    schema: int
    """The version of this schema: 2."""

    to_fill_in: list[ToFillInResult]
    """What is to be filled in."""


class InputResult(TypedDict):
    """A file that was read."""

    path: str
    """Its path, as it was given."""

    sha256: str
    """The SHA-256 of its content, 64 hexadecimal digits."""


class IntervalResult(TypedDict):
    """An interval."""

    high: float
    """Its upper end."""

    low: float
    """Its lower end."""


class ItemResult(TypedDict):
    """The IMU of a measurement; what is not stated is null."""

    maker: NotRequired[str | None]
    """Its maker."""

    model: NotRequired[str | None]
    """Its model."""

    serial: NotRequired[str | None]
    """Its serial number."""


class IterationResult(TypedDict):
    """One iteration of the estimate."""

    log_likelihood: float
    """The log-likelihood [nats]."""

    step_sigma: float
    """The largest step of a parameter, in its sigmas."""


class LeveledDegrees(TypedDict):
    """An attitude of which the yaw may not be known [deg]."""

    pitch: float
    """Pitch."""

    roll: float
    """Roll."""

    yaw: NotRequired[float | None]
    """Yaw; null if north was not found."""


class LimitsResult(TypedDict):
    """The limits of a table."""

    acceleration_deg_s2: float
    """Its acceleration [deg/s²]."""

    directions: int
    """Into how many directions its axis may be brought."""

    duration_s: float
    """The longest that all runs may take together [s]."""

    rate_deg_s: float
    """Its fastest rate [deg/s]."""


class LineResult(TypedDict):
    """A spectral line: sinusoidal interference."""

    amplitude: float
    """Its amplitude, in the unit of the channel."""

    amplitude_sigma: float
    """The 1σ of that."""

    frequency_hz: float
    """Its frequency [Hz]."""

    frequency_sigma_hz: float
    """The 1σ of that [Hz]."""

    width_hz: float
    """How far its frequency wanders [Hz]."""


class LiveParameterResult(TypedDict):
    """The estimate of a parameter by the samples so far, in its unit."""

    id: str
    """Its id, along the sensor's own axes."""

    identified: bool
    """Whether the samples determine it: its 1σ is less than half of the one known beforehand.
    Only identified parameters are compensated."""

    prior_sigma: float
    """The 1σ known beforehand."""

    sigma: float
    """Its 1σ."""

    unit: str
    """The unit."""

    value: float
    """The value."""


class LiveResult(TypedDict):
    """The result of `rins calibrate --live`."""

    assumptions: list[str]
    """What was neither measured nor stated, and therefore assumed."""

    command: str
    """`calibrate --live`."""

    correlation: list[list[float]]
    """Their correlation, n by n."""

    end: str
    """Why the log ended: `closed`, `idle` or `interrupted`."""

    epoch_s: float
    """The duration of an epoch [s]."""

    epochs: int
    """In how many epochs."""

    innovation_variance: NotRequired[float | None]
    """The mean squared whitened innovation at the estimate: 1 if model and noise describe the
    run."""

    model: str
    """The model: `full` or the name of a model file."""

    notes: list[str]
    """What else is to be known."""

    parameters: list[LiveParameterResult]
    """The estimates."""

    provenance: ProvenanceResult
    """The program, its inputs, the item and its measurement."""

    repairs: list[str]
    """What reading the logs has repaired or left out."""

    rig: str
    """The rig file."""

    samples: int
    """How many samples were processed."""

    schema: int
    """The version of this schema: 2."""

    time_s: float
    """The time of the last sample [s]."""


class MeasurementResult(TypedDict):
    """A measurement (ISO/IEC 17025:2017, 7.8.2 and 7.8.4); what is not stated is null."""

    file: str
    """The rig file or calibration file that states it."""

    laboratory: NotRequired[str | None]
    """The laboratory."""

    operator: NotRequired[str | None]
    """The operator."""

    procedure: NotRequired[str | None]
    """The procedure."""

    run: NotRequired[str | None]
    """The id of the run."""

    series: NotRequired[str | None]
    """The name of the power-on."""

    started: NotRequired[str | None]
    """When it started (RFC 3339)."""

    temperature_degc: NotRequired[list[float] | None]
    """The smallest and largest temperature of the log [°C]; the mean twice if only that is
    known."""


class MissionBudgetResult(TypedDict):
    """The contribution of one source."""

    radial_nmi: float
    """The radial position error, 1σ [nmi]."""

    source: str
    """The id of the parameter, `initial attitude`, or `white noise`; `noise` if it includes
    bias instability or random walk."""


class MissionResult(TypedDict):
    """The result of `rins mission`."""

    assumptions: list[str]
    """What was neither measured nor stated, and therefore assumed."""

    command: str
    """`mission`."""

    mission: str
    """The mission file."""

    notes: list[str]
    """What else is to be known."""

    provenance: ProvenanceResult
    """The program, its inputs, the item and its measurement."""

    repairs: list[str]
    """What reading the logs has repaired or left out."""

    schema: int
    """The version of this schema: 2."""

    schemes: list[SchemeResult]
    """The schemes, as the file lists them."""


class MotionResult(TypedDict):
    """The share of a motion in an approximate design."""

    angle_deg: NotRequired[float | None]
    """The table angle of a static interval [deg]; null for a rotation."""

    rate_deg_s: float
    """The rate [deg/s]; zero for a static interval."""

    share: float
    """The share."""


class NavigateResult(TypedDict):
    """The result of `rins navigate`."""

    assumptions: list[str]
    """What was neither measured nor stated, and therefore assumed."""

    command: str
    """`navigate`."""

    duration_s: float
    """How long is navigated [s]."""

    notes: list[str]
    """The same in sentences."""

    outside_calibrated_range: NotRequired[OutsideRange | None]
    """What of the log lies outside of what the calibration covers; null without a calibration."""

    provenance: ProvenanceResult
    """The program, its inputs, the item and its measurement."""

    repairs: list[str]
    """What reading the logs has repaired or left out."""

    rig: str
    """The rig file."""

    runs: list[NavigatedResult]
    """What navigation ends with: as recorded, and with what is known compensated."""

    schema: int
    """The version of this schema: 2."""

    start: str
    """The attitude from which navigation starts, in words."""


class NavigatedResult(TypedDict):
    """What navigation ends with."""

    attitude_error_deg: EulerDegrees
    """The attitude error of the axis frame [deg]."""

    name: str
    """`as recorded`, `gyro bias removed` or `compensated`."""

    position_error_m: list[float]
    """The position error, east, north and up [m]."""

    velocity_m_s: list[float]
    """The velocity error, east, north and up [m/s]."""


class NavigationResult(TypedDict):
    """What free inertial navigation ends with."""

    attitude_error_deg: EulerDegrees
    """The attitude error of the axis frame [deg]."""

    position_error_m: list[float]
    """The position error, east, north and up [m]."""

    velocity_m_s: list[float]
    """The velocity error, east, north and up [m/s]."""


NextTestResult = TypedDict(
    "NextTestResult",
    {
        "from": "str",
        "schedule": "str",
        "sigmas": "float",
    },
)
"""The run that would distinguish a cause from an alternative."""


class NoiseResult(TypedDict):
    """The noise of the sensors."""

    accel: AccelNoiseResult
    """The accelerometers."""

    estimated: bool
    """Whether it was estimated, or is the data sheet's."""

    gyro: GyroNoiseResult
    """The gyros."""


class NoiseTermResult(TypedDict):
    """A noise term of one sensor."""

    cannot_tell_from: list[str]
    """The ids of the terms from which this static interval does not distinguish it."""

    data_sheet: NotRequired[float | None]
    """What the data sheet says of it."""

    id: str
    """The effect of the catalogue that it is."""

    sigma: NotRequired[float | None]
    """The 1σ of that."""

    significant: bool
    """Whether it is significant."""

    symbol: str
    """`Q`, `N`, `B` or `K` of IEEE Std 952."""

    unit: str
    """The unit of all three."""

    upper_bound: NotRequired[float | None]
    """The bound, where it is not significant."""

    value: NotRequired[float | None]
    """Its value; null if it is not significant."""


class ObserveResult(TypedDict):
    """The result of `rins observe`."""

    assumptions: list[str]
    """What was neither measured nor stated, and therefore assumed."""

    command: str
    """`observe`."""

    limits: LimitsResult
    """The limits of the table within which the next schedule is sought."""

    model: str
    """The model."""

    proposal: NotRequired[ProposalResult | None]
    """The schedule to run next; null if the given one does, or nothing was asked."""

    provenance: ProvenanceResult
    """The program, its inputs, the item and its measurement."""

    repairs: list[str]
    """What reading the logs has repaired or left out."""

    schedules: list[ScheduleResult]
    """The schedules."""

    schema: int
    """The version of this schema: 2."""


class OutsideRange(TypedDict):
    """What of a log lies outside of what a calibration covers."""

    days: NotRequired[float | None]
    """How many days after the calibration the log was made, if that is a day or more; negative
    before it."""

    power_on: NotRequired[bool]
    """Whether the log is of another power-on, as far as both state one; turn-on biases are
    other ones then."""

    rate_deg_s: NotRequired[OutsideRate | None]
    """The rate about the axis of rotation, if it does [deg/s]."""

    temperature_degc: NotRequired[OutsideTemperature | None]
    """The temperature, if it does [°C]."""


class OutsideRate(TypedDict):
    """A rate outside of what a calibration covers [deg/s]."""

    calibrated: float
    """The fastest that was calibrated."""

    log: float
    """The fastest of the log."""


class OutsideTemperature(TypedDict):
    """A temperature outside of what a calibration covers [°C]."""

    calibrated: list[float]
    """The lowest and the highest that were calibrated."""

    log: list[float]
    """The lowest and the highest of the log."""

    outside: float
    """By how much it is outside."""


class PairResult(TypedDict):
    """A figure without and with the causes."""

    after: float
    """With."""

    before: float
    """Without."""


class ParameterResult(TypedDict):
    """The estimate of a parameter, in its unit; of one that is observable only in a
    combination, that of the combination."""

    alias_coefficients: list[float]
    """The coefficients of the aliases, as in the combination."""

    aliases: list[str]
    """The ids of the other parameters of its combination."""

    combination: list[SummandResult]
    """These with their coefficients."""

    data_sigma: NotRequired[float | None]
    """The 1σ by the data alone; null if they do not bound it."""

    exactly: NotRequired[bool | None]
    """Whether some combination is all that shows it."""

    gauge: NotRequired[str | None]
    """The gauge that it is part of."""

    id: str
    """Its id, along the sensor's own axes."""

    identifiable: bool
    """Whether it is observable by itself."""

    marginal: NotRequired[EstimateResult | None]
    """The estimate of the parameter itself, which what was known beforehand bounds."""

    meaning: str
    """The observability in words."""

    observability: str
    """`observable`, `combination` or `prior_dominated`."""

    prior_sigma: NotRequired[float | None]
    """The 1σ known beforehand."""

    run: NotRequired[int | None]
    """The run to which it belongs, from 1; null if it belongs to all."""

    sigma: float
    """Its 1σ."""

    uncertainty: NotRequired[UncertaintyResult | None]
    """The uncertainty budget, if the accuracy of a reference is stated; `sigma` is its combined
    standard uncertainty."""

    unit: str
    """The unit."""

    value: float
    """The value."""


class PosteriorResult(TypedDict):
    """How the posterior of one parameter or combination agrees with the true values over the
    runs."""

    calibrated: NotRequired[bool | None]
    """Whether the ranks are uniform, with 1 % of false alarms over all parameters and
    combinations of the scenario; absent of a parameter whose posterior is not calibrated for
    given true values, because the prior dominates it."""

    coverage: list[CoverageResult]
    """The coverage of the central 68 %, 95 % and 99.7 % intervals."""

    ecdf_difference: list[float]
    """The empirical distribution function of the ranks of the true values in their posteriors,
    minus the uniform one, at `points` of `rank_band`."""

    mean_error_sigma: float
    """The standard error of `mean_error`."""

    observability: str
    """The observability: `observable` (posterior sigma below half of the prior sigma),
    `observable only in a combination`, or `unobservable` (prior-dominated)."""

    p_value: float
    """The p-value of uniform ranks."""

    prior_sigma: float
    """The root mean square of the prior sigmas."""

    rms_ratio: float
    """The root mean square of error over sigma: 1 if the posteriors are calibrated."""

    rms_ratio_interval_95: list[float]
    """Its 95 % confidence interval."""


class PredictedResult(TypedDict):
    """A parameter before it is estimated: its prior and the uncertainty that the data leave."""

    aliases: list[str]
    """The ids of the other parameters of its combination."""

    combination: list[SummandResult]
    """These with their coefficients."""

    data_sigma: NotRequired[float | None]
    """The 1σ by the data alone; null if they do not bound it."""

    exactly: NotRequired[bool | None]
    """Whether some combination is all that shows it."""

    gauge: NotRequired[str | None]
    """The gauge that it is part of."""

    id: str
    """Its id."""

    identifiable: bool
    """Whether it is observable by itself."""

    observability: str
    """`observable`, `combination` or `prior_dominated`."""

    prior_sigma: float
    """The 1σ known beforehand, in its unit."""

    run: NotRequired[int | None]
    """The run to which it belongs, from 1; null if it belongs to all."""

    sigma: float
    """The 1σ by both."""

    unit: str
    """Its unit."""


class PredictionResult(TypedDict):
    """How well a parameter is predicted in each run from the runs before it."""

    crps: NotRequired[ScoreResult | None]
    """The mean continuous ranked probability scores: the smaller the better, in the unit of the
    parameter."""

    id: str
    """The parameter."""

    runs: list[RunValueResult]
    """The runs that were predicted."""

    unit: str
    """Its unit."""


class ProposalResult(TypedDict):
    """A schedule to run next."""

    attitude_deg: list[EulerDegrees]
    """The attitude of the axis frame in each run [deg]."""

    duration_s: float
    """How long it takes in all [s]."""

    files: list[str]
    """The scenario files among the files."""

    profile: list[SegmentResult]
    """What the table does in each direction of its axis."""

    schedule: str
    """What it is, in words."""

    separation: NotRequired[SeparationsResult | None]
    """How well it separates the two effects."""

    separation_sigma: NotRequired[float | None]
    """By how many sigmas the two effects differ."""

    sigma: NotRequired[float | None]
    """The 1σ of the parameter that was asked for, in its unit."""

    sufficient: bool
    """Whether it reaches what was asked for."""


class ProvenanceResult(TypedDict):
    """The program, its inputs, the item and its measurement."""

    inputs: list[InputResult]
    """The files that were read."""

    item: ItemResult
    """The IMU; a property in which the inputs differ is null."""

    measured: list[MeasurementResult]
    """The measurements, one per log or calibration file."""

    version: str
    """The version of rins."""


class RankBandResult(TypedDict):
    """The simultaneous 95 % confidence band of the difference between the empirical
    distribution function of ranks and the uniform one (Säilynoja, Bürkner and Vehtari, 2022)."""

    lower: list[float]
    """The lower edge."""

    points: list[float]
    """The ranks at which the functions are evaluated."""

    upper: list[float]
    """The upper edge."""


class RunConditionsResult(TypedDict):
    """The conditions of a run; null where they are not known."""

    date_s: NotRequired[float | None]
    """The date, since 1970 [s]."""

    file: NotRequired[str | None]
    """The path of its file; null of the run that is predicted."""

    power_on: int
    """The power-on: runs of one power-on have the same number."""

    since_power_on_s: NotRequired[float | None]
    """The time since power-on [s]."""

    temperature_degc: NotRequired[float | None]
    """The mean temperature [°C]."""

    unit: int
    """The unit, numbered from zero."""


class RunResult(TypedDict):
    """What belongs to one run."""

    axis_attitude_deg: EulerDegrees
    """The attitude of the axis frame, as estimated [deg]."""

    base_sway_arcsec_sqrt_s: list[float]
    """The sway of the base about x, y and z [arcsec/√s]."""

    base_velocity_m_s: float
    """The velocity noise of the base [m/s]."""

    consistency: ConsistencyResult
    """What the innovations say of the model."""

    encoder_jitter_us: NotRequired[float | None]
    """The jitter of the times at which it is read [µs]."""

    encoder_noise_arcsec: NotRequired[float | None]
    """The noise of the encoder [arcsec]."""

    error_budget: DemoBudgetResult
    """The error budget of free inertial navigation over the first run."""

    gravity_across_axis_m_s2: float
    """How much of gravity turns in the plane of rotation [m/s²]."""

    navigation: BeforeAfterResult
    """Free navigation before and after compensation."""

    reference: str
    """What shows the table's angle: `table_angle`, `table_rate`, `gravity` or `static`."""

    rig: str
    """The rig file."""

    samples: int
    """How many samples were used."""

    static_intervals: list[StaticIntervalResult]
    """The static intervals."""

    static_intervals_used: NotRequired[int | None]
    """How many static intervals were used; null if the log was used as a whole."""

    wobble_arcsec: float
    """The wobble of the axis [arcsec]."""


class RunValueResult(TypedDict):
    """A run against its forecast."""

    estimate: EstimateResult
    """Its estimate."""

    inside: bool
    """Whether it is inside."""

    interval_95: IntervalResult
    """The 95 % interval in which the estimate was predicted."""

    run: int
    """The run, from zero."""


class ScaleBoundResult(TypedDict):
    """The smallest standard deviation of gyro.scale.z that white noise of the gyro allows."""

    bound_ppm: float
    """`N / (ω √T)` with the noise density, the fastest rate and the duration [ppm]."""

    sigma_ppm: NotRequired[float | None]
    """The standard deviation under the optimal schedule [ppm]; null if the model does not have
    it."""


class ScatterResult(TypedDict):
    """How the estimates of one parameter scatter, in its unit."""

    coverage_95: float
    """The share of the 95 % intervals that hold the true value."""

    error_std: float
    """The standard deviation of the errors."""

    id: str
    """Its id."""

    mean_error: float
    """The mean error."""

    posterior: NotRequired[PosteriorResult | None]
    """The calibration of its posterior; of a model only."""

    sigma_rms: float
    """The root mean square of the reported sigmas."""

    truth: float
    """The true value; the mean of the true values, if each run has its own."""

    unit: str
    """Its unit."""


class ScheduleResult(TypedDict):
    """One schedule: one scenario, or several as runs of one IMU."""

    better_than_prior: NotRequired[int | None]
    """How many directions the data determine better than what was known beforehand."""

    combination: list[str]
    """Those that are observable only in combinations."""

    duration_s: float
    """How long it takes [s]."""

    gauges: list[GaugeResult]
    """The gauges: combinations that no schedule shows."""

    least_information: NotRequired[float | None]
    """The information that the least observable direction has for itself, in units of the
    prior."""

    name: str
    """What it is called: the file names."""

    null_information: NotRequired[float | None]
    """That of the null space, which is rounding."""

    null_space_dimension: NotRequired[int | None]
    """How many dimensions the null space has."""

    observable: list[str]
    """The ids of the parameters that are observable."""

    parameters: list[PredictedResult]
    """The parameters."""

    rank: NotRequired[int | None]
    """The rank of the information of the data alone."""

    scenarios: list[str]
    """The scenario files."""

    separation: NotRequired[SeparationsResult | None]
    """How well it separates the two effects that were asked for."""

    unknowns: int
    """How many parameters there are."""

    unobservable: list[str]
    """Those that are unobservable."""


class SchemeResult(TypedDict):
    """The navigation errors under one scheme; a list has a value for each of `hours`."""

    budget: list[MissionBudgetResult]
    """The radial position error at the end by each source alone, 1σ; the largest first."""

    cep50_nmi: NotRequired[list[float] | None]
    """The radius that holds half of the position errors [nmi]; null if no uncertainty is
    stated."""

    cep95_nmi: NotRequired[list[float] | None]
    """The radius that holds 95 % of them."""

    east_nmi: NotRequired[list[float] | None]
    """The position error east by the stated errors [nmi]; null if none are stated."""

    heading_rms_arcsec: NotRequired[list[float] | None]
    """The root mean square of the heading error [arcsec]."""

    hours: list[float]
    """The time since the start [h]."""

    law_nmi: NotRequired[list[float] | None]
    """The secular part of the error east by the stated errors [nmi]; null if none are stated,
    or a cycle does not close."""

    name: str
    """Its name."""

    nmi_per_hour: NotRequired[float | None]
    """The TRMS at the end divided by the time [nmi/h]."""

    north_nmi: NotRequired[list[float] | None]
    """The same north."""

    simulated: NotRequired[SimulatedResult | None]
    """The same position errors of simulated missions; null if none were simulated."""

    tilt_rms_arcsec: NotRequired[list[float] | None]
    """The root mean square of the tilt, both axes together [arcsec]."""

    trms_before_nmi: NotRequired[list[float] | None]
    """The TRMS with the uncertainties of the data sheet, before the calibration [nmi]; null if
    no calibration is given."""

    trms_nmi: NotRequired[list[float] | None]
    """The root mean square of the radial position error [nmi] (TRMS)."""

    velocity_rms_m_s: NotRequired[list[float] | None]
    """The root mean square of the horizontal velocity error [m/s]."""

    want: NotRequired[WantResult | None]
    """Which uncertainties hold the wanted figure; null if none is wanted."""


class ScoreResult(TypedDict):
    """The scores of forecasts."""

    forecast: float
    """Of the average over all hypotheses."""

    last_value: float
    """Of the last value."""

    line: float
    """Of the line over the date."""

    mean: float
    """Of the mean."""


class SegmentResult(TypedDict):
    """A part of a profile."""

    duration_s: float
    """How long it lasts [s]."""

    rate_deg_s: float
    """The rate [deg/s]."""


SeparationResult = TypedDict(
    "SeparationResult",
    {
        "absorbed": "int",
        "directions": "list[DirectionResult]",
        "effect": "NotRequired[str | None]",
        "from": "NotRequired[str | None]",
        "kappa": "NotRequired[float | None]",
        "separation_sigma": "float",
    },
)
"""How well a schedule separates one effect from another."""


class SeparationsResult(TypedDict):
    """How well a schedule separates two effects."""

    each: list[SeparationResult]
    """The first effect against the second, and the second against the first."""

    required_sigma: float
    """By how many sigmas the two must differ."""

    separated: bool
    """Whether they do, each of its typical size."""


class SettingResult(TypedDict):
    """A setting of an effect, in its unit."""

    sigma: NotRequired[float | None]
    """Its 1σ, if it was estimated."""

    unit: str
    """The unit."""

    value: float
    """The value."""


class ShiftResult(TypedDict):
    """An estimate that was biased without the causes, in its unit."""

    after: float
    """The estimate with them."""

    before: float
    """The estimate without the causes."""

    id: str
    """The parameter."""

    run: NotRequired[int | None]
    """The run to which it belongs, from 1; null if it belongs to all."""

    sigmas: float
    """The change in sigmas of the estimate before."""

    unit: str
    """The unit."""


class SimulateResult(TypedDict):
    """The result of `rins simulate`."""

    assumptions: list[str]
    """What was neither measured nor stated, and therefore assumed."""

    command: str
    """`simulate`."""

    duration_s: float
    """How long the run is [s]."""

    files: list[str]
    """The files of the run."""

    provenance: ProvenanceResult
    """The program, its inputs, the item and its measurement."""

    repairs: list[str]
    """What reading the logs has repaired or left out."""

    samples: int
    """How many samples there are."""

    scenario: str
    """The scenario file."""

    schema: int
    """The version of this schema: 2."""

    seed: int
    """The seed of its random numbers."""

    turns: float
    """How often the table turns, either way."""


class SimulatedResult(TypedDict):
    """The position errors of simulated missions, navigated by strapdown with drawn errors; a
    list has a value for each time."""

    cep50_nmi: list[float]
    """The median of the radial position error [nmi]."""

    cep50_within_nmi: list[list[float]]
    """Its interval of 95 %."""

    cep95_nmi: list[float]
    """The radius that holds 95 % of the missions [nmi]."""

    runs: int
    """The number of missions."""

    sample_rate_hz: float
    """The sampling rate of the navigation [Hz]."""

    seconds: float
    """The time that the simulation took [s]."""

    seed: int
    """The seed of their errors."""

    trms_nmi: list[float]
    """The root mean square of the radial position error [nmi]."""

    trms_within_nmi: list[list[float]]
    """Its interval of 95 %."""


class StaticIntervalResult(TypedDict):
    """A span over which the IMU is static, or might be."""

    end_s: float
    """Its end [s]."""

    run: NotRequired[int | None]
    """The run that it is in, from 1, where a result is of several runs."""

    start_s: float
    """Its start [s], in the time of the log."""

    stated: bool
    """Whether the rig file states it."""

    used: bool
    """Whether this command uses it as a static interval."""

    why: NotRequired[str | None]
    """Why it is not used, or what is to be known of it."""


class StaticMeanResult(TypedDict):
    """A static interval, with what it shows."""

    from_s: float
    """The time of its first sample [s]."""

    gravity_m_s2: float
    """The magnitude of the mean specific force [m/s²]."""

    rate_deg_h: float
    """The magnitude of the mean angular rate [deg/h]."""

    to_s: float
    """The time of its last sample [s]."""


class SummandResult(TypedDict):
    """A parameter in a combination."""

    coefficient: float
    """What one of its unit counts, in the unit of the parameter beside which it stands."""

    exactly: NotRequired[bool | None]
    """Whether nothing but this combination shows the parameter, or other combinations do a
    little."""

    id: str
    """The parameter's id."""

    run: NotRequired[int | None]
    """The run to which it belongs, from 1; null if it belongs to all."""


class ToFillInResult(TypedDict):
    """A key of the rig file that is to be filled in."""

    expected: str
    """What is expected."""

    key: str
    """The key."""


class TogetherResult(TypedDict):
    """All differences together, with both covariances."""

    chi_square: float
    """The chi-squared of all differences."""

    dof: int
    """Its degrees of freedom."""

    p: float
    """The p-value of that much, if nothing has changed."""


class UncertaintyResult(TypedDict):
    """The uncertainty of an estimate (JCGM 100:2008), in the unit of the parameter."""

    combined: float
    """The combined standard uncertainty."""

    coverage_factor: float
    """The coverage factor of the expanded uncertainty."""

    expanded: float
    """The expanded uncertainty: of an interval of 95 %."""

    type_a: float
    """The standard uncertainty by noise and by what was known beforehand: type A."""

    type_b: list[ContributionOfReference]
    """The contributions of the references: type B."""


class UnexplainedResult(TypedDict):
    """Residual structure that no effect of the catalogue explains."""

    amplitude: NotRequired[str | None]
    """How large it is, with its unit, if it is a signal."""

    channel: str
    """The channel."""

    effect: NotRequired[str | None]
    """The effect that is not the same all along, if that is what was found."""

    ln_p: float
    """Its natural logarithm."""

    p_value: float
    """The p-value of anything like it; zero where it is too small for a number."""

    run: int
    """The run, from 1."""

    structure: str
    """What it looks like."""

    worst: list[WorstResult]
    """By how much it may bias the gyro errors along the spin axis at worst."""


class UntestableResult(TypedDict):
    """An effect that these runs cannot show."""

    effect: str
    """Its id."""

    name: str
    """Its name."""

    why: str
    """What the runs would have to offer."""


class VariantResult(TypedDict):
    """A member of a credible set."""

    id: str
    """The parameter."""

    probability: float
    """Its posterior probability."""

    variation: str
    """The variation."""


class VariationResult(TypedDict):
    """A parameter that varies between runs."""

    across: str
    """`runs`."""

    alternatives: list[VariantResult]
    """The credible set of 98 %: what may be there in its place, with posterior probabilities."""

    amplitudes: list[EstimateResult]
    """The amplitudes: the change over all runs; of a warm-up the value at power-on; of a
    polynomial the coefficients of its Legendre polynomials; of what is random the deviation of
    each group of runs."""

    id: str
    """The parameter."""

    meaning: str
    """The variation in words, with its size."""

    p_value: float
    """The p-value, family-wise over all parameters: a bound by Markov's inequality."""

    unit: str
    """The unit of the parameter."""

    variation: str
    """The variation: `drift`, `drift_since_power_on`, `warm_up`, `temperature_linear`,
    `temperature_quadratic`, `temperature_cubic`, `thermal_hysteresis`, `turn_on`, `scatter`,
    `random_walk`, `change`, `unit` or `run`."""


class VerdictResult(TypedDict):
    """A verdict on one thing that can be wrong with a log."""

    check: str
    """What was checked."""

    finding: str
    """What was found, in a sentence."""

    verdict: str
    """`good`, `fact`, `odd` or `bad`."""


class WantResult(TypedDict):
    """The uncertainties that hold a wanted TRMS."""

    fixed_nmi: float
    """The position error by noise and the initial attitude alone, 1σ [nmi]."""

    hours: float
    """The time since the start [h]."""

    parameters: list[WantedParameterResult]
    """The parameters, those that must improve most first."""

    possible: bool
    """Whether better sensor errors can hold it: noise and the initial attitude alone must leave
    less."""

    present_nmi: float
    """The TRMS with the present uncertainties, as independent errors [nmi]."""

    reached_nmi: float
    """The TRMS with the uncertainties that are asked for [nmi]."""

    simulated_nmi: NotRequired[float | None]
    """The same by simulated missions [nmi]; null if none were simulated."""

    trms_nmi: float
    """The wanted TRMS [nmi]."""


class WantedParameterResult(TypedDict):
    """What is asked of a parameter."""

    asked: float
    """The standard deviation that is asked for."""

    id: str
    """Its id."""

    present: float
    """The present standard deviation."""

    share_nmi: float
    """The radial position error that the latter causes, 1σ [nmi]."""

    unit: str
    """Their unit."""


class WorstResult(TypedDict):
    """By how much a parameter may be biased at worst, in its unit."""

    id: str
    """The parameter."""

    unit: str
    """The unit."""

    value: float
    """By how much."""
