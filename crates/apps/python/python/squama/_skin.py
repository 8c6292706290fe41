"""What a skin does that needs no solver."""

from ._errors import InvalidParameter
from ._squama import Skin


def replace(self, **parameters):
    """A skin with other values of some parameters; ``None`` is the default."""
    # A length takes the place of the same length in the other unit.
    lengths = {name.removesuffix("_mm") for name in parameters} | {name.removesuffix("_over_t") for name in parameters}
    other = {f"{name}{unit}" for name in lengths for unit in ("_mm", "_over_t")} - {"thickness_mm"}
    kept = {name: value for name, value in self.parameters.items() if name not in other}
    return Skin(**kept | parameters)


def from_toml(definition, design=None):
    """The skin of a definition: a text in TOML, or the path of a file. Of several designs ``design`` is the number, from 1."""
    is_number = design is None or isinstance(design, int) and 0 < design < 2**63
    count, skins = Skin._designs(definition, design - 1 if design and is_number else 0)
    if not is_number or not skins or (design is None and count > 1):
        raise InvalidParameter("design", design, f"the number of one of its {count} designs")
    return skins[0]


def all_from_toml(definition):
    """All skins of a definition, in the order of their numbers: a text in TOML, or the path of a file."""
    return Skin._designs(definition, None)[1]


def made(parameters):
    """The skin that was pickled."""
    return Skin(**parameters)
