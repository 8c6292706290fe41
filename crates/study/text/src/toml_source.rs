//! Parses TOML into keys and values with their positions; numbers remain text.

use std::fmt;
use std::sync::Arc;

use toml::de::{DeTable, DeValue};

use crate::message::one_line;

/// Location of a key or a value, for messages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Location {
    /// A line in a file.
    File {
        /// Name of the file as the user gave it.
        name: Arc<str>,
        /// Number of the line, from 1; `None` if unknown.
        line: Option<usize>,
    },
    /// A command-line option or another source, named by the text.
    Argument(Arc<str>),
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File { name, line: Some(line) } => write!(f, "{name}:{line}"),
            Self::File { name, line: None } => f.write_str(name),
            Self::Argument(text) => f.write_str(text),
        }
    }
}

/// Maximum number of commas in a document, which limits its number of values.
///
/// The longest axis of a sweep has at most a million values.
const MOST_VALUES: usize = 1_200_000;

/// A key with its value.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyValue {
    /// Key within its table, without the name of the table.
    pub key: String,
    /// Value of the key.
    pub value: Value,
    /// Location of the key.
    pub location: Location,
}

/// Keys and values in the order of the document.
pub type KeyValues = Vec<KeyValue>;

/// A TOML value.
///
/// Numbers remain text, because ranges are computed in decimal arithmetic.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number as written, including `nan` and `inf`.
    Number(String),
    /// A string without its quotes.
    Text(String),
    /// A list.
    List(Vec<Value>),
    /// A table.
    Table(KeyValues),
    /// A boolean, date or time as text.
    Other(String),
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(text) | Self::Other(text) => f.write_str(text),
            Self::Text(text) => f.write_str(&quoted(text)),
            Self::List(items) => {
                let items: Vec<_> = items.iter().map(ToString::to_string).collect();
                write!(f, "[{}]", items.join(", "))
            }
            Self::Table(entries) if entries.is_empty() => f.write_str("{}"),
            Self::Table(entries) => {
                let entries: Vec<_> =
                    entries.iter().map(|e| format!("{} = {}", e.key, e.value)).collect();
                write!(f, "{{ {} }}", entries.join(", "))
            }
        }
    }
}

/// Returns `text` as a TOML string on one line.
pub fn quoted(text: &str) -> String {
    // The `toml` crate writes a string with line breaks on several lines, but messages have one
    // line.
    toml::Value::from(text.replace(['\n', '\r'], " ")).to_string()
}

/// Error for a text that is not valid TOML; its message has one line per mistake.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
pub struct SyntaxError(Vec<SyntaxMistake>);

/// A line that is not valid TOML.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{location}: {line}: not valid TOML ({message}), expected key = value or [section]")]
struct SyntaxMistake {
    location: Location,
    /// Text of the line, shortened.
    line: String,
    message: String,
}

/// Parses the TOML document `text`; `name` is the file name for messages.
///
/// # Errors
///
/// Returns all invalid lines if `text` is not valid TOML, or the first value beyond the maximum
/// number of values.
pub fn parse(text: &str, name: &str) -> Result<KeyValues, SyntaxError> {
    let source = Document::new(text, name);
    // Count commas before parsing: a parsed value takes about 200 bytes of memory, but only two or
    // three bytes in the file.
    if let Some((offset, _)) = text.match_indices(',').nth(MOST_VALUES) {
        let message = format!("more than {MOST_VALUES} values");
        let (location, line) = (source.location(Some(offset)), source.line(offset));
        return Err(SyntaxError(vec![SyntaxMistake { location, line, message }]));
    }
    let (table, mut errors) = DeTable::parse_recoverable(text);
    // Sort by position, because `dedup_by` below compares neighbours.
    errors.sort_by_key(|error| error.span().map(|span| span.start));
    let mut mistakes: Vec<_> = errors.iter().map(|error| source.mistake(error)).collect();
    // Keep the first mistake on each line, because it usually causes the others.
    mistakes.dedup_by(|next, first| next.location == first.location);
    if mistakes.is_empty() { Ok(source.table(table.get_ref())) } else { Err(SyntaxError(mistakes)) }
}

