#!/usr/bin/env python3
"""Fig. 8 through the FMU: two turns side by side at four speeds, two runs at a time.

Leaves a directory per speed and, over them, the verdict table (verdicts.csv, verdicts.md), curves,
sections and index.html. Ctrl-C ends the runs early and reports on what they have wound.
"""

import argparse
import os
import signal
import subprocess
import sys
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path

from runs import open_run
from signals import duration

SCRIPTS = Path(__file__).resolve().parent
SPEEDS = (30.0, 100.0, 300.0, 500.0)
TELL_S = 5.0
"""Wall time between lines, s."""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmu", type=Path, default=Path("target/fmu/CoilWinding.fmu"))
    parser.add_argument("--command", type=Path, default=Path("target/release/coilwind"))
    parser.add_argument("--out", type=Path, default=Path("target/demo"))
    parser.add_argument("--turns", type=float, default=2.5, help="turns of the spindle (2.5)")
    parser.add_argument(
        "--speeds", type=float, nargs="+", default=SPEEDS, metavar="RAD/S", help="spindle speeds"
    )
    parser.add_argument("--no-bobbin", dest="bobbin", action="store_false", help="leave out the bobbin with four layers")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time (2)")
    arguments = parser.parse_args()
    if arguments.turns <= 0 or arguments.jobs < 1 or min(arguments.speeds) <= 0:
        parser.error("turns, speeds and jobs must be above 0")

    # A step costs the same at every speed, so the slowest takes longest.
    runs = [Run(speed, arguments) for speed in sorted(set(arguments.speeds))]
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    began, interrupted = time.monotonic(), False
    try:
        wind(runs, arguments.jobs, began)
    except KeyboardInterrupt:
        interrupted = True
        print("stopping: the runs write what they have", flush=True)
        # The terminal has told them already; the runs take a second signal as the first.
        for run in runs:
            run.stop()
        for run in runs:
            run.wait()
    started = sum(run.process is not None for run in runs)
    print(f"\n{started} of {len(runs)} runs in {clock(time.monotonic() - began)}\n", flush=True)

    report(arguments, runs, with_more=not interrupted)
    failed = [run for run in runs if run.failed]
    for run in failed:
        print(f"{run.label} failed: {run.reason()}", file=sys.stderr)
    sys.exit(130 if interrupted else 1 if failed else 0)


def wind(runs, jobs, began):
    """Starts the runs in their order, `jobs` at a time, and tells how far they are."""
    waiting = list(runs)
    told = began
    while any(not run.over for run in runs):
        active = [run for run in runs if run.active]
        while waiting and len(active) < jobs:
            run = waiting.pop(0)
            run.start()
            active.append(run)
        time.sleep(0.1)
        for run in active:
            if run.over:
                print(f"{run.label}: {run.ending()}", flush=True)
                told = time.monotonic()
        if time.monotonic() - told >= TELL_S:
            told = time.monotonic()
            tell(runs, jobs, told - began)


def tell(runs, jobs, elapsed):
    """One line: each active run, and the time that is left."""
    parts = [
        f"{run.label} {run.turns:.2f} of {run.total:g} turns, {clock(run.left())} left"
        for run in runs
        if run.active
    ]
    known = [run for run in runs if run.share > 0]
    everything = "?"
    if known:
        # Wall time per simulated time is about the same for all.
        rate = sum(run.elapsed for run in known) / sum(run.share * run.simulated for run in known)
        rest = [(1 - run.share) * run.simulated * rate for run in runs if not run.over]
        everything = clock(max(max(rest, default=0), sum(rest) / jobs))
    print(f"{clock(elapsed)}  {';  '.join(parts)};  in all {everything} left", flush=True)


def wound(command, folder, scene, **settings):
    """Whether the command has wound a packed scene into a folder."""
    sets = [word for name, value in settings.items() for word in ("--set", f"spindle.{name}={value:g}")]
    done = subprocess.run([command, "run", scene, *sets, "--out", folder, "--quiet", "--force"])
    return done.returncode == 0


def more_coils(command, arguments, runs):
    """Title and folder of what the command winds: half the traverse at each speed, and a whole coil."""
    print("winding fig8_gap, with half the traverse", flush=True)
    for run in runs:
        folder = arguments.out / "fig8_gap" / f"{run.speed:g}"
        if wound(command, folder, "fig8_gap", speed=run.speed, turns=arguments.turns):
            yield f"Half the traverse, {run.label}", folder
    if arguments.bobbin:
        print("winding a bobbin with four layers, about half a minute", flush=True)
        folder = arguments.out / "bobbin"
        if wound(command, folder, "bobbin"):
            yield "A bobbin with four layers", folder
    print(flush=True)


