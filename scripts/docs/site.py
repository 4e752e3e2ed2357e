"""What the site needs beyond mkdocs; mkdocs.yml names this file as a hook.

* README.md and the other pages of the repository's root become pages under project/.
* Links are written as they work in the repository; here they are pointed to where their targets lie on the site.
  A link to a file that is no page gets a copy of the file, a link to a folder becomes text, one to nothing is a warning.
* What code hosts and the site would show differently is a warning.
* Formulas are rendered by KaTeX while the site is built; one that KaTeX refuses is a warning.
* Patterns in the navigation are replaced by pages.

Every warning fails a strict build. COILWIND_NODE_MODULES names the folder that holds KaTeX (scripts/docs.sh sets it).
"""

import fnmatch
import html
import json
import logging
import mimetypes
import os
import posixpath
import re
import subprocess
from pathlib import Path
from urllib.parse import unquote, urlsplit

from markdown.extensions import Extension
from markdown.treeprocessors import Treeprocessor
from mkdocs.structure.files import File

log = logging.getLogger("mkdocs.hooks.site")

ROOT_PAGES = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"]
# on the site, for pages and for other files of the repository
PROJECT, SOURCE = "project", "source"
FORMULA = re.compile(r'<(span|div) class="arithmatex">(?:\\\((.*?)\\\)|\\\[(.*?)\\\])</\1>', re.DOTALL)


def repository(config):
    return Path(config.config_file_path).parent


def node_modules():
    return Path(os.environ["COILWIND_NODE_MODULES"])


def on_config(config):
    config.markdown_extensions.append(LinkExtension(repository(config)))
    pages = sorted(path.relative_to(config.docs_dir).as_posix() for path in Path(config.docs_dir).rglob("*.md"))
    config.nav = expand(config.nav, set(strings(config.nav)), pages)
    return config


def strings(nav):
    """All pages and patterns of a navigation."""
    if isinstance(nav, str):
        yield nav
    for item in nav.values() if isinstance(nav, dict) else nav if isinstance(nav, list) else []:
        yield from strings(item)


def expand(nav, named, pages):
    if isinstance(nav, dict):
        return {title: expand(item, named, pages) for title, item in nav.items()}
    if not isinstance(nav, list):
        return nav
    items = []
    for item in nav:
        if isinstance(item, str) and "*" in item:
            items += reversed([page for page in fnmatch.filter(pages, item) if page not in named])
        else:
            items.append(expand(item, named, pages))
    return items


def on_files(files, config):
    for name in ROOT_PAGES:
        files.append(File.generated(config, f"{PROJECT}/{name}", abs_src_path=str(repository(config) / name)))
    modules = node_modules()
    vendored = {
        "iframe-worker/shim.js": "iframe-worker/shim/index.js",
        "iframe-worker/LICENSE.txt": "iframe-worker/LICENSE",
        "katex/katex.min.css": "katex/dist/katex.min.css",
        "katex/LICENSE.txt": "katex/LICENSE",
    }
    for font in sorted((modules / "katex/dist/fonts").glob("*.woff2")):
        vendored[f"katex/fonts/{font.name}"] = f"katex/dist/fonts/{font.name}"
    for name, source in vendored.items():
        files.append(File.generated(config, f"vendor/{name}", abs_src_path=str(modules / source)))
    return files


def on_page_markdown(markdown, page, config, files):
    links = next(e for e in config.markdown_extensions if isinstance(e, LinkExtension))
    links.begin(page, config, files)
    for number, problem in layout_problems(markdown):
        log.warning("%s, line %d: %s", links.here, number, problem)
    return markdown


