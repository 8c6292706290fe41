"""Gradients for optimisers."""

import warnings

import numpy as np

from . import _squama
from ._errors import FoldWarning, InvalidParameter, KinkWarning


AT_KINKS = {
    None: lambda left, right: float("nan"),
    "left": lambda left, right: left,
    "right": lambda left, right: right,
    "mean": lambda left, right: (left + right) / 2,
}


def _gradient(skin, measures, keys, at_kinks, level, warn_of_fold=True):
    if at_kinks not in AT_KINKS:
        raise InvalidParameter("at_kinks", at_kinks, 'None, "left", "right" or "mean"')
    values, rows = [], []
    gradients, fold = _squama.gradients(skin, measures, keys)
    if fold is not None and warn_of_fold:
        warnings.warn(FoldWarning(fold), stacklevel=level)
    for measure, (value, slopes) in zip(measures, gradients):
        row = []
        for key, (left, right, change) in zip(keys, slopes):
            left, right = (float("nan") if side is None else side for side in (left, right))
            if change is None and left == right:
                row.append(left)
            else:
                warnings.warn(KinkWarning(measure, key, left, right, change or "no derivative"), stacklevel=level)
                row.append(AT_KINKS[at_kinks](left, right))
        values.append(value)
        rows.append(row)
    return np.array(values), np.array(rows), fold


def value_and_gradient(self, measure, keys, at_kinks=None):
    """Returns a measure and its exact derivatives with respect to ``keys``, as a number and an array.

    ``measure`` is any column of numbers with derivatives, in physical units too (``"critical_force_N"``); keys are
    continuous parameters, or lengths in mm. At a kink there is no derivative: the gradient is NaN, and a
    `squama.KinkWarning` reports both one-sided derivatives. ``at_kinks`` replaces NaN by the derivative for a decrease
    of the parameter (``"left"``), for an increase (``"right"``), or their ``"mean"``; the warning remains. If the
    surface of the substrate folds before the path ends, a `squama.FoldWarning` reports the force at the fold. The model
    is not valid beyond the fold; ``"sound_force"`` is the force up to it. Raises `squama.Failed` if the measure has no
    value.
    """
    values, rows, _ = _gradient(self, [measure], list(keys), at_kinks, 3)
    return float(values[0]), rows[0]


class _Solution:
    """Caches the last point, so that value and gradient share one solution."""

    def __init__(self, skin, keys, measures, at_kinks):
        self.skin, self.keys, self.measures, self.at_kinks = skin, list(keys), measures, at_kinks
        self.x, self.found, self.has_folded = None, None, False

    def at(self, x):
        try:
            point = np.atleast_1d(np.asarray(x))
        except ValueError:
            # Lists of different lengths cannot be converted to an array.
            point = np.array(None)
        # Without this check, texts and bytes would be converted to numbers.
        if point.dtype.kind not in "iuf" or point.shape != (len(self.keys),):
            raise InvalidParameter("x", x, f"{len(self.keys)} numbers: {', '.join(self.keys)}")
        x = point.astype(float)
        if self.x is None or not np.array_equal(x, self.x):
            skin = self.skin.replace(**dict(zip(self.keys, x.tolist())))
            *self.found, fold = _gradient(skin, self.measures, self.keys, self.at_kinks, 4, not self.has_folded)
            # An optimiser visits many folded designs: one warning is enough.
            self.has_folded |= fold is not None
            self.x = x.copy()
        return self.found


def function(skin, keys, measures, at_kinks=None):
    """Returns functions ``f`` and ``jac`` of the values of ``keys``, for ``scipy.optimize``.

    All other parameters have their values in ``skin``. For one measure (a text), ``f(x)`` is a number and ``jac(x)`` an
    array of shape ``(len(keys),)``; for a list of ``m`` measures, the shapes are ``(m,)`` and ``(m, len(keys))``. Calls of
    ``f`` and ``jac`` at the same point share one solution. Kinks and failures are handled as in
    ``Skin.value_and_gradient``; set ``at_kinks``, because most optimisers fail on NaN. A point out of bounds raises
    `squama.InvalidParameter`.
    """
    is_one = isinstance(measures, str)
    solution = _Solution(skin, keys, [measures] if is_one else list(measures), at_kinks)

    def f(x):
        values, _ = solution.at(x)
        return float(values[0]) if is_one else values.copy()

    def jac(x):
        _, rows = solution.at(x)
        return (rows[0] if is_one else rows).copy()

    return f, jac
