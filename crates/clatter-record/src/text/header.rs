//! What the lines above the numbers tell of all of them, a key and its value each: it is used, or held against the numbers.

use super::cells::Form;
use super::layout::uncommented;
use crate::unit::{Kind, Unit};

/// What the lines above the numbers tell; each with its line, from 1, where a message names it.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Header {
    /// How many samples there are.
    pub(super) samples: Option<(usize, usize)>,
    /// Time of the first sample, in seconds.
    pub(super) start_s: Option<(f64, usize)>,
    /// The number that stands for none.
    pub(super) fill: Option<f64>,
    /// Names of channels, or of all columns.
    pub(super) names: Vec<String>,
    /// Their units, by a list of as many.
    pub(super) units: Vec<String>,
    /// The unit of acceleration that is told for all.
    pub(super) unit: Option<(String, usize)>,
    /// The slope and the offset of a calibration, for numbers without a unit of their own, and the line.
    pub(super) slope: Option<([f64; 2], usize)>,
    /// Lines that tell a factor or an offset, of which nobody knows whether the numbers have it.
    pub(super) scales: Vec<(String, usize)>,
}

const SAMPLES: &str = "\
    number of samples, total samples, samples, sample count, no of samples, n samples, ndata, npts, number of points, \
    points, data points, #pts, rows, record length, anzahl, anzahl werte, anzahl messwerte, anzahl samples, nombre de points, \
    número de puntos, データ数";
const STARTS: &str = "time of first sample, x-axis offset, start time, t0, first sample time";
const FILLS: &str = "fill value, fillvalue, missing value, no data, nodata, nodata value, missing data, nan value";
const NAMES: &str = "\
    channeltitle, channel title, channel titles, name of the channel, channel name, channel names, signal, signals";
const UNITS: &str =
    "unit, units, unité, unidad, unità, 単位, unitname, unit name, einheit, acceleration unit, amplitude unit";
/// What keys have in them that tell a factor, an offset, or that samples were left out.
const SCALES: &str = "\
    slope, scale, scaling, skalier, factor, faktor, facteur, fattore, multipl, gain, verstärkung, amplif, sensitivity, calib, \
    kalib, cal factor, umrechnung, conversion, coeff, steigung, exponent, decimals, prescale, ymult, yscale, preamp, offset, \
    intercept, divide, maßstab, normalized, power of ten, times 1, werte mal, decimation, downsampl, untersetzung, thinning, reduction, save every, 倍率, 係数, 系数, 比例";

/// The key of a line and what stands behind it.
fn key_and_value(line: &str) -> Option<(String, &str)> {
    let (text, _) = uncommented(line);
    let text = text.trim_start_matches([';', '*', '"', ' ']);
    let (key, value) = text.split_once([':', '=', '\t', ',', ';'])?;
    let key = key.trim().trim_matches('"').replace('_', " ").to_lowercase();
    Some((key, value.trim_start_matches([':', '=', '\t', ',', ';', ' ']).trim_end()))
}

/// Returns the number that a word is, with a sign of a product before it, and with a comma for its point; none where three digits stand
/// behind that, which may be a group.
fn number(word: &str) -> Option<f64> {
    let word = word.trim_start_matches(['x', '×', '*']);
    let grouped = word.split_once(',').is_some_and(|(_, behind)| behind.len() == 3);
    if grouped { None } else { word.replace(',', ".").parse().ok() }
}

