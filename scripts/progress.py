"""A line on standard error that tells how far a script is, where somebody watches."""

import sys
import time

# Work that is over sooner is not told of, s.
QUIET = 2.0


class Progress:
    """Tells how many of `what` are done, on a terminal only. `count` is how many there will be, if that is known."""

    def __init__(self, what, count=None):
        self.what, self.count, self.done = what, count, 0
        self.began, self.shown = time.monotonic(), False

    def step(self):
        self.done += 1
        took = time.monotonic() - self.began
        if took < QUIET or not sys.stderr.isatty():
            return
        of, left = "", ""
        if self.count is not None:
            of, left = f" of {self.count}", f", {took / self.done * (self.count - self.done):.0f} s left"
        print(f"{self.done}{of} {self.what}, {took:.0f} s{left}   ", end="\r", file=sys.stderr, flush=True)
        self.shown = True

    def end(self):
        """Leaves the line to what comes next."""
        if self.shown:
            print("\r\033[K", end="", file=sys.stderr, flush=True)
            self.shown = False