def layout_problems(markdown):
    """Where code hosts and the site read a page differently, as pairs of line number and sentence."""
    fence, formula, before = None, False, ""
    for number, line in enumerate(markdown.splitlines(), 1):
        mark = re.match(r"( *)(```+|~~~+)", line)
        item = re.match(r"( *)([-*+]|\d+[.)]) ", line)
        if mark and fence is None:
            fence = mark[2]
            if 0 < len(mark[1]) < 4:
                yield number, "a fence inside a list is indented by four spaces"
        elif mark and mark[2].startswith(fence) and line.strip() == mark[2]:
            fence = None
        elif fence is None:
            formula ^= line.count("$$") % 2 == 1
            # A paragraph, not another item, quotation, table, heading, comment or what continues one of them.
            paragraph = before.strip() and not re.match(r"[ |]|[-*+>] |\d+[.)] |#+ |<!--|\$\$", before)
            if formula:
                if item:
                    yield number, f"code hosts begin a list at this {item[2]}; it belongs at the end of the line before"
            elif item and 0 < len(item[1]) < 4:
                yield number, "a list inside a list is indented by four spaces"
            elif item and not item[1] and paragraph:
                yield number, "a list begins after an empty line"
            elif line.startswith("|") and paragraph:
                yield number, "a table begins after an empty line"
        before = line


class LinkExtension(Extension):
    """Points links of the repository to their places on the site."""

    def __init__(self, root):
        super().__init__()
        self.root = root

    def begin(self, page, config, files):
        self.config, self.files = config, files
        self.page = page.file.src_uri
        folder, name = posixpath.split(self.page)
        self.here = name if folder == PROJECT and name in ROOT_PAGES else f"docs/{self.page}"

    def extendMarkdown(self, md):
        # After inline patterns have made the links (20), before mkdocs judges them (0).
        md.treeprocessors.register(LinkProcessor(md, self), "repository_links", 6)

    def moved(self, link):
        """The link as it works on the site; None if its target is not to be had there."""
        parts = urlsplit(link)
        if parts.scheme or parts.netloc or not parts.path or parts.path.startswith("/"):
            return link
        target = posixpath.normpath(posixpath.join(posixpath.dirname(self.here), unquote(parts.path)))
        on_site = self.place(link, target)
        if on_site is None:
            return None
        moved = posixpath.relpath(on_site, posixpath.dirname(self.page))
        return moved + (f"#{parts.fragment}" if parts.fragment else "")

    def place(self, link, target):
        path = self.root / target
        if target.startswith("../") or not path.exists():
            log.warning("%s links to '%s', which does not exist", self.here, link)
            return None
        if target in ROOT_PAGES:
            return f"{PROJECT}/{target}"
        if target == "docs" or target.startswith("docs/"):
            inside = posixpath.relpath(target, "docs")
            return inside if path.is_file() else posixpath.normpath(f"{inside}/index.md")
        if path.is_dir():
            return None
        if path.suffix == ".md":
            log.warning("%s links to '%s', a page that is not on the site", self.here, link)
            return None
        # Browsers show a text where they would offer to save a file of a kind they do not know.
        image = (mimetypes.guess_type(target)[0] or "").startswith("image/")
        copy = f"{SOURCE}/{target}" if image else f"{SOURCE}/{target}.txt"
        if self.files.get_file_from_path(copy) is None:
            self.files.append(File.generated(self.config, copy, abs_src_path=str(path)))
        return copy


class LinkProcessor(Treeprocessor):
    def __init__(self, md, links):
        super().__init__(md)
        self.links = links

    def run(self, root):
        for element in root.iter():
            key = {"a": "href", "img": "src"}.get(element.tag)
            if key is None or element.get(key) is None:
                continue
            moved = self.links.moved(element.get(key))
            if moved is None:
                element.tag = "span"
                del element.attrib[key]
            else:
                element.set(key, moved)


def on_post_page(output, page, config):
    found = list(FORMULA.finditer(output))
    if not found:
        return output
    formulas = [{"tex": html.unescape(m[2] or m[3]), "display": m[3] is not None} for m in found]
    script = repository(config) / "scripts/docs/render_formulas.js"
    done = subprocess.run(
        ["node", script, node_modules() / "katex"],
        input=json.dumps(formulas), capture_output=True, text=True, encoding="utf-8", check=True,
    )
    rendered = iter(json.loads(done.stdout))

    def replaced(match):
        result = next(rendered)
        if "error" in result:
            log.warning("%s: %s", page.file.src_uri, result["error"])
            return match[0]
        return f'<{match[1]} class="arithmatex">{result["html"]}</{match[1]}>'

    return FORMULA.sub(replaced, output)
