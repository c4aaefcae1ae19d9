//! Logs written by other software, as described in `tests/data/logs.py`.

use std::fs;
use std::path::Path;

use rins_io::{IoError, Loaded, read};
use rins_testing::assert_close;

use crate::support::{SITE, folder, without};

/// The interval of all these logs \[s\].
const STEP: f64 = 0.01;

fn data(name: &str) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name);
    fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn load(log: &str, name: &str) -> Result<Loaded, String> {
    load_bytes(log, name, &data(name))
}

fn load_bytes(log: &str, name: &str, bytes: &[u8]) -> Result<Loaded, String> {
    let rig = format!("{SITE}[log]\npath = \"{name}\"\n{log}");
    let folder = folder(&[("rig.toml", rig.as_bytes()), (name, bytes)]);
    read(&folder.path().join("rig.toml")).map_err(|error: IoError| without(&error, folder.path()))
}

/// Asserts that a recording is the run in `logs.py`, along right, front and up.
fn is_the_run(loaded: &Loaded, within: f64) {
    let recording = &loaded.recording;
    assert_eq!(recording.len(), 24);
    for (sample, increments) in recording.increments.iter().enumerate() {
        let k = (sample + 1) as f64;
        let rates = [0.1 + 0.001 * k, 0.2 - 0.002 * k, 0.3 + 0.003 * k];
        let forces = [1.0 + 0.01 * k, 2.0 - 0.02 * k, 9.8 + 0.03 * k];
        assert_close!(increments.interval, STEP, 1e-7);
        for axis in 0..3 {
            assert_close!(increments.angle.components()[axis], rates[axis] * STEP, within * STEP);
            let velocity = increments.velocity.components()[axis];
            assert_close!(velocity, forces[axis] * STEP, 10.0 * within * STEP);
        }
        let first = recording.times[0];
        assert_close!(recording.times[sample] - first, (k - 1.0) * STEP, 1e-7);
    }
}

/// The tolerance for doubles that were rounded once or twice.
const ROUNDING: f64 = 1e-14;

#[test]
fn psins_doubles_are_read() {
    let loaded = load("format = \"psins-bin\"\n", "psins.bin").unwrap();
    is_the_run(&loaded, ROUNDING);
    assert_close!(loaded.recording.times[0], 0.01, 1e-16);
    let turned = "format = \"psins-bin\"\ngyro = { axes = [\"-y\", \"x\", \"z\"] }\n";
    let turned = load(turned, "psins.bin").unwrap().recording;
    assert_eq!(
        turned.increments[0].angle.components().x,
        -loaded.recording.increments[0].angle.components().y
    );
}

#[test]
fn doubles_that_are_not_seven_a_row_are_refused() {
    let log = "format = \"psins-bin\"\n";
    let bytes = data("psins.bin");
    let refused = load_bytes(log, "psins.bin", &bytes[..bytes.len() - 3]).unwrap_err();
    assert_eq!(refused, "psins.bin:24: the last row is cut short: rows have 56 bytes");
    assert_eq!(load_bytes(log, "psins.bin", &[]).unwrap_err(), "psins.bin: the file is empty");
    // In the other byte order, not even time increases.
    let swapped: Vec<u8> =
        bytes.chunks(8).flat_map(|double| double.iter().rev().copied()).collect();
    let refused = load_bytes(log, "psins.bin", &swapped).unwrap_err();
    assert!(refused.contains("psins.bin"), "{refused}");
}

#[test]
fn file_with_a_hole_is_refused_where_the_hole_begins() {
    let bytes = data("psins.bin");
    for rows in [0, 5, 24] {
        let folder = folder(&[
            (
                "rig.toml",
                format!("{SITE}[log]\npath = \"run.bin\"\nformat = \"psins-bin\"\n").as_bytes(),
            ),
            ("run.bin", &bytes[..rows * 56]),
        ]);
        // A terabyte, as a sparse file.
        let file = fs::OpenOptions::new().write(true).open(folder.path().join("run.bin")).unwrap();
        file.set_len((rows * 56) as u64 + (1 << 40)).unwrap();
        let refused = read(&folder.path().join("rig.toml")).unwrap_err();
        let refused = without(&refused, folder.path());
        let expected = format!("run.bin:{}: equal to the previous row, as are 10", rows + 2);
        assert!(refused.starts_with(&expected), "{refused}");
    }
}

#[test]
fn kf_gins_text_is_read() {
    is_the_run(&load("format = \"kf-gins\"\n", "kf_gins.txt").unwrap(), ROUNDING);
}

#[test]
fn euroc_text_is_read() {
    let loaded = load("format = \"euroc\"\n", "euroc.csv").unwrap();
    // Nanoseconds since 1970 are integers again when they are counted from a nearby second.
    is_the_run(&loaded, 1e-12);
    assert_close!(loaded.summary.time_origin, 1403636579.0, 1e-6);
    assert_close!(loaded.recording.times[0], 0.768555392, 1e-12);
}

