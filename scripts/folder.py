"""Folders of results: where what is built stands, what a folder holds, and files that are whole or absent."""

import json
import os
import shlex
from pathlib import Path

from failure import Mistake, Stuck

ROOT = Path(__file__).resolve().parents[1]
TARGET = Path(os.environ.get("CARGO_TARGET_DIR") or ROOT / "target")
COMMAND = Path(os.environ.get("COILWIND_COMMAND") or TARGET / "release/coilwind")
FMU = Path(os.environ.get("COILWIND_FMU") or TARGET / "fmu/CoilWinding.fmu")
# What builds them.
COMMAND_BUILD, FMU_BUILD = "cargo build --release", "scripts/build_fmu.sh"

# Options of a run that are no part of its scene, at the head of its file.
WITH = "# wound with:"
CHECKPOINT = "checkpoint.bin"
# How many members an ensemble has, and what it is until it has ended; as in src/cli/ensemble_files.rs.
ENSEMBLE = "ensemble.json"
# By what a folder is known, and which files belong to it; those of runs and sweeps as in src/cli/folder.rs.
SIGNS = {
    "another run": ["summary.json", "history.csv", "scene.toml", CHECKPOINT],
    "another sweep": ["sweep.json", "sweep.csv", "times.csv"],
    "an ensemble": [ENSEMBLE, "ensemble.bin"],
    "another calibration": ["calibration.json", "residuals.csv", "residuals.png"],
}
RESULTS = [
    "turns.csv", "stations.csv", "defects.csv", "coil.vtp", "coil.png", "core.vtp", "report.html", "compare.html", "frames.pvd",
    "ensemble.csv", "map.svg", "map.html", "find_max.json",
]


def need(path, build):
    """A mistake where `path` has not been built."""
    if not path.is_file():
        raise Mistake(f"{path} is missing; build it with {build}")


def refuse_occupied(folder, force, *allowed):
    """A mistake where the folder holds results, unless `force` says otherwise or they are `allowed`."""
    for holds, names in SIGNS.items():
        if not force and holds not in allowed and any(has(folder, name) for name in names):
            raise Mistake(f"{folder} holds {holds}; add --force to overwrite it, or --out for another folder")


def members(folder):
    """The folders of the members of the ensemble in a folder, made or not."""
    try:
        count = json.loads((folder / ENSEMBLE).read_text(encoding="utf-8"))["members"]
    except (OSError, ValueError, KeyError):
        count = 0
    return [folder / str(member) for member in range(1, count + 1)]


def has(folder, name):
    """Whether a folder has this file, with something in it."""
    path = folder / name
    return path.is_file() and path.stat().st_size > 0


def make(folder):
    """Makes the folder."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise Mistake(f"cannot write {folder}: {error.strerror}") from None


def clear(folder):
    """Removes the run, the sweep and the ensemble that the folder holds. Files of other names stay."""
    for member in members(folder):
        clear(member)
        remove_empty(member)
    for name in [*SIGNS["another run"], *SIGNS["another sweep"], *SIGNS["an ensemble"], *RESULTS]:
        if (folder / name).is_file():
            (folder / name).unlink()
    for path in (folder / "frames").glob("frame_*.vtp"):
        path.unlink()
    remove_empty(folder / "frames")


def remove_empty(folder):
    """Removes a folder with nothing in it."""
    if folder.is_dir() and not any(folder.iterdir()):
        folder.rmdir()


def write_whole(path, write):
    """Has `write` write a file beside `path`, which takes its name at the end: a reader never finds half of it."""
    # (by the ending, encoders tell what to write)
    partial = path.with_name(f"{path.stem}.partial{path.suffix}")
    try:
        write(partial)
        os.replace(partial, path)
    except OSError as error:
        partial.unlink(missing_ok=True)
        raise Stuck(f"cannot write {path}: {error.strerror or error}") from None
    except BaseException:
        partial.unlink(missing_ok=True)
        raise


def is_under_way(folder):
    """Whether a run writes here: it holds its history. Not told on Windows, nor by file systems without locks."""
    try:
        import fcntl
    except ModuleNotFoundError:
        return False
    try:
        with open(folder / "history.csv", "rb") as history:
            fcntl.flock(history, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        pass
    return False


def refuse_without_run(folder):
    """A mistake where there is no folder of a run."""
    if not folder.is_dir():
        raise Mistake(f"{folder} is no folder; name that of a run (coilwind run SCENE --out DIR)")
    if members(folder):
        raise Mistake(f"{folder} holds an ensemble; name a member, such as {folder / '1'}")
    if any(has(folder, name) for name in SIGNS["another sweep"]):
        raise Mistake(f"{folder} holds a sweep; name the folder of a run")
    if not any(has(folder, name) for name in [*SIGNS["another run"], "stations.csv", "coil.vtp", "frames.pvd"]):
        raise Mistake(f"{folder} holds no results of a run; wind one with: {shlex.join(['coilwind', 'run', 'SCENE', '--out', str(folder)])}")


def wind_again(folder, *words):
    """What gives a run that is not whole, in words."""
    if has(folder, CHECKPOINT):
        return f"go on with: {shlex.join(['coilwind', 'run', '--resume', str(folder)])}"
    if not has(folder, "scene.toml"):
        return "wind the scene again"
    line = ["coilwind", "run", str(folder / "scene.toml"), "--out", str(folder), *wound_with(folder, words), *words, "--force"]
    return f"begin again with: {shlex.join(line)}"


def wound_with(folder, other):
    """The options at the head of a run's scene, but for those that `other` words give and for those that leave out what they ask for."""
    first = (folder / "scene.toml").read_text(encoding="utf-8").partition("\n")[0]
    if not first.startswith(WITH):
        return []
    words = shlex.split(first.removeprefix(WITH))
    if "--frames" in words and "--frames" in other:
        place = words.index("--frames")
        del words[place : place + 2]
    return [word for word in words if word != "--no-geometry"]
