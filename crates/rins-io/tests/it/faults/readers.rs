//! Every reader, with a valid file of its format.

use std::fs;
use std::path::Path;

use rins_io::{Calibration, IoError, ScenarioFile, read};

use crate::support::{SITE, log};

/// The representation of the numbers in a file.
#[derive(Clone, Copy)]
pub(super) enum Writing {
    /// As text: a row of numbers in the middle, its delimiter, the index of a
    /// measured number, and that of the time stamp.
    Text { row: usize, between: char, number: usize, time: Option<usize> },
    /// As doubles of eight bytes, one of which starts at this position; `None` if they are compressed.
    Binary { number: Option<usize> },
    /// As TOML keys, one of which has this value.
    Keys { value: &'static str },
}

/// The function that reads the file.
#[derive(Clone, Copy)]
pub(super) enum Entry {
    Rig,
    Scenario,
    Calibration,
}

/// A reader with its input files.
pub(super) struct Reader {
    pub(super) name: &'static str,
    /// The file that is damaged.
    pub(super) file: &'static str,
    pub(super) good: Vec<u8>,
    pub(super) writing: Writing,
    /// The other files.
    pub(super) others: Vec<(&'static str, Vec<u8>)>,
    pub(super) entry: Entry,
}

impl Reader {
    /// Reads the files in `folder`: returns the number of samples, or the error.
    pub(super) fn run(&self, folder: &Path) -> Result<usize, IoError> {
        let path = |name: &str| folder.join(name);
        match self.entry {
            Entry::Rig => read(&path("rig.toml")).map(|loaded| {
                // Data that are read are plausible, whatever was damaged.
                let recording = &loaded.recording;
                assert!(recording.times.windows(2).all(|pair| pair[0] < pair[1]), "{}", self.name);
                for sample in &recording.increments {
                    assert!(sample.interval > 0.0 && sample.interval.is_finite());
                    assert!(sample.angle.components().norm().is_finite());
                    assert!(sample.velocity.components().norm().is_finite());
                }
                recording.len()
            }),
            Entry::Scenario => ScenarioFile::read(&path("scenario.toml")).map(|_| 0),
            Entry::Calibration => Calibration::read(&path("calibration.toml")).map(|_| 0),
        }
    }
}

const COLUMNS: &str = "time = { column = \"t\", unit = \"s\" }\n\
    gyro = { columns = [\"gx\", \"gy\", \"gz\"], unit = \"rad/s\" }\n\
    accel = { columns = [\"ax\", \"ay\", \"az\"], unit = \"m/s^2\" }\n";

const SCENARIO: &str = "[site]\nlatitude = \"34.25 deg\"\nlongitude = \"108.9 deg\"\nheight = \"400 m\"\n\n\
    [log]\nrate = \"50 Hz\"\n\n[table]\nprofile = [{ rate = \"0 deg/s\", duration = \"20 s\" }]\n\n\
    [attitude]\nroll = \"0 deg\"\npitch = \"0 deg\"\nyaw = \"0 deg\"\nsigma = \"0.1 deg\"\n\n\
    [imu.gyro]\nnoise = \"0.02 deg/h/sqrt(Hz)\"\nbias_sigma = \"0.1 deg/h\"\n\
    scale_sigma = \"500 ppm\"\nmisalignment_sigma = \"120 arcsec\"\n\n\
    [imu.accel]\nnoise = \"30 ug/sqrt(Hz)\"\nbias_sigma = \"200 ug\"\n\
    scale_sigma = \"300 ppm\"\nmisalignment_sigma = \"60 arcsec\"\n\n\
    [truth]\nseed = 1\n";

const CALIBRATION: &str = "[gyro]\nbias = [\"0.1 deg/h\", \"0 deg/h\", \"0 deg/h\"]\n\
    scale = [\"1 ppm\", \"2 ppm\", \"3 ppm\"]\nmisalignment = { xy = \"0 deg\", xz = \"0 deg\", \
    yx = \"0 deg\", yz = \"0 deg\", zx = \"0 deg\", zy = \"0 deg\" }\n";

const PSINS: &str = "% PSINS\n0 0 -90.6 0 0 0\n34.2 108.9 380 0 10 9.78\n0.1 0.1 0.1 125 125 125\n";

fn data(name: &str) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name);
    fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A reader of a log with these keys in the rig file.
fn of_log(
    name: &'static str,
    file: &'static str,
    keys: &str,
    writing: Writing,
    good: Vec<u8>,
) -> Reader {
    let rig = format!("{SITE}[log]\npath = \"{file}\"\n{keys}").into_bytes();
    Reader { name, file, good, writing, others: vec![("rig.toml", rig)], entry: Entry::Rig }
}

fn of_keys(name: &'static str, entry: Entry, text: &str, value: &'static str) -> Reader {
    let (good, writing) = (text.as_bytes().to_vec(), Writing::Keys { value });
    Reader { name, file: name, good, writing, others: Vec::new(), entry }
}

/// The position of a double with this value.
fn place_of(bytes: &[u8], value: f64) -> usize {
    let number = |window: &[u8]| f64::from_le_bytes(window.try_into().unwrap());
    let near = |window: &[u8]| (number(window) / value - 1.0).abs() < 1e-12;
    let place = bytes.windows(8).position(near);
    place.expect("the file holds this number")
}

/// All readers.
pub(super) fn readers() -> Vec<Reader> {
    let text = |row, between, number, time| Writing::Text { row, between, number, time };
    let mut psins = PSINS.to_string();
    for row in 1..=24 {
        psins.push_str(&format!("{row} {} 3 0 -1 {}\n", row + 1, 100 + row));
    }
    let psins = psins.replacen(" 3 0", " 4 0", 1).into_bytes();
    let matrix = |name: &'static str, file: &'static str, number| {
        let keys = "time = { column = \"imu(:,7)\", unit = \"s\" }\n\
            gyro = { columns = [\"imu(:,1)\", \"imu(:,2)\", \"imu(:,3)\"], unit = \"rad\" }\n\
            accel = { columns = [\"imu(:,4)\", \"imu(:,5)\", \"imu(:,6)\"], unit = \"m/s\" }\n";
        of_log(name, file, keys, Writing::Binary { number }, data(file))
    };
    let table = |file: &'static str, number| {
        let keys = COLUMNS.replace("unit = \"s\"", "unit = \"ns\"");
        of_log(file, file, &keys, Writing::Binary { number }, data(file))
    };
    // The rate of gyro y and the increment of gyro x in the ninth sample.
    let rate = 0.2 - 0.002 * 9.0;
    let increment = (0.1 + 0.001 * 9.0) * 0.01;
    let accel = CALIBRATION.replace("gyro", "accel").replace("deg/h", "mg");
    let calibration = format!("schema = 1\n{CALIBRATION}{accel}");
    let doubles = data("psins.bin");
    let number = Some(place_of(&doubles, increment));
    let mut readers = vec![
        of_log("csv", "run.csv", COLUMNS, text(12, ',', 1, Some(0)), log(24).into()),
        of_log("psins", "run.imu", "format = \"psins\"\n", text(12, ' ', 0, None), psins),
        of_log(
            "psins-bin",
            "run.bin",
            "format = \"psins-bin\"\n",
            Writing::Binary { number },
            doubles,
        ),
        of_log(
            "kf-gins",
            "run.txt",
            "format = \"kf-gins\"\n",
            text(12, ' ', 1, Some(0)),
            data("kf_gins.txt"),
        ),
        of_log(
            "euroc",
            "run.csv",
            "format = \"euroc\"\n",
            text(12, ',', 1, Some(0)),
            data("euroc.csv"),
        ),
        of_log(
            "novatel",
            "run.asc",
            "format = \"novatel\"\nimu = \"HG1700-AG58\"\n",
            text(12, ',', 6, Some(1)),
            data("novatel.asc"),
        ),
        matrix("mat, plain", "v6.mat", Some(place_of(&data("v6.mat"), increment))),
        matrix("mat, compressed", "v7.mat", None),
        table("plain.parquet", Some(place_of(&data("plain.parquet"), rate))),
        table("snappy.parquet", None),
        table("gzip.parquet", None),
        of_keys(
            "rig.toml",
            Entry::Rig,
            &format!("{SITE}[log]\npath = \"run.csv\"\n{COLUMNS}"),
            "400 m",
        ),
        of_keys("scenario.toml", Entry::Scenario, SCENARIO, "400 m"),
        of_keys("calibration.toml", Entry::Calibration, &calibration, "0.1 deg/h"),
    ];
    let rig = readers.iter_mut().find(|reader| reader.name == "rig.toml").unwrap();
    rig.others.push(("run.csv", log(24).into()));
    readers.extend(beside_the_log());
    readers
}