/// Of lines above numbers.
pub(super) fn of(lines: &[String], form: Form) -> Header {
    let (mut header, mut offset) = (Header::default(), 0.0);
    for (i, line) in lines.iter().enumerate() {
        // A sentence tells a factor as well: `all values times 100`.
        let sentence = || (uncommented(line).0.to_lowercase(), uncommented(line).0);
        let (key, value) = key_and_value(line).unwrap_or_else(sentence);
        let is = |keys: &str| keys.split(", ").any(|other| other == key);
        let number = || value.split(|c: char| c.is_whitespace() || matches!(c, ';' | '"')).find_map(number);
        let listed = || -> Vec<String> {
            let separator = form.separator.map_or('\t', char::from);
            let cells = value.split(separator).map(|cell| cell.trim().trim_matches('"').to_owned());
            cells.filter(|cell| !cell.is_empty()).collect()
        };
        if is(SAMPLES) {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "it is whole and in this range"
            )]
            let count = number().filter(|n| n.fract() == 0.0 && (1.0..1e12).contains(n)).map(|n| n as usize);
            header.samples = header.samples.or_else(|| Some((count?, i + 1)));
        } else if is(STARTS) {
            let seconds = value.trim_end_matches('s').trim_end().parse().ok();
            header.start_s = header.start_s.or_else(|| Some((seconds?, i + 1)));
        } else if is(FILLS) {
            header.fill = header.fill.or_else(&number);
        } else if is(NAMES) && header.names.is_empty() {
            header.names = listed();
        } else if is(UNITS) {
            let all = listed();
            let of = |unit: &String| Unit::of_kind(unit, Kind::Acceleration);
            if let [unit, ..] = &all[..]
                && of(unit).is_some()
                && header.unit.is_none()
            {
                header.unit = all.iter().all(|other| of(other) == of(unit)).then(|| (unit.clone(), i + 1));
                header.units = all;
            }
        } else if SCALES.split(", ").any(|part| key.contains(part))
            && !["horizontal", "time", "plot"].iter().any(|other| key.contains(other) && !key.contains("times"))
            && let Some(value) = number()
        {
            match &key[..] {
                "slope" => header.slope = header.slope.or(Some(([value, 0.0], i + 1))),
                "offset" => offset = value,
                _ => {}
            }
            let is_offset = key.ends_with("offset") || key == "intercept";
            if value.to_bits() != (if is_offset { 0.0_f64 } else { 1.0 }).to_bits() {
                header.scales.push((uncommented(line).0.trim_end().to_owned(), i + 1));
            }
        }
    }
    header.slope = header.slope.map(|([slope, _], line)| ([slope, offset], line));
    header
}

impl Header {
    /// Returns what does not go with the numbers that are read: so many rows, times from a first one on, and channels in these units of
    /// their own.
    pub(super) fn against(&self, rows: usize, start_s: Option<f64>, own: &[(String, String)]) -> Vec<String> {
        let mut found = Vec::new();
        if let Some((samples, line)) = self.samples.filter(|(samples, _)| *samples != rows) {
            found.push(format!("line {line} tells of {samples} samples, and there are {rows}"));
        }
        if let Some(((told_s, line), start_s)) =
            self.start_s.zip(start_s).filter(|((a, _), b)| (a - b).abs() > 1e-6 * a.abs())
        {
            found.push(format!("line {line} tells of a first sample at {told_s} s, and its time is {start_s} s"));
        }
        if let Some((unit, line)) = &self.unit {
            let differs = |(_, spelled): &&(String, String)| {
                let kind = Kind::Acceleration;
                Unit::of_kind(spelled, kind).zip(Unit::of_kind(unit, kind)).is_some_and(|(a, b)| a != b)
            };
            if let Some((name, spelled)) = own.iter().find(differs) {
                found.push(format!("{name} is in {spelled} by its heading, and in {unit} by line {line}"));
            }
        }
        if self.slope.is_none() {
            let told = |(text, line): &(String, usize)| {
                format!("line {line} tells '{}', and the numbers are taken as they are", super::visible(text))
            };
            found.extend(self.scales.iter().map(told));
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_in_any_language_and_in_sentences() {
        let scales = |line: &str| of(&[line.to_owned()], Form::default()).scales.len();
        for line in [
            "Skalierungsfaktor: 0,01",
            "Facteur: 0,01",
            "Amplifier gain x100",
            "Divide by 100 to get g",
            "倍率: 100",
            "Decimation=2",
        ] {
            assert_eq!(scales(line), 1, "{line}");
        }
        for line in ["Gain: 1", "Offset = 0", "Scale: 1,000", "Horizontal Scale,0.004", "Factor: none", "Range: 100 g"]
        {
            assert_eq!(scales(line), 0, "{line}");
        }
    }

    #[test]
    fn lines_of_a_key_and_a_value() {
        let lines = "# Total Samples: 600\nTime of first sample :-0.002\nChannelTitle=\tDeck\tRim\nUnitName=\tg\tg\nSlope,0.01\nOffset,0\nGain: 1\nStart time: 10:11:12\nFill value: -999"
            .split('\n')
            .map(str::to_owned)
            .collect::<Vec<_>>();
        let header = of(&lines, Form::new(Some(b'\t'), b'.'));
        let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let right = Header {
            samples: Some((600, 1)),
            start_s: Some((-0.002, 2)),
            fill: Some(-999.0),
            names: names(&["Deck", "Rim"]),
            units: names(&["g", "g"]),
            unit: Some(("g".to_owned(), 4)),
            slope: Some(([0.01, 0.0], 5)),
            scales: vec![("Slope,0.01".to_owned(), 5)],
        };
        assert_eq!(header, right);
    }
}
