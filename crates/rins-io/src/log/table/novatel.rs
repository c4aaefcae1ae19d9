//! NovAtel RAWIMU logs in ASCII: counts accumulated over each sample, in NovAtel's order of axes.
//!
//! ‹novatel-oem7›: after the header come the GNSS week and the seconds into it, the IMU status, and
//! the counts along z, −y and x, of velocity first and then of angle. The extended logs begin with a
//! word of information and the IMU type.

use std::path::Path;

use super::columns::{Columns, MOST_ROWS, Repeated, Wanted, place};
use crate::error::{IoError, LogError};
use crate::log::damage::Damage;
use crate::log::lines::Lines;
use crate::log::problem::LogProblem;
use crate::log::summary::Omission;

/// The columns in the order of the log.
pub(crate) const COUNTS: [&str; 6] =
    ["accel_z", "accel_y", "accel_x", "gyro_z", "gyro_y", "gyro_x"];

/// The signs in the log: y has the opposite direction.
const SIGNS: [f64; 6] = [1.0, -1.0, 1.0, 1.0, -1.0, 1.0];

const SECONDS_OF_A_WEEK: i64 = 604_800;

/// The maximum number of weeks in a log: about 190 years.
const MOST_WEEKS: i64 = 10_000;

/// The maximum number of digits of a checksum.
const CHECKSUM_DIGITS: usize = 8;

/// Reads columns of the RAWIMU, RAWIMUS, RAWIMUX and RAWIMUSX messages of the log at `path`. Other
/// messages are skipped.
pub(super) fn read(path: &Path, wanted: Wanted<'_>) -> Result<Columns, IoError> {
    let Wanted { names, mut time, .. } = wanted;
    let present = COUNTS.map(String::from);
    let places = names.iter().map(|name| place(name, &present)).collect::<Result<Vec<_>, _>>();
    let places = places.map_err(|problem| LogError::of(path, problem))?;
    let mut lines = Lines::messages(path)?;
    let mut columns = Columns { numbers: vec![Vec::new(); names.len()], ..Columns::default() };
    let mut any = false;
    let mut before = String::new();
    let mut repeated = Repeated::default();
    let mut damage = Damage::default();
    while let Some((line, text)) = lines.next()? {
        any = true;
        let refuse_at = |(line, problem)| LogError::at(path, line, problem);
        let message = match Message::of(text.trim_end()) {
            Ok(Some(message)) => message,
            Ok(None) => continue,
            Err(problem) => {
                damage.note(line, problem, MOST_ROWS).map_err(refuse_at)?;
                continue;
            }
        };
        let is_same = message.body == before;
        repeated.count(line, is_same).map_err(refuse_at)?;
        if is_same {
            columns.left_out.push((line, Omission::Repeated));
            continue;
        }
        before.clear();
        before.push_str(message.body);
        let read = message.fields().and_then(|(counts, week, seconds)| {
            let Some(time) = &mut time else { return Ok((counts, None)) };
            let stamp = time.instants.of_sum(week * SECONDS_OF_A_WEEK, seconds, 1);
            let stamp = stamp.filter(|stamp| stamp.is_finite());
            Ok((counts, Some(stamp.ok_or_else(|| not_a_number("seconds", seconds))?)))
        });
        let (counts, stamp) = match read {
            Ok(read) => read,
            Err(problem) => {
                damage.note(line, problem, MOST_ROWS).map_err(refuse_at)?;
                continue;
            }
        };
        columns.time.extend(stamp);
        for (list, &place) in columns.numbers.iter_mut().zip(&places) {
            list.push(counts[place]);
        }
        if columns.lines.len() as u64 >= MOST_ROWS {
            return Err(refuse_at((line, LogProblem::ManyRows { most: MOST_ROWS })));
        }
        columns.lines.push(line);
    }
    let refused = |(line, problem)| LogError::at(path, line, problem);
    damage.settle(&mut columns).map_err(refused)?;
    columns.left_out.extend(lines.unfinished().map(|line| (line, Omission::Unfinished)));
    match (any, columns.lines.is_empty()) {
        (_, false) => Ok(columns),
        (true, true) => Err(LogError::of(path, LogProblem::NoMessages)),
        (false, true) => Err(LogError::of(path, lines.emptiness())),
    }
}

/// One message.
struct Message<'l> {
    body: &'l str,
    extended: bool,
}

/// A RAWIMU message without its mark, and whether it is extended; `None` of another line.
fn raw_imu(line: &str) -> Option<(&str, bool)> {
    let text = line.strip_prefix(['%', '#'])?;
    match text.split([',', ';']).next()? {
        "RAWIMUA" | "RAWIMUSA" => Some((text, false)),
        "RAWIMUXA" | "RAWIMUSXA" => Some((text, true)),
        _ => None,
    }
}

