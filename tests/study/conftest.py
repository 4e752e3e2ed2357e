"""What the tests of scripts around a run share: where the command and the FMU are, and how a script is started."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TARGET = Path(os.environ.get("CARGO_TARGET_DIR") or ROOT / "target").resolve()


@pytest.fixture(scope="session")
def command():
    return str(Path(os.environ.get("COILWIND_COMMAND") or TARGET / "release/coilwind").resolve())


@pytest.fixture(scope="session")
def fmu():
    return str(Path(os.environ.get("COILWIND_FMU") or TARGET / "fmu/CoilWinding.fmu").resolve())


@pytest.fixture(scope="session")
def script():
    """Runs a script of the repository; its exit code, and what it said on either stream."""

    def run(name, *words, python=sys.executable, timeout=300):
        line = [python, ROOT / name, *map(str, words)]
        done = subprocess.run(line, capture_output=True, text=True, timeout=timeout, check=False, cwd=ROOT)
        return done.returncode, done.stdout + done.stderr

    return run


@pytest.fixture(scope="session")
def root():
    return ROOT


@pytest.fixture(scope="module")
def scene(request, tmp_path_factory):
    """The scene that the module holds as SCENE, in a file."""
    path = tmp_path_factory.mktemp("scene") / "machine.toml"
    path.write_text(request.module.SCENE, encoding="utf-8")
    return path
