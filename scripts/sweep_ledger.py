"""The folder of a sweep: what the sweep is, and rows of the runs that ended, so that a stopped sweep goes on."""

import csv
import io
import json
import time

import folder as folders
from failure import Mistake

PLAN, ROWS, TIMES = "sweep.json", "sweep.csv", "times.csv"
# Time between two writes of the rows, s.
EVERY = 0.5
TIMED = ["run", "worker", "began", "wound_s"]


class Ledger:
    """Rows by the number of their run, in memory and on disk. `begin` is the first to write."""

    def __init__(self, folder, plan, header, keys, force):
        """`plan` is what makes a sweep the same, `keys` the first cells of every row in the order of the runs.

        Raises `Mistake` where the folder holds a run or another sweep, unless `force` says otherwise.
        """
        self.folder, self.plan, self.header, self.force = folder, plan, header, force
        self.runs = {tuple(map(str, key)): run for run, key in enumerate(keys)}
        self.rows, self.times, self.written, self.lock = {}, {}, 0.0, None
        self.kept = 0  # rows on disk
        folders.refuse_occupied(folder, force, "another sweep")
        if force:
            return
        if differs := self.difference():
            raise Mistake(f"{folder} holds another sweep ({differs}); add --force to overwrite it, or --out for another folder")
        self.read()

    def difference(self):
        """In which respect the folder holds another sweep, if it does."""
        path = self.folder / PLAN
        if not path.is_file():
            return f"without {PLAN}" if (self.folder / ROWS).exists() else None
        try:
            found = dict(json.loads(path.read_text(encoding="utf-8")))
        except ValueError:
            return f"its {PLAN} is not whole"
        names = [name for name in self.plan if self.plan[name] != found.get(name)]
        return f"another {', '.join(names)}" if names else None

    def read(self):
        """Takes the rows that are there."""
        path = self.folder / ROWS
        if not path.is_file():
            return
        width = len(next(iter(self.runs)))
        reason = self.header.index("reason")
        for line, row in enumerate(whole_rows(path, len(self.header)), 1):
            if line == 1 and row == self.header:
                continue
            run = self.runs.get(tuple(row[:width]))
            if line == 1 or run is None or len(row) != len(self.header):
                raise Mistake(f"{path}:{line}: no row of this sweep; remove the line, or begin again with --force")
            # Chance killed its workers; the numbers of a sweep do not depend on chance.
            if not row[reason].startswith("its worker died"):
                self.rows[run] = row
        self.kept = len(self.rows)
        if (self.folder / TIMES).is_file():
            for run, *cells in whole_rows(self.folder / TIMES, len(TIMED))[1:]:
                self.times[int(run)] = cells

    def begin(self):
        """Makes the folder, or takes it in hand again; a mistake where another sweep goes on in it."""
        folders.make(self.folder)
        path = self.folder / PLAN
        goes_on = path.is_file() and not self.force
        if path.is_file():
            self.hold(path)
        if not goes_on:
            folders.clear(self.folder)
            folders.write_whole(path, lambda partial: partial.write_text(json.dumps(self.plan, indent=1) + "\n", encoding="utf-8"))
            self.hold(path)

    def hold(self, path):
        try:
            import fcntl
        except ImportError:  # Windows
            return
        if self.lock:
            self.lock.close()
        self.lock = open(path, encoding="utf-8")
        try:
            fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise Mistake(f"{self.folder}: a sweep is going on here; wait for its end, or stop it first") from None
        except OSError:
            pass  # Not every file system has locks.

    def add(self, run, row, times):
        """Keeps a row; it is on disk soon."""
        self.rows[run], self.times[run] = [str(cell) for cell in row], times
        if time.monotonic() - self.written > EVERY:
            self.write()

    def write(self):
        """Writes what there is, in the order of the grid. A row on disk has its times there."""
        times = [[run, *self.times.get(run, ["", "", ""])] for run in sorted(self.rows)]
        self.table(TIMES, [TIMED, *times])
        self.table(ROWS, [self.header, *(self.rows[run] for run in sorted(self.rows))])
        self.written, self.kept = time.monotonic(), len(self.rows)

    def table(self, name, rows):
        def write(path):
            with open(path, "w", newline="", encoding="utf-8") as file:
                csv.writer(file, lineterminator="\n").writerows(rows)

        folders.write_whole(self.folder / name, write)

    def count(self, column, value, **others):
        """How many rows have this value in this column, and others in theirs."""
        places = [(self.header.index(name), wanted) for name, wanted in [(column, value), *others.items()]]
        return sum(all(row[place] == wanted for place, wanted in places) for row in self.rows.values())


def whole_rows(path, width):
    """Rows of a table but for a last one that a crash has cut: it has too few cells, or no end of its line."""
    # A cut may fall within a character.
    with open(path, newline="", encoding="utf-8", errors="replace") as file:
        text = file.read()
    rows = list(csv.reader(io.StringIO(text, newline="")))
    if rows and (not text.endswith("\n") or 1 < len(rows) and len(rows[-1]) < width):
        del rows[-1]
    return rows
