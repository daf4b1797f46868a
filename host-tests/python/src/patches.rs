//! Patches from Python, dictionaries with the keys of a model file's patches, as the text of a model file.

use crate::model::Source;
use crate::refusal::Refusal;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::borrow::Cow;
use toml::{Table, Value};

/// The keys of a patch.
const KEYS: [&str; 6] = ["name", "degree", "points", "knots_u", "knots_v", "flip"];
/// The model's name in messages.
const LABEL: &str = "patches";

/// The model of these patches, in metres, centimetres or millimetres.
///
/// # Errors
/// The first entry that is not of its kind.
pub fn model(patches: &[Bound<'_, PyDict>], unit: &str) -> Result<Source, Refusal> {
    let mut tables = Vec::with_capacity(patches.len());
    for (index, patch) in patches.iter().enumerate() {
        let table = table(patch).map_err(|says| Refusal::Model(format!("{LABEL}[{index}]: {says}")))?;
        tables.push(Value::Table(table));
    }
    let mut model = Table::new();
    model.insert("name".to_owned(), LABEL.into());
    model.insert("unit".to_owned(), unit.into());
    model.insert("patch".to_owned(), Value::Array(tables));
    Ok(Source::Text(Cow::Owned(model.to_string()), LABEL.to_owned()))
}

fn table(patch: &Bound<'_, PyDict>) -> Result<Table, String> {
    let mut table = Table::new();
    for (key, value) in patch {
        let key: String = key.extract().map_err(|_| "a key is not a string".to_owned())?;
        let value = match key.as_str() {
            "name" => Value::String(value.extract().map_err(|_| "its name is not a string")?),
            "degree" => degree(&value)?,
            "points" => points(&value)?,
            "knots_u" | "knots_v" => numbers(&key, value.extract().map_err(|_| format!("its {key} are not numbers"))?)?,
            "flip" => Value::Boolean(value.extract().map_err(|_| "its flip is neither True nor False")?),
            _ => return Err(format!("there is no key {key:?}; there are {}", KEYS.join(", "))),
        };
        table.insert(key, value);
    }
    match ["degree", "points"].into_iter().find(|key| !table.contains_key(*key)) {
        Some(key) => Err(format!("it has no {key}")),
        None => Ok(table),
    }
}

fn degree(value: &Bound<'_, PyAny>) -> Result<Value, String> {
    let degree: [u8; 2] = value.extract().map_err(|_| "its degree is not two small integers")?;
    Ok(Value::Array(degree.map(|degree| i64::from(degree).into()).to_vec()))
}

fn points(value: &Bound<'_, PyAny>) -> Result<Value, String> {
    let rows: Vec<Vec<Vec<f64>>> = value.extract().map_err(|_| "its points are not rows of rows of 3 or 4 numbers")?;
    let row = |(u, row): (usize, Vec<Vec<f64>>)| {
        let points = row.into_iter().enumerate().map(|(v, point)| numbers(&format!("points[{u}][{v}]"), point));
        points.collect::<Result<_, _>>().map(Value::Array)
    };
    Ok(Value::Array(rows.into_iter().enumerate().map(row).collect::<Result<_, _>>()?))
}

fn numbers(what: &str, numbers: Vec<f64>) -> Result<Value, String> {
    if let Some(number) = numbers.iter().find(|number| !number.is_finite()) {
        return Err(format!("{what}: {number} is not finite"));
    }
    Ok(Value::Array(numbers.into_iter().map(Value::Float).collect()))
}
