//! One of several records of a text, each below its own heading.

use super::head;
use crate::Error;

/// So many lines of numbers make a record,
const LEAST: usize = 2;
/// and so many whose first numbers rise make sure that these are times.
const SURE: usize = 8;

/// The number that a line begins with.
fn first_number(line: &[u8]) -> Option<f64> {
    let (number, _) = crate::decimal::Decimal::scan(line.trim_ascii_start(), b'.')?;
    Some(number.float())
}

/// The text of one record, from 1: all other lines empty, but for the heading of the first, whose names and units count where a
/// record has none of its own. And how many lines were not empty before.
pub(super) fn only(text: &[u8], number: usize) -> Result<(Vec<u8>, usize), Error> {
    let lines: Vec<&[u8]> = text.split(|byte| *byte == b'\n').collect();
    let records = parts(&lines);
    let Some((begin, end)) = number.checked_sub(1).and_then(|part| records.get(part)) else {
        return Err(Error::no_record(number, records.len()));
    };
    let heading = lines.iter().take_while(|line| !is_numbers(line)).count();
    let (mut kept, mut hidden) = (Vec::with_capacity(text.len()), 0);
    for (i, line) in lines.iter().enumerate() {
        if (*begin..*end).contains(&i) || i < heading {
            kept.extend_from_slice(line);
        } else if !line.trim_ascii().is_empty() {
            hidden += 1;
        }
        if i + 1 < lines.len() {
            kept.push(b'\n');
        }
    }
    Ok((kept, hidden))
}

/// The lines of each record: from its heading to the heading of the next, or to where its times begin again.
fn parts(lines: &[&[u8]]) -> Vec<(usize, usize)> {
    let (mut begins, mut numbers, mut text) = (vec![0], 0, None);
    // The first number of the record and of the line before, as long as they rise.
    let mut rising: Option<(f64, f64)> = None;
    for (i, line) in lines.iter().enumerate() {
        if is_numbers(line) {
            let first = first_number(line);
            numbers += 1;
            if let (Some((begin, last)), Some(first)) = (rising, first)
                && first.to_bits() == begin.to_bits()
                && last > begin
                && numbers > SURE
                && text.is_none()
            {
                begins.push(i);
                numbers = 1;
            }
            rising = match (rising.filter(|_| numbers > 1), first) {
                (None, Some(first)) if numbers == 1 => Some((first, first)),
                (Some((begin, last)), Some(first)) if first > last => Some((begin, first)),
                _ => None,
            };
            if let Some(begin) = text.take().filter(|_| numbers > LEAST) {
                begins.push(begin);
                numbers = 1;
                rising = first_number(line).map(|first| (first, first));
            }
        } else if !line.trim_ascii().is_empty() && text.is_none() && numbers >= LEAST {
            text = Some(i);
        }
    }
    let ends = begins.iter().skip(1).copied().chain([lines.len()]).collect::<Vec<_>>();
    begins.into_iter().zip(ends).collect()
}

/// Returns whether a line is one of numbers: digits are most of it, or it is nothing else.
fn is_numbers(line: &[u8]) -> bool {
    let text = String::from_utf8_lossy(line);
    let text = text.trim();
    let digits = text.bytes().filter(u8::is_ascii_digit).count();
    let letters = text.chars().filter(|c| c.is_alphabetic()).count();
    let begins = text.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '-' | '+' | '.' | '"' | '\''));
    head::numbers(text) > 0 || begins && digits > 2 * letters
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_that_begin_again_are_another_record() {
        let times = || (0..10).map(|k| format!("{}.5,{k}\n", k - 3));
        let text = format!("Segments,2\nt,a\n{}{}", times().collect::<String>(), times().collect::<String>());
        let lines: Vec<&[u8]> = text.as_bytes().split(|byte| *byte == b'\n').collect();
        assert_eq!(parts(&lines), [(0, 12), (12, 23)]);
    }

    #[test]
    fn each_record_below_its_heading() {
        let text = b"t,a\n0,1\n1,2\n\nt,a\n0,3\n1,4\nend\n";
        let of =
            |number| only(text, number).map(|(text, hidden)| (String::from_utf8_lossy(&text).into_owned(), hidden));
        assert_eq!(of(1), Ok(("t,a\n0,1\n1,2\n\n\n\n\n\n".to_owned(), 4)));
        assert_eq!(of(2), Ok(("t,a\n\n\n\nt,a\n0,3\n1,4\nend\n".to_owned(), 2)));
        assert_eq!(of(3).expect_err("two").to_string(), "there is no record 3 in the file: there are 2 records");
        assert!(of(0).is_err());
    }
}
