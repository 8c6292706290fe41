"""Tables: columns of numbers and texts."""

from collections.abc import Mapping
from difflib import get_close_matches
from html import escape

import numpy as np

from . import _squama


def find(known, name, what, given=()):
    """Returns ``known[name]``; the error suggests a similar name, or names the material keys that are not ``given``."""
    try:
        return known[name]
    except KeyError:
        # Tables have lengths divided by the thickness, even if the skin was given in mm.
        over_t = str(name).removesuffix("_mm") + "_over_t"
        if over_t not in known and any(name == column for column, *_ in _squama.columns()):
            needed = " and ".join(key for key in _squama.needs(name) if key not in given) or "other parameters or measures"
            raise KeyError(f"this skin has no {what} {name}: it needs {needed}") from None
        near = [f"{over_t}, times thickness_mm"] if over_t in known else get_close_matches(str(name), known, 1)
        raise KeyError(f"there is no {what} {name}" + (f"; did you mean {near[0]}?" if near else "")) from None


class Table(Mapping):
    """Columns by name: numbers as arrays of ``float`` (a value that does not exist is NaN), texts as arrays of ``str``.

    ``table["coverage"]`` is a column, ``table.units`` and ``table.meanings`` describe it, ``table.row(0)`` is a row as a
    dict, ``table.to_pandas()`` a data frame. ``polars.DataFrame(table)``, ``pyarrow.table(table)`` and other consumers of
    Arrow streams read it through ``__arrow_c_stream__``, without pyarrow; NaN becomes null.
    """

    def __init__(self, columns):
        self._columns, self.units, self.meanings = {}, {}, {}
        for name, unit, meaning, cells in columns:
            is_number = isinstance(cells, (bytes, bytearray))
            self._columns[name] = np.frombuffer(bytearray(cells)) if is_number else np.array(cells, dtype=object)
            self.units[name], self.meanings[name] = unit, meaning

    def __getitem__(self, name):
        return find(self._columns, name, "column")

    def __iter__(self):
        return iter(self._columns)

    def __len__(self):
        return len(self._columns)

    @property
    def rows(self):
        """The number of rows."""
        return len(next(iter(self._columns.values()), ()))

    def row(self, index):
        """Returns a row as a dict."""
        return {name: column[index] for name, column in self._columns.items()}

    def to_pandas(self):
        """Returns the table as a ``pandas.DataFrame``."""
        import pandas

        return pandas.DataFrame(dict(self._columns))

    def __arrow_c_stream__(self, requested_schema=None):
        of = lambda column: column.tobytes() if column.dtype == float else [c if c is None else str(c) for c in column]  # noqa: E731
        return _squama.arrow([(name, of(column)) for name, column in self._columns.items()])

    def __repr__(self):
        return f"<{type(self).__name__} of {self.rows} rows: {', '.join(self._columns)}>"

    def _repr_html_(self):
        names, shown = list(self._columns), min(self.rows, 10)
        head = "".join(f"<th title='{escape(self.meanings[n], True)}'>{escape(n)}</th>" for n in names)
        lines = ("".join(f"<td>{escape(_text(self[n][k]))}</td>" for n in names) for k in range(shown))
        body = "".join(f"<tr>{line}</tr>" for line in lines)
        more = f"<p>{self.rows} rows</p>" if self.rows > shown else ""
        return f"<table><tr>{head}</tr>{body}</table>{more}"


def _text(cell):
    if cell is None or cell != cell:
        return ""
    return f"{cell:.6g}" if isinstance(cell, float) else str(cell)
