#!/usr/bin/env python3
"""Makes docs/guide/report.png, the picture of a report in the guide.

    scripts/report/picture.py

Winds fig8_gap with a gap, opens its report in headless Chromium as tests/report/run.sh does, and keeps the upper part of
the page at half its size. Needs what tests/report/run.sh needs, and Pillow, which comes with matplotlib.
"""

import subprocess
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
SHOTS = ROOT / "target" / "report-shots"
UPPER = 0.56
"""Share of the page: verdict, product, view, defects."""

subprocess.run([ROOT / "tests/report/run.sh", "--shots", SHOTS], check=True, cwd=ROOT)
page = Image.open(SHOTS / "gap" / "light.png").convert("RGB")
page = page.crop((0, 0, page.width, int(UPPER * page.height)))
page = page.resize((page.width * 5 // 8, page.height * 5 // 8), Image.Resampling.LANCZOS)
page.save(ROOT / "docs/guide/report.png", optimize=True)
