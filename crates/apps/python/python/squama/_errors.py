"""Exceptions and warnings of the package. They can be pickled, because their arguments define them."""


class InvalidParameter(ValueError):
    """A parameter has an invalid value.

    ``key`` is the parameter, ``value`` the given value (``None`` if it is missing), ``expected`` a description of valid values.
    """

    def __init__(self, key, value, expected):
        super().__init__(key, value, expected)
        self.key, self.value, self.expected = key, value, expected

    def __str__(self):
        found = "is missing" if self.value is None else f"{_shown(self.value)} is not accepted"
        return "\n".join([f"{self.key}: {found}, expected {self.expected}", *self.others])

    @property
    def others(self):
        """Further problems, one line for each."""
        return self.__dict__.get("_others", [])

    def add(self, line):
        """Adds a further problem."""
        self.__dict__.setdefault("_others", []).append(line)


def _shown(value):
    """Returns a short text of ``value`` for a message: its type if ``repr`` fails, as for a deeply nested list."""
    try:
        text = repr(value)
    except Exception:  # noqa: BLE001
        return f"a value of type {type(value).__name__}"
    return text if len(text) <= 200 else f"{text[:200]}…"


class InvalidDefinition(ValueError):
    """A definition is not valid TOML, or cannot be read."""


class Failed(RuntimeError):
    """A requested result has no value: ``what`` is its name, ``reason`` is the reason."""

    def __init__(self, what, reason):
        super().__init__(what, reason)
        self.what, self.reason = what, reason

    def __str__(self):
        return f"{self.what}: {self.reason}"


class KinkWarning(UserWarning):
    """A measure has a kink: its derivatives for a decrease (``left``) and an increase (``right``) of a parameter differ.

    ``warnings.simplefilter("error", squama.KinkWarning)`` turns the warning into an error. A derivative is NaN if the
    measure has no value on its side. ``change`` names the event at the kink. ``at_kinks`` selects the value in the
    gradient.
    """

    def __init__(self, measure, key, left, right, change):
        super().__init__(measure, key, left, right, change)
        self.measure, self.key, self.left, self.right, self.change = measure, key, left, right, change

    def __str__(self):
        return (
            f"{self.measure} has a kink ({self.change}): its derivative with respect to {self.key} is {self.left:.6g} "
            f"for a decrease and {self.right:.6g} for an increase; at_kinks=\"left\", \"right\" or \"mean\" selects one"
        )


class CheckWarning(UserWarning):
    """A finer model contradicts a requirement that the best design of a search meets."""


class FoldWarning(UserWarning):
    """The surface of the substrate folds at ``fold_force``, before the path ends. Beyond it the model is not valid.

    Optimise ``"sound_force"`` in place of ``"critical_force"``: it is the largest valid force, up to the fold.
    """

    def __init__(self, fold_force):
        super().__init__(fold_force)
        self.fold_force = fold_force

    def __str__(self):
        return f"the surface folds at fold_force {self.fold_force:.6g}, beyond which the model is not valid: use sound_force"
