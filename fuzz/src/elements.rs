//! MATLAB level 5 files, whose elements are what they say but for what the fuzzer makes wrong.

use std::io::Write as _;

use arbitrary::Arbitrary;
use flate2::Compression;
use flate2::write::ZlibEncoder;

/// A file.
#[derive(Arbitrary, Debug)]
pub struct File {
    big: bool,
    variables: Vec<Variable>,
    end: u8,
}

#[derive(Arbitrary, Debug)]
struct Variable {
    packed: bool,
    array: Array,
}

#[derive(Arbitrary, Debug)]
enum Array {
    Matrix(Matrix),
    Structure { name: u8, width: u8, fields: Vec<(u8, Matrix)> },
    Raw { kind: u8, bytes: Vec<u8> },
}

#[derive(Arbitrary, Debug)]
struct Matrix {
    name: u8,
    class: Option<u8>,
    complex: bool,
    rows: u8,
    columns: u8,
    sizes: Option<(u32, u32)>,
    kind: u8,
    length: Option<u32>,
    numbers: Vec<i16>,
}

const NAMES: [&str; 6] = ["imu", "t", "gyro", "accel", "s", ""];

/// How many bytes a number of each kind has.
const KINDS: [(u32, usize); 9] =
    [(9, 8), (1, 1), (2, 1), (3, 2), (4, 2), (5, 4), (6, 4), (7, 4), (12, 8)];

impl File {
    /// Its bytes.
    pub fn bytes(&self) -> Vec<u8> {
        let mut out = Out { big: self.big, bytes: vec![b' '; 124] };
        out.bytes.extend(if self.big { *b"\x01\0MI" } else { *b"\0\x01IM" });
        for variable in &self.variables {
            let mut inner = Out { big: self.big, bytes: Vec::new() };
            variable.array.write(&mut inner);
            if variable.packed {
                let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
                encoder.write_all(&inner.bytes).expect("memory takes it");
                out.element(15, &encoder.finish().expect("memory takes it"), false);
            } else {
                out.bytes.extend(inner.bytes);
            }
        }
        out.bytes.truncate(out.bytes.len() - usize::from(self.end / 16).min(out.bytes.len()));
        out.bytes
    }
}

impl Array {
    fn write(&self, out: &mut Out) {
        match self {
            Self::Matrix(matrix) => matrix.write(out, true),
            Self::Structure { name, width, fields } => {
                let mut inner = Out { big: out.big, bytes: Vec::new() };
                inner.head(2, false, (1, 1), NAMES[usize::from(*name) % NAMES.len()]);
                let width = usize::from(*width % 33);
                inner.word_element(5, &[width as u32]);
                let mut names = Vec::new();
                for (name, _) in fields {
                    let mut field = NAMES[usize::from(*name) % NAMES.len()].as_bytes().to_vec();
                    field.resize(width, 0);
                    names.extend(field);
                }
                inner.element(1, &names, true);
                fields.iter().for_each(|(_, matrix)| matrix.write(&mut inner, false));
                out.element(14, &inner.bytes, false);
            }
            Self::Raw { kind, bytes } => out.element(u32::from(*kind), bytes, true),
        }
    }
}

impl Matrix {
    fn write(&self, out: &mut Out, named: bool) {
        let mut inner = Out { big: out.big, bytes: Vec::new() };
        let (rows, columns) = (u32::from(self.rows % 40), u32::from(self.columns % 9));
        let name = if named { NAMES[usize::from(self.name) % NAMES.len()] } else { "" };
        let sizes = self.sizes.unwrap_or((rows, columns));
        inner.head(self.class.unwrap_or(6), self.complex, sizes, name);
        let (kind, size) = KINDS[usize::from(self.kind) % KINDS.len()];
        let mut data = Vec::new();
        for place in 0..(rows * columns) as usize {
            // Most files have numbers that rise, as time does.
            let number = self.numbers.get(place).copied().unwrap_or(place as i16);
            let bits = match kind {
                9 => (f64::from(number) * 0.01).to_bits(),
                7 => u64::from((f32::from(number) * 0.01).to_bits()),
                _ => number as u64,
            };
            let bytes = bits.to_le_bytes();
            if out.big {
                data.extend(bytes[..size].iter().rev());
            } else {
                data.extend(&bytes[..size]);
            }
        }
        inner.tag(kind, self.length.unwrap_or(data.len() as u32));
        inner.bytes.extend(&data);
        inner.pad();
        out.element(14, &inner.bytes, false);
    }
}

struct Out {
    big: bool,
    bytes: Vec<u8>,
}

impl Out {
    fn word(&mut self, word: u32) {
        self.bytes.extend(if self.big { word.to_be_bytes() } else { word.to_le_bytes() });
    }

    fn tag(&mut self, kind: u32, length: u32) {
        self.word(kind);
        self.word(length);
    }

    fn pad(&mut self) {
        self.bytes.resize(self.bytes.len().next_multiple_of(8), 0);
    }

    fn element(&mut self, kind: u32, bytes: &[u8], padded: bool) {
        self.tag(kind, bytes.len() as u32);
        self.bytes.extend(bytes);
        if padded {
            self.pad();
        }
    }

    fn word_element(&mut self, kind: u32, words: &[u32]) {
        self.tag(kind, 4 * words.len() as u32);
        words.iter().for_each(|word| self.word(*word));
        self.pad();
    }

    fn head(&mut self, class: u8, complex: bool, (rows, columns): (u32, u32), name: &str) {
        self.word_element(6, &[u32::from(class) | if complex { 0x800 } else { 0 }, 0]);
        self.word_element(5, &[rows, columns]);
        self.element(1, name.as_bytes(), true);
    }
}
