//! This module reads the arguments of a call of Python by their names, as `locals()` has them.
//!
//! A function of Python states its arguments once, in its signature, and hands on `locals()`. An argument that is not read here is an
//! error.

use std::ops::RangeInclusive;
use std::path::PathBuf;

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyBytes, PyDict, PyFloat, PyFrozenSet, PyInt, PyMapping, PySet, PyString};

use crate::refused;
use crate::single::LISTED;

/// The arguments of a call.
pub(crate) struct Given<'py> {
    values: Bound<'py, PyDict>,
    unread: Bound<'py, PyDict>,
}

impl<'py> FromPyObject<'_, 'py> for Given<'py> {
    type Error = PyErr;
    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let values = PyDict::new(given.py());
        values.update(&*given.cast::<PyMapping>()?)?;
        let given = Self { unread: values.copy()?, values };
        given.leave(&["self", "cls"])?;
        Ok(given)
    }
}

impl<'py> Given<'py> {
    /// Returns the argument as Python has it; None where there is none of this name.
    pub(crate) fn value(&self, name: &str) -> PyResult<Bound<'py, PyAny>> {
        self.leave(&[name])?;
        Ok(self.values.get_item(name)?.unwrap_or_else(|| self.values.py().None().into_bound(self.values.py())))
    }
    pub(crate) fn read<T: Value>(&self, name: &str) -> PyResult<T> {
        T::read(name, &self.value(name)?)
    }
    pub(crate) fn whole<T: TryFrom<u64>>(&self, name: &str, within: RangeInclusive<u64>) -> PyResult<T> {
        whole(name, &self.value(name)?, within)
    }
    pub(crate) fn whole_if_given<T: TryFrom<u64>>(
        &self,
        name: &str,
        within: RangeInclusive<u64>,
    ) -> PyResult<Option<T>> {
        let value = self.value(name)?;
        if value.is_none() { Ok(None) } else { whole(name, &value, within).map(Some) }
    }
    /// Counts arguments as read: they are left alone where others decide.
    pub(crate) fn leave(&self, names: &[&str]) -> PyResult<()> {
        for name in names {
            if self.unread.contains(name)? {
                self.unread.del_item(name)?;
            }
        }
        Ok(())
    }
    /// Returns the name of an argument that was not read.
    pub(crate) fn unread(&self) -> Option<String> {
        self.unread.keys().iter().next().map(|name| name.to_string())
    }
    /// Ends the reading.
    ///
    /// # Errors
    /// An argument that was not read.
    pub(crate) fn done(&self) -> PyResult<()> {
        let unknown = |name| Err(PyTypeError::new_err(format!("the core does not know the argument '{name}'")));
        self.unread().map_or(Ok(()), unknown)
    }
}

/// What is read of an argument.
pub(crate) trait Value: Sized {
    /// Reads the value; errors name it.
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self>;
}

/// Makes the error of a value that is something else.
pub(crate) fn wrong(name: &str, value: &Bound<'_, PyAny>, wanted: &str) -> PyErr {
    /// Characters of a value that are shown.
    const SHOWN: usize = 200;
    let shown =
        value.repr().map_or_else(|_| format!("{}", value.get_type()), |shown| shown.to_string_lossy().into_owned());
    let cut: String = shown.chars().take(SHOWN).collect();
    let more = if cut.len() < shown.len() { "…" } else { "" };
    refused(format!("{name} = {cut}{more} is not {wanted}"))
}

/// Calls the way in for arrays, which a number or a list that is none of Python takes as well.
fn by_arrays<'py>(what: &str, name: &str, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    value.py().import("clatter._arrays")?.call_method1(what, (name, value))
}

macro_rules! plain {
    ($($Type:ty: $wanted:literal),*) => {
        $(impl Value for $Type {
            fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
                value.extract().map_err(|_| wrong(name, value, $wanted))
            }
        })*
    };
}
plain!(bool: "True or False", String: "text", PathBuf: "a path");

impl<T: Value> Value for Option<T> {
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        if value.is_none() { Ok(None) } else { T::read(name, value).map(Some) }
    }
}

impl Value for f64 {
    /// Reads a number of Python or numpy, to the last digit.
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        /// Whole numbers up to this are floats as well.
        const EXACT: u64 = 1 << 53;
        let small = || value.extract::<i64>().is_ok_and(|whole| whole.unsigned_abs() <= EXACT);
        if value.is_instance_of::<PyFloat>() || value.is_exact_instance_of::<PyInt>() && small() {
            return value.extract();
        }
        if value.is_none() || value.is_instance_of::<PyBool>() || is_text(value) {
            return Err(wrong(name, value, "a number"));
        }
        by_arrays("number", name, value)?.extract()
    }
}