/// A TOML document, with the offsets needed to find the line of a key.
struct Document<'a> {
    text: &'a str,
    name: Arc<str>,
    /// Byte offsets of the newline characters, in ascending order.
    ends: Vec<usize>,
}

impl<'a> Document<'a> {
    fn new(text: &'a str, name: &str) -> Self {
        let ends = text.match_indices('\n').map(|(offset, _)| offset).collect();
        Self { text, name: name.into(), ends }
    }

    fn mistake(&self, error: &toml::de::Error) -> SyntaxMistake {
        let offset = error.span().map(|span| span.start);
        let (location, line) = (self.location(offset), self.line(offset.unwrap_or_default()));
        SyntaxMistake { location, line, message: one_line(error.message()) }
    }

    /// Returns the first 60 characters of the line at the byte `offset`.
    ///
    /// Control characters are omitted.
    fn line(&self, offset: usize) -> String {
        let start = self.text.get(..offset).and_then(|before| before.rfind('\n'));
        let line = self.text[start.map_or(0, |newline| newline + 1)..].lines().next();
        let visible = line.unwrap_or_default().trim().chars().filter(|c| !c.is_control());
        let visible: String = visible.take(60).collect();
        if visible.is_empty() { "a line that cannot be shown".to_owned() } else { visible }
    }

    fn location(&self, offset: Option<usize>) -> Location {
        // Binary search, because counting newlines for each key would take quadratic time.
        let line = offset.map(|offset| self.ends.partition_point(|end| *end < offset) + 1);
        Location::File { name: Arc::clone(&self.name), line }
    }

    fn table(&self, table: &DeTable<'_>) -> KeyValues {
        entries(table, &|offset| self.location(Some(offset)))
    }
}

fn entries(table: &DeTable<'_>, location: &dyn Fn(usize) -> Location) -> KeyValues {
    table
        .iter()
        .map(|(key, value)| {
            let key: &toml::Spanned<toml::de::DeString<'_>> = key;
            KeyValue {
                key: key.get_ref().to_string(),
                value: value_of(value.get_ref(), location),
                location: location(key.span().start),
            }
        })
        .collect()
}

fn value_of(value: &DeValue<'_>, location: &dyn Fn(usize) -> Location) -> Value {
    match value {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Integer(number) if number.radix() == 10 => {
            Value::Number(number.as_str().to_owned())
        }
        DeValue::Integer(number) => {
            // Convert hexadecimal, octal and binary integers, because ranges need decimal numbers.
            let parsed = i128::from_str_radix(number.as_str(), number.radix());
            Value::Number(parsed.map_or_else(|_| number.to_string(), |n| n.to_string()))
        }
        DeValue::Float(number) => Value::Number(number.as_str().to_owned()),
        DeValue::Boolean(boolean) => Value::Other(boolean.to_string()),
        DeValue::Datetime(datetime) => Value::Other(datetime.to_string()),
        DeValue::Array(items) => {
            Value::List(items.iter().map(|item| value_of(item.get_ref(), location)).collect())
        }
        DeValue::Table(table) => Value::Table(entries(table, location)),
    }
}

/// Parses a value given on the command line, where a string needs no quotes.
///
/// # Errors
///
/// Returns an error if `text` is empty, or if it begins like a list, table or quoted string but is
/// not valid TOML.
pub fn parse_argument(text: &str, location: &Location) -> Result<Value, String> {
    let text = text.trim();
    let error = match DeValue::parse(text) {
        Ok(value) => return Ok(value_of(value.get_ref(), &|_| location.clone())),
        Err(error) => error,
    };
    // Users write numbers such as `.5` and `5.`, which are not valid TOML.
    let number = || text.parse::<f64>().ok().filter(|number| number.is_finite());
    if let Some(number) = text.contains('.').then(number).flatten() {
        return Ok(Value::Number(number.to_string()));
    }
    // A text that begins like a list, table or string is a mistake, not a string without quotes.
    if text.is_empty() || text.starts_with(['[', '{', '"', '\'']) {
        return Err(one_line(error.message()));
    }
    Ok(Value::Text(text.to_owned()))
}