/// A RAWIMU message, as far as it states the IMU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RawImu {
    /// The type of the IMU, which only extended messages state.
    pub(crate) kind: Option<u32>,
}

impl RawImu {
    /// The message of a line; `None` of another line.
    pub(crate) fn of(line: &str) -> Option<Self> {
        let (text, extended) = raw_imu(line)?;
        let stated = || text.split_once(';')?.1.split(',').nth(1)?.trim().parse().ok();
        Some(Self { kind: if extended { stated() } else { None } })
    }
}

impl<'l> Message<'l> {
    /// The message of a line; `None` if the line contains another message, or none.
    fn of(line: &'l str) -> Result<Option<Self>, LogProblem> {
        let Some((text, extended)) = raw_imu(line) else { return Ok(None) };
        let Some((content, checksum)) = text.rsplit_once('*') else {
            return Err(LogProblem::NoChecksum);
        };
        let digits = checksum.len() <= CHECKSUM_DIGITS;
        let stated = u32::from_str_radix(checksum, 16).ok().filter(|_| digits);
        let found = checksum_of(content.as_bytes());
        if stated != Some(found) {
            let stated = checksum.chars().take(40).collect();
            return Err(LogProblem::Checksum { stated, found });
        }
        let Some((_, body)) = content.split_once(';') else {
            return Err(LogProblem::FieldCount { got: 0, expected: 9 });
        };
        Ok(Some(Self { body, extended }))
    }

    /// The counts in the order of [`COUNTS`], the week, and the seconds into it.
    fn fields(&self) -> Result<([f64; 6], i64, &'l str), LogProblem> {
        let fields: Vec<&str> = self.body.split(',').map(str::trim).collect();
        let first = if self.extended { 2 } else { 0 };
        if fields.len() != first + 9 {
            return Err(LogProblem::FieldCount { got: fields.len(), expected: first + 9 });
        }
        let week = fields[first].parse().ok().filter(|week| (0..=MOST_WEEKS).contains(week));
        let week = week.ok_or_else(|| not_a_number("week", fields[first]))?;
        let mut counts = [0.0; 6];
        for (place, count) in counts.iter_mut().enumerate() {
            let text = fields[first + 3 + place];
            let number: i32 = text.parse().map_err(|_| not_a_number(COUNTS[place], text))?;
            *count = SIGNS[place] * f64::from(number);
        }
        Ok((counts, week, fields[first + 1]))
    }
}

fn not_a_number(column: &str, text: &str) -> LogProblem {
    LogProblem::NotANumber { column: column.into(), text: text.chars().take(40).collect() }
}

/// The CRC-32 of NovAtel logs: reflected, with initial value zero, and without final inversion.
fn checksum_of(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| {
            if sum & 1 == 1 { (sum >> 1) ^ 0xEDB8_8320 } else { sum >> 1 }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::{COUNTS, Message};

    /// The examples of the NovAtel manual.
    const EXAMPLES: [&str; 3] = [
        "%RAWIMUSA,2209,491612.254;2209,491612.253588,ea5afe00,329303960,-2512321,4410363,309705,607017,-1009773*1fb76c28",
        "%RAWIMUSXA,2209,491674.014;04,41,2209,491674.013699,ea59fe00,329308016,-2706935,4508389,196192,417138,-1000837*038422a7",
        "#RAWIMUXA,USB1,0,64.5,FINESTEERING,2209,491740.110,02000020,0dc5,16809;04,41,2209,491740.109817,ea57fe00,329394068,-2396829,4481425,321199,257329,-936077*cf9c035d",
    ];

    #[test]
    fn the_manual_s_examples_are_read() {
        for example in EXAMPLES {
            let message = Message::of(example).unwrap().unwrap();
            let (counts, week, seconds) = message.fields().unwrap();
            assert_eq!((week, &seconds[..3]), (2209, "491"));
            // The z axis of that receiver is up; y has the opposite sign in the log.
            let named = |name| counts[COUNTS.iter().position(|known| *known == name).unwrap()];
            assert!((329303960.0..329394069.0).contains(&named("accel_z")), "{example}");
            assert!((2396829.0..2706936.0).contains(&named("accel_y")), "{example}");
            assert!((-607017.0..=-257329.0).contains(&named("gyro_y")), "{example}");
            assert!((-1009773.0..=-936077.0).contains(&named("gyro_x")), "{example}");
        }
    }

    #[test]
    fn a_digit_that_has_changed_is_noticed() {
        for example in EXAMPLES {
            let changed = example.replacen("3293", "3294", 1);
            assert!(Message::of(&changed).is_err(), "{changed}");
        }
    }

    #[test]
    fn other_messages_are_passed_over() {
        assert!(Message::of("#BESTPOSA,COM1,0;SOL_COMPUTED*00000000").unwrap().is_none());
        assert!(Message::of("free text").unwrap().is_none());
    }
}
