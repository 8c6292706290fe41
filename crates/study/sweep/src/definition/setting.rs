//! Settings from outside the definition, such as `--set puncture.scales=41`.

use std::sync::Arc;

use super::suggestion::VARIABLES;
use crate::case::Case;
use crate::named_values::{NAME_KEYS, short_name_key};
use crate::parameter::{Parameter, key};
use text::toml_source::{self, KeyValue, KeyValues, Location, Value};

/// Maximum number of parts of a dotted key.
///
/// Valid keys have one or two parts. Longer keys up to this limit are parsed, so that the error of
/// the unknown key can suggest a known key.
const DEEPEST: usize = 8;

/// A key with a value that replaces the value in the file.
///
/// ```
/// use sweep::Setting;
///
/// assert!(Setting::parse("scale.base=2L").is_ok());
/// assert!(Setting::parse("designs.slant_deg=[0, 45]").is_ok());
/// assert!(Setting::parse("scale.base").is_err());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    path: Vec<String>,
    value: Value,
    location: Location,
}

/// An invalid setting.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{location}: {problem}, expected KEY=VALUE with a dotted key, e.g. puncture.scales=41")]
pub struct InvalidSetting {
    location: Location,
    problem: String,
}

impl Setting {
    /// Parses `key=value`. The value is TOML; a single word needs no quotes.
    ///
    /// # Errors
    ///
    /// If there is no `=`, the key is empty or the value is not TOML.
    pub fn parse(text: &str) -> Result<Self, InvalidSetting> {
        Self::from_option(&format!("--set {text}"), text)
    }

    /// Parses the setting `text` of the command-line option `option`, like [`Self::parse`].
    ///
    /// Messages show `option`, which is the option with its setting as the user typed them.
    ///
    /// # Errors
    ///
    /// As [`Self::parse`].
    pub fn from_option(option: &str, text: &str) -> Result<Self, InvalidSetting> {
        // An argument may have several lines, but a message must have one line.
        let location = Location::Argument(Arc::from(text::one_line(option)));
        let refuse = |problem: String| InvalidSetting { location: location.clone(), problem };
        // Split at the first `=`, because the value may be a table or a text with further `=`.
        let (key, value) =
            text.split_once('=').ok_or_else(|| refuse("there is no `=`".to_owned()))?;
        let mut path: Vec<_> = key.split('.').map(|part| part.trim().to_owned()).collect();
        if path.iter().any(String::is_empty) {
            return Err(refuse(format!("`{}` is not a key", key.trim())));
        }
        if path.len() > DEEPEST {
            return Err(refuse(format!("a key of {} parts, expected at most two", path.len())));
        }
        let value = toml_source::parse_argument(value, &location).map_err(|message| {
            refuse(format!("`{}` is not a TOML value ({message})", value.trim()))
        })?;
        // `material=PLA` sets `material.scale`; it must not replace the whole section.
        if let [section] = path.as_slice()
            && let Some(name) = short_name_key(section)
            && matches!(value, Value::Text(_))
        {
            path.push(name.key.to_owned());
        }
        Ok(Self { path, value, location })
    }

