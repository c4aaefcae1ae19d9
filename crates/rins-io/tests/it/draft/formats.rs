//! Drafts of logs that are not columns of text.

use rins_io::{LogFile, Overwrite, convert, read};

use super::support::draft;
use crate::support::{RIG, folder, log};

/// Columns of binary files have names, and the draft names their format.
#[test]
fn columns_of_binary_files_are_drafted() {
    for (file, format) in [(LogFile::Parquet, "parquet"), (LogFile::Mat, "mat")] {
        let folder = folder(&[("rig.toml", RIG.as_bytes()), ("run.csv", log(40).as_bytes())]);
        let name = format!("run.{format}");
        convert(
            &folder.path().join("rig.toml"),
            &folder.path().join(&name),
            file,
            Overwrite::Refuse,
        )
        .unwrap();
        let draft = draft(folder.path(), &name);
        assert!(draft.text.contains(&format!("format = \"{format}\"")), "{}", draft.text);
        assert!(draft.text.contains("All 40 rows were read."), "{}", draft.text);
        let written = read(&folder.path().join("run.toml")).unwrap();
        assert_eq!(written.recording.len(), 40);
    }
}

/// The extended messages of a NovAtel receiver state the IMU; the others do not.
#[test]
fn messages_of_a_receiver_are_drafted() {
    let extended =
        "%RAWIMUSXA,2209,491674.014;04,26,2209,491674.013699,ea59fe00,3,-2,4,1,4,-1*038422a7\n";
    let plain = "%RAWIMUSA,2209,491612.254;2209,491612.253588,ea5afe00,3,-2,4,3,6,-1*1fb76c28\n";
    let unknown = extended.replace("04,26,", "04,99,");
    for (log, imu) in [
        (extended.to_owned(), "imu = \"ISA-100C\"  # GUESS"),
        (format!("#BESTPOSA,COM1;SOL*1\n{plain}"), "# imu = \"?\"  # TO FILL IN"),
        (unknown, "its messages state the unknown type 99"),
    ] {
        let folder = folder(&[("run.ASC", log.as_bytes())]);
        let text = draft(folder.path(), "run.ASC").text;
        assert!(text.contains("format = \"novatel\"") && text.contains(imu), "{text}");
    }
}

/// Rows of several sensors: which are read is proposed where the names say so.
#[test]
fn rows_of_several_sensors_are_drafted() {
    let rows: String = (1..50)
        .map(|row| format!("Gyro,{row}.0,1e-3,2e-3,{row}e-5\nAccel,{row}.5,0.1,0.{row},9.8\n"))
        .collect();
    let log = format!("type,ms,x,y,z\n{rows}");
    let folder = folder(&[("run.csv", log.as_bytes())]);
    let text = draft(folder.path(), "run.csv").text;
    for line in [
        "gyro.where = { column = \"type\", value = \"Gyro\" }  # GUESS",
        "accel.where = { column = \"type\", value = \"Accel\" }  # GUESS",
        "accel.columns = [\"x\", \"y\", \"z\"]  # GUESS",
    ] {
        assert!(text.contains(line), "{line} in {text}");
    }
}
