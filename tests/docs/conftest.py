"""What the tests of the pages share: the repository, its target folder, and a small repository with planted pages."""

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def root():
    return ROOT


@pytest.fixture(scope="session")
def target():
    return Path(os.environ.get("CARGO_TARGET_DIR") or ROOT / "target").resolve()


@pytest.fixture
def planted(tmp_path, target):
    """Makes a repository of given pages that shares what is built with the real one."""

    def plant(pages, linked=("release", "fmu")):
        for name, text in pages.items():
            path = tmp_path / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        (tmp_path / "target").mkdir()
        for name in linked:
            (tmp_path / "target" / name).symlink_to(target / name)
        return tmp_path

    return plant
