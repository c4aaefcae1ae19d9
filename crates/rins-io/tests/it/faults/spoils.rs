//! Faults of files.

use super::readers::{Reader, Writing};

/// A fault, with the damaged file.
pub(super) type Spoilt = (&'static str, Vec<u8>);

/// All faults that a file of this kind can have.
pub(super) fn spoilt(reader: &Reader) -> Vec<Spoilt> {
    let mut all = vec![("empty", Vec::new()), ("blank", b"\n \n\n".to_vec())];
    match reader.writing {
        Writing::Text { row, between, number, time } => {
            let text = Lines::of(reader);
            all.extend(text.fields(row, between, number, time));
            all.extend(text.lines(row, between));
            all.extend(letters(&reader.good));
        }
        Writing::Binary { number } => all.extend(binary(reader, number)),
        Writing::Keys { value } => {
            all.extend(keys(&String::from_utf8(reader.good.clone()).unwrap(), value));
            all.extend(letters(&reader.good));
        }
    }
    all
}

/// Numbers that no sensor gives.
const NUMBERS: [(&str, &str); 9] = [
    ("a word", "error"),
    ("nothing", ""),
    ("two points", "1.2.3"),
    ("NaN", "nan"),
    ("infinity", "inf"),
    ("1e999", "1e999"),
    ("1e308", "1e308"),
    ("denormal", "5e-324"),
    ("40 digits", "0.0000000000000000000000000000000000000001"),
];

/// The lines of a text log.
struct Lines {
    lines: Vec<String>,
    seal: fn(String) -> String,
}

impl Lines {
    fn of(reader: &Reader) -> Self {
        let text = String::from_utf8(reader.good.clone()).unwrap();
        let seal = if reader.name == "novatel" { sealed } else { std::convert::identity };
        Self { lines: text.lines().map(str::to_owned).collect(), seal }
    }

    fn with(&self, row: usize, line: String) -> Vec<u8> {
        let mut lines = self.lines.clone();
        lines[row] = (self.seal)(line);
        (lines.join("\n") + "\n").into_bytes()
    }

    /// A row with another text in one of its fields.
    fn field(&self, row: usize, between: char, place: usize, text: &str) -> Vec<u8> {
        let line = &self.lines[row];
        // The text before the semicolon is the header of a message.
        let (head, body) = line.split_once(';').unwrap_or(("", line));
        let mut fields: Vec<&str> = body.split(between).collect();
        fields[place] = text;
        let body = fields.join(&between.to_string());
        let line = if head.is_empty() { body } else { format!("{head};{body}") };
        self.with(row, line)
    }

    fn fields(&self, row: usize, between: char, number: usize, time: Option<usize>) -> Vec<Spoilt> {
        let mut all: Vec<Spoilt> = NUMBERS
            .iter()
            .map(|(fault, text)| (*fault, self.field(row, between, number, text)))
            .collect();
        let Some(time) = time else { return all };
        let of_time = |text: &str| self.field(row, between, time, text);
        let stamp = |row: usize| {
            let body = self.lines[row].rsplit(';').next().unwrap_or_default();
            body.split(between).nth(time).unwrap().to_owned()
        };
        all.extend([
            ("time that is a word", of_time("noon")),
            ("time that is NaN", of_time("nan")),
            ("time of 1e308", of_time("1e308")),
            ("the time before", of_time(&stamp(row - 1))),
            ("an earlier time", of_time(&stamp(row - 2))),
        ]);
        all
    }

    fn lines(&self, row: usize, between: char) -> Vec<Spoilt> {
        let join = |lines: &[String]| (lines.join("\n") + "\n").into_bytes();
        let line = &self.lines[row];
        let mut twice = self.lines.clone();
        twice.insert(row, line.clone());
        let mut header_again = self.lines.clone();
        header_again.insert(row, self.lines[0].clone());
        let mut two_headers = self.lines.clone();
        two_headers.insert(1, self.lines[0].clone());
        let body = line.rsplit_once('*').map_or(line.as_str(), |(body, _)| body);
        let cut = body.rsplit_once(between).map_or(body, |(cut, _)| cut);
        let whole = join(&self.lines);
        vec![
            ("only the first line", join(&self.lines[..1])),
            ("a field too few", self.with(row, cut.to_owned())),
            ("a field too many", self.with(row, format!("{body}{between}7"))),
            ("a line twice", join(&twice)),
            ("the first line again", join(&header_again)),
            ("the first line twice", join(&two_headers)),
            ("without its last line's end", whole[..whole.len() - 1].to_vec()),
            ("cut in its last line", whole[..whole.len() - 4].to_vec()),
            ("a line of 2 MB", self.with(row, "1".repeat(2 << 20))),
            ("5000 columns", (format!("7{between}").repeat(5000) + "\n").repeat(3).into_bytes()),
        ]
    }
}

/// A NovAtel message with the checksum of its present content.
fn sealed(line: String) -> String {
    let text = line.rsplit_once('*').map_or(line.as_str(), |(text, _)| text);
    let Some(content) = text.strip_prefix(['%', '#']) else { return line };
    let sum = content.bytes().fold(0_u32, |sum, byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| {
            if sum & 1 == 1 { (sum >> 1) ^ 0xEDB8_8320 } else { sum >> 1 }
        })
    });
    format!("{text}*{sum:08x}")
}