#[test]
fn novatel_messages_are_read() {
    let loaded = load("format = \"novatel\"\nimu = \"HG1700-AG58\"\n", "novatel.asc").unwrap();
    // A count is 1.2e-8 rad/s, or 2.3e-7 m/s^2, over ten milliseconds; the run includes the end of a GNSS week.
    is_the_run(&loaded, 3e-8);
    let loaded = load("format = \"novatel\"\nimu = \"EG320N\"\n", "novatel_epson.asc").unwrap();
    is_the_run(&loaded, 3e-9);
    let by_hand = "format = \"novatel\"\ngyro = { unit = \"rad\", scale = 1.1641532182693481e-10 }\n\
                   accel = { unit = \"m/s\", scale = 2.270936965942383e-9 }\n";
    is_the_run(&load(by_hand, "novatel.asc").unwrap(), 3e-8);
}

/// One message whose checksum fails is a lost sample; several are refused.
#[test]
fn novatel_messages_with_wrong_checksums_are_lost_samples() {
    let log = "format = \"novatel\"\nimu = \"HG1700-AG58\"\n";
    let mut bytes = data("novatel.asc");
    let good = load_bytes(log, "novatel.asc", &bytes).unwrap();
    let place = bytes.len() - 20;
    bytes[place] ^= 1;
    let loaded = load_bytes(log, "novatel.asc", &bytes).unwrap();
    assert_eq!(loaded.recording.len() + 1, good.recording.len());
    assert_eq!(loaded.recording.times[..], good.recording.times[..loaded.recording.len()]);
    let messages = bytes.iter().enumerate().filter(|(_, byte)| **byte == b'*');
    let (second, _) = messages.map(|(place, byte)| (place - 3, *byte)).nth(9).unwrap();
    bytes[second] ^= 1;
    let refused = load_bytes(log, "novatel.asc", &bytes).unwrap_err();
    assert!(refused.contains("the checksum is") && refused.contains("2 of 24 rows"), "{refused}");
}

#[test]
fn novatel_log_of_an_unknown_imu_is_refused() {
    let refused = load("format = \"novatel\"\nimu = \"HG1700\"\n", "novatel.asc").unwrap_err();
    assert!(refused.starts_with("rig.toml:9: [log] imu: \"HG1700\" is not allowed"), "{refused}");
    let refused = load("format = \"novatel\"\n", "novatel.asc").unwrap_err();
    assert!(refused.contains("[log] imu: missing, expected the IMU's model"), "{refused}");
    let log = "format = \"novatel\"\nimu = \"HG1700-AG58\"\n";
    let refused = load_bytes(log, "novatel.asc", b"$GPGGA,1,2\n").unwrap_err();
    assert!(refused.starts_with("novatel.asc: no RAWIMUA"), "{refused}");
}

fn mat(time: &str, gyro: &str, accel: &str, units: [&str; 2]) -> String {
    let triad = |name: &str, from: u8| -> String {
        let columns: Vec<String> = (from..from + 3).map(|n| format!("\"{name}(:,{n})\"")).collect();
        columns.join(", ")
    };
    let first = if gyro == accel { 4 } else { 1 };
    format!(
        "time = {{ column = \"{time}\", unit = \"s\" }}\ngyro = {{ columns = [{}], unit = \"{}\" }}\n\
         accel = {{ columns = [{}], unit = \"{}\" }}\n",
        triad(gyro, 1),
        units[0],
        triad(accel, first),
        units[1]
    )
}

#[test]
fn matlab_matrices_are_read() {
    for name in ["v6.mat", "v7.mat"] {
        let increments = mat("imu(:,7)", "imu", "imu", ["rad", "m/s"]);
        is_the_run(&load(&increments, name).unwrap(), ROUNDING);
        let rates = mat("navego.t", "navego.wb", "navego.fb", ["rad/s", "m/s^2"]);
        is_the_run(&load(&rates, name).unwrap(), 1e-12);
        let vector = mat("t", "navego.wb", "navego.fb", ["rad/s", "m/s^2"]);
        is_the_run(&load(&vector, name).unwrap(), 1e-12);
    }
}

