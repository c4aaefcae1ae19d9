//! Detects at build time which tests can run here: tests without their requirements are ignored, visibly.

use std::path::PathBuf;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=RINS_DATA");
    let data = std::env::var_os("RINS_DATA").map(PathBuf::from);
    told("rins_data", data.is_some_and(|folder| folder.is_dir()));
    told("private_mounts", may_mount());
}

fn told(name: &str, is_there: bool) {
    println!("cargo::rustc-check-cfg=cfg({name})");
    if is_there {
        println!("cargo::rustc-cfg={name}");
    }
}

/// Whether this user may mount a file system that only a process of its own sees.
fn may_mount() -> bool {
    let tried =
        Command::new("unshare").args(["-rm", "mount", "-t", "tmpfs", "tmpfs", "/mnt"]).output();
    tried.is_ok_and(|output| output.status.success())
}
