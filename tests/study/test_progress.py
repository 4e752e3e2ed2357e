"""What scripts tell of their progress: on a terminal only, and only of work that takes long."""

import os
import subprocess
import sys

import pytest

CODE = """
import sys; sys.path.insert(0, 'scripts')
import progress
progress.QUIET = float(sys.argv[1])
told = progress.Progress("runs", 2)
told.step()
told.step()
told.end()
"""


@pytest.mark.skipif(os.name == "nt", reason="terminals of POSIX")
@pytest.mark.parametrize(("terminal", "quiet", "tells"), [(True, 0.0, True), (True, 60.0, False), (False, 0.0, False)])
def test_progress_shows_on_a_terminal_where_work_takes_long(terminal, quiet, tells, root):
    """A film of 82 s and a fit of half a minute said nothing on their way."""
    reader, writer = os.openpty() if terminal else os.pipe()
    subprocess.run([sys.executable, "-c", CODE, str(quiet)], stderr=writer, check=True, cwd=root)
    os.write(writer, b".")
    said = os.read(reader, 10_000).decode()
    os.close(reader)
    os.close(writer)
    assert ("2 of 2 runs, 0 s, 0 s left" in said) == tells, said
    assert tells or said == ".", said
