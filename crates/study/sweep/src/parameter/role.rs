//! Roles of parameters in the model. Code selects parameters by role, not by name.

use std::sync::LazyLock;

use super::{PARAMETERS, Parameter, ParameterKind, key};
use crate::case::Case;

/// Role of a parameter in the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The parameter is an axis of every grid.
    Geometry,
    /// The measures are differentiable with respect to the parameter.
    ///
    /// The parameter is a number that describes the skin or its load, not the solver or the scatter
    /// of imperfect rows.
    Continuous,
    /// The parameter may have manufacturing deviations, in `[tolerance]`.
    Toleranced,
    /// The manufacturing deviation may vary from scale to scale.
    Scattered,
    /// The springs of the substrate depend on the parameter.
    MovesSprings,
    /// The parameter defines the end of a puncture, and has no manufacturing deviations.
    EndsPuncture,
    /// The parameter defines the end of bending.
    EndsBending,
    /// The unit of the bending measures depends on the parameter.
    UnitOfBending,
    /// The parameter is an alternative to the parameter with this key.
    ///
    /// A word as its value, such as `auto`, selects the parameter with this key.
    InsteadOf(&'static str),
    /// The parameter is a length in mm and determines the parameter with this key.
    InMm(&'static str),
}

impl Parameter {
    /// Returns true if the parameter has `role`.
    pub fn has(&self, role: Role) -> bool {
        self.roles.contains(&role)
    }

    /// Returns the parameters with `role`, in the order of the documentation.
    pub fn with(role: Role) -> impl Iterator<Item = &'static Self> {
        PARAMETERS.iter().filter(move |parameter| parameter.has(role))
    }

    /// Returns the alternatives of this parameter in a case.
    ///
    /// A definition gives either this parameter or one of its alternatives.
    pub(crate) fn others_in(&self, case: &Case) -> impl Iterator<Item = &'static Self> {
        PARAMETERS.iter().filter(|other| self.is_alternative_of(other, case))
    }

    /// Returns true if `other` is an alternative of this parameter in a case.
    ///
    /// Critical tilt and needle friction are alternatives only for a free needle. A pitch is an
    /// alternative of the length if the case also gives a gap, otherwise of the gap.
    pub(crate) fn is_alternative_of(&self, other: &Self, case: &Case) -> bool {
        let origin = |parameter: &Self| {
            let sets_length = parameter.key == key::PITCH && case.in_mm.pitch_determines_length;
            if sets_length { key::LENGTH } else { parameter.origin() }
        };
        // Alternatives are in the same section. Compare sections first, because `origin` is slow.
        let is_same = other.section == self.section
            && other.key != self.key
            && origin(other) == origin(self)
            && !(self.origin() == key::CRITICAL_TILT && case.puncture.needle.is_guided());
        is_same || self.excludes(other)
    }

    /// Returns true if this optional number, in any unit, may be given instead of `other`.
    pub(super) fn replaces(&self, other: &Self) -> bool {
        let is_number = matches!(self.kind, ParameterKind::OptionalNumber { .. });
        is_number && self.over_t().unwrap_or(self).has(Role::InsteadOf(other.key))
    }

    /// Returns true if an alternative of this parameter is given in `before`, but not in `case`.
    pub fn supersedes(&self, before: &Case, case: &Case) -> bool {
        self.others_in(before).any(|other| other.is_given(before) && !other.is_given(case))
    }

    /// Returns the key that this parameter finally determines, or its own key.
    ///
    /// Follows alternatives and units: `load_inset_mm` determines `load_inset_over_t`, which
    /// determines `load_position`.
    fn origin(&self) -> &'static str {
        // Cached, because reading a definition calls `origin` thousands of times, and the search by
        // key is slow.
        static ORIGINS: LazyLock<Vec<(&str, &str)>> = LazyLock::new(|| {
            let origins = PARAMETERS.iter().filter_map(|p| {
                let next = p.stands_for();
                let all = std::iter::successors(next, |key| Parameter::named(key)?.stands_for());
                Some((p.key, all.last()?))
            });
            origins.collect()
        });
        match self.stands_for() {
            Some(of) => {
                ORIGINS.iter().find(|(key, _)| *key == self.key).map_or(of, |found| found.1)
            }
            None => self.key,
        }
    }

    /// Returns the key of the parameter that this one replaces, as alternative or length in mm.
    fn stands_for(&self) -> Option<&'static str> {
        self.roles.iter().find_map(|role| match role {
            Role::InsteadOf(key) | Role::InMm(key) => Some(*key),
            _ => None,
        })
    }

    /// Returns the parameter that may be given instead of this one.
    pub(super) fn instead(&self) -> Option<&'static Self> {
        Self::with(Role::InsteadOf(self.key)).next()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Scalar;

    #[test]
    fn roles_agree_with_each_other() {
        for parameter in PARAMETERS {
            let key = parameter.key;
            let case = Case::default();
            let mut others = parameter.others_in(&case);
            assert!(others.all(|other| other.is_alternative_of(parameter, &case)), "{key}");
            let origin = Parameter::named(parameter.origin()).expect("a parameter");
            assert_eq!(origin.section, parameter.section, "{key}");
            if let Some(instead) = parameter.instead() {
                let open = instead.default();
                assert!(matches!(open, Scalar::Word(_)), "default of the alternative: {open}");
            }
            let is_number = parameter.moved(&Case::default(), 0.0).is_some();
            assert!(
                !parameter.has(Role::Continuous) || is_number || parameter.is_optional(),
                "{key} is continuous, but takes no numbers"
            );
            let parameter = parameter.over_t().unwrap_or(parameter);
            let is_skin = parameter.has(Role::Continuous) || parameter.section == "material";
            assert_eq!(
                parameter.has(Role::Toleranced),
                is_skin && !parameter.has(Role::EndsPuncture),
                "{key}"
            );
            assert!(
                !parameter.has(Role::Scattered) || parameter.has(Role::Toleranced),
                "{key} varies from scale to scale, but has no manufacturing deviation"
            );
        }
    }

    /// The springs depend on the footprint and the coupling alone.
    #[test]
    fn springs_depend_on_the_parameters_with_the_role_moves_springs() {
        // Decrease the parameters, because the default Poisson's ratio is at its upper bound.
        let case = Case::default();
        for parameter in PARAMETERS.iter().filter(|p| p.has(Role::Continuous)) {
            let Some(moved) = parameter.moved(&case, -0.01) else { continue };
            let moves = moved.footprint().unwrap() != case.footprint().unwrap();
            assert_eq!(moves, parameter.has(Role::MovesSprings), "{}", parameter.key);
        }
    }
}
