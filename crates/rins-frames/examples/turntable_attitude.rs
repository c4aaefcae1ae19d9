//! A tilted rate table: gravity and the Earth rate in the body frame of its IMU.
#![expect(clippy::print_stdout, reason = "an example prints")]

use rins_frames::units::{DEG, DEG_PER_HOUR};
use rins_frames::{Body, Dcm, EulerAngles, InFrame, Nav, Site, Table};

fn main() {
    let site = Site { latitude: 34.25 * DEG, longitude: 108.9 * DEG, height: 400.0 };
    let tilt = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
    let nav_from_table: Dcm<Nav, Table> = tilt.dcm();
    let up = InFrame::<Nav>::new(0.0, 0.0, site.normal_gravity());

    println!("table   specific force [m/s²]         Earth rate [deg/h]");
    for angle in [0.0, 90.0, 180.0, 270.0] {
        let table_from_body = Dcm::<Table, Body>::about_z(angle * DEG);
        let body_from_nav = (nav_from_table * table_from_body).inverse();
        let f = body_from_nav * up;
        let w = body_from_nav * site.earth_rate();
        let (f, w) = (f.components(), w.components() / DEG_PER_HOUR);
        println!(
            "{angle:>4}°  {:9.4}{:9.4}{:9.4}  {:9.3}{:9.3}{:9.3}",
            f.x, f.y, f.z, w.x, w.y, w.z
        );
    }
    println!("The spin axis (z) keeps its reading; x and y change sign over half a turn.");
}