#[test]
fn matlab_files_that_do_not_hold_it_are_refused() {
    let log = |time: &str, imu: &str| mat(time, imu, imu, ["rad", "m/s"]);
    let refused = load(&log("time", "imu"), "v7.mat").unwrap_err();
    assert!(
        refused.starts_with("v7.mat: no column \"time\"; the columns are \"imu(:,1)\""),
        "{refused}"
    );
    let refused = load(&log("t", "imv"), "v7.mat").unwrap_err();
    assert!(
        refused.contains("no column \"imv(:,1)\"") && refused.contains("did you mean"),
        "{refused}"
    );
    let refused = load(&log("imu", "imu"), "v7.mat").unwrap_err();
    assert!(refused.contains("no column \"imu\""), "{refused}");
    let refused = load(&log("t", "z"), "v7.mat").unwrap_err();
    assert!(refused.contains("complex"), "{refused}");
    let refused = load(&log("t", "imu"), "v4.mat").unwrap_err();
    assert!(refused.starts_with("v4.mat: not a MATLAB level 5 file"), "{refused}");
    let bytes = data("v7.mat");
    for length in [1, 127, 128, 140, 1000, bytes.len() - 40] {
        let refused = load_bytes(&log("t", "imu"), "v7.mat", &bytes[..length]).unwrap_err();
        assert!(refused.starts_with("v7.mat: "), "{refused}");
    }
    let mut newer = data("v6.mat");
    newer[125] = 2;
    newer[124] = 0;
    let refused = load_bytes(&log("t", "imu"), "v6.mat", &newer).unwrap_err();
    assert!(refused.contains("version 7.3, which is HDF5; save it with -v7"), "{refused}");
}

const PARQUET: &str = "time = { column = \"t\", unit = \"ns\" }\n\
    gyro = { columns = [\"gx\", \"gy\", \"gz\"], unit = \"rad/s\" }\n\
    accel = { columns = [\"ax\", \"ay\", \"az\"], unit = \"m/s^2\" }\n";

#[test]
fn parquet_is_read_however_it_is_packed() {
    for name in ["plain.parquet", "snappy.parquet", "gzip.parquet"] {
        let loaded = load(PARQUET, name).unwrap();
        is_the_run(&loaded, 1e-12);
        assert_close!(loaded.recording.times[0], 0.768555392, 1e-12);
    }
    let single = PARQUET.replace("\"gx\"", "\"single\"");
    is_the_run(&load(&single, "snappy.parquet").unwrap(), 1e-8);
    let counted = PARQUET
        .replace("\"t\", unit = \"ns\"", "\"count\", unit = \"sample\"")
        .replace("time =", "rate = \"100 Hz\"\ntime =");
    is_the_run(&load(&counted, "snappy.parquet").unwrap(), 1e-12);
}

#[test]
fn parquet_columns_that_are_no_numbers_are_refused() {
    let refused =
        |from: &str, to: &str| load(&PARQUET.replace(from, to), "snappy.parquet").unwrap_err();
    let text = refused("\"gy\"", "\"word\"");
    assert_eq!(text, "snappy.parquet: column \"word\" is BYTE_ARRAY, expected one number per row");
    let list = refused("\"gy\"", "\"list.list.element\"");
    assert!(list.contains("expected one number per row"), "{list}");
    // A missing number is a lost sample.
    let log = format!("{PARQUET}temperature = {{ column = \"hole\", unit = \"degC\" }}\n");
    let hole = load(&log, "snappy.parquet").unwrap();
    assert_eq!(hole.recording.temperature, Some(vec![1.0; 23]));
    assert_eq!(hole.summary.left_out[0].line, 10);
    let missing = refused("\"gy\"", "\"gyy\"");
    assert!(missing.contains("no column \"gyy\"; the columns are \"t\", \"gx\""), "{missing}");
    let packed = load(PARQUET, "zstd.parquet").unwrap_err();
    assert_eq!(
        packed,
        "zstd.parquet: compressed with zstd; write it uncompressed, or with snappy or gzip"
    );
    let bytes = data("snappy.parquet");
    for length in [0, 3, 100, bytes.len() / 2, bytes.len() - 1] {
        let cut = load_bytes(PARQUET, "snappy.parquet", &bytes[..length]).unwrap_err();
        assert!(cut.starts_with("snappy.parquet: "), "{cut}");
    }
}

/// Two files as from a logger like `NaveGo`: raw counts, each sensor with its own clock.
fn own_clocks(accel_clock: &str, accel_rows: std::ops::Range<u32>) -> Result<Loaded, String> {
    let gyro: String = (1..=40)
        .map(|k| format!("{}.{:03} {} 32760 32770\n", k / 50, k % 50 * 20, 32768 + k))
        .collect();
    // A specific force that increases by 0.1 m/s^2 per second, sampled every 30 ms, 5 ms earlier.
    let accel: String = accel_rows
        .map(|k| {
            let end = f64::from(k) * 0.03;
            format!("{:.3} 1 2 {}\n", (end - 0.005) * 1e3, 9800.0 + 100.0 * (end - 0.015))
        })
        .collect();
    let rig = format!(
        "{SITE}[log]\nformat = \"csv\"\ntime = {{ column = \"1\", unit = \"s\" }}\n\
         gyro = {{ path = \"gyro.mat\", columns = [\"2\", \"3\", \"4\"], unit = \"rad/s\", \
         offset = 32768, scale = 2e-4 }}\n\
         accel = {{ path = \"acc.mat\", columns = [\"2\", \"3\", \"4\"], unit = \"m/s^2\", scale = 1e-3\
         {accel_clock} }}\n",
    );
    let gyro = gyro.replacen("32760", "32761", 1);
    let gyro = gyro.replacen("32770", "32771", 1);
    let files = [
        ("rig.toml", rig.as_bytes()),
        ("gyro.mat", gyro.as_bytes()),
        ("acc.mat", accel.as_bytes()),
    ];
    let folder = folder(&files);
    read(&folder.path().join("rig.toml")).map_err(|error| without(&error, folder.path()))
}

