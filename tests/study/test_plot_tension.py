"""scripts/plot_tension.py names the folder of each run."""

import subprocess
import sys


def test_runs_of_one_speed_are_told_apart(root, tmp_path):
    """Their panels had the speed alone for a title. A folder named by the speed is not told twice."""
    code = (
        f"import sys; sys.path.insert(0, r'{root / 'scripts'}')\n"
        "import pathlib, runs, plot_tension\n"
        "for name in sys.argv[1:]: print(plot_tension.titled(runs.Run(pathlib.Path(name), {'speed_rad_per_s': 100.0})))\n"
        "print(plot_tension.titled(runs.Run(pathlib.Path('x'), {})))\n"
    )
    done = subprocess.run([sys.executable, "-c", code, tmp_path / "thin", tmp_path / "thick", tmp_path / "100"], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == ["100 rad/s, thin", "100 rad/s, thick", "100 rad/s", "x"]
