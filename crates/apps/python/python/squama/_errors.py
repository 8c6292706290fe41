"""Exceptions and warnings of the package. All pickle: their arguments are all that they hold."""


class InvalidParameter(ValueError):
    """A parameter has a value that it does not take.

    ``key`` is the parameter, ``value`` what was given (``None`` if it is missing), ``expected`` what would be right.
    """

    def __init__(self, key, value, expected):
        super().__init__(key, value, expected)
        self.key, self.value, self.expected = key, value, expected

    def __str__(self):
        found = "is missing" if self.value is None else f"{self.value!r} is not accepted"
        return "\n".join([f"{self.key}: {found}, expected {self.expected}", *self.others])

    @property
    def others(self):
        """What else is wrong, a line each."""
        return self.__dict__.get("_others", [])

    def add(self, line):
        """Tells of something else that is wrong."""
        self.__dict__.setdefault("_others", []).append(line)


class InvalidDefinition(ValueError):
    """A definition that is no TOML, or cannot be read."""


class Failed(RuntimeError):
    """Something that was asked for has no value: ``what``, and the ``reason``."""

    def __init__(self, what, reason):
        super().__init__(what, reason)
        self.what, self.reason = what, reason

    def __str__(self):
        return f"{self.what}: {self.reason}"


class KinkWarning(UserWarning):
    """A measure has two derivatives by a parameter: where it decreases (``left``) and where it increases (``right``).

    ``warnings.simplefilter("error", squama.KinkWarning)`` makes an error of it. A side on which the measure does not
    exist is NaN. ``change`` says what happens there. The gradient holds what ``at_kinks`` chooses.
    """

    def __init__(self, measure, key, left, right, change):
        super().__init__(measure, key, left, right, change)
        self.measure, self.key, self.left, self.right, self.change = measure, key, left, right, change

    def __str__(self):
        return (
            f"{self.measure} has a kink ({self.change}): its derivative by {self.key} is {self.left:.6g} where that "
            f"decreases and {self.right:.6g} where it increases"
        )
