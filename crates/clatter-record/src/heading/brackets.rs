//! Headings whose units stand in brackets.

use super::Heading;
use crate::factor;
use crate::unit::{Kind, Unit};

/// A text without the brackets around all of it.
pub(crate) fn unbracketed(text: &str) -> &str {
    let text = text.trim();
    let inner = [('[', ']'), ('(', ')')].into_iter().find_map(|(open, close)| {
        let whole = text.starts_with(open) && closing(text, close) == Some(text.len() - 1);
        whole.then(|| text[1..text.len() - 1].trim())
    });
    inner.unwrap_or(text)
}

/// A heading whose unit stands in brackets, with the factor that stands beside or in brackets of its own. What stands in brackets
/// and names no unit is part of the name; what has a part that is a unit, and is none as a whole, is a unit that is not known.
pub(super) fn bracketed(cell: &str) -> Option<Heading> {
    let (names, groups) = apart(cell)?;
    let unclear = |name: &str| Heading { spelled: Some(groups.join("; ")), ..Heading::named_alone(name) };
    let Ok(place) = place_of_unit(&groups) else {
        return Some(unclear(&names.concat().split_whitespace().collect::<Vec<_>>().join(" ")));
    };
    let unit = place.and_then(|place| Unit::of(groups[place]));
    let mut size = 1.0;
    let mut kept: Vec<String> = Vec::new();
    // A column that is divided by 9.81 was in m/s².
    let in_si = unit.is_some_and(|unit| unit.size.to_bits() == 1.0_f64.to_bits());
    let divided = place.map(|place| names[place + 1].trim()).filter(|beside| beside.starts_with('/') && !in_si);
    let mut refused = divided;
    for (i, name) in names.iter().enumerate() {
        let found = match place {
            Some(place) if place + 1 == i => factor::after(name),
            Some(place) if place == i => factor::before(name),
            _ => factor::Prefixed::name(name),
        };
        size *= found.factor;
        refused = refused.or(found.refused);
        kept.extend(found.name.split_whitespace().map(str::to_owned));
        if let Some(group) = groups.get(i).filter(|_| place != Some(i)) {
            match factor::in_brackets(group) {
                Some(factor) => size *= factor,
                None => kept.push(if group.chars().count() == 1 { (*group).to_owned() } else { format!("({group})") }),
            }
        }
    }
    let name = kept.join(" ");
    let is_one = size.to_bits() == 1.0_f64.to_bits();
    let Some(place) = place else {
        return Some(Heading { factor: size, ..Heading::named_alone(&name) });
    };
    let spelled = match refused {
        Some(beside) => format!("{} {beside}", groups[place]),
        None if is_one => groups[place].to_owned(),
        None => format!("{} × {size}", groups[place]),
    };
    let unit = unit.filter(|_| refused.is_none()).map(|unit| unit.times(size));
    Some(Heading { unit, spelled: Some(spelled), ..Heading::named_alone(&name) })
}

/// The texts between brackets, and those before, between and behind these; none where there are no brackets.
fn apart(cell: &str) -> Option<(Vec<String>, Vec<&str>)> {
    let (mut groups, mut names) = (Vec::new(), vec![String::new()]);
    let mut rest = cell;
    while let Some(open) = rest.find(['[', '(']) {
        let close = if rest[open..].starts_with('[') { ']' } else { ')' };
        let length = closing(&rest[open..], close)?;
        names.last_mut()?.push_str(&rest[..open]);
        let group = since_dropped(rest[open + 1..open + length].trim());
        // `accSmooth[0]` is a name; `(z)` may be an axis.
        if group.bytes().all(|c| c.is_ascii_digit()) {
            names.last_mut()?.push_str(&rest[open..=open + length]);
        } else {
            groups.push(group);
            names.push(String::new());
        }
        rest = &rest[open + length + 1..];
    }
    names.last_mut()?.push_str(rest);
    (!groups.is_empty()).then_some((names, groups))
}

/// The one of some texts in brackets that is a unit, if one is. One of several may be a unit and the others words, but no one can
/// tell for all, which is an error.
fn place_of_unit(groups: &[&str]) -> Result<Option<usize>, ()> {
    let (mut recorded, mut other, mut unknown) = (Vec::new(), Vec::new(), Vec::new());
    for (place, group) in groups.iter().enumerate() {
        match Unit::of(group) {
            Some(unit) if unit.kind.is_recorded() => recorded.push(place),
            Some(_) => other.push(place),
            None if factor::in_brackets(group).is_some() => {}
            None if is_like_unit(group) || factor::is_operation(group) => unknown.push(place),
            None => {}
        }
    }
    // A letter beside a unit is the name of an axis or a place.
    let is_letter = |place: &usize| groups[*place].chars().count() == 1;
    match (&recorded[..], &other[..], &unknown[..]) {
        ([unit], others, []) if others.iter().all(is_letter) => Ok(Some(*unit)),
        ([], [unit], []) | ([], [], [unit]) => Ok(Some(*unit)),
        ([], [], []) => Ok(None),
        _ => Err(()),
    }
}

/// A unit of time without what it counts from: `s since trigger`.
fn since_dropped(group: &str) -> &str {
    let end = [" since ", " after ", " from ", " relative "].iter().find_map(|word| group.find(word));
    end.map(|end| &group[..end]).filter(|unit| Unit::of_kind(unit, Kind::Time).is_some()).unwrap_or(group)
}

/// Returns whether a text that is no unit has a part that is one: `500g`, `g rms`, `deka g`, `m/s2/Hz`, and not `raw` or `CFC 1000`.
fn is_like_unit(group: &str) -> bool {
    let parts = group.split(|c: char| c.is_whitespace() || matches!(c, '/' | '*' | '·' | ',' | ';' | '^' | '²'));
    parts.map(|part| part.trim_start_matches(|c: char| c.is_ascii_digit() || matches!(c, '.' | '±' | '+' | '-'))).any(
        |part| {
            let telling = |unit: Unit| unit.kind.is_recorded() || part.chars().count() > 1;
            Unit::of(part).is_some_and(telling)
        },
    )
}

/// Bytes up to the bracket that closes the one a text begins with.
fn closing(text: &str, close: char) -> Option<usize> {
    let open = text.chars().next()?;
    let mut depth = 0_usize;
    for (at, c) in text.char_indices() {
        depth += usize::from(c == open);
        if c == close {
            depth -= 1;
            if depth == 0 {
                return Some(at);
            }
        }
    }
    None
}
