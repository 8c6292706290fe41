"""A progress bar for terminals and notebooks."""

import sys
import time


class Bar:
    """A progress bar on standard error, if ``progress`` is true.

    ``progress`` may also be a function, which is called with the completed fraction and a text instead.
    """

    def __init__(self, progress):
        self.tell = progress if callable(progress) else self.show if progress else None
        self.begun, self.width = time.monotonic(), 0

    def show(self, share, words):
        left = (time.monotonic() - self.begun) * (1 - share) / share if share > 0 else 0
        line = f"[{'#' * int(30 * share):30}] {100 * share:3.0f} %  {words}" + (f"  {left:.0f} s left" if left else "")
        sys.stderr.write("\r" + line.ljust(self.width))
        sys.stderr.flush()
        self.width = len(line)

    def __enter__(self):
        return self.tell

    def __exit__(self, *_):
        if self.width:
            sys.stderr.write("\r" + " " * self.width + "\r")
            sys.stderr.flush()
