//! Kinds of files are told by their first bytes.

use super::mat::level4::is_level4;
use super::refuse;
use crate::Error;
use std::fmt;

/// A kind of file that is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Kind {
    /// Text: columns with separators, and whatever is nothing else.
    Text,
    /// An array of NumPy.
    Npy,
    /// Sound: RIFF WAVE, RF64 too.
    Wav,
    /// Variables of MATLAB as its versions 5 to 7.2 write them.
    Mat5,
    /// Variables of MATLAB 4.
    Mat4,
    /// HDF5, which MATLAB 7.3 writes too.
    Hdf5,
    /// Channels of National Instruments.
    Tdms,
    /// Universal file with data set 58 or 58b.
    Uff,
    /// Apache Parquet.
    Parquet,
    /// Apache Arrow, as a file or a stream; Feather version 2 too.
    Arrow,
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Text => "text",
            Self::Npy => "NPY file",
            Self::Wav => "WAV file",
            Self::Mat5 | Self::Mat4 => "MAT file",
            Self::Hdf5 => "HDF5 file",
            Self::Tdms => "TDMS file",
            Self::Uff => "universal file",
            Self::Parquet => "Parquet file",
            Self::Arrow => "Arrow file",
        })
    }
}

/// Kinds with a place and bytes of their own there; a question mark stands for any byte.
const READ: [(usize, &[u8], Kind); 13] = [
    (0, b"\x93NUMPY", Kind::Npy),
    (0, b"RIFF????WAVE", Kind::Wav),
    (0, b"RIFX????WAVE", Kind::Wav),
    (0, b"RF64????WAVE", Kind::Wav),
    (0, b"BW64????WAVE", Kind::Wav),
    (0, b"\x89HDF\r\n\x1a\n", Kind::Hdf5),
    (512, b"\x89HDF\r\n\x1a\n", Kind::Hdf5),
    (124, b"\x00\x01IM", Kind::Mat5),
    (124, b"\x01\x00MI", Kind::Mat5),
    (0, b"TDSm", Kind::Tdms),
    (0, b"PAR1", Kind::Parquet),
    (0, b"ARROW1", Kind::Arrow),
    (0, b"\xff\xff\xff\xff", Kind::Arrow),
];

const UNPACK: &str = "unpack it first";
const NO_RECORD: &str = "a record is numbers: save them as CSV";
const SHEET: &str = "save it as CSV";

