"""scripts/docs.sh fails for what a reader of the site would stumble over, and points links of the repository to pages."""

import json
import os
import re
import shutil
import subprocess

import pytest

ROOT_PAGES = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"]


@pytest.fixture(scope="module", autouse=True)
def _tools(root):
    words = [root / "scripts/missing_tools.sh", "site"]
    missing = subprocess.run(words, capture_output=True, text=True, check=True).stdout
    if missing:
        pytest.skip(f"the site cannot be built here: {missing.strip()}")


@pytest.fixture
def build(planted, root):
    """Builds a site of docs/index.md, docs/other/page.md and root pages; its folder, exit code and output."""

    def run(index, readme="# Read me\n"):
        pages = {name: f"# {name}\n" for name in ROOT_PAGES}
        pages |= {"README.md": readme, "docs/index.md": index, "docs/other/page.md": "# Other\n\n## Part\n"}
        pages |= {"src/lib.rs": "// code\n", "LICENSE": "MIT\n"}
        settings = (root / "mkdocs.yml").read_text(encoding="utf-8")
        project = settings[settings.index("  - Project:") :]
        start = settings.index("\nnav:\n")
        pages["mkdocs.yml"] = f"{settings[:start]}\nnav:\n  - index.md\n  - other/*.md\n{project}"
        folder = planted(pages, linked=("venv-docs", "node-docs"))
        for name in ["docs.sh", "node_modules.sh", "venv.sh", "missing_tools.sh", "docs"]:
            source = root / "scripts" / name
            copy = shutil.copytree if source.is_dir() else shutil.copy
            (folder / "scripts").mkdir(exist_ok=True)
            copy(source, folder / "scripts" / name)
        shutil.copy(root / "requirements-docs.txt", folder)
        inherited = {name: value for name, value in os.environ.items() if name != "CARGO_TARGET_DIR"}
        done = subprocess.run(
            [folder / "scripts/docs.sh"], env=inherited, capture_output=True, text=True, check=False
        )
        return folder / "target/site", done.returncode, done.stdout + done.stderr

    return run


def test_links_formulas_and_pages_of_the_root_work_on_the_site(build):
    index = """# Start

[page](other/page.md#part) [top](../README.md) [code](../src/lib.rs) [licence](../LICENSE) [folder](../src/)
Of $a < b$ and

$$
\\kappa = \\frac{M}{EI}
$$
"""
    site, code, said = build(index, readme="# Read me\n\n[page](docs/other/page.md#part) [docs](docs/)\n")
    assert code == 0, said
    html = (site / "index.html").read_text(encoding="utf-8")
    for link in ["other/page.html#part", "project/index.html", "source/src/lib.rs.txt", "source/LICENSE.txt"]:
        assert f'href="{link}"' in html
    assert "<span>folder</span>" in html
    assert html.count('<span class="katex">') == 2 and "<mfrac>" in html
    readme = (site / "project/index.html").read_text(encoding="utf-8")
    assert 'href="../other/page.html#part"' in readme and 'href="../index.html"' in readme
    assert (site / "source/src/lib.rs.txt").read_text(encoding="utf-8") == "// code\n"
    # A pattern in the navigation stands for its pages.
    assert re.search(r'href="other/page.html"[^>]*class="md-(nav|tabs)__link', html)


def test_the_site_needs_no_network(build):
    site, code, said = build("# Start\n\nOf $x$.\n")
    assert code == 0, said
    html = (site / "index.html").read_text(encoding="utf-8")
    loaded = re.findall(r'<(?:script|img)[^>]* src="([^"]+)"|<link[^>]* rel="stylesheet"[^>]* href="([^"]+)"', html)
    loaded = {script or sheet for script, sheet in loaded}
    assert {"vendor/katex/katex.min.css", "vendor/iframe-worker/shim.js"} <= loaded
    assert all((site / name).is_file() for name in loaded), loaded
    style = (site / "vendor/katex/katex.min.css").read_text(encoding="utf-8")
    fonts = set(re.findall(r"url\((fonts/[^)]+\.woff2)\)", style))
    assert len(fonts) >= 20 and all((site / "vendor/katex" / font).is_file() for font in fonts)
    assert "MIT" in (site / "vendor/katex/LICENSE.txt").read_text(encoding="utf-8")
    # What search reads in a site that is opened from a disk.
    assert (site / "search/search_index.js").is_file()
    assert json.loads((site / "search/search_index.json").read_text(encoding="utf-8"))["docs"]


def test_anchors_are_those_of_code_hosts(build):
    heading = "## Energy & the `tol_m` (2e-6 m), rod's"
    _, code, said = build(f"# Start\n\n[there](#energy--the-tol_m-2e-6-m-rods)\n\n{heading}\n")
    assert code == 0, said


@pytest.mark.parametrize(
    ("body", "complaint"),
    [
        ("[dead](other/no.md)", "docs/index.md links to 'other/no.md'"),
        ("[dead](other/page.md#no)", "does not contain an anchor '#no'"),
        ("[dead](#no)", "there is no such anchor on this page"),
        ("[dead](../no.txt)", "docs/index.md links to '../no.txt'"),
        ("[outside](../../elsewhere.md)", "docs/index.md links to '../../elsewhere.md'"),
        ("[absolute](/other/page.md)", "absolute link"),
        ("![dead](no.png)", "docs/index.md links to 'no.png'"),
        ('<img src="no.png">', "leads to no.png, which does not exist"),
        ('<img src="https://example.org/a.png">', "loads https://example.org/a.png"),
        ("$$\na\n  + b\n$$", "docs/index.md, line 5: code hosts begin a list at this +"),
        ("Of $\\frac{a$.", "index.md: KaTeX parse error"),
        ("Text\n- item", "docs/index.md, line 4: a list begins after an empty line"),
        ("Text\n| a |\n|---|\n| b |", "docs/index.md, line 4: a table begins after an empty line"),
        ("- item\n  - inner", "docs/index.md, line 4: a list inside a list is indented"),
        ("1. item\n\n   ```sh\n   true\n   ```", "docs/index.md, line 5: a fence inside a list"),
    ],
)
def test_what_is_broken_fails_the_build(build, body, complaint):
    _, code, said = build(f"# Start\n\n{body}\n")
    assert code == 1, said
    assert complaint in said


def test_a_page_outside_the_navigation_fails_the_build(build, tmp_path):
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs/forgotten.md").write_text("# Forgotten\n", encoding="utf-8")
    _, code, said = build("# Start\n")
    assert code == 1
    assert "forgotten.md" in said


def test_a_dead_link_in_a_page_of_the_root_fails_the_build(build):
    _, code, said = build("# Start\n", readme="# Read me\n\n[dead](docs/no.md)\n")
    assert code == 1
    assert "README.md links to 'docs/no.md'" in said
