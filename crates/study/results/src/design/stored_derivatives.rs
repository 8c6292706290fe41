//! Compact form of derivatives in the journal: a matrix with each name stored once.

use std::borrow::Cow;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use sweep::Parameter;

use super::parameter_derivative::ParameterDerivative;
use crate::columns::values::VALUES;

/// Name of a continuous measure, or key of a parameter.
#[derive(Clone, Copy, Debug, Serialize)]
struct KnownName(&'static str);

impl KnownName {
    fn parse(text: &str) -> Option<Self> {
        // The names in a derivative are static strings, so refuse a name that is not in the lists.
        let value = VALUES.iter().filter(|value| value.has_derivatives());
        let measure = value.map(|value| value.name).find(|name| *name == text);
        measure.or_else(|| Parameter::named(text).map(|parameter| parameter.key)).map(Self)
    }
}

impl<'de> Deserialize<'de> for KnownName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = Cow::<str>::deserialize(deserializer)?;
        Self::parse(&text)
            .ok_or_else(|| D::Error::custom(format!("no measure or parameter {text}")))
    }
}

/// Derivatives of several measures with respect to the same parameters.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Matrix {
    /// Keys and values of the parameters.
    by: Vec<(KnownName, f64)>,
    /// Derivatives of each measure, in the order of the parameters.
    of: Vec<Measure>,
}

/// Derivatives of a measure: name, value, left-sided derivatives, and kinks.
#[derive(Debug, Serialize, Deserialize)]
struct Measure(KnownName, f64, Vec<Option<f64>>, Vec<Kink>);

/// A kink: index of the parameter, right-sided derivative, and cause.
#[derive(Debug, Serialize, Deserialize)]
struct Kink(usize, Option<f64>, String);

impl Matrix {
    /// Returns true if `derivatives` have the parameters of this matrix, with the same values.
    fn fits(&self, derivatives: &[ParameterDerivative]) -> bool {
        // Compare bit by bit: merging nearly equal values would change one of them when read back.
        let parameters = derivatives.iter().map(|d| (d.parameter, d.at.to_bits()));
        self.by.iter().map(|(key, at)| (key.0, at.to_bits())).eq(parameters)
    }

    /// Creates a matrix with the parameters of `derivatives` and without measures.
    fn of_parameters(derivatives: &[ParameterDerivative]) -> Self {
        let by = derivatives.iter().map(|d| (KnownName(d.parameter), d.at)).collect();
        Self { by, of: Vec::new() }
    }

    fn derivatives(&self) -> impl Iterator<Item = ParameterDerivative> + '_ {
        self.of.iter().flat_map(|measure| measure.derivatives(&self.by))
    }
}

impl Measure {
    fn new(derivatives: &[ParameterDerivative]) -> Self {
        let (measure, value) = (KnownName(derivatives[0].measure), derivatives[0].value);
        let left = derivatives.iter().map(|derivative| derivative.left).collect();
        let kink = |(position, derivative): (usize, &ParameterDerivative)| {
            Some(Kink(position, derivative.right, derivative.kink.clone()?))
        };
        Self(measure, value, left, derivatives.iter().enumerate().filter_map(kink).collect())
    }

    fn derivatives<'a>(
        &'a self,
        by: &'a [(KnownName, f64)],
    ) -> impl Iterator<Item = ParameterDerivative> + 'a {
        let Self(measure, value, left, kinks) = self;
        by.iter().zip(left).enumerate().map(move |(position, ((parameter, at), &left))| {
            let kink = kinks.iter().find(|kink| kink.0 == position);
            ParameterDerivative {
                measure: measure.0,
                parameter: parameter.0,
                at: *at,
                value: *value,
                left,
                // Away from a kink both sides are equal, so the number is stored once.
                right: kink.map_or(left, |kink| kink.1),
                kink: kink.map(|kink| kink.2.clone()),
            }
        })
    }
}

/// Serializes derivatives that are grouped by measure.
pub fn serialize<S: Serializer>(
    derivatives: &[ParameterDerivative],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let mut matrices: Vec<Matrix> = Vec::new();
    for of_measure in derivatives.chunk_by(|one, next| one.measure == next.measure) {
        // Measures with equal parameters are adjacent, so only the last matrix can fit.
        if !matrices.last().is_some_and(|last| last.fits(of_measure)) {
            matrices.push(Matrix::of_parameters(of_measure));
        }
        if let Some(last) = matrices.last_mut() {
            last.of.push(Measure::new(of_measure));
        }
    }
    matrices.serialize(serializer)
}

/// Deserializes derivatives.
pub fn deserialize<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Vec<ParameterDerivative>, D::Error> {
    let matrices = Vec::<Matrix>::deserialize(deserializer)?;
    Ok(matrices.iter().flat_map(Matrix::derivatives).collect())
}

#[cfg(test)]
mod tests {
    use super::{ParameterDerivative, deserialize, serialize};

    fn derivative(
        measure: &'static str,
        parameter: &'static str,
        left: f64,
    ) -> ParameterDerivative {
        ParameterDerivative {
            measure,
            parameter,
            at: 0.1,
            value: 2.0,
            left: Some(left),
            right: Some(left),
            kink: None,
        }
    }

    #[test]
    fn derivatives_are_read_back_unchanged() {
        let mut derivatives = vec![derivative("coverage", "gap_over_t", 1.0 / 3.0)];
        for measure in ["critical_force", "sink"] {
            derivatives.extend(["gap_over_t", "c1"].map(|key| derivative(measure, key, -1e-9)));
        }
        (derivatives[2].right, derivatives[2].kink) = (None, Some("a contact opens".to_owned()));
        (derivatives[3].left, derivatives[3].right) = (None, None);
        let mut text = Vec::new();
        serialize(&derivatives, &mut serde_json::Serializer::new(&mut text)).unwrap();
        let text = String::from_utf8(text).unwrap();
        assert_eq!(text.matches("critical_force").count(), 1, "{text}");
        let read = deserialize(&mut serde_json::Deserializer::from_str(&text)).unwrap();
        assert_eq!(read, derivatives);
    }
}