    /// Returns the parameter that this setting sets; `None` if its key is not a parameter.
    pub fn parameter(&self) -> Option<&'static Parameter> {
        match self.path.as_slice() {
            [section, key] => Parameter::named(key).filter(|parameter| {
                ["designs", VARIABLES, parameter.section].contains(&&**section)
            }),
            _ => None,
        }
    }

    /// Returns the origin of the setting for messages: the option as typed.
    pub fn location(&self) -> &Location {
        &self.location
    }

    /// Replaces or adds the value of this setting in `table`.
    pub(crate) fn apply(&self, table: &mut KeyValues) {
        self.supersede(table);
        self.put(table, &self.path);
    }

    fn put(&self, table: &mut KeyValues, path: &[String]) {
        let Some((key, rest)) = path.split_first() else { return };
        match table.iter_mut().find(|entry| entry.key == *key) {
            Some(KeyValue { value: Value::Table(inner), .. }) if !rest.is_empty() => {
                self.put(inner, rest);
            }
            // Keep the position of the entry, because the order of the axes determines the numbers
            // of the designs.
            Some(entry) => *entry = self.entry(key, rest),
            None => table.push(self.entry(key, rest)),
        }
    }

    /// Returns the entry `key` with the value, nested in tables with the names `rest`.
    fn entry(&self, key: &str, rest: &[String]) -> KeyValue {
        let value = match rest.split_first() {
            None => self.value.clone(),
            Some((next, rest)) => Value::Table(vec![self.entry(next, rest)]),
        };
        KeyValue { key: key.to_owned(), value, location: self.location.clone() }
    }

    /// Removes from `table` the values that contradict this setting.
    ///
    /// A parameter may be in its section, an axis or a variable, and some parameters exclude each
    /// other. Contradicting values from the file are removed. Contradicting values from other
    /// settings stay, and the reader refuses them.
    fn supersede(&self, table: &mut KeyValues) {
        self.supersede_named_values(table);
        let Some(parameter) = self.parameter() else { return };
        for section in ["designs", VARIABLES, parameter.section] {
            if section != self.path[0] {
                drop_from_file(table, section, parameter.key);
            }
        }
        for other in parameter.others_in(&case_of(table)) {
            for section in ["designs", VARIABLES, other.section] {
                drop_from_file(table, section, other.key);
            }
        }
    }

    /// Removes the values of the file that the material or body named by this setting supplies.
    ///
    /// A name in the file supplies only values that the file does not give. A name in a setting
    /// replaces values of the file, because a definition that squama wrote gives every value. Axes
    /// and variables stay.
    fn supersede_named_values(&self, table: &mut KeyValues) {
        let ([section, key], Value::Text(value)) = (self.path.as_slice(), &self.value) else {
            return;
        };
        let mut names = NAME_KEYS.iter().filter(|name| name.section == section && name.key == key);
        let Some(named) = names.find_map(|name| name.find(value)) else { return };
        let case = case_of(table);
        for parameter in named.values.iter().filter_map(|(key, _)| Parameter::named(key)) {
            for replaced in std::iter::once(parameter).chain(parameter.others_in(&case)) {
                drop_from_file(table, replaced.section, replaced.key);
            }
        }
    }
}

/// Returns a case with the choices that decide which parameters are alternatives.
///
/// These choices are the parameter that the pitch determines, and the kind of needle.
fn case_of(table: &KeyValues) -> Case {
    let mut written = Vec::new();
    for KeyValue { key: section, value, .. } in table {
        let Value::Table(entries) = value else { continue };
        written.extend(entries.iter().filter_map(|entry| {
            let parameter = Parameter::named(&entry.key)
                .filter(|p| ["designs", VARIABLES, p.section].contains(&&**section))?;
            Some((parameter, &entry.value))
        }));
    }
    let mut case = Case::default();
    // If a gap is given, the pitch determines the length.
    case.in_mm.pitch_determines_length = [key::PITCH, key::GAP]
        .iter()
        .all(|key| written.iter().any(|(parameter, _)| parameter.is_or_determines(key)));
    // Critical tilt and needle friction are alternatives only for a free needle.
    for (parameter, value) in written.iter().filter(|(p, _)| p.key == key::NEEDLE) {
        // Skip an axis of needles, which has no single value, and an invalid value, which the
        // reader refuses.
        if let Ok(needle) = parameter.read(value) {
            parameter.set(&mut case, needle);
        }
    }
    case
}

