//! The layouts of the logs of many programs.

use rins_frames::units::{DEG, STANDARD_GRAVITY};

/// A unit as a rig file spells it, and its value in SI units.
type Unit = (&'static str, f64);

const RAD: Unit = ("rad/s", 1.0);
const DPS: Unit = ("deg/s", DEG);
const MS2: Unit = ("m/s^2", 1.0);
const G: Unit = ("g", STANDARD_GRAVITY);
const MG: Unit = ("mg", 1e-3 * STANDARD_GRAVITY);

/// A stamp at a time \[us\].
type Stamp = fn(u64) -> String;

/// The layout of a log.
pub(super) struct Layout {
    pub(super) name: &'static str,
    pub(super) file: &'static str,
    /// The lines before the rows; the first one with as many fields as a row has the names.
    pub(super) before: &'static str,
    /// The kinds of the columns: t and d for the time, g, a, l, m for triads, q, e, T, P, n for others, s for text, 0 for zero.
    pub(super) codes: &'static str,
    pub(super) between: &'static str,
    pub(super) comma: bool,
    pub(super) decimals: usize,
    pub(super) stamp: Stamp,
    pub(super) second: Stamp,
    pub(super) gyro: Unit,
    pub(super) accel: Unit,
    /// The right units of the time.
    pub(super) time_units: &'static [&'static str],
}

impl Layout {
    /// The names of the columns, if there are any.
    pub(super) fn names(&self) -> Vec<String> {
        let count = self.codes.split(' ').count();
        let split = |line: &str| -> Vec<String> {
            let line = line.trim_start_matches(['%', '#']).trim_start();
            line.split(self.between).map(|name| name.trim_matches('"').trim().to_string()).collect()
        };
        let mut lines = self.before.lines().map(split);
        lines.find(|names| names.len() == count).unwrap_or_default()
    }

    /// The columns that are times.
    pub(super) fn times(&self) -> Vec<usize> {
        let codes = self.codes.split(' ').enumerate();
        codes
            .filter(|(_, code)| code.starts_with(['t', 'd', 'n']))
            .map(|(place, _)| place)
            .collect()
    }
}

/// A layout with commas, its time in seconds in the first column, rad/s and m/s².
const BASE: Layout = Layout {
    name: "",
    file: "run.csv",
    before: "",
    codes: "t gx gy gz ax ay az",
    between: ",",
    comma: false,
    decimals: 7,
    stamp: seconds,
    second: seconds,
    gyro: RAD,
    accel: MS2,
    time_units: &["s"],
};

fn seconds(time: u64) -> String {
    format!("{}.{:06}", time / 1_000_000, time % 1_000_000)
}

fn comma_seconds(time: u64) -> String {
    seconds(time).replace('.', ",")
}

fn millis(time: u64) -> String {
    (time / 1000).to_string()
}

fn micros(time: u64) -> String {
    (4_294_000_000 + time).to_string()
}

fn nanos(time: u64) -> String {
    (1_700_000_000_123_456_000 + time * 1000).to_string()
}

fn fine(time: u64) -> String {
    (time / 100).to_string()
}

fn unix(time: u64) -> String {
    (1_700_000_000 + time / 1_000_000).to_string()
}

fn part(time: u64) -> String {
    (time % 1_000_000 * 1000).to_string()
}

fn iso(time: u64) -> String {
    format!(
        "2024-03-01T09:{:02}:{:02}.{:06}Z",
        time / 60_000_000,
        time / 1_000_000 % 60,
        time % 1_000_000
    )
}

fn date(_: u64) -> String {
    "01.03.2024".into()
}

fn clock(time: u64) -> String {
    format!("09:{:02}:{:02}.{:03}", time / 60_000_000, time / 1_000_000 % 60, time / 1000 % 1000)
}

fn week(_: u64) -> String {
    "2303".into()
}

fn tow(time: u64) -> String {
    seconds(345_600_000_000 + time)
}

fn tow_ms(time: u64) -> String {
    (345_600_000 + time / 1000).to_string()
}

fn matlab(time: u64) -> String {
    format!("{} sec", seconds(time))
}

