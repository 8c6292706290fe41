//! States which failure modes of a puncture are judged, and the reasons for the others.

use std::fmt;

use skin::puncture::FailureMode;

use crate::case::Case;

/// All failure modes, each with the reason if it is not judged (`None`: it is judged).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JudgedModes(Vec<(FailureMode, Option<&'static str>)>);

impl JudgedModes {
    /// Returns the name of every mode, and the reason if it is not judged (`None`: it is judged).
    pub fn reasons(&self) -> impl Iterator<Item = (&'static str, Option<&'static str>)> {
        self.0.iter().map(|(mode, reason)| (mode.name(), *reason))
    }
}

impl Case {
    /// Returns which failure modes are judged; `None` unless the first failure is requested.
    pub fn judged_modes(&self) -> Option<JudgedModes> {
        let (parameters, across) = (self.punctured(), self.across().is_some());
        parameters.failure?;
        let modes = FailureMode::ALL.into_iter();
        let judged = modes.map(|mode| (mode, mode.not_judged(&parameters, across)));
        Some(JudgedModes(judged.collect()))
    }
}

/// Writes one line with the judged modes and, if any mode is not judged, a second line.
///
/// The second line lists the modes that are not judged, with the reasons.
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
