//! File formats that are identified by their first bytes and are not columns of text.

/// A file format, for an error message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Container {
    /// Its name.
    pub(crate) name: &'static str,
    /// How to read or to convert such a file.
    pub(crate) remedy: &'static str,
}

/// The offset of a format's signature, the signature, and the format.
type Signature = (usize, &'static [u8], Container);

const fn signature(
    place: usize,
    bytes: &'static [u8],
    name: &'static str,
    remedy: &'static str,
) -> Signature {
    (place, bytes, Container { name, remedy })
}

/// The beginning of a Parquet file.
pub(super) const PARQUET: &[u8] = b"PAR1";

/// The beginning of a MATLAB level 5 file.
pub(super) const MATLAB: &[u8] = b"MATLAB 5.0 MAT-file";

const DECOMPRESS: &str = "decompress it";

/// The signatures in the specifications of the formats.
const SIGNATURES: &[Signature] = &[
    signature(0, b"ULog\x01\x12\x35", "a PX4 ULog file", "convert it with ulog2csv of pyulog"),
    signature(0, b"#ROSBAG V", "a ROS 1 bag", "export the IMU topic with rostopic echo -p"),
    signature(0, b"\x89MCAP0\r\n", "an MCAP file", "export the IMU topic as CSV"),
    signature(
        0,
        b"SQLite format 3\0",
        "an SQLite database, such as a ROS 2 bag",
        "export the IMU topic as CSV",
    ),
    signature(0, b"\x89HDF\r\n\x1a\n", "an HDF5 file", "export its datasets as CSV or Parquet"),
    signature(
        512,
        b"\x89HDF\r\n\x1a\n",
        "a MATLAB 7.3 file (HDF5)",
        "save it with -v7 and state format = \"mat\"",
    ),
    signature(0, MATLAB, "a MATLAB level 5 file", "state format = \"mat\""),
    signature(0, PARQUET, "a Parquet file", "state format = \"parquet\""),
    signature(0, b"ARROW1\0\0", "an Arrow (Feather) file", "save it as Parquet"),
    signature(0, b"\x93NUMPY", "a NumPy array", "save it with numpy.savetxt"),
    signature(
        0,
        b"\xa3\x95",
        "an ArduPilot DataFlash log",
        "convert it with mavlogdump.py --format csv --types IMU",
    ),
    signature(
        0,
        b"\xaa\x44\x12",
        "a binary NovAtel log",
        "convert it to ASCII with NovAtel Convert",
    ),
    signature(
        0,
        b"\xaa\x44\x13",
        "a binary NovAtel log",
        "convert it to ASCII with NovAtel Convert",
    ),
    signature(0, b"\xb5\x62", "a binary u-blox log", "export it as CSV"),
    signature(0, b"MDF     ", "an ASAM MDF file", "export it as CSV, for example with asammdf"),
    signature(0, b"TDSm", "an NI TDMS file", "export it as CSV, for example with npTDMS"),
    signature(
        0,
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
        "an Excel workbook of 1997 to 2003",
        "save it as CSV",
    ),
    signature(
        0,
        b"PK\x03\x04",
        "a ZIP archive or an Excel workbook (xlsx)",
        "save the workbook as CSV, or unpack the archive",
    ),
    signature(0, b"\x1f\x8b", "a gzip archive", DECOMPRESS),
    signature(0, b"BZh", "a bzip2 archive", DECOMPRESS),
    signature(0, b"\xfd7zXZ\0", "an xz archive", DECOMPRESS),
    signature(0, b"\x28\xb5\x2f\xfd", "a Zstandard archive", DECOMPRESS),
    signature(0, b"7z\xbc\xaf\x27\x1c", "a 7z archive", DECOMPRESS),
    signature(0, b"\xff\xfe", "UTF-16 text", "save it as UTF-8"),
    signature(0, b"\xfe\xff", "UTF-16 text", "save it as UTF-8"),
];

impl Container {
    /// The format of a file with these first bytes, if it is one of these formats.
    pub(crate) fn of(beginning: &[u8]) -> Option<Self> {
        let fits = |(place, bytes, _): &&Signature| {
            beginning.get(*place..).is_some_and(|rest| rest.starts_with(bytes))
        };
        // A MATLAB 7.3 file begins like one of level 5, except for the version.
        SIGNATURES.iter().find(fits).map(|(.., container)| *container)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_signature_is_recognised_as_itself() {
        for (place, bytes, container) in SIGNATURES {
            let mut file = vec![b' '; *place];
            file.extend(*bytes);
            file.resize(file.len() + 600, 0);
            assert_eq!(Container::of(&file), Some(*container));
            assert_eq!(Container::of(&file[..place + bytes.len() - 1]).map(|c| c.name), None);
        }
    }

    #[test]
    fn text_is_no_container() {
        for text in
            ["t,gx,gy,gz\n0,1,2,3\n", "# ROS\n1 2 3\n", "%RAWIMUSXA,1\n", "PK\n", "B,Z\n", ""]
        {
            assert_eq!(Container::of(text.as_bytes()), None, "{text}");
        }
    }
}
