"""Gradients for optimisers."""

import warnings

import numpy as np

from . import _squama
from ._errors import InvalidParameter, KinkWarning


AT_KINKS = {
    None: lambda left, right: float("nan"),
    "left": lambda left, right: left,
    "right": lambda left, right: right,
    "mean": lambda left, right: (left + right) / 2,
}


def _gradient(skin, measures, keys, at_kinks, level):
    if at_kinks not in AT_KINKS:
        raise InvalidParameter("at_kinks", at_kinks, 'None, "left", "right" or "mean"')
    values, rows = [], []
    for measure, (value, slopes) in zip(measures, _squama.gradients(skin, measures, keys)):
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
    return np.array(values), np.array(rows)


def value_and_gradient(self, measure, keys, at_kinks=None):
    """The value of a measure, and its exact derivatives by ``keys``, an array of that length.

    ``measure`` is any column of numbers with derivatives, in physical units too (``"critical_force_N"``); keys are
    continuous parameters, or lengths in mm. At a kink there is no derivative: the gradient is NaN there, and a
    `squama.KinkWarning` tells both one-sided ones. ``at_kinks`` chooses what stands in the gradient in place of NaN: the one
    where the parameter decreases (``"left"``), where it increases (``"right"``), or their ``"mean"``; the warning stays.
    Raises `squama.Failed` where the measure has no value.
    """
    values, rows = _gradient(self, [measure], list(keys), at_kinks, 3)
    return float(values[0]), rows[0]


class _Solution:
    """The last point at which a function was asked for, so that value and gradient are solved together."""

    def __init__(self, skin, keys, measures, at_kinks):
        self.skin, self.keys, self.measures, self.at_kinks = skin, list(keys), measures, at_kinks
        self.x, self.found = None, None

    def at(self, x):
        x = np.atleast_1d(np.asarray(x, dtype=float))
        if self.x is None or not np.array_equal(x, self.x):
            skin = self.skin.replace(**dict(zip(self.keys, x.tolist())))
            self.found = _gradient(skin, self.measures, self.keys, self.at_kinks, 4)
            self.x = x.copy()
        return self.found


def function(skin, keys, measures, at_kinks=None):
    """Functions ``f`` and ``jac`` of the values of ``keys``, as ``scipy.optimize`` takes them; the rest is as in ``skin``.

    Of one measure (a text) ``f(x)`` is a number and ``jac(x)`` an array of ``len(keys)``; of a list of ``m`` measures they
    are arrays of ``m`` and ``(m, len(keys))``. A point is solved once for both. Kinks (``at_kinks``: most optimisers want one of
    the sides, and none can do anything with NaN) and failures are as in ``Skin.value_and_gradient``; a point out of
    bounds raises `squama.InvalidParameter`.
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
