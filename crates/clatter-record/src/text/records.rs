//! One of several records of a text, each below its own heading.

use super::head;
use crate::Error;

/// So many lines of numbers make a record.
const LEAST: usize = 2;

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

/// The lines of each record: from its heading to the heading of the next.
fn parts(lines: &[&[u8]]) -> Vec<(usize, usize)> {
    let (mut begins, mut numbers, mut text) = (vec![0], 0, None);
    for (i, line) in lines.iter().enumerate() {
        if is_numbers(line) {
            numbers += 1;
            if let Some(begin) = text.take().filter(|_| numbers > LEAST) {
                begins.push(begin);
                numbers = 1;
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
