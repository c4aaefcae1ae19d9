//! The text around the tables of the page on identifiability.

pub(super) const HEAD: &str = "\
# Observability of rotation schedules

`rins observe` predicts the results of a run before it is made: the Fisher information matrix of all parameters of a model, from
the motion of a scenario and the noise of its `[imu]`. A test generates this page from the schedules in
[scenarios/schedules](https://github.com/rins-rs/rins/tree/main/scenarios/schedules). They take 360 s at 50 Hz, on a spin axis
tilted by 25 deg at latitude 45 deg. The gyros have 0.02 deg/h/√Hz, the accelerometers 30 µg/√Hz and the encoder 1 arcsec.

| schedule | rotation |
| --- | --- |
| i | 10 deg/s |
| ii | forward and back |
| iii | ±5, ±10 and ±20 deg/s |
| iv | eight static intervals |
| v | forward and back at two tilts |

## Method

All parameters are scaled by their prior sigmas. The parameters are then ordered:

1. The most observable parameter is retained first.
2. The parameter that is most observable beside the retained ones follows, as long as the data determine it better than the prior.
3. Each remaining parameter is a combination of the retained ones, either exactly or up to a negligible amount of information.
   *Exactly* means that less than 10⁻¹¹ of its information is independent. The evaluation of the rotation at the middle of a
   sample leaves 10⁻¹².

A retained parameter that is combined with others is reported as the sum only, such as
`gyro.misalignment.xz + 5.73 arcsec/(deg/h) × gyro.bias.x`. A remaining parameter is reported as the sum that the data determine
best. A gauge, a combination of parameters that amounts to a choice of axes, units or origins, is unobservable under every
schedule and is named. A calibration reports the observability of its run in the same terms, with the estimated noise.
It leaves prior-dominated parameters at their prior means and reports the sigmas that follow from this, which are larger than those here.

## JSON

With `--json`, `schedules` holds for each schedule:

| key | meaning |
| --- | --- |
| `rank`, `null_space_dimension` | of the information matrix of the data alone |
| `observable`, `combination`, `unobservable` | ids of the parameters that are observable, observable only in a combination, unobservable |
| `gauges` | the gauges |
| `parameters` | see below |
| `separation` | `kappa` and `separation_sigma` of a pair of effects, each against the other |

Each of the `parameters` holds:

| key | meaning |
| --- | --- |
| `prior_sigma` | the sigma of the prior |
| `data_sigma` | the sigma by the data alone, of the combination if there is one; null if the data do not bound it |
| `sigma` | the sigma by the data and the prior |
| `identifiable`, `observability` | as in [a calibration](calibration.md#observability) |
| `aliases`, `combination` | the other parameters of the combination, and their coefficients |
| `gauge` | the gauge to which the parameter belongs |

`proposal` holds the recommended next schedule: its `profile`, its `attitude_deg`, and the predicted result.

## Dimension of the null space

`baseline` holds biases, attitude, mounting and the gyro errors along the spin axis. `full` holds all errors of eq. (1) and the
attitude.

| model, unknowns | i | ii | iii | iv | v |
| --- | --- | --- | --- | --- | --- |
";

pub(super) const INVISIBLE: &str = "
At one rate the null space has three dimensions: each bias forms one combination with an error that is proportional to the rate.
Under every schedule with one tilt, `full` has further unobservable combinations, because the specific force along the spin axis is
constant: biases with misalignments, and scale errors with the tilt. The table gives 1σ by the data alone (deg/h, ppm, arcsec), for
`baseline`, in which the mounting limits the misalignments:

| parameter | i | ii | iii | iv | v |
| --- | --- | --- | --- | --- | --- |
";

pub(super) const COSTS: &str = "
## Separation of two effects

An effect that is detected by `s` sigma differs from another effect by `s/κ` sigma. `1/κ` is the sine of the angle between the
signatures of the two effects after the parameters of `baseline` are estimated. For effects with several parameters it is the
angle in the worst direction. `rins observe --compare --separate A,B` computes `κ`:

| effects | i | ii | iii | iv | v |
| --- | --- | --- | --- | --- | --- |
";

pub(super) const FIGURES: &str = "
An independent linear prototype gives the same infinities, and other values within a factor of two, with two exceptions:

- Under (i) it gives no value for the pairs with a delay or with a cube of the rate. There the nuisance parameters, which have no
  prior, absorb the first effect.
- `accel_latency` and `wrong_latitude` have one common signature there under (i). They are separated here, because the initial
  attitude of a run is known to 2 mrad.

For some further pairs the results differ:

| effects | schedule | here | prototype | why |
| --- | --- | --- | --- | --- |
| `encoder_latency`, `clock_drift` | ii | 4.8 | 64 | the ramp from standstill is a second change of rate; without ramps: 70 |
| `gyro_scale_asymmetry`, `gyro_rate_dependent_bias.square_z` | ii | 11 | 41 | the prior of the bias is 0.1 deg/h; with 1000 deg/h: 31 |
| `gyro_scale_asymmetry`, `encoder_latency` | ii | 1.9 | 9 | unexplained; with an unknown bias: 2.6 |
| `accel_lever_arm`, `accel_vibration_rectification` | ii | 1.1 | 2.6 | the latter is proportional to the rate here, to its square there; not tested |
| `dropped_samples`, `encoder_slip` | ii | ∞ | 1.2 | they occur at 300 s, after the last change of rate, where both are one constant |
| `base_tilt_ramp`, `clock_drift` | i | 1.0 | 24 | unexplained; on an axis tilted to the east: 5.0 |

## Uncertainty by the data alone

1σ by the data alone, and in brackets the value of the prototype:

| parameter | unit | i | ii | iii | v |
| --- | --- | --- | --- | --- | --- |
";

pub(super) const REASONS: &str = "
The values differ for these reasons:

| parameter | schedule | factor | reason |
| --- | --- | --- | --- |
| `gyro_g_sensitivity.xy`, `wrong_latitude` | | 1.4, 2 | the axis is tilted to the south here; tilted to the east they are 0.0035 deg/h/g and 0.34 arcmin, as in the prototype |
| `accel_bias_step.x` | | 1.3 | the step is at 300 s here and at 150 s there: the sigma of a step in white noise is proportional to `√(T / t (T - t))` |
| parameters of each run, such as encoder, wobble, latitude | v | 1.4 | each run holds half of the data |
| `accel_lever_arm` | ii, v | | it is observable by changes of rate alone: with 2.5 deg/s², with 5 deg/s² and at once it is 1.8, 1.4 and 0.72 mm; the acceleration of the prototype's table is unknown |
| `accel_latency` | i | | probably the initial attitude, known to 2 mrad here |
| `accel_vibration_rectification` | | | probably because it is proportional to the rate here, and to its square there |
| `base_tilt_ramp` | v | | probably because one tilt continues through both runs there, and each run has its own here |
| `gyro.scale.z`, `encoder_latency` | iii | | probably because the rates are held for different times |
| `accel_quadratic.x` | v | | unexplained |
";