/// Removes `key` from `section` of `table`, unless another setting added the key.
fn drop_from_file(table: &mut KeyValues, section: &str, key: &str) {
    for entry in table.iter_mut().filter(|entry| entry.key == section) {
        if let Value::Table(entries) = &mut entry.value {
            entries.retain(|entry| {
                entry.key != key || !matches!(entry.location, Location::File { .. })
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invalid_settings_are_refused_with_a_reason() {
        let message = |text| Setting::parse(text).expect_err("invalid").to_string();
        insta::assert_snapshot!(message("scales"), @"--set scales: there is no `=`, expected KEY=VALUE with a dotted key, e.g. puncture.scales=41");
        insta::assert_snapshot!(message("=3"), @"--set =3: `` is not a key, expected KEY=VALUE with a dotted key, e.g. puncture.scales=41");
        insta::assert_snapshot!(message("designs.slant_deg=[0,"), @"--set designs.slant_deg=[0,: `[0,` is not a TOML value (unclosed array, expected `]`), expected KEY=VALUE with a dotted key, e.g. puncture.scales=41");
        insta::assert_snapshot!(message("scale.base="), @"--set scale.base=: `` is not a TOML value (string values must be quoted, expected literal string), expected KEY=VALUE with a dotted key, e.g. puncture.scales=41");
    }

    /// The file gives every value, like a definition that squama wrote.
    #[test]
    fn a_name_in_a_setting_replaces_values_of_the_file() {
        let text = "name = 'x'\nmeasures = 'puncture'\n[designs]\ngap_over_t = 0.2\nlength_over_t = 0.5\n\
            slant_deg = 60\n[body]\ncurvature_times_t = 0\n[material]\nthickness_mm = 1\n\
            substrate_modulus_MPa = 1\nscale_modulus_MPa = 2500\nscale_strength_MPa = 50\n";
        let case = |settings: &[&str]| {
            let settings: Vec<_> =
                settings.iter().map(|text| Setting::parse(text).expect("valid")).collect();
            crate::Sweep::parse(text, "x.toml", &settings).expect("a sweep").grid().case(0)
        };
        assert_eq!(case(&["body=finger"]).body_radius, Some(10.0));
        let tpu = case(&["material.scale=TPU"]);
        assert_ne!(tpu.material.scale_strength_mpa, Some(50.0));
        assert_eq!(tpu, case(&["material.scale=tpu"]));
        // Values that are set explicitly take precedence over the values of the name.
        let both = case(&["material.scale=TPU", "material.scale_strength_MPa=7"]);
        assert_eq!(both.material.scale_strength_mpa, Some(7.0));
        let both = case(&["body.radius_mm=30", "body=finger"]);
        assert_eq!(both.body_radius, Some(30.0));
    }

    #[test]
    fn a_word_needs_no_quotes() {
        for (text, value) in [
            ("scale.base=2L", Value::Text("2L".to_owned())),
            ("scale.base=\"2L\"", Value::Text("2L".to_owned())),
            ("contact.friction=.1", Value::Number("0.1".to_owned())),
            ("puncture.scales = 41", Value::Number("41".to_owned())),
        ] {
            assert_eq!(Setting::parse(text).expect("valid").value, value);
        }
    }

    #[test]
    fn a_setting_replaces_adds_or_removes_values() {
        for (file, settings, expected) in [
            ("name = 'x'", "name=y", "{ name = \"y\" }"),
            ("name = 'x'", "contact.c1=2", "{ name = \"x\", contact = { c1 = 2 } }"),
            ("contact.c1 = 1", "designs.c1=[1, 2]", "{ contact = {}, designs = { c1 = [1, 2] } }"),
            ("designs.c1 = [1, 2]", "contact.c1=3", "{ designs = {}, contact = { c1 = 3 } }"),
            (
                "flexure.membrane_length_over_t = 50",
                "flexure.gaps=42",
                "{ flexure = { gaps = 42 } }",
            ),
            (
                "flexure.gaps = 42",
                "designs.membrane_length_over_t=[50, 100]",
                "{ flexure = {}, designs = { membrane_length_over_t = [50, 100] } }",
            ),
            // Together with a gap, the pitch determines the length, so a setting of the gap keeps
            // the pitch. Without a gap, the pitch determines the gap.
            (
                "designs = { gap_mm = 0.3, pitch_mm = 2 }",
                "designs.gap_over_t=0.2",
                "{ designs = { pitch_mm = 2, gap_over_t = 0.2 } }",
            ),
            (
                "designs = { gap_mm = 0.3, pitch_mm = 2 }",
                "designs.length_mm=1",
                "{ designs = { gap_mm = 0.3, length_mm = 1 } }",
            ),
            (
                "designs = { length_mm = 1, pitch_mm = 2 }",
                "designs.gap_mm=0.2",
                "{ designs = { length_mm = 1, gap_mm = 0.2 } }",
            ),
            (
                "designs = { pitch_mm = 2 }\ntolerance = { gap_mm = { batch_sd = 1 } }",
                "designs.gap_mm=0.2",
                "{ designs = { gap_mm = 0.2 }, tolerance = { gap_mm = { batch_sd = 1 } } }",
            ),
            ("variables.c1 = [1, 2]", "contact.c1=3", "{ variables = {}, contact = { c1 = 3 } }"),
            (
                "",
                "contact.c1=3; designs.c1=[1, 2]",
                "{ contact = { c1 = 3 }, designs = { c1 = [1, 2] } }",
            ),
        ] {
            let mut table = toml_source::parse(file, "x.toml").expect("TOML");
            for setting in settings.split("; ") {
                Setting::parse(setting).expect("valid").apply(&mut table);
            }
            assert_eq!(Value::Table(table).to_string(), expected);
        }
    }
}
