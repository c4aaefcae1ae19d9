//! Merging of many shards.

use std::fs;
use std::path::PathBuf;

use rins::{MonteCarloOptions, Overwrite};

/// A scenario of 20 s at 10 Hz, at 140 heights.
const SCENARIO: &str = r#"
[site]
latitude = "45 deg"
height = "0 m"
[log]
rate = "10 Hz"
table_rate = {}
[table]
profile = [{ rate = "20 deg/s", duration = "20 s" }]
[attitude]
roll = "0 deg"
pitch = "25 deg"
yaw = "0 deg"
sigma = "0.1 deg"
[imu]
grade = "fog"
[truth]
seed = 1
[truth.gyro]
scale = ["0 ppm", "0 ppm", "200 ppm"]
[grid]
"site.height" = { from = "0 m", to = "1390 m", steps = 140 }
"#;

/// More than are open at a time, so that they are merged in groups.
const SHARDS: u64 = 70;

#[test]
fn more_shards_than_are_open_at_a_time_give_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("scenario.toml"), SCENARIO).unwrap();
    let options = |output: PathBuf| MonteCarloOptions::new(2, output);
    rins::monte_carlo(&at("scenario.toml"), &options(at("single.parquet"))).unwrap();
    // In another order than that of the shards.
    let shards: Vec<u64> = (1..=SHARDS).rev().collect();
    let parts: Vec<PathBuf> = shards.iter().map(|shard| at(&format!("{shard}.parquet"))).collect();
    for (&shard, part) in shards.iter().zip(&parts) {
        let options = MonteCarloOptions { shard: Some((shard, SHARDS)), ..options(part.clone()) };
        rins::monte_carlo(&at("scenario.toml"), &options).unwrap();
    }
    let before = fs::read_dir(folder.path()).unwrap().count();
    rins::merge(&parts, &at("merged.parquet"), Overwrite::Refuse).unwrap();
    assert!(fs::read(at("merged.parquet")).unwrap() == fs::read(at("single.parquet")).unwrap());
    // The results, the report, and no intermediate file.
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), before + 2);

    // The last part is damaged: nothing is written.
    let content = fs::read(&parts[0]).unwrap();
    fs::write(&parts[0], &content[..content.len() / 2]).unwrap();
    assert!(rins::merge(&parts, &at("again.parquet"), Overwrite::Refuse).is_err());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), before + 2);
}
