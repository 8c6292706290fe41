//! What parameters are to a skin: whoever treats some of them in a way of their own asks for their role, not for their names.

use std::sync::LazyLock;

use super::{PARAMETERS, Parameter, key};
use crate::case::Case;

/// What a parameter is to the skin, beyond its value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// It is an axis of every grid.
    Geometry,
    /// Measures change continuously with it, so that they have derivatives with respect to it: a number that describes the skin
    /// or how far it is loaded, not how it is solved or how it scatters.
    Continuous,
    /// What is made may differ from it.
    Made,
    /// It may differ from scale to scale.
    Scattered,
    /// The springs of the substrate depend on it.
    MovesSprings,
    /// It says where a puncture ends: a criterion of a study, which nobody makes.
    EndsPuncture,
    /// It says where bending ends.
    EndsBending,
    /// The unit of what bending measures depends on it.
    UnitOfBending,
    /// It says in another way what the parameter of that key says, and may leave it to that by a word.
    InsteadOf(&'static str),
    /// It is the length of that key in mm, which then follows from it.
    InMm(&'static str),
}

impl Parameter {
    /// Whether it has a role.
    pub fn has(&self, role: Role) -> bool {
        self.roles.contains(&role)
    }

    /// The parameters of a role, in the order of the documentation.
    pub fn with(role: Role) -> impl Iterator<Item = &'static Self> {
        PARAMETERS.iter().filter(move |parameter| parameter.has(role))
    }

    /// The parameters that say the same in another way in a case: a definition has one of them.
    pub(crate) fn others_in(&self, case: &Case) -> impl Iterator<Item = &'static Self> {
        PARAMETERS.iter().filter(|other| self.is_said_by(other, case))
    }

    /// Whether another parameter says the same in a case: under a guided needle tilt and friction are two things, and beside a gap the
    /// pitch says a length.
    pub(crate) fn is_said_by(&self, other: &Self, case: &Case) -> bool {
        let origin = |parameter: &Self| {
            let says_length = parameter.key == key::PITCH && case.in_mm.pitch_says_length;
            if says_length { key::LENGTH } else { parameter.origin() }
        };
        let is_needle = || self.origin() == key::CRITICAL_TILT && case.puncture.needle.is_guided();
        let is_same = other.key != self.key && origin(other) == origin(self) && !is_needle();
        is_same || self.excludes(other)
    }

    /// The key of the parameter that this one stands for, in another way or unit; its own, if it stands for none.
    fn origin(&self) -> &'static str {
        // A definition asks for this thousands of times, and finding a parameter by its key takes as long as all else that is asked.
        static ORIGINS: LazyLock<Vec<(&str, &str)>> = LazyLock::new(|| {
            let next = |key: &&'static str| Parameter::named(key)?.stands_for();
            let origin = |p: &Parameter| std::iter::successors(p.stands_for(), next).last();
            PARAMETERS.iter().filter_map(|p| Some((p.key, origin(p)?))).collect()
        });
        match self.stands_for() {
            Some(of) => {
                ORIGINS.iter().find(|(key, _)| *key == self.key).map_or(of, |found| found.1)
            }
            None => self.key,
        }
    }

    /// The key of the parameter that this one says in another way or unit.
    fn stands_for(&self) -> Option<&'static str> {
        self.roles.iter().find_map(|role| match role {
            Role::InsteadOf(key) | Role::InMm(key) => Some(*key),
            _ => None,
        })
    }

    /// The parameter that may be given instead of this one.
    pub(super) fn instead(&self) -> Option<&'static Self> {
        Self::with(Role::InsteadOf(self.key)).next()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameter::Scalar;

    #[test]
    fn roles_agree_with_each_other() {
        for parameter in PARAMETERS {
            let key = parameter.key;
            let case = Case::default();
            let mut others = parameter.others_in(&case);
            assert!(others.all(|other| other.is_said_by(parameter, &case)), "{key}");
            if let Some(instead) = parameter.instead() {
                let open = instead.default();
                assert!(matches!(open, Scalar::Word(_)), "{key} is left to {open}");
            }
            let is_number = parameter.moved(&Case::default(), 0.0).is_some();
            assert!(
                !parameter.has(Role::Continuous) || is_number || parameter.is_optional(),
                "{key} has no number"
            );
            let parameter = parameter.over_t().unwrap_or(parameter);
            let is_skin = parameter.has(Role::Continuous) || parameter.section == "material";
            assert_eq!(
                parameter.has(Role::Made),
                is_skin && !parameter.has(Role::EndsPuncture),
                "{key}"
            );
            assert!(
                !parameter.has(Role::Scattered) || parameter.has(Role::Made),
                "{key} is not made"
            );
        }
    }

    /// The springs are those of the footprint and of the coupling, whatever else a case says.
    #[test]
    fn the_springs_move_with_the_parameters_that_say_so() {
        // Down, because Poisson's ratio stands at the end of its bounds.
        let case = Case::default();
        for parameter in PARAMETERS.iter().filter(|p| p.has(Role::Continuous)) {
            let Some(moved) = parameter.moved(&case, -0.01) else { continue };
            let moves = moved.footprint().unwrap() != case.footprint().unwrap();
            assert_eq!(moves, parameter.has(Role::MovesSprings), "{}", parameter.key);
        }
    }
}
