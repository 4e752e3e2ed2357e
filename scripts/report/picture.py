#!/usr/bin/env python3
"""Makes docs/guide/report.png, the picture of a report in the guide.

    scripts/report/picture.py

Winds the run of docs/guide/report.md, opens its report in headless Chromium, and keeps the page. Needs
Chromium, and Pillow, which comes with matplotlib; COILWIND_COMMAND names the command (target/release/coilwind).
"""

import os
import subprocess
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
COMMAND = os.environ.get("COILWIND_COMMAND", str(ROOT / "target/release/coilwind"))
RUN = ["fig8", "--set", "spindle.speed=100", "--set", "spindle.turns=2.6", "--set", "traverse.per_turn_mm=1", "--frames", "6"]
FOLDER = ROOT / "target/shown"
SHOT = FOLDER / "page.png"
BROWSER = [
    "chromium", "--headless", "--no-sandbox", "--use-gl=swiftshader", "--enable-unsafe-swiftshader",
    "--virtual-time-budget=9000", "--hide-scrollbars", "--window-size=1200,2600",
]

subprocess.run([COMMAND, "run", *RUN, "--quiet", "--force", "--out", FOLDER], check=True, cwd=ROOT)
subprocess.run([*BROWSER, f"--screenshot={SHOT}", (FOLDER / "report.html").as_uri()], check=True)
page = Image.open(SHOT).convert("RGB")
page.save(ROOT / "docs/guide/report.png", optimize=True)
