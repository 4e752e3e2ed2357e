"""Work-precision diagrams: error against CPU time, one picture a problem."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

# what a picture is about: problem, what tells its variants apart, and the error it shows with its unit
VARIANTS = {"P1": "a", "P4": "omega", "W": "omega"}
ERRORS = {
    "P1": "tip error / length",
    "P2": "tip error / amplitude",
    "P3": "error of the force ratio",
    "P4": "error of the drawn-in length",
    "W": "bulge error, rms, m",
}
METHODS = ("coilwind", "coilwind, explicit", "exudyn", "mujoco", "pyelastica")
MARKS = dict(zip(METHODS, ("o-", "s--", "^-", "v-", "D-")))
COLOURS = dict(zip(METHODS, ("C0", "C9", "C1", "C2", "C3")))


def method(line):
    """Who computed a line and how."""
    if line["peer"] == "coilwind" and line["integrator"] != "implicit":
        return "coilwind, explicit"
    return line["peer"]


def variants(lines, problem):
    """Values of what tells a problem's variants apart, with their lines."""
    chosen = [line for line in lines if line["problem"] == problem]
    key = VARIANTS.get(problem)
    values = sorted({line.get(key) for line in chosen}) if key else [None]
    return [(value, [line for line in chosen if key is None or line.get(key) == value]) for value in values]


def title(problem, value):
    """Name of a variant."""
    key = VARIANTS.get(problem)
    return problem if key is None else f"{problem}, a = {value:g}" if key == "a" else f"{problem}, {value:g} rad/s"


def setting(line):
    """What was asked of a method, in words."""
    words = [line["integrator"]] if "integrator" in line else []
    for name in ("a", "omega", "n", "points", "dt", "tol", "soft", "heavy"):
        value = line.get(name)
        if value is not None:
            words.append(f"{name} {value:.3g}" if isinstance(value, float) else f"{name} {value}")
    return ", ".join(words)


def draw(lines, folder):
    """Draws every problem that has lines; returns the files."""
    files = []
    for problem in ERRORS:
        panels = [(value, found) for value, found in variants(lines, problem) if any(line["error"] for line in found)]
        if not panels:
            continue
        figure, axes = plt.subplots(1, len(panels), figsize=(1.2 + 3.8 * len(panels), 3.8), sharey=True, squeeze=False)
        for axis, (value, found) in zip(axes[0], panels):
            for name in METHODS:
                own = [line for line in found if method(line) == name]
                points = sorted((line["cpu_s"], line["error"]) for line in own if line["error"])
                if points:
                    axis.loglog(*zip(*points), MARKS[name], color=COLOURS[name], label=name, markersize=5)
            axis.set_title(title(problem, value))
            axis.set_xlabel("CPU time, s")
            axis.grid(True, which="major", alpha=0.4)
            axis.legend(fontsize=8)
        axes[0][0].set_ylabel(ERRORS[problem])
        figure.tight_layout()
        path = folder / f"{problem.lower()}.png"
        figure.savefig(path, dpi=110)
        plt.close(figure)
        files.append(path)
    return files