/// Files in addition to the log: accelerometers with a clock of their own, and a thermometer.
fn beside_the_log() -> [Reader; 2] {
    let keys = "format = \"csv\"\ntime = { column = \"t\", unit = \"s\" }\n\
        gyro = { columns = [\"gx\", \"gy\", \"gz\"], unit = \"rad/s\" }\n";
    let accel = "accel = { path = \"accel.txt\", columns = [\"2\", \"3\", \"4\"], unit = \"m/s^2\", \
        time = { column = \"1\", unit = \"s\" } }\n";
    let rig = |accel: &str| format!("{SITE}[log]\npath = \"run.csv\"\n{keys}{accel}").into_bytes();
    let row = |k: u32| format!("{:.3} {k} 2 9.8\n", f64::from(k) * 0.025);
    let own = Reader {
        name: "accelerometers on their own clock",
        file: "accel.txt",
        good: (0..=24).map(row).collect::<String>().into_bytes(),
        writing: Writing::Text { row: 12, between: ' ', number: 1, time: Some(0) },
        others: vec![("rig.toml", rig(accel)), ("run.csv", log(24).into())],
        entry: Entry::Rig,
    };
    let together = "accel = { columns = [\"ax\", \"ay\", \"az\"], unit = \"m/s^2\" }\n";
    let temperature =
        "temperature = { path = \"warm.txt\", time = \"1\", column = \"2\", unit = \"degC\" }\n";
    let row = |k: u32| format!("{:.2} {}\n", f64::from(k) * 0.02, 20.0 + f64::from(k) * 0.1);
    let thermometer = Reader {
        name: "a thermometer",
        file: "warm.txt",
        good: (0..=24).map(row).collect::<String>().into_bytes(),
        writing: Writing::Text { row: 12, between: ' ', number: 1, time: Some(0) },
        others: vec![
            ("rig.toml", rig(&format!("{together}{temperature}"))),
            ("run.csv", log(24).into()),
        ],
        entry: Entry::Rig,
    };
    [own, thermometer]
}