/// Kinds that are not read: place, bytes, what it is, what to do.
const REFUSED: [(usize, &[u8], &str, &str); 39] = [
    (0, b"PK\x03\x04", "a spreadsheet, an NPZ or another ZIP file", "save a spreadsheet as CSV, unpack what is packed"),
    (0, b"PK\x05\x06", "an empty ZIP file", NO_RECORD),
    (0, b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "an old Excel or other OLE file", SHEET),
    (0, b"\x1a\x45\xdf\xa3", "an IDE file of an enDAQ or Mide logger", "export it as CSV with enDAQ Lab"),
    (0, b"\x1f\x8b", "a gzip file", UNPACK),
    (0, b"\x28\xb5\x2f\xfd", "a Zstandard file", UNPACK),
    (0, b"\xfd7zXZ\x00", "an xz file", UNPACK),
    (0, b"BZh", "a bzip2 file", UNPACK),
    (0, b"7z\xbc\xaf\x27\x1c", "a 7-Zip file", UNPACK),
    (0, b"Rar!\x1a\x07", "a RAR file", UNPACK),
    (0, b"\x04\x22\x4d\x18", "an LZ4 file", UNPACK),
    (257, b"ustar", "a tar file", UNPACK),
    (0, b"%PDF", "a PDF", NO_RECORD),
    (0, b"\x89PNG", "an image (PNG)", NO_RECORD),
    (0, b"\xff\xd8\xff", "an image (JPEG)", NO_RECORD),
    (0, b"GIF8", "an image (GIF)", NO_RECORD),
    (0, b"II*\x00", "an image (TIFF)", NO_RECORD),
    (0, b"MM\x00*", "an image (TIFF)", NO_RECORD),
    (0, b"RIFF????WEBP", "an image (WebP)", NO_RECORD),
    (0, b"\x00\x00\x00?ftyp", "a video", "take the heights from it, and save them as CSV"),
    (0, b"RIFF????AVI ", "a video (AVI)", "take the heights from it, and save them as CSV"),
    (0, b"ID3\x03", "an MP3 file", "save the sound as WAV"),
    (0, b"ID3\x04", "an MP3 file", "save the sound as WAV"),
    (0, b"fLaC", "a FLAC file", "save the sound as WAV"),
    (0, b"OggS", "an Ogg file", "save the sound as WAV"),
    (0, b"FORM????AIFF", "an AIFF file", "save the sound as WAV"),
    (0, b"SQLite format 3\x00", "an SQLite database", "export the table as CSV"),
    (0, b"TDSh", "the index of a TDMS file", "give the .tdms file that stands beside it"),
    (0, b"DIAEXTENDED", "a header of DIAdem DAT data", "save the channels as TDMS or CSV with DIAdem"),
    (0, b"MDF     ", "an MDF file (MF4, DAT)", "export the channels as CSV, for example with asammdf"),
    (0, b"UnFinMF ", "an MDF file that was not finished", "export the channels as CSV, for example with asammdf"),
    (0, b"|CF,", "an imc FAMOS file", "export it as CSV with FAMOS"),
    (0, b"CDF\x01", "a NetCDF file of version 3", "save it as NetCDF 4, HDF5 or CSV"),
    (0, b"CDF\x02", "a NetCDF file of version 3", "save it as NetCDF 4, HDF5 or CSV"),
    (0, b"FEA1", "a Feather file of version 1", "save it as Parquet or Feather of version 2"),
    (0, b"Obj\x01", "an Avro file", SHEET),
    (0, b"\xffBIOSEMI", "a BDF file of BioSemi", "export the channels as CSV"),
    (0, b"\xc3\x40\xf1", "a SEG-Y file", "export the traces as CSV"),
    (0, b"MS\x03", "a miniSEED file", WITH_OBSPY),
];

const WITH_OBSPY: &str = "export the channel as CSV, for example with ObsPy";

impl Kind {
    /// Bytes from the beginning of a file that suffice to know what it is.
    pub const BEGINNING: usize = 1024;

    /// By the first [`Self::BEGINNING`] bytes of a file, or all of it.
    ///
    /// # Errors
    /// [`Error::File`] for a kind that is known but not read: it names the kind and says what to do.
    ///
    /// # Examples
    /// ```
    /// use clatter_record::Kind;
    /// assert_eq!(Kind::of(b"time [s],a [g]\n0,0\n")?, Kind::Text);
    /// let refused = Kind::of(b"PK\x03\x04\x14\x00").unwrap_err();
    /// assert!(refused.to_string().contains("save a spreadsheet as CSV"));
    /// # Ok::<(), clatter_record::Error>(())
    /// ```
    pub fn of(beginning: &[u8]) -> Result<Self, Error> {
        let has = |at: usize, magic: &[u8]| {
            let bytes = beginning.get(at..).and_then(|bytes| bytes.get(..magic.len()));
            bytes.is_some_and(|bytes| bytes.iter().zip(magic).all(|(byte, magic)| *magic == b'?' || byte == magic))
        };
        if let Some((.., kind)) = READ.iter().find(|(at, magic, _)| has(*at, magic)) {
            return Ok(*kind);
        }
        if let Some((_, _, what, advice)) = REFUSED.iter().find(|(at, magic, ..)| has(*at, magic)) {
            return Err(refuse(format!("this is {what}: {advice}")));
        }
        if is_universal(beginning) {
            return Ok(Self::Uff);
        }
        if is_level4(beginning) {
            return Ok(Self::Mat4);
        }
        if let Some((what, advice)) = refused_text(beginning).or_else(|| refused_binary(beginning)) {
            return Err(refuse(format!("this is {what}: {advice}")));
        }
        Ok(Self::Text)
    }
}