impl<T: Value, const N: usize> Value for [T; N] {
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let values = several(name, value, &[N])?.iter().map(|one| T::read(name, one)).collect::<PyResult<Vec<_>>>()?;
        values.try_into().map_err(|_| wrong(name, value, "a list"))
    }
}

impl Value for Vec<f64> {
    /// Reads a list of numbers; a number alone is a list of one.
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        numbers(name, value, &[])
    }
}

impl<const N: usize> Value for Vec<[f64; N]> {
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        rows(name, value, <[f64; N]>::read)
    }
}

/// Reads numbers, as many as one of the counts says, where there are any.
pub(crate) fn numbers(name: &str, value: &Bound<'_, PyAny>, counts: &[usize]) -> PyResult<Vec<f64>> {
    several(name, value, counts)?.iter().map(|one| f64::read(name, one)).collect()
}

/// Returns the values of a list, and a value alone as the only one.
pub(crate) fn several<'py>(
    name: &str,
    value: &Bound<'py, PyAny>,
    counts: &[usize],
) -> PyResult<Vec<Bound<'py, PyAny>>> {
    let several = elements(name, value)?.unwrap_or_else(|| vec![value.clone()]);
    if counts.is_empty() || counts.contains(&several.len()) || is_text(value) {
        return Ok(several);
    }
    let takes: Vec<_> = counts.iter().map(|n| format!("{n} value{}", if *n > 1 { "s" } else { "" })).collect();
    Err(refused(format!("{name} takes {}, not {}", takes.join(" or "), several.len())))
}

/// Returns the parts of a value, which are as many as `wanted` names.
pub(crate) fn parts<'py, const N: usize>(
    name: &str,
    value: &Bound<'py, PyAny>,
    wanted: &str,
) -> PyResult<[Bound<'py, PyAny>; N]> {
    several(name, value, &[])?.try_into().map_err(|_| wrong(name, value, wanted))
}

/// Reads a list; errors name its rows by their numbers.
pub(crate) fn rows<'py, T>(
    name: &str,
    value: &Bound<'py, PyAny>,
    row: impl Fn(&str, &Bound<'py, PyAny>) -> PyResult<T>,
) -> PyResult<Vec<T>> {
    let rows = elements(name, value)?.ok_or_else(|| wrong(name, value, "a list"))?;
    rows.iter().enumerate().map(|(i, one)| row(&format!("{name}[{i}]"), one)).collect()
}

/// Returns the elements of a list, an array or an iterator; none of what is no list, or has no order.
fn elements<'py>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<Option<Vec<Bound<'py, PyAny>>>> {
    if value.hasattr("__array__")? {
        return by_arrays("listed", name, value)?.extract().map(Some);
    }
    let is_unordered = value.is_instance_of::<PyFrozenSet>() || value.is_instance_of::<PySet>();
    if is_text(value) || is_unordered || value.cast::<PyMapping>().is_ok() {
        return Ok(None);
    }
    let Ok(values) = value.try_iter() else { return Ok(None) };
    let elements = values.take(LISTED + 1).collect::<PyResult<Vec<_>>>()?;
    if elements.len() > LISTED {
        return Err(refused(format!("{name} has more than {LISTED} elements: ask in pieces")));
    }
    Ok(Some(elements))
}

pub(crate) fn is_text(value: &Bound<'_, PyAny>) -> bool {
    value.is_instance_of::<PyString>() || value.is_instance_of::<PyBytes>()
}

/// Reads a whole number within bounds.
pub(crate) fn whole<T: TryFrom<u64>>(name: &str, value: &Bound<'_, PyAny>, within: RangeInclusive<u64>) -> PyResult<T> {
    if value.is_instance_of::<PyBool>() || value.call_method0("__index__").is_err() {
        return Err(wrong(name, value, "a whole number"));
    }
    let number = value.extract().ok().filter(|number| within.contains(number));
    let bounds = format!("in {} ..= {}", within.start(), within.end());
    number.and_then(|number| T::try_from(number).ok()).ok_or_else(|| wrong(name, value, &bounds))
}

/// Reads a text that is one of these; `last` stands before the last of their names.
pub(crate) fn one_of<T: Copy>(name: &str, value: &Bound<'_, PyAny>, all: &[(&str, T)], last: &str) -> PyResult<T> {
    let text = String::read(name, value)?;
    let found = all.iter().find(|(known, _)| *known == text).map(|(_, one)| *one);
    found.ok_or_else(|| {
        let names: Vec<_> = all.iter().map(|(known, _)| *known).collect();
        let (end, begin) = names.split_last().unwrap_or((&"", &[]));
        refused(format!("{name} = '{text}' is none: {}{last}{end}", begin.join(", ")))
    })
}