#[rustfmt::skip]
pub(super) const LAYOUTS: &[Layout] = &[
    // ROS.
    Layout { name: "ros2 topic echo --csv", codes: "t d simu q0 q0 qz qw 0 0 0 0 0 0 0 0 0 gx gy gz 0 0 0 0 0 0 0 0 0 ax ay az 0 0 0 0 0 0 0 0 0", stamp: unix, second: part, time_units: &["s ns"], ..BASE },
    Layout { name: "rostopic echo -p", before: "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.orientation.x,field.orientation.y,field.orientation.z,field.orientation.w,field.angular_velocity.x,field.angular_velocity.y,field.angular_velocity.z,field.linear_acceleration.x,field.linear_acceleration.y,field.linear_acceleration.z\n", codes: "t n t simu q0 q0 qz qw gx gy gz ax ay az", stamp: nanos, time_units: &["ns"], ..BASE },
    Layout { name: "rosbag to csv", before: "header.stamp.sec,header.stamp.nanosec,header.frame_id,orientation.x,orientation.y,orientation.z,orientation.w,angular_velocity.x,angular_velocity.y,angular_velocity.z,linear_acceleration.x,linear_acceleration.y,linear_acceleration.z\n", codes: "t d simu q0 q0 qz qw gx gy gz ax ay az", stamp: unix, second: part, time_units: &["s ns"], ..BASE },
    Layout { name: "PlotJuggler", before: "__time,/imu/header/stamp/sec,/imu/header/stamp/nanosec,/imu/linear_acceleration/x,/imu/linear_acceleration/y,/imu/linear_acceleration/z,/imu/angular_velocity/x,/imu/angular_velocity/y,/imu/angular_velocity/z\n", codes: "t t d ax ay az gx gy gz", stamp: unix, second: part, time_units: &["s ns"], ..BASE },
    Layout { name: "secs, nsecs", before: "secs,nsecs,wx,wy,wz,fx,fy,fz\n", codes: "t d gx gy gz ax ay az", stamp: unix, second: part, time_units: &["s ns"], ..BASE },
    Layout { name: "EuRoC", before: "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n", stamp: nanos, time_units: &["ns"], ..BASE },
    // Autopilots.
    Layout { name: "PX4 sensor_combined", before: "timestamp,gyro_rad[0],gyro_rad[1],gyro_rad[2],gyro_integral_dt,accelerometer_timestamp_relative,accelerometer_m_s2[0],accelerometer_m_s2[1],accelerometer_m_s2[2],accelerometer_integral_dt\n", codes: "t gx gy gz s20000 0 ax ay az s20000", stamp: micros, time_units: &["us"], ..BASE },
    Layout { name: "ArduPilot IMU", before: "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz,AHz\n", codes: "t 0 gx gy gz ax ay az 0 0 T s1 s1 s1000 s1000", stamp: micros, time_units: &["us"], ..BASE },
    Layout { name: "Betaflight blackbox", before: "loopIteration,time (us),gyroADC[0],gyroADC[1],gyroADC[2],accSmooth[0],accSmooth[1],accSmooth[2]\n", codes: "n t gx gy gz ax ay az", stamp: micros, gyro: DPS, accel: ("?", STANDARD_GRAVITY / 2048.0), decimals: 0, time_units: &["us", "sample"], ..BASE },
    // Inertial units.
    Layout { name: "Xsens MT Manager", before: "// General information:\n//  MT Manager version:\t2022.0\n//  Start Time: unknown\nPacketCounter\tSampleTimeFine\tAcc_X\tAcc_Y\tAcc_Z\tFreeAcc_E\tFreeAcc_N\tFreeAcc_U\tGyr_X\tGyr_Y\tGyr_Z\tMag_X\tMag_Y\tMag_Z\tRoll\tPitch\tYaw\n", codes: "n t ax ay az lx ly lz gx gy gz mx my mz ex ey ez", between: "\t", stamp: fine, time_units: &["sample"], ..BASE },
    Layout { name: "Xsens quaternions", before: "PacketCounter,UTC_Nano,Quat_q0,Quat_q1,Quat_q2,Quat_q3,Acc_X,Acc_Y,Acc_Z,Gyr_X,Gyr_Y,Gyr_Z,Temperature\n", codes: "n s0 qw q0 q0 qz ax ay az gx gy gz T", time_units: &["sample"], ..BASE },
    Layout { name: "VectorNav", before: "TimeStartup (ns),UncompMagX,UncompMagY,UncompMagZ,UncompAccelX,UncompAccelY,UncompAccelZ,UncompGyroX,UncompGyroY,UncompGyroZ,Temperature,Pressure\n", codes: "t mx my mz ax ay az gx gy gz T P", stamp: nanos, time_units: &["ns"], ..BASE },
    Layout { name: "VectorNav with GNSS time", before: "GpsTow,GpsWeek,Yaw,Pitch,Roll,GyroX,GyroY,GyroZ,AccelX,AccelY,AccelZ\n", codes: "t d ez ey ex gx gy gz ax ay az", stamp: tow, second: week, time_units: &["week s"], ..BASE },
    Layout { name: "NovAtel week and seconds", before: "Week,Seconds,AccelX (m/s^2),AccelY (m/s^2),AccelZ (m/s^2),GyroX (deg/s),GyroY (deg/s),GyroZ (deg/s)\n", codes: "t d ax ay az gx gy gz", stamp: week, second: tow, gyro: DPS, time_units: &["week s"], ..BASE },
    Layout { name: "u-blox iTOW", before: "iTOW_ms,gyroX_deg_s,gyroY_deg_s,gyroZ_deg_s,accX_m_s2,accY_m_s2,accZ_m_s2,gyroTemp_degC\n", codes: "t gx gy gz ax ay az T", stamp: tow_ms, gyro: DPS, time_units: &["ms"], ..BASE },
    Layout { name: "GNSS week without seconds' unit", before: "GPS_Week,GPS_TOW,gx,gy,gz,ax,ay,az\n", codes: "t d gx gy gz ax ay az", stamp: week, second: tow_ms, gyro: DPS, accel: G, time_units: &["week ms"], ..BASE },
    Layout { name: "x-io x-IMU3", before: "Timestamp (us),Gyroscope X (deg/s),Gyroscope Y (deg/s),Gyroscope Z (deg/s),Accelerometer X (g),Accelerometer Y (g),Accelerometer Z (g)\n", stamp: micros, gyro: DPS, accel: G, time_units: &["us"], ..BASE },
    Layout { name: "x-io NGIMU", before: "Time (s),Gyroscope X (deg/s),Gyroscope Y (deg/s),Gyroscope Z (deg/s),Accelerometer X (g),Accelerometer Y (g),Accelerometer Z (g),Magnetometer X (uT),Magnetometer Y (uT),Magnetometer Z (uT),Barometer (hPa)\n", codes: "t gx gy gz ax ay az mx my mz P", gyro: DPS, accel: G, ..BASE },
    Layout { name: "x-io x-IMU", before: "Packet number,Gyroscope X (deg/s),Gyroscope Y (deg/s),Gyroscope Z (deg/s),Accelerometer X (g),Accelerometer Y (g),Accelerometer Z (g)\n", codes: "n gx gy gz ax ay az", gyro: DPS, accel: G, time_units: &["sample"], ..BASE },
    Layout { name: "Movella DOT", before: "sep=,\nPacketCounter,SampleTimeFine,Euler_X,Euler_Y,Euler_Z,dq_W,dq_X,dq_Y,dq_Z,Acc_X,Acc_Y,Acc_Z,Gyr_X,Gyr_Y,Gyr_Z,Mag_X,Mag_Y,Mag_Z,Status\n", codes: "n t ex ey ez qw q0 q0 qz ax ay az gx gy gz mx my mz 0", stamp: micros, gyro: DPS, time_units: &["us", "sample"], ..BASE },
    Layout { name: "Microstrain", before: "Time,X Accel [x8004],Y Accel [x8004],Z Accel [x8004],X Gyro [x8005],Y Gyro [x8005],Z Gyro [x8005]\n", codes: "t ax ay az gx gy gz", accel: G, ..BASE },
    // Telephones.
    Layout { name: "phyphox", before: "\"Time (s)\",\"Acceleration x (m/s^2)\",\"Acceleration y (m/s^2)\",\"Acceleration z (m/s^2)\",\"Gyroscope x (rad/s)\",\"Gyroscope y (rad/s)\",\"Gyroscope z (rad/s)\"\n", codes: "t ax ay az gx gy gz", ..BASE },
    Layout { name: "phyphox with commas", before: "\"Time (s)\"\t\"Gyroscope x (rad/s)\"\t\"Gyroscope y (rad/s)\"\t\"Gyroscope z (rad/s)\"\t\"Linear Acceleration x (m/s^2)\"\t\"Linear Acceleration y (m/s^2)\"\t\"Linear Acceleration z (m/s^2)\"\t\"Acceleration x (m/s^2)\"\t\"Acceleration y (m/s^2)\"\t\"Acceleration z (m/s^2)\"\n", codes: "t gx gy gz lx ly lz ax ay az", between: "\t", comma: true, stamp: comma_seconds, ..BASE },
    Layout { name: "Sensor Logger", before: "time,seconds_elapsed,z,y,x\n", file: "Gyroscope.csv", codes: "t d gz gy gx", stamp: nanos, second: seconds, time_units: &["ns", "s"], ..BASE },
    Layout { name: "Sensor Logger accelerometer", before: "time,seconds_elapsed,z,y,x\n", file: "TotalAcceleration.csv", codes: "t d az ay ax", stamp: nanos, second: seconds, time_units: &["ns", "s"], ..BASE },
    Layout { name: "Physics Toolbox", before: "time,gFx,gFy,gFz,ax,ay,az,wx,wy,wz,Bx,By,Bz,Azimuth,Pitch,Roll\n", codes: "t ax ay az lx ly lz gx gy gz mx my mz ez ey ex", accel: G, ..BASE },
    Layout { name: "MATLAB Mobile", before: "Timestamp,X,Y,Z\n", file: "acceleration.csv", codes: "t ax ay az", stamp: iso, ..BASE },
    Layout { name: "Android sensor fusion", before: "timestamp_ms,acc_x,acc_y,acc_z,gravity_x,gravity_y,gravity_z,gyro_x,gyro_y,gyro_z\n", codes: "t ax ay az mx my mz gx gy gz", stamp: millis, time_units: &["ms"], ..BASE },
    // Sketches.
    Layout { name: "Arduino", before: "millis,ax,ay,az,gx,gy,gz,temp\n", codes: "t ax ay az gx gy gz T", stamp: millis, gyro: DPS, accel: G, time_units: &["ms"], ..BASE },
    Layout { name: "Arduino without names", codes: "t ax ay az gx gy gz T", between: "\t", stamp: millis, time_units: &["ms"], ..BASE },
    Layout { name: "Arduino with blanks", codes: "ax ay az gx gy gz", between: " ", accel: G, gyro: DPS, time_units: &[], ..BASE },
    Layout { name: "Arduino counts", before: "t_us,aX,aY,aZ,gX,gY,gZ\n", codes: "t ax ay az gx gy gz", decimals: 0, stamp: micros, gyro: ("?", DEG / 131.0), accel: ("?", STANDARD_GRAVITY / 16384.0), time_units: &["us"], ..BASE },
    Layout { name: "counts of 65.5 per deg/s", before: "ms,gx,gy,gz,ax,ay,az\n", codes: "t gx gy gz ax ay az", decimals: 0, stamp: millis, gyro: ("?", DEG / 65.5), accel: ("?", STANDARD_GRAVITY / 8192.0), time_units: &["ms"], ..BASE },
    Layout { name: "counts of 32.8 per deg/s", before: "ms,gx,gy,gz,ax,ay,az\n", codes: "t gx gy gz ax ay az", decimals: 0, stamp: millis, gyro: ("?", DEG / 32.8), accel: ("?", STANDARD_GRAVITY / 4096.0), time_units: &["ms"], ..BASE },
    Layout { name: "counts of 16.4 per deg/s", before: "ms,gx,gy,gz,ax,ay,az\n", codes: "t gx gy gz ax ay az", decimals: 0, stamp: millis, gyro: ("?", DEG / 16.4), accel: ("?", STANDARD_GRAVITY / 2048.0), time_units: &["ms"], ..BASE },
    Layout { name: "counts of 14.375 per deg/s", before: "ms,gx,gy,gz,ax,ay,az\n", codes: "t gx gy gz ax ay az", decimals: 0, stamp: millis, gyro: ("?", DEG / 14.375), accel: ("?", STANDARD_GRAVITY / 256.0), time_units: &["ms"], ..BASE },
    Layout { name: "counts of 114.3 per deg/s", before: "ms,gx,gy,gz,ax,ay,az\n", codes: "t gx gy gz ax ay az", decimals: 0, stamp: millis, gyro: ("?", DEG / 114.3), accel: ("mg", STANDARD_GRAVITY / 1000.0), time_units: &["ms"], ..BASE },
    Layout { name: "mg and mdps", before: "time_ms;acc_x_mg;acc_y_mg;acc_z_mg;gyr_x_dps;gyr_y_dps;gyr_z_dps\n", codes: "t ax ay az gx gy gz", between: ";", stamp: millis, gyro: DPS, accel: MG, time_units: &["ms"], ..BASE },
    // Calculation.
    Layout { name: "MATLAB timetable", before: "Time,AngularVelocity_1,AngularVelocity_2,AngularVelocity_3,Acceleration_1,Acceleration_2,Acceleration_3\n", stamp: matlab, time_units: &[], ..BASE },
    Layout { name: "MATLAB table", before: "t,wb_1,wb_2,wb_3,fb_1,fb_2,fb_3\n", ..BASE },
    Layout { name: "pandas", before: ",timestamp,gyro_x,gyro_y,gyro_z,acc_x,acc_y,acc_z\n", codes: "n t gx gy gz ax ay az", stamp: iso, time_units: &["s"], ..BASE },
    Layout { name: "German spreadsheet", before: "Zeit;Drehrate X;Drehrate Y;Drehrate Z;Beschleunigung X;Beschleunigung Y;Beschleunigung Z;Temperatur\n", codes: "t gx gy gz ax ay az T", between: ";", comma: true, stamp: comma_seconds, gyro: DPS, ..BASE },
    Layout { name: "German spreadsheet with units", before: "Zeit [s];Gyro X [°/s];Gyro Y [°/s];Gyro Z [°/s];Acc X [m/s²];Acc Y [m/s²];Acc Z [m/s²]\n", between: ";", comma: true, stamp: comma_seconds, gyro: DPS, ..BASE },
    Layout { name: "German date and time of day", before: "Datum;Uhrzeit;Gyro X [°/s];Gyro Y [°/s];Gyro Z [°/s];Acc X [g];Acc Y [g];Acc Z [g]\n", codes: "t d gx gy gz ax ay az", between: ";", comma: true, stamp: date, second: clock, gyro: DPS, accel: G, time_units: &["date s"], ..BASE },
    Layout { name: "front, left, up", before: "time,acc_front,acc_left,acc_up,roll_rate,pitch_rate,yaw_rate\n", codes: "t ax ay az gx gy gz", ..BASE },
    Layout { name: "roll, pitch, yaw beside rates", before: "t,roll,pitch,yaw,roll_rate_deg_s,pitch_rate_deg_s,yaw_rate_deg_s,ax,ay,az\n", codes: "t ex ey ez gx gy gz ax ay az", gyro: DPS, ..BASE },
    Layout { name: "p, q, r", before: "time_s,p,q,r,u,v,w\n", codes: "t gx gy gz lx ly lz", time_units: &["s"], ..BASE },
    Layout { name: "with a preamble", before: "Device: IMU 7\nRate: 50 Hz\n\nTime,Gx,Gy,Gz,Ax,Ay,Az,Mx,My,Mz\n[s],[deg/s],[deg/s],[deg/s],[m/s^2],[m/s^2],[m/s^2],[uT],[uT],[uT]\n", codes: "t gx gy gz ax ay az mx my mz", gyro: DPS, ..BASE },
    Layout { name: "without names, accelerometers first, magnetometer", codes: "t ax ay az gx gy gz mx my mz", ..BASE },
    Layout { name: "without names, quaternion first", codes: "t qw q0 q0 qz gx gy gz ax ay az", accel: G, ..BASE },
    Layout { name: "without names or time, temperature last", codes: "gx gy gz ax ay az T", gyro: DPS, time_units: &[], ..BASE },
    Layout { name: "without names, Euler angles and pressure", codes: "t ex ey ez ax ay az gx gy gz P", gyro: DPS, ..BASE },
];