/// A line of `    -1`, then one that begins with the number of a data set in its first six places.
fn is_universal(beginning: &[u8]) -> bool {
    let mut lines = beginning.split(|byte| *byte == b'\n').filter(|line| !line.trim_ascii().is_empty());
    let begins = lines.next().is_some_and(|line| line.trim_ascii_end() == b"    -1");
    begins
        && lines.next().and_then(|line| line.get(..6)).is_some_and(|set| {
            let digits = set.trim_ascii();
            !digits.is_empty() && digits.iter().all(u8::is_ascii_digit)
        })
}

/// Kinds that are text, and yet no columns.
fn refused_text(beginning: &[u8]) -> Option<(&'static str, &'static str)> {
    let text = beginning.strip_prefix(b"\xef\xbb\xbf").unwrap_or(beginning).trim_ascii_start();
    let holds = |word: &[u8]| text.windows(word.len()).any(|window| window == word);
    if text.starts_with(b"<") {
        return Some(if holds(b"<usi:tdm") {
            ("the header of an NI TDM file", "save the channels as TDMS or CSV with DIAdem or LabVIEW")
        } else if holds(b"<html") || holds(b"<HTML") || holds(b"<!DOCTYPE") {
            ("a web page", NO_RECORD)
        } else {
            ("an XML file", "export the numbers as CSV")
        });
    }
    let second = text.get(1..).unwrap_or_default().trim_ascii_start().first();
    let json = match text.first() {
        Some(b'{') => matches!(second, Some(b'"' | b'}')),
        // `[s], [g]` may be a line of units.
        Some(b'[') => matches!(second, Some(b'{' | b'[' | b']' | b'"' | b'-' | b'0'..=b'9')),
        _ => false,
    };
    json.then_some(("a JSON file", "save the numbers as CSV"))
}

/// Kinds whose first bytes are few, or lie in several places.
fn refused_binary(beginning: &[u8]) -> Option<(&'static str, &'static str)> {
    // Protocols 2 to 5: the opcode PROTO, its number, and from 4 on the opcode FRAME.
    if matches!(beginning, [0x80, 2 | 3, ..] | [0x80, 4 | 5, 0x95, ..]) {
        return Some(("a pickle of Python", "save the array with numpy.save or as CSV"));
    }
    // The block of the parameters, and the key of the format.
    if matches!(beginning, [2..=8, 0x50, ..]) {
        return Some(("a C3D file", "export the analog channels as CSV"));
    }
    // A number of six digits, the quality and a blank; then the names of the station and the network.
    if let Some((number, [b'D' | b'R' | b'Q' | b'M' | b'V' | b'A' | b'S' | b'T', b' ' | 0, names @ ..])) =
        beginning.split_at_checked(6)
        && number.iter().all(u8::is_ascii_digit)
        && names.get(..12).is_some_and(|names| names.iter().all(|c| c.is_ascii_alphanumeric() || *c == b' '))
    {
        return Some(("a SEED or miniSEED file", WITH_OBSPY));
    }
    // Version 0, texts of 80 letters for patient and record, then date and time with points.
    let points = [170, 173, 178, 181].iter().all(|at| beginning.get(*at) == Some(&b'.'));
    if points && beginning.starts_with(b"0       ") && !beginning[..181].contains(&b'\n') {
        return Some(("an EDF file", "export the channels as CSV, for example with EDFbrowser"));
    }
    // Floats of four bytes, of which those that no one uses are -12345.
    let unused = beginning.get(4 * 63..4 * 70).map(|words| words.as_chunks::<4>().0);
    let untold = |word: &[u8; 4]| [f32::from_le_bytes(*word), f32::from_be_bytes(*word)].contains(&-12345.0);
    unused.is_some_and(|words| words.iter().all(untold)).then_some(("a SAC file", WITH_OBSPY))
}
