"""What lies in the FMU, and what its libraries show."""

import subprocess
import zipfile
from pathlib import Path

import pytest
from conftest import ROOT

BIGGEST = 5_000_000
"""Bytes that the archive may have, libraries for both platforms included."""


@pytest.fixture(scope="session")
def archive(fmu_path):
    with zipfile.ZipFile(fmu_path) as archive:
        yield archive


def test_documentation_licences_and_icon_are_there(archive, description):
    page = archive.read("documentation/index.html").decode()
    for variable in description.modelVariables:
        assert f'<tr id="{variable.name}">' in page, variable.name
        assert variable.description is not None
    assert description.guid in page
    assert archive.read("documentation/licenses/license.txt") == (ROOT / "LICENSE").read_bytes()
    for picture in ("model.png", "documentation/coil.png"):
        assert archive.read(picture).startswith(b"\x89PNG"), picture


def test_the_introduction_counts_no_inputs(archive, description):
    """It told of three inputs where there are seven."""
    page = archive.read("documentation/index.html").decode()
    inputs = [variable for variable in description.modelVariables if variable.causality == "input"]
    assert len(inputs) > 3
    assert "Connect the inputs" in page and "three inputs" not in page


def test_every_crate_that_is_linked_in_has_its_licence(archive):
    text = archive.read("documentation/licenses/third-party.txt").decode()
    table = text.split("Crates\n------\n\n")[1].split("\n\n")[0].splitlines()
    listed = {line.split(":")[0] for line in table}
    # cargo tree is another way to the same list; both platforms, no build tools, no macros.
    for triple in ("x86_64-unknown-linux-gnu", "x86_64-pc-windows-gnu"):
        tree = subprocess.run(
            ["cargo", "tree", "--locked", "--package", "coilwind-fmu", "--edges", "normal,no-proc-macro",
             "--target", triple, "--prefix", "none", "--format", "{p}"],
            cwd=ROOT, capture_output=True, text=True, check=True,
        ).stdout
        crates = {
            line.removesuffix(" (*)").replace(" v", " ")
            for line in tree.splitlines()
            if line and "(/" not in line and "(proc-macro)" not in line
        }
        assert len(crates) > 50
        assert crates <= listed, crates - listed
    for line in table:
        first = line.split("(text ")[1].split(",")[0].rstrip(")")
        assert f"\nText {first}\n" in text, line


def test_the_archive_is_small(fmu_path):
    assert Path(fmu_path).stat().st_size < BIGGEST


def test_libraries_show_the_functions_of_fmi_and_nothing_else(archive, tmp_path):
    names = [name for name in archive.namelist() if name.startswith("binaries/")]
    assert names
    portable = len(names) == 2
    for name in names:
        library = Path(archive.extract(name, tmp_path))
        ceiling = ["--glibc", "2.17"] if portable and library.suffix == ".so" else []
        checked = subprocess.run(
            [ROOT / "scripts/check_library.sh", *ceiling, library],
            capture_output=True, text=True, check=False,
        )
        assert checked.returncode == 0, checked.stderr
        assert "34 functions" in checked.stdout
    if portable:
        assert names == ["binaries/linux64/CoilWinding.so", "binaries/win64/CoilWinding.dll"]
