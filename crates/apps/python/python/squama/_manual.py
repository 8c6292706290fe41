"""Generates the documentation of skins and results, and the stub of the package."""

import inspect

from ._squama import columns, named, parameters


def _type(expected):
    number = "float | Sequence[float]" if "a list" in expected else "int" if expected.startswith("a whole") else "float"
    is_word = expected.startswith('"')
    if expected == '"false" or "true"':
        return "bool"
    return "str" if is_word else f"{number} | str" if '"' in expected else number


def signature():
    """Returns the signature of ``Skin``, with a keyword for each parameter."""
    keyword, one = inspect.Parameter.KEYWORD_ONLY, inspect.Parameter
    of = [one(key, keyword, default=one.empty if default is None and section == "designs" else _value(default))
          for key, section, *_, default in parameters()]
    names = [one(key, keyword, default=None) for key, *_ in named()]
    return inspect.Signature(of + names)


def _value(default):
    if default in (None, "false", "true"):
        return None if default is None else default == "true"
    return default.strip('"') if default.startswith('"') else float(default)


def skin():
    """Returns the documentation of a skin: unit, meaning, values and default of every parameter."""
    lines = [
        "A skin of scales: Skin(gap_over_t=0.1, length_over_t=0.3, slant_deg=60).",
        "",
        "Skins are immutable and hashable, and can be pickled. Every parameter of a definition is a keyword and an",
        "attribute; None means its default. Lengths *_over_t are divided by the thickness t of the scales; with",
        "thickness_mm they may be given in mm as *_mm.",
    ]
    last = None
    for key, section, unit, meaning, expected, default in parameters():
        if section != last:
            lines += ["", f"[{section}]"]
            last = section
        unit = "" if unit == "-" else f" ({unit})"
        has_default = section != "designs" or key.endswith(("_over_t", "_mm"))
        default = f"default {default}" if default else "not given" if has_default else "required"
        lines += [f"{key}{unit}", f"    {meaning}: {expected}; {default}"]
    lines += ["", "Names, which supply the parameters that are not given (docs/materials.md, docs/bodies.md):", ""]
    for key, _, names, keys in named():
        lines += [key, f"    {', '.join(keys)}: {' or '.join(names)}"]
    lines += ["", "Measures of a solved skin, with their units:", ""]
    lines += [f"{name} ({unit}): {meaning}" for name, unit, meaning in columns()]
    return "\n".join(lines)


_SKIN = '''class Skin:
    def __init__(
        self,
        *,
{parameters}
    ) -> None: ...
{attributes}
    @property
    def parameters(self) -> dict[str, Any]: ...
    @property
    def failure_modes(self) -> dict[str, str | None] | None: ...
    @staticmethod
    def from_toml(definition: str | PathLike[str], design: int | None = None) -> Skin: ...
    @staticmethod
    def all_from_toml(definition: str | PathLike[str]) -> list[Skin]: ...
    def to_toml(self) -> str: ...
    def replace(self, **parameters: Any) -> Skin: ...
    def solve(self, measures: Measures = "all") -> Result: ...
    def value_and_gradient(
        self, measure: str, keys: Iterable[str], at_kinks: AtKinks = None
    ) -> tuple[float, Floats]: ...
'''


MARK = "# Made from the list of parameters by `python -m squama._manual __init__.pyi`."


def stub(text):
    """Returns the text of ``__init__.pyi``; the part after the mark is generated."""
    all_of = [(key, _type(expected), default) for key, *_, expected, default in parameters()]
    geometry = {key for key, section, *_ in parameters() if section == "designs"}
    # Lengths are optional, because the same length may be given in mm.
    required = {key for key in geometry if not key.endswith(("_over_t", "_mm"))}
    given = [f"        {key}: {of}{'' if key in required else ' | None = None'}," for key, of, _ in all_of]
    given += [f"        {key}: str | None = None," for key, *_ in named()]
    # A parameter without a default is an attribute that may be None.
    attributes = [f"    @property\n    def {key}(self) -> {of}{'' if default or key in geometry and not key.endswith('_mm') else ' | None'}: ..."
                  for key, of, default in all_of]
    return text.split(MARK)[0] + MARK + "\n" + _SKIN.format(
        parameters="\n".join(given),
        attributes="\n".join(attributes),
    )


if __name__ == "__main__":
    import sys
    from pathlib import Path

    file = Path(sys.argv[1])
    file.write_text(stub(file.read_text()))
