"""Methods of ``Skin`` that do not need the solver."""

from ._errors import InvalidParameter
from ._squama import Skin, named


def replace(self, **parameters):
    """Returns a skin with other values of some parameters; ``None`` restores the default.

    The name of another material or body replaces all values that it supplies.
    """
    # A length replaces the value of the same length in the other unit.
    lengths = {name.removesuffix("_mm") for name in parameters} | {name.removesuffix("_over_t") for name in parameters}
    other = {f"{name}{unit}" for name in lengths for unit in ("_mm", "_over_t")} - {"thickness_mm"}
    other.update(key for keyword, _, _, keys in named() if keyword in parameters for key in keys)
    kept = {name: value for name, value in self.parameters.items() if name not in other}
    return Skin(**kept | parameters)


def from_toml(definition, design=None):
    """Returns the skin of a definition: a text in TOML, or a path. ``design`` selects one of several, from 1."""
    is_number = design is None or isinstance(design, int) and 0 < design < 2**63
    count, skins = Skin._designs(definition, design - 1 if design and is_number else 0)
    if not is_number or not skins or (design is None and count > 1):
        raise InvalidParameter("design", design, f"the number of one of its {count} designs")
    return skins[0]


def all_from_toml(definition):
    """Returns all skins of a definition (a text in TOML, or a path), in the order of their numbers."""
    return Skin._designs(definition, None)[1]


def made(parameters):
    """Restores a pickled skin."""
    return Skin(**parameters)
