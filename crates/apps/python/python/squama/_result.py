"""Results of solving a skin."""

from functools import cached_property
from html import escape

from . import _squama
from ._errors import Failed
from ._table import Table, find

_TABLES = (
    *("path", "events", "scales", "steps", "way_back", "places"),
    *("flexure_path", "flexure_events", "flexure_scales", "flexure_steps", "flexure_way_back", "sensitivity"),
)


class Result:
    """A solved skin: ``result["critical_force"]`` is a measure, by the name of its column in ``designs.csv``.

    A measure that does not exist for this skin (``fold_force`` if nothing folds) is NaN. A measure that could not be
    computed, because its path stopped early, raises `squama.Failed`; ``get`` returns a default instead.

    ==================  ==========================================================================================
    ``skin``            the skin
    ``status``          ``"complete"``, or the reason why a measure has no value
    ``warnings``        texts on failures, limits of the model, curved bodies and printing, as the commands print them
    ``values``          all measures as a dict, ``None`` for a missing value; ``units`` and ``meanings`` likewise
    ``path``            puncture: displacement, force, tilt … at every equilibrium, as a `Table`
    ``events``          puncture: contacts that open, close and slide, folds and snaps
    ``scales``          puncture: displacement and rotation of every scale at the end
    ``steps``           puncture: Newton iterations
    ``way_back``        puncture: the unloading path, if ``puncture.unload`` is set
    ``places``          puncture: the force at every load position, if ``puncture.places`` has several
    ``flexure_path``    bending: curvature, moment, stiffness …; ``flexure_events``, ``flexure_scales``,
                        ``flexure_steps``, ``flexure_way_back`` as above
    ``sensitivity``     derivatives of every measure, if ``measures`` has ``"sensitivity"``
    ==================  ==========================================================================================
    """

    def __init__(self, skin, solved):
        self.skin, self._solved = skin, solved

    # Each property copies its values from the solver on first access. Pickling accesses all of
    # them.
    @cached_property
    def _tables(self):
        return self._solved.tables()

    @cached_property
    def _values(self):
        return self._solved.values()

    @cached_property
    def _failures(self):
        return self._solved.failures()

    @cached_property
    def _warnings(self):
        return self._solved.warnings()

    @property
    def status(self):
        return self._failures[0][1] if self._failures else "complete"

    @property
    def warnings(self):
        return [f"{measure}: {meaning}" for measure, _, meaning in self._failures] + self._warnings

    def answer(self, require=()):
        """Returns requirements, such as ``"coverage >= 0.6"``, with value, limit and margin, and every warning.

        The answer is a dict with ``"requirements"``, a list of dicts, and ``"warnings"``, as ``squama design`` prints them.
        The skin is solved again with gaps 10 % smaller and larger, to warn of measures that are sensitive to the gap.
        """
        require = [require] if isinstance(require, str) else list(require)
        solved = self._solved if self._solved is not None else self.skin.solve()._solved
        rows, warnings = solved.answer(require)
        named = [dict(zip(("requirement", "value", "limit", "margin"), row)) for row in rows]
        return {"requirements": named, "warnings": warnings}

    @property
    def values(self):
        return {name: value for name, _, _, value, _ in self._values}

    @property
    def units(self):
        return {name: unit for name, unit, *_ in self._values}

    @property
    def meanings(self):
        return {name: meaning for name, _, meaning, *_ in self._values}

    @cached_property
    def _by_name(self):
        return {name: (value, reason) for name, _, _, value, reason in self._values}

    def __getitem__(self, name):
        value, reason = find(self._by_name, name, "measure", self.skin.parameters)
        if value is not None:
            return value
        if reason is not None:
            raise Failed(name, reason)
        return float("nan")

    def keys(self):
        """The names of all measures."""
        return list(self._by_name)

    def get(self, name, default=float("nan")):
        """Returns a measure, or ``default`` if it could not be computed."""
        try:
            return self[name]
        except Failed:
            return default

    def __getstate__(self):
        for name in ("_values", "_failures", "_tables", "_warnings"):
            getattr(self, name)
        return {**self.__dict__, "_solved": None}

    def __repr__(self):
        values = self.values
        known = ", ".join(f"{name}={values[name]:.6g}" for name in _squama.CRITERIA if values[name] is not None)
        return f"<Result of {self.skin}: {self.status}; {known}>"

    def _repr_html_(self):
        shown = [(n, v, u, m) for n, u, m, v, _ in self._values if v is not None]
        cell = lambda v: f"{v:.6g}" if isinstance(v, float) else str(v)  # noqa: E731
        rows = (
            f"<tr><th>{n}</th><td>{cell(v)}</td><td>{escape(u)}</td><td>{escape(m)}</td></tr>" for n, v, u, m in shown
        )
        return f"<p>{escape(self.status)}</p><table>{''.join(rows)}</table>"

    def plot(self, axes=None):
        """Draws force against displacement and, if it was solved, moment against curvature; returns the axes."""
        import matplotlib.pyplot as plt

        puncture = (self.path, self.way_back, "displacement", "force", self.events)
        bending = (self.flexure_path, self.flexure_way_back, "curvature", "moment", self.flexure_events)
        curves = [curve for curve in (puncture, bending) if len(curve[0])]
        if axes is None:
            _, axes = plt.subplots(1, len(curves), squeeze=False, figsize=(5 * len(curves), 3.6), layout="constrained")
            axes = axes[0]
        for ax, (path, back, x, y, events) in zip(axes, curves):
            (line,) = ax.plot(path[x], path[y])
            if len(back):
                ax.plot(back[x], back[y], "--", color=line.get_color())
            ax.plot(events[x], events[y], "o", markersize=3)
            ax.set(xlabel=f"{x} ({path.units[x]})", ylabel=f"{y} ({path.units[y]})")
        return axes


def _table(name):
    table = cached_property(lambda self: Table(self._tables.get(name, [])))
    table.__set_name__(Result, name)
    return table


for _name in _TABLES:
    setattr(Result, _name, _table(_name))
