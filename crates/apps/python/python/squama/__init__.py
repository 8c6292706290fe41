"""squama: the mechanics of flexible armour, hard scales on a soft skin, with exact derivatives.

>>> import squama
>>> skin = squama.Skin(gap_over_t=0.1, length_over_t=0.3, slant_deg=60)
>>> result = skin.solve()
>>> round(result["critical_force"], 4)
1.4478

`Skin` is a design, `Skin.solve` returns a `Result`, `solve_many` a `Table`; `Skin.value_and_gradient` and `function`
are for optimisers. `run`, `read`, `optimise` and `tolerance` work on results folders, like the commands of these names.
``help(squama.Skin)`` lists every parameter and every measure.
"""

from . import _gradient, _manual, _skin
from ._errors import CheckWarning, Failed, FoldWarning, InvalidDefinition, InvalidParameter, KinkWarning
from ._gradient import function
from ._result import Result
from ._squama import Skin, __version__
from ._study import Run, optimise, read, run, solve_many, tolerance
from ._table import Table

__all__ = [
    "CheckWarning", "Failed", "FoldWarning", "InvalidDefinition", "InvalidParameter", "KinkWarning", "Result", "Run", "Skin", "Table", "__version__",
    "function", "optimise", "read", "run", "solve_many", "tolerance",
]  # fmt: skip

Skin.value_and_gradient = _gradient.value_and_gradient
Skin.__doc__ = _manual.skin()
Skin.__signature__ = _manual.signature()
Skin.replace = _skin.replace
Skin.from_toml = staticmethod(_skin.from_toml)
Skin.all_from_toml = staticmethod(_skin.all_from_toml)
Skin.__reduce__ = lambda self: (_skin.made, (self.parameters,))