/// The same characters in another encoding, or invalid characters.
fn letters(good: &[u8]) -> Vec<Spoilt> {
    let text = String::from_utf8(good.to_vec()).unwrap().replace("\r\n", "\n");
    let middle = text.len() / 2;
    let with = |byte: u8| {
        let mut bytes = text.clone().into_bytes();
        bytes[middle] = byte;
        bytes
    };
    let utf16 = |bytes: fn(u16) -> [u8; 2]| {
        let marked = format!("\u{feff}{text}");
        marked.encode_utf16().flat_map(bytes).collect::<Vec<u8>>()
    };
    vec![
        ("a byte that is not UTF-8", with(0xff)),
        ("a byte that is zero", with(0)),
        ("UTF-16", utf16(u16::to_le_bytes)),
        ("UTF-16 of the other byte order", utf16(u16::to_be_bytes)),
        ("a byte order mark", format!("\u{feff}{text}").into_bytes()),
        ("lines that end as in DOS", text.replace('\n', "\r\n").into_bytes()),
        ("lines that end as on an old Mac", text.replace('\n', "\r").into_bytes()),
    ]
}

fn binary(reader: &Reader, number: Option<usize>) -> Vec<Spoilt> {
    let good = &reader.good;
    let cut = |length: usize| good[..length].to_vec();
    let mut all = vec![
        ("a single byte", cut(1)),
        ("half of it", cut(good.len() / 2)),
        ("all but a byte", cut(good.len() - 1)),
        ("a byte too many", [good.as_slice(), &[0]].concat()),
        ("text", b"t,gx,gy,gz\n1,2,3,4\n".repeat(20)),
        ("zeros", vec![0; good.len()]),
    ];
    let mut swapped = good.clone();
    match reader.name {
        // The mark of the byte order.
        name if name.starts_with("mat") => swapped[124..128].reverse(),
        _ => swapped.chunks_mut(8).for_each(<[u8]>::reverse),
    }
    all.push(("the other byte order", swapped));
    let numbers =
        [("NaN", f64::NAN), ("infinity", f64::INFINITY), ("1e308", 1e308), ("denormal", 5e-324)];
    if let Some(place) = number {
        all.extend(numbers.map(|(fault, value)| {
            let mut bytes = good.clone();
            bytes[place..place + 8].copy_from_slice(&value.to_le_bytes());
            (fault, bytes)
        }));
    }
    all
}

fn keys(good: &str, value: &str) -> Vec<Spoilt> {
    let quoted = format!("\"{value}\"");
    let unit = value.split_once(' ').unwrap().1;
    let with = |text: &str| good.replacen(&quoted, text, 1).into_bytes();
    let mut all: Vec<Spoilt> =
        NUMBERS.iter().map(|(fault, text)| (*fault, with(&format!("\"{text} {unit}\"")))).collect();
    let first = good.lines().next().unwrap();
    let deep = |open: &str, close: &str| {
        with(&format!("{}{}", open.repeat(100_000), close.repeat(100_000)))
    };
    all.extend([
        ("a bare number", with("400")),
        ("a bare NaN", with("nan")),
        ("another unit", with("\"4 kg\"")),
        ("no unit", with("\"4\"")),
        ("no value", with("")),
        ("a text that does not end", with("\"400")),
        ("an unknown key", format!("{good}colour = \"red\"\n").into_bytes()),
        ("a section twice", format!("{good}{first}\n").into_bytes()),
        ("a million entries", with(&format!("[{}]", "1,".repeat(500_000)))),
        ("lists 100,000 deep", deep("[", "]")),
        ("tables 100,000 deep", deep("{a=", "}")),
        ("a name 100,000 deep", format!("{}x = 1\n{good}", "a.".repeat(100_000)).into_bytes()),
        ("2 MB", format!("# {}\n{good}", "x".repeat(2 << 20)).into_bytes()),
    ]);
    all
}
