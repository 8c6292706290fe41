"""Batches of skins, and studies in results folders."""

import os
import shutil
import subprocess
import tempfile
import warnings

from . import _squama
from ._errors import CheckWarning, Failed
from ._progress import Bar
from ._table import Table


def solve_many(skins, measures="all", *, threads=None, progress=False):
    """Solves skins on all cores, and returns a `Table` with the columns of ``designs.csv``, one row per skin.

    Parameters in which the skins differ have columns too. A measure that failed is NaN; ``puncture_status`` and
    ``flexure_status`` state the reason. Ctrl-C discards the results; use `run` to keep them.
    """
    with Bar(progress) as tell:
        skins = [skins] if isinstance(skins, _squama.Skin) else list(skins)
        return Table(_squama.solve_many(skins, measures, threads, tell))


class Run(Table):
    """The designs of a results folder, a `Table` with the columns of ``designs.csv``."""

    def __init__(self, folder):
        self.folder = os.fspath(folder)
        # `optimise` replaces these values.
        self.skin, self.failed_checks = None, []
        known = {name: (unit, meaning) for name, unit, meaning in _squama.columns()}
        known.update({key: (unit, meaning) for key, _, unit, meaning, _, _ in _squama.parameters()})
        columns = ((name, *known.get(name, ("-", "")), cells) for name, cells in _squama.read(folder))
        super().__init__(columns)

    def rank(self, require=(), maximize=(), minimize=(), weights=None):
        """Ranks the designs that meet the requirements, such as ``"coverage >= 0.6"``, by fitness; returns a `Table`.

        The default criteria are the four of the paper; ``maximize`` and ``minimize`` name other columns. ``weights`` holds
        one weight for each criterion.
        """
        listed = lambda of: [of] if isinstance(of, str) else list(of)  # noqa: E731
        return Table(_squama.rank(self.folder, listed(require), listed(maximize), listed(minimize), weights))

    def report(self, out=None):
        """Writes one page with figures, ranking, table and drawings by ``squama report``, and returns its path.

        The command ``squama`` must be on the path, or in the environment variable ``SQUAMA``.
        """
        command = os.environ.get("SQUAMA") or shutil.which("squama")
        if command is None:
            raise Failed("report", "the command squama is not on the path; install it with cargo install --path crates/apps/cli")
        out = os.path.join(self.folder, "report.html") if out is None else os.fspath(out)
        done = subprocess.run([command, "report", self.folder, "--out", out], capture_output=True, text=True)
        if done.returncode:
            raise Failed("report", done.stderr.strip())
        return out


def read(folder):
    """Reads and verifies the designs in a results folder that ``run`` or ``optimise`` has written."""
    return Run(folder)


def run(definition, out=None, *, set=None, resume=False, fresh=False, threads=None, progress=False):
    """Solves every design of a definition (a path, a text in TOML or a `Skin`), and returns a `Run`, as ``squama run``.

    The folder ``out`` defaults to ``results/NAME``; ``set={"puncture.scales": 41}`` overrides keys of the definition.
    Ctrl-C keeps the solved designs, ``resume=True`` continues, and ``fresh=True`` discards earlier results.
    """
    with Bar(progress) as tell:
        return Run(_squama.run(definition, dict(out=out, set=set, resume=resume, fresh=fresh, threads=threads, progress=tell)))


def optimise(goal, out=None, *, set=None, resume=False, fresh=False, threads=None, progress=False):
    """Searches for the optimum of a goal, or its Pareto front, as ``squama optimise``.

    Returns a `Run` of the best designs; for a single objective, its ``skin`` is the best design. The
    search warns of each requirement that full coupling, another load position or new samples
    contradict (`squama.CheckWarning`), and lists these warnings in ``failed_checks``. Raises
    `squama.Failed` if no design meets the constraints.
    """
    with Bar(progress) as tell:
        keywords = dict(out=out, set=set, resume=resume, fresh=fresh, threads=threads, progress=tell)
        folder, best, failed_checks = _squama.optimise(goal, keywords)
    found = Run(folder)
    found.skin = best and _squama.Skin.from_toml(best)
    found.failed_checks = failed_checks
    for check in failed_checks:
        warnings.warn(CheckWarning(check), stacklevel=2)
    return found


def tolerance(definition, *, set=None, require=(), samples=1000, out=None, threads=None, progress=False):
    """Predicts the effect of manufacturing tolerances, and the yield, as ``squama tolerance``.

    ``definition`` is a path, a text in TOML or a `Skin`, with a section ``[tolerance]`` or
    ``set={"tolerance.gap_over_t": {"batch_sd": 0.02}}``. Returns a dict of tables: ``"tolerance"``, ``"sources"`` and
    ``"yield"``. The folder ``out`` keeps the samples, so that the same call continues from them.
    """
    require = [require] if isinstance(require, str) else list(require)
    with Bar(progress) as tell, tempfile.TemporaryDirectory() as temporary:
        keywords = dict(out=out or temporary, set=set, resume=False, fresh=False, threads=threads, progress=tell)
        tables = _squama.tolerance(definition, require, samples, keywords)
    return dict(zip(("tolerance", "sources", "yield"), map(Table, tables)))
