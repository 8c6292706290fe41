//! The failure modes that a puncture is judged by.

use std::fmt;

use skin::puncture::FailureMode;

use crate::case::Case;

/// Failure modes of a design: judged, or not and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JudgedModes(Vec<(FailureMode, Option<&'static str>)>);

impl JudgedModes {
    /// Returns the name of every mode, with the reason for which it is not judged.
    pub fn reasons(&self) -> impl Iterator<Item = (&'static str, Option<&'static str>)> {
        self.0.iter().map(|(mode, reason)| (mode.name(), *reason))
    }
}

impl Case {
    /// Returns the judged failure modes; `None` unless the first failure is requested.
    pub fn judged_modes(&self) -> Option<JudgedModes> {
        let (parameters, across) = (self.punctured(), self.across().is_some());
        parameters.failure?;
        let modes = FailureMode::ALL.into_iter();
        let judged = modes.map(|mode| (mode, mode.not_judged(&parameters, across)));
        Some(JudgedModes(judged.collect()))
    }
}

/// Writes a line of the judged modes and, if there are others, a line with the reasons.
impl fmt::Display for JudgedModes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (mut judged, mut others) = (Vec::new(), Vec::new());
        for (mode, reason) in self.reasons() {
            match reason {
                None => judged.push(mode.to_owned()),
                Some(reason) => others.push(format!("{mode} ({reason})")),
            }
        }
        writeln!(f, "Failure modes judged: {}", judged.join(", "))?;
        if !others.is_empty() {
            writeln!(f, "Not judged: {}", others.join(", "))?;
        }
        Ok(())
    }
}