const CLOCK: &str = ", time = { column = \"1\", unit = \"ms\", offset = \"-5 ms\" }";

#[test]
fn accelerometers_with_a_clock_of_their_own_are_divided_anew() {
    let loaded = own_clocks(CLOCK, 1..40).unwrap();
    let redivided = loaded.summary.redivided.unwrap();
    assert_eq!((redivided.samples, redivided.left_out, loaded.recording.len()), (39, 0, 40));
    for (time, increments) in loaded.recording.times.iter().zip(&loaded.recording.increments) {
        assert_close!(increments.interval, 0.02, 1e-12);
        // The mean over the interval, within the steps of 3 mm/s^2 in the samples.
        let force = increments.velocity.components().z / 0.02;
        assert_close!(force, 9.8 + 0.1 * (time - 0.01), 2e-3);
    }
    // The sum is preserved: 9.8 T + 0.05 T^2 over the first 0.78 s, at which samples of both clocks end.
    let sum: f64 =
        loaded.recording.increments[..39].iter().map(|i| i.velocity.components().z).sum();
    assert_close!(sum, 9.8 * 0.78 + 0.05 * 0.78 * 0.78, 1e-9);
}

#[test]
fn samples_that_the_other_clock_does_not_cover_are_left_out_and_counted() {
    let loaded = own_clocks(CLOCK, 5..20).unwrap();
    let redivided = loaded.summary.redivided.unwrap();
    // They cover 0.12 s to 0.57 s, which contain 22 complete intervals of 0.02 s.
    assert_eq!((redivided.samples, redivided.left_out), (15, 18));
    assert_eq!(loaded.recording.len(), 22);
    assert_close!(redivided.late, 0.12, 1e-12);
    assert_close!(loaded.recording.times[0], 0.14, 1e-12);
}

#[test]
fn clocks_that_cannot_be_compared_are_refused() {
    let refused = own_clocks("", 1..40).unwrap_err();
    assert!(refused.starts_with("acc.mat: 39 samples, but gyro.mat has 40"), "{refused}");
    let later = CLOCK.replace("-5 ms", "-100 s");
    let refused = own_clocks(&later, 1..40).unwrap_err();
    assert!(refused.starts_with("gyro.mat: has no time in common with acc.mat"), "{refused}");
    let counted = CLOCK.replace("\"ms\"", "\"sample\"");
    let refused = own_clocks(&counted, 1..40).unwrap_err();
    assert!(refused.contains("two clocks are compared in s, ms, us or ns"), "{refused}");
    let long = own_clocks(CLOCK, 1..40).unwrap().summary.nominal_interval;
    assert_close!(long, 0.02, 1e-12);
}

#[test]
fn separators_and_units_on_lines_of_their_own_are_understood() {
    let rows: String = (1..=12)
        .map(|k| format!("{}|{k}|{k}|-{k}|0.1|0.2|9.8{k}\n", f64::from(k) * 0.01))
        .collect();
    let log = "time = { column = \"t\", unit = \"s\" }\n\
        gyro = { columns = [\"gx\", \"gy\", \"gz\"], unit = \"deg/s\" }\n\
        accel = { columns = [\"ax\", \"ay\", \"az\"], unit = \"m/s^2\" }\n";
    let text = format!("sep=|\nt|gx|gy|gz|ax|ay|az\ns|deg/s|deg/s|deg/s|m/s^2|m/s^2|m/s^2\n{rows}");
    for (separator, text) in [("|", text.clone()), (";", text.replace('|', ";"))] {
        let loaded = load_bytes(log, "run.csv", text.as_bytes()).unwrap();
        assert_eq!(loaded.recording.len(), 12, "{separator}");
    }
    // A row of words between numbers is a damaged row, not a row of units.
    let late = text.replacen("\n0.02|2|2", "\ns|x|y", 1);
    let loaded = load_bytes(log, "run.csv", late.as_bytes()).unwrap();
    assert_eq!(loaded.recording.len(), 11);
    assert_eq!(loaded.summary.left_out[0].reason, rins_io::Omission::Damaged);
}
