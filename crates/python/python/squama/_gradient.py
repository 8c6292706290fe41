"""Gradients for optimisers."""

import warnings

import numpy as np

from ._errors import KinkWarning


def _gradient(skin, measures, keys, level):
    values, rows = [], []
    for measure, (value, slopes) in zip(measures, skin._gradients(measures, keys)):
        row = []
        for key, (left, right, change) in zip(keys, slopes):
            left, right = (float("nan") if side is None else side for side in (left, right))
            if change is None and left == right:
                row.append(left)
            else:
                warnings.warn(KinkWarning(measure, key, left, right, change or "no derivative"), stacklevel=level)
                row.append((left + right) / 2)
        values.append(value)
        rows.append(row)
    return np.array(values), np.array(rows)


def value_and_gradient(self, measure, keys):
    """The value of a measure, and its exact derivatives by ``keys``, an array of that length.

    ``measure`` is any column of numbers with derivatives, in physical units too (``"critical_force_N"``); keys are
    continuous parameters, or lengths in mm. At a kink a `squama.KinkWarning` tells both one-sided derivatives, and the
    gradient holds their mean. Raises `squama.Failed` where the measure has no value.
    """
    values, rows = _gradient(self, [measure], list(keys), 3)
    return float(values[0]), rows[0]


class _Solution:
    """The last point at which a function was asked for, so that value and gradient are solved together."""

    def __init__(self, skin, keys, measures):
        self.skin, self.keys, self.measures = skin, list(keys), measures
        self.x, self.found = None, None

    def at(self, x):
        x = np.atleast_1d(np.asarray(x, dtype=float))
        if self.x is None or not np.array_equal(x, self.x):
            skin = self.skin.replace(**dict(zip(self.keys, x.tolist())))
            self.found = _gradient(skin, self.measures, self.keys, 4)
            self.x = x.copy()
        return self.found


def function(skin, keys, measures):
    """Functions ``f`` and ``jac`` of the values of ``keys``, as ``scipy.optimize`` takes them; the rest is as in ``skin``.

    Of one measure (a text) ``f(x)`` is a number and ``jac(x)`` an array of ``len(keys)``; of a list of ``m`` measures they
    are arrays of ``m`` and ``(m, len(keys))``. A point is solved once for both. Kinks and failures are as in
    ``Skin.value_and_gradient``; a point out of bounds raises `squama.InvalidParameter`.
    """
    is_one = isinstance(measures, str)
    solution = _Solution(skin, keys, [measures] if is_one else list(measures))

    def f(x):
        values, _ = solution.at(x)
        return float(values[0]) if is_one else values.copy()

    def jac(x):
        _, rows = solution.at(x)
        return (rows[0] if is_one else rows).copy()

    return f, jac
