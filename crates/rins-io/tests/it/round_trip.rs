//! A recording that is written as a log is bit-identical when it is read.

use proptest::prelude::*;
use rins_frames::{InFrame, Increments};
use rins_io::{read, write_recording};
use rins_motion::Recording;

/// The rig of the output of [`write_recording`]; an interval of 1/64 s has no rounding error.
const RIG: &str = r#"
[site]
latitude = "0 deg"
longitude = "0 deg"
height = "0 m"

[log]
path = "run.csv"
rate = "64 Hz"
time = { column = "time", unit = "s" }
gyro = { columns = ["gyro_x", "gyro_y", "gyro_z"], unit = "rad" }
accel = { columns = ["accel_x", "accel_y", "accel_z"], unit = "m/s" }
"#;

const ANGLE: &str = "table_angle = { column = \"table_angle\", unit = \"rad\" }\n";
const RATE: &str = "table_rate = { column = \"table_rate\", unit = \"rad/s\" }\n";
const TEMPERATURE: &str = "temperature = { column = \"temperature\", unit = \"degC\" }\n";

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        -1.0..1.0_f64,
        -1e-6..1e-6_f64,
        prop::num::f64::POSITIVE | prop::num::f64::NEGATIVE | prop::num::f64::SUBNORMAL,
    ]
    .prop_map(|number| number % 1e3)
}

/// A recording at 64 Hz with slightly uneven intervals.
fn any_recording() -> impl Strategy<Value = Recording> {
    let sample = (prop::array::uniform6(any_number()), -0.1..0.1_f64, any_number());
    let samples = prop::collection::vec(sample, 2..40);
    (samples, any::<[bool; 3]>()).prop_map(|(samples, others)| {
        let interval = 1.0 / 64.0;
        let mut recording = Recording::default();
        let (mut angles, mut rates, mut temperatures) = (Vec::new(), Vec::new(), Vec::new());
        let mut angle = 0.25;
        for (index, (numbers, step, other)) in samples.into_iter().enumerate() {
            let time = (index + 1) as f64 * interval + 5e-4 * step;
            let [gx, gy, gz, ax, ay, az] = numbers;
            let before = recording.times.last().copied();
            recording.increments.push(Increments {
                angle: InFrame::new(gx, gy, gz),
                velocity: InFrame::new(ax, ay, az),
                interval: before.map_or(interval, |before| time - before),
            });
            recording.times.push(time);
            angle += step;
            angles.push(angle);
            rates.push(other);
            temperatures.push(20.0 + step);
        }
        recording.table_angle = others[0].then_some(angles);
        recording.table_rate = others[1].then_some(rates);
        recording.temperature = others[2].then_some(temperatures);
        recording
    })
}

fn write(recording: &Recording) -> String {
    let mut bytes = Vec::new();
    write_recording(recording, &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

proptest! {
    #[test]
    fn a_recording_is_read_back_to_the_last_bit(recording in any_recording()) {
        let mut rig = String::from(RIG);
        let lists = [
            (&recording.table_angle, ANGLE),
            (&recording.table_rate, RATE),
            (&recording.temperature, TEMPERATURE),
        ];
        for (_, key) in lists.iter().filter(|(list, _)| list.is_some()) {
            rig.push_str(key);
        }
        let folder = crate::support::folder(&[
            ("rig.toml", rig.as_bytes()),
            ("run.csv", write(&recording).as_bytes()),
        ]);
        let again = read(&folder.path().join("rig.toml")).unwrap().recording;
        prop_assert_eq!(again, recording);
    }

    #[test]
    fn any_log_is_read_or_refused(text in "(t,gx,gy,gz,ax,ay,az\n)?([-+0-9.eEnaif,;\t \"#\r\n]{0,80})") {
        let folder = crate::support::folder(&[
            ("rig.toml", crate::support::plain_rig().as_bytes()),
            ("run.csv", text.as_bytes()),
        ]);
        let _ = read(&folder.path().join("rig.toml"));
    }
}

#[test]
fn even_steps_are_exactly_nominal() {
    // A tenth of a second is not exact in binary, so that differences of times have rounding errors.
    let interval = 1.0 / 10.0;
    let increments = Increments {
        angle: InFrame::new(1e-3, 2e-3, 3e-3),
        velocity: InFrame::new(0.1, 0.2, 0.3),
        interval,
    };
    let recording = Recording {
        times: (1..=9).map(|sample| f64::from(sample) * interval).collect(),
        increments: vec![increments; 9],
        ..Recording::default()
    };
    let differences = recording.times.windows(2).any(|pair| pair[1] - pair[0] != interval);
    assert!(differences, "or the test would show nothing");
    let folder = crate::support::folder(&[
        ("rig.toml", RIG.replace("64 Hz", "10 Hz").as_bytes()),
        ("run.csv", write(&recording).as_bytes()),
    ]);
    assert_eq!(read(&folder.path().join("rig.toml")).unwrap().recording, recording);
}
