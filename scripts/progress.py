"""A line on standard error that tells how far a script is, where somebody watches."""

import sys
import time

# Work that is over sooner is not told of, s.
QUIET = 2.0


class Progress:
    """Tells how many of `what` are done, `before` of them earlier. `count` is how many there will be, if that is known.

    Where nobody watches it tells nothing, or with `logged` a line for each; that of the last stays.
    """

    def __init__(self, what, count=None, before=0, logged=False):
        self.what, self.count, self.before, self.done, self.logged = what, count, before, before, logged
        self.began, self.shown = time.monotonic(), False

    def step(self):
        self.done += 1
        took = time.monotonic() - self.began
        watched = sys.stderr.isatty()
        if not self.logged and (took < QUIET or not watched):
            return
        of, left = "", ""
        if self.count is not None:
            of, left = f" of {self.count}", f", {took / (self.done - self.before) * (self.count - self.done):.0f} s left"
        stays = self.logged and (not watched or self.done == self.count)
        end = "\n" if stays else "\r"
        print(f"{self.done}{of} {self.what}, {took:.0f} s{left}   ", end=end, file=sys.stderr, flush=True)
        self.shown = not stays

    def end(self):
        """Leaves the line to what comes next."""
        if self.shown:
            print("\r\033[K", end="", file=sys.stderr, flush=True)
            self.shown = False
