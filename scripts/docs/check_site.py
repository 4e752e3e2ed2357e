#!/usr/bin/env python3
"""Checks a built site as a browser without a network sees it.

    scripts/docs/check_site.py SITE

Every link within the site leads to a file, and to an anchor where it names one; no page loads a script, style sheet,
font or picture from elsewhere. mkdocs judges links in Markdown only; this sees HTML in pages, too, and the theme's part.
"""

import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

# what a browser fetches by itself
LOADED = {("link", "href"), ("script", "src"), ("img", "src"), ("iframe", "src"), ("source", "src"), ("video", "src")}
# relations of <link> that load nothing
RELATIONS = {"canonical", "next", "prev"}


class Page(HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.anchors, self.links = {"", "top"}, []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        for key in ("id", "name"):
            if attributes.get(key):
                self.anchors.add(attributes[key])
        for key in ("href", "src"):
            if attributes.get(key) is not None:
                loads = (tag, key) in LOADED and attributes.get("rel") not in RELATIONS
                self.links.append((attributes[key], loads, self.getpos()[0]))


def problems(site):
    site = site.resolve()
    pages = {path: Page(path) for path in sorted(site.rglob("*.html"))}
    for path, page in pages.items():
        name = path.relative_to(site)
        # The page for dead addresses is served for any address, so its links are absolute.
        if name.name == "404.html":
            continue
        for link, loads, line in page.links:
            parts = urlsplit(link)
            if parts.scheme == "data":
                continue
            if parts.scheme or parts.netloc:
                if loads:
                    yield f"{name}:{line}: loads {link}, which is not part of the site"
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if target.is_dir():
                target /= "index.html"
            if not target.is_file() or not target.is_relative_to(site):
                yield f"{name}:{line}: leads to {link}, which does not exist"
            elif parts.fragment and target in pages and unquote(parts.fragment) not in pages[target].anchors:
                yield f"{name}:{line}: leads to {link}, where there is no such anchor"
    for path in sorted(site.rglob("*.css")):
        # The theme's own style sheets end in a map that browsers load for developers only.
        for link in re.findall(r"url\([\"']?(?!data:)([^)\"']*)", path.read_text(encoding="utf-8")):
            if urlsplit(link).scheme or link.startswith("//"):
                yield f"{path.relative_to(site)}: loads {link}, which is not part of the site"
    if not pages:
        yield f"{site} holds no pages"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    site = Path(sys.argv[1])
    found = list(problems(site))
    for problem in found:
        print(f"check_site.py: {problem}", file=sys.stderr)
    if found:
        sys.exit(1)
    count = sum(1 for _ in site.rglob("*.html"))
    print(f"{site}: {count} pages, no dead links, nothing from elsewhere")


if __name__ == "__main__":
    main()
