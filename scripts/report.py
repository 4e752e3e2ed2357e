#!/usr/bin/env python3
"""One self-contained page about the runs of a directory.

    report.py target/demo

Finds every summary.json below it, and writes index.html with the verdict table, the figures that
lie in the directory itself, and each run's picture. No network, no other files needed.
"""

import argparse
import base64
import html
import os
from pathlib import Path

from runs import by_speed, open_run

# What the source paper says of its Fig. 8, by spindle speed in rad/s.
FIG8_CLAIMS = {30: "aligned", 100: "aligned", 300: "aligned", 500: "gap"}

FIGURES = [
    ("tension.png", "Wire tension at the nozzle"),
    ("sections.png", "Sections through the coil, and the gap of the second turn"),
]

PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>
  :root {{ --ink: #22262c; --soft: #666d78; --line: #e2e5e9; --copper: #b5562b; }}
  body {{ margin: 0; background: #f5f6f7; color: var(--ink);
         font: 15px/1.55 system-ui, "Segoe UI", Helvetica, Arial, sans-serif; }}
  main {{ max-width: 1080px; margin: 0 auto; padding: 40px 24px 64px; }}
  h1 {{ font-size: 27px; font-weight: 650; margin: 0 0 4px; letter-spacing: -.01em; }}
  h1::before {{ content: ""; display: inline-block; width: .62em; height: .62em; margin-right: .45em;
               border-radius: 50%; background: var(--copper); }}
  h2 {{ font-size: 18px; font-weight: 600; margin: 44px 0 12px; }}
  p {{ max-width: 46em; }}
  .lead, .note, figcaption {{ color: var(--soft); }}
  .note, figcaption {{ font-size: 13px; }}
  .card {{ background: #fff; border: 1px solid var(--line); border-radius: 10px; overflow-x: auto; }}
  table {{ border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }}
  th, td {{ padding: 9px 14px; text-align: right; border-bottom: 1px solid var(--line);
           white-space: nowrap; }}
  th {{ font-size: 12px; font-weight: 600; color: var(--soft); vertical-align: bottom; }}
  th:first-child, td:first-child, .word {{ text-align: left; }}
  tr:last-child td {{ border-bottom: 0; }}
  .verdict {{ display: inline-block; padding: 1px 10px; border-radius: 999px; font-weight: 600;
             font-size: 13px; background: #e9ebee; color: #4b525c; }}
  .aligned {{ background: #dff1e6; color: #1d6b3f; }}
  .marginal {{ background: #fdf0d2; color: #80590a; }}
  .gap, .overlap, .bulge {{ background: #fbe0da; color: #9b2c17; }}
  figure {{ margin: 0; }}
  figure img {{ display: block; width: 100%; border-radius: 10px; }}
  figcaption {{ padding: 8px 4px 0; }}
  .pair {{ display: grid; gap: 24px; grid-template-columns: repeat(auto-fit, minmax(420px, 1fr)); }}
  .wide {{ margin-bottom: 28px; }} .wide img {{ border: 1px solid var(--line); background: #fff; }}
</style>
</head>
<body><main>
<h1>{title}</h1>
<p class="lead">{lead}</p>
{body}
</main></body>
</html>
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("directory", type=Path, help="directory that holds the runs")
    parser.add_argument("-o", "--output", type=Path, help="default: index.html in the directory")
    parser.add_argument("--title", default="Winding two turns side by side")
    parser.add_argument("--turn", type=int, default=2, help="turn of the table, from 1")
    parser.add_argument("--diameter-mm", type=float, default=0.7, help="wire diameter")
    arguments = parser.parse_args()

    summaries = sorted(arguments.directory.rglob("summary.json"))
    runs = by_speed(open_run(summary) for summary in summaries)
    if not runs:
        raise SystemExit(f"no summary.json below {arguments.directory}")
    body = [verdict_table(runs, arguments), figures(arguments.directory), pictures(runs)]
    page = PAGE.format(
        title=html.escape(arguments.title), lead=lead(runs), body="\n".join(filter(None, body))
    )
    output = arguments.output or arguments.directory / "index.html"
    partial = output.with_name(output.name + ".partial")
    partial.write_text(page, encoding="utf-8")
    os.replace(partial, output)
    print(f"wrote {output}")


def lead(runs):
    first = runs[0].summary
    words = [f"Scene {first.get('scene', 'unknown')}", f"preset {first.get('preset', 'unknown')}"]
    if "integrator" in first:
        words.append(f"integrator {first['integrator']}")
    if "spacing_m" in first:
        near, free = (1e3 * spacing for spacing in first["spacing_m"])
        words.append(f"nodes every {near:g} mm near the core and {free:g} mm in the free span")
    return html.escape(", ".join(words) + ".")


def verdict_table(runs, arguments):
    scale = 1e3 / arguments.diameter_mm
    claims = any(claim(run) for run in runs)
    head = ["spindle", "verdict", "paper" if claims else None, "mean gap<br>over d",
            "largest gap<br>over d", "longest run<br>above limit", "axial distance<br>over d",
            "largest bulge<br>mm", "overlap<br>over d", "energy residual<br>over dissipated"]
    rows = []
    for run in runs:
        turn = run.turn(arguments.turn)
        verdict = turn.get("verdict", "unsettled")
        residual = run.summary.get("energy", {}).get("residual_over_dissipated")
        cells = [html.escape(run.label), badge(verdict), badge(claim(run)) if claims else None,
                 number(turn.get("gap_mean"), scale, 3), number(turn.get("gap_max"), scale, 3),
                 number(turn.get("gap_run"), 100, 0, " %"),
                 number(turn.get("axial_mean"), scale, 3), number(turn.get("bulge_max"), 1e3, 2),
                 number(turn.get("overlap_max"), scale, 2), number(residual, 100, 2, " %")]
        rows.append(row("td", cells))
    note = (
        f"Turn {arguments.turn}, measured on wire at rest in the frame of the core, without the "
        f"neighbourhood of the clamp; d = {arguments.diameter_mm:g} mm. A gap counts from 0.15 d "
        "over a tenth of the turn. A single run is one throw: landings scatter at high speed."
    )
    table = f'<div class="card"><table>{row("th", head)}{"".join(rows)}</table></div>'
    return f'<h2>Verdict</h2>{table}<p class="note">{note}</p>'


def row(kind, cells):
    shown = [(k, cell) for k, cell in enumerate(cells) if cell is not None]
    words = (f'<{kind}{" class=word" if k in (1, 2) else ""}>{cell}</{kind}>' for k, cell in shown)
    return f"<tr>{''.join(words)}</tr>"


def claim(run):
    """What the paper says of this run, if it is one of its own."""
    if not str(run.summary.get("scene", "")).startswith("fig8") or run.speed is None:
        return None
    return FIG8_CLAIMS.get(round(run.speed, 6))


def badge(word):
    if not word:
        return "–"
    word = html.escape(word)
    return f'<span class="verdict {word}">{word}</span>'


def number(value, scale, digits, unit=""):
    if value is None:
        return "–"
    # Rounding may leave a zero with a sign.
    return f"{round(value * scale, digits) + 0.0:.{digits}f}{unit}"


def figures(directory):
    found = [(directory / name, title) for name, title in FIGURES if (directory / name).exists()]
    return "\n".join(
        f'<h2>{title}</h2><figure class="wide">{embed(path, title)}</figure>'
        for path, title in found
    )


def pictures(runs):
    found = [run for run in runs if (run.directory / "coil.png").exists()]
    if not found:
        return ""
    items = "".join(
        f"<figure>{embed(run.directory / 'coil.png', 'coil at ' + run.label)}"
        f"<figcaption>{html.escape(run.label)}, "
        f"{run.summary.get('turns_settled', 0):.2f} turns at rest</figcaption></figure>"
        for run in found
    )
    return (
        f'<h2>The coil</h2><div class="pair">{items}</div>'
        '<p class="note">Copper: wire at rest. Blue: wire still in motion.</p>'
    )


def embed(path, text):
    data = base64.b64encode(path.read_bytes()).decode("ascii")
    return f'<img alt="{html.escape(text)}" src="data:image/png;base64,{data}">'


if __name__ == "__main__":
    main()