def report(arguments, runs, with_more):
    """Table, figures and page of the runs that left something; one failing keeps none back."""
    command, out, directories = arguments.command, arguments.out, [run.directory for run in runs]
    usable = [str(path) for path in directories if (path / "summary.json").exists()]
    if not usable:
        print("no run left results", file=sys.stderr)
        return
    settled = [path for path in usable if has_rows(Path(path) / "stations.csv")]
    script("verdicts.py", out)
    script("plot_tension.py", *usable, "-o", out / "tension.png")
    if settled:
        script("section_plot.py", *settled, "-o", out / "sections.png")
    for path in usable:
        if subprocess.run([command, "report", path]).returncode != 0:
            print(f"no report of {path}", file=sys.stderr)
    # after the verdicts, which compare second turns
    coils = more_coils(command, arguments, runs) if with_more else []
    script("report.py", out, *(word for title, folder in coils for word in ("--more", f"{title}={folder}")))


def script(name, *arguments):
    command = [sys.executable, SCRIPTS / name, *arguments]
    result = subprocess.run(command)
    if result.returncode != 0:
        print(f"{name} failed", file=sys.stderr)
    sys.stdout.flush()


def has_rows(path):
    try:
        with open(path, encoding="utf-8") as file:
            return sum(1 for _, line in zip(range(2), file)) == 2
    except OSError:
        return False


def clock(seconds):
    """Minutes and seconds."""
    return "?" if seconds is None else f"{int(seconds) // 60}:{int(seconds) % 60:02d}"


@dataclass
class Run:
    """One speed, in a process of its own."""

    speed: float
    arguments: argparse.Namespace
    process: subprocess.Popen = None
    share: float = 0.0
    """simulated so far, as a share of the whole"""
    turns: float = 0.0
    """of the spindle"""
    elapsed: float = 0.0
    """wall time at the last sign of life, s"""
    reader: threading.Thread = field(default=None, repr=False)

    @property
    def label(self):
        return f"{self.speed:g} rad/s"

    @property
    def total(self):
        return self.arguments.turns

    @property
    def directory(self):
        return self.arguments.out / f"{self.speed:g}"

    @property
    def simulated(self):
        return duration(self.speed, self.total)

    @property
    def active(self):
        return self.process is not None and self.process.poll() is None

    @property
    def over(self):
        return self.process is not None and self.process.poll() is not None

    @property
    def failed(self):
        return self.over and self.process.returncode not in (0, 130)

    def start(self):
        self.directory.mkdir(parents=True, exist_ok=True)
        command = [
            sys.executable, SCRIPTS / "wind.py", "--fmu", self.arguments.fmu,
            "--speed", repr(self.speed), "--turns", repr(self.total), "--out", self.directory,
        ]
        with open(self.directory / "log.txt", "w", encoding="utf-8") as log:
            self.process = subprocess.Popen(
                command, stdout=subprocess.PIPE, stderr=log, text=True, encoding="utf-8"
            )
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()
        print(f"{self.label}: started", flush=True)

    def read(self):
        """Takes in the lines of the process as they come."""
        for line in self.process.stdout:
            try:
                self.share, self.turns, self.elapsed = (float(word) for word in line.split())
            except ValueError:
                # Something else that wants to be seen; fmpy also names every input that keeps its start value.
                if not line.startswith("Warning: missing input"):
                    print(f"{self.label}: {line.rstrip()}", flush=True)

    def left(self):
        """Estimate of the wall time left, s."""
        return self.elapsed * (1 - self.share) / self.share if self.share > 0 else None

    def stop(self):
        if self.active:
            self.process.send_signal(signal.SIGINT if os.name == "posix" else signal.SIGTERM)

    def wait(self):
        if self.process is None:
            return
        try:
            self.process.wait(timeout=60)
        except subprocess.TimeoutExpired:
            self.process.kill()

    def ending(self):
        """How it went, in words."""
        if self.failed:
            return f"failed, see {self.directory / 'log.txt'}"
        run = open_run(self.directory)
        wall, factor = run.summary.get("wall_s", 0.0), run.summary.get("real_time_factor", 0.0)
        verdict = run.turn(2).get("verdict", "turn 2 not at rest")
        return f"{run.ending}, {verdict}; computed for {wall:.1f} s, real-time factor {factor:.2f}"

    def reason(self):
        lines = (self.directory / "log.txt").read_text(encoding="utf-8").splitlines()
        return lines[-1] if lines else f"exit code {self.process.returncode}"


if __name__ == "__main__":
    main()
