#!/usr/bin/env python3
"""One page about the runs of a directory; it leads to the report of each run where there is one.

    report.py target/demo

Finds every summary.json below it, and writes index.html with the verdict table, the figures that
lie in the directory itself, and each run's picture. No network, no other files needed.
"""

import argparse
import base64
import html
import os
from pathlib import Path

from failure import Mistake, told
from runs import open_run
from verdicts import NOTE, STEADY_TURNS, Row, columns, runs_below

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
  :root {{ --ink: #22262c; --soft: #666d78; --line: #e2e5e9; --copper: #b5562b; --ground: #f5f6f7; --card: #fff;
          color-scheme: light dark; }}
  @media (prefers-color-scheme: dark) {{
    :root {{ --ink: #e5e7ea; --soft: #9aa2ad; --line: #31353b; --copper: #d8794c; --ground: #15171a; --card: #1d2024; }}
  }}
  body {{ margin: 0; background: var(--ground); color: var(--ink);
         font: 15px/1.55 system-ui, "Segoe UI", Helvetica, Arial, sans-serif; }}
  main {{ max-width: 1180px; margin: 0 auto; padding: 40px 24px 64px; }}
  h1 {{ font-size: 27px; font-weight: 650; margin: 0 0 4px; letter-spacing: -.01em; }}
  h1::before {{ content: ""; display: inline-block; width: .62em; height: .62em; margin-right: .45em;
               border-radius: 50%; background: var(--copper); }}
  h2 {{ font-size: 18px; font-weight: 600; margin: 44px 0 12px; }}
  p {{ max-width: 46em; }}
  .lead, .note, figcaption {{ color: var(--soft); }}
  .note, figcaption {{ font-size: 13px; max-width: 70em; }}
  a {{ color: var(--copper); }}
  .card {{ background: var(--card); border: 1px solid var(--line); border-radius: 10px; overflow-x: auto; }}
  table {{ border-collapse: collapse; width: 100%; font-size: 14px; font-variant-numeric: tabular-nums; }}
  th, td {{ padding: 9px 8px; text-align: right; border-bottom: 1px solid var(--line);
           white-space: nowrap; }}
  th {{ font-size: 12px; font-weight: 600; color: var(--soft); vertical-align: bottom;
       white-space: normal; }}
  tr:last-child td {{ border-bottom: 0; }}
  .verdict {{ display: inline-block; padding: 1px 10px; border-radius: 999px; font-weight: 600;
             font-size: 13px; background: #e9ebee; color: #4b525c; }}
  .aligned {{ background: #dff1e6; color: #1d6b3f; }}
  .marginal {{ background: #fdf0d2; color: #80590a; }}
  .gap, .overlap, .bulge, .skipped_groove, .double_turn {{ background: #fbe0da; color: #9b2c17; }}
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
    parser.add_argument("--more", action="append", default=[], metavar="TITLE=DIR", help="a run of another kind to link")
    arguments = parser.parse_args()
    with told(parser.prog):
        write(arguments)


def write(arguments):
    """Writes the page."""
    more = [given.partition("=")[::2] for given in arguments.more]
    apart = {Path(folder).resolve() for _, folder in more}
    runs = [run for run in runs_below(arguments.directory) if run.directory.resolve() not in apart]
    if not runs:
        raise Mistake(f"no summary.json below {arguments.directory}; name a folder that holds folders of runs")
    output = arguments.output or arguments.directory / "index.html"
    body = [
        verdict_table(runs, arguments),
        figures(arguments.directory),
        pictures(runs, output.parent),
        elsewhere([(title, open_run(folder)) for title, folder in more], output.parent),
    ]
    page = PAGE.format(
        title=html.escape(arguments.title), lead=lead(runs), body="\n".join(filter(None, body))
    )
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
    table = columns(arguments.turn)
    rows = [Row.of(run, arguments.turn, arguments.directory) for run in runs]
    head = row("th", [html.escape(column.heading) for column in table])
    body = "".join(row("td", [cell(column, r) for column in table]) for r in rows)
    note = NOTE.format(turn=arguments.turn, steady=STEADY_TURNS)
    note += " A single run is one throw: landings scatter at high speed."
    shown = f'<div class="card"><table>{head}{body}</table></div>'
    return f'<h2>Verdict</h2>{shown}<p class="note">{html.escape(note)}</p>'


def row(kind, cells):
    return f"<tr>{''.join(f'<{kind}>{text}</{kind}>' for text in cells)}</tr>"


def cell(column, run):
    text = html.escape(column.shown(run))
    return badge(text) if column.name in ("coil_verdict", "turn_verdict", "claim_of_the_paper") and text != "–" else text


def badge(verdict):
    return f'<span class="verdict {verdict}">{verdict.replace("_", " ")}</span>'


def figures(directory):
    found = [(directory / name, title) for name, title in FIGURES if (directory / name).exists()]
    return "\n".join(
        f'<h2>{title}</h2><figure class="wide">{embed(path, title)}</figure>'
        for path, title in found
    )


def pictures(runs, directory):
    found = [run for run in runs if (run.directory / "coil.png").exists()]
    if not found:
        return ""
    items = "".join(
        f"<figure>{embed(run.directory / 'coil.png', 'coil at ' + run.label)}"
        f"<figcaption>{html.escape(run.label)}, "
        f"{run.summary.get('turns_settled', 0):.2f} turns at rest{link(run, directory)}</figcaption></figure>"
        for run in found
    )
    return (
        f'<h2>The coil</h2><div class="pair">{items}</div>'
        '<p class="note">Copper: wire at rest. Blue: wire still in motion.</p>'
    )


def elsewhere(runs, directory):
    """Runs that are not of this table: their pictures, verdicts and reports."""
    shown = []
    for title, run in runs:
        if not run.summary:
            continue
        picture, title = run.directory / "coil.png", html.escape(title)
        image = embed(picture, f"{title}, seen from the side") if picture.exists() else ""
        words = f"{title} {badge(html.escape(run.summary.get('verdict', '')))}{link(run, directory)}"
        shown.append(f"<figure>{image}<figcaption>{words}</figcaption></figure>")
    return f'<h2>More coils</h2><div class="pair">{"".join(shown)}</div>' if shown else ""


def link(run, directory):
    """To the report of a run, which turns the coil and shows its defects."""
    page = run.directory / "report.html"
    if not page.exists():
        return ""
    return f' · <a href="{html.escape(os.path.relpath(page, directory))}">report</a>'


def embed(path, text):
    data = base64.b64encode(path.read_bytes()).decode("ascii")
    return f'<img alt="{html.escape(text)}" src="data:image/png;base64,{data}">'


if __name__ == "__main__":
    main()
