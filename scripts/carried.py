"""A scene whose files travel with it: their bytes, and a text that names them where a worker puts them."""

import json
import re
from pathlib import Path

try:
    import tomllib
except ModuleNotFoundError:  # Python 3.10
    import tomli as tomllib

from failure import Mistake

# A key that names a file, and its value on one line.
NAMED = re.compile(r"""(\bfile["']?[ \t]*=[ \t]*)("(?:[^"\\\n]|\\.)*"|'[^'\n]*')""")


def carried(scene, keys):
    """The text of a scene file, and the bytes of the files that its `keys`, such as core.file, name.

    The bytes are by names such as 1/tooth.stl, where the text has ../1/tooth.stl: the scene lies in a folder beside those of its files.
    """
    text = Path(scene).read_text(encoding="utf-8-sig")
    if "file" not in text:
        return text, {}
    try:
        wanted = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise Mistake(f"{scene}: the files that it names cannot be told ({error}); write it in TOML 1.0") from None
    names, files = {}, {}
    for key in keys:
        section, _, leaf = key.partition(".")
        given = wanted.get(section, {}).get(leaf)
        if not given:
            continue
        if given not in names:
            name = f"{len(names) + 1}/{Path(given).name}"
            names[given] = f"../{name}"
            files[name] = (Path(scene).parent / given).read_bytes()
        wanted[section][leaf] = names[given]
    text = NAMED.sub(lambda found: found[1] + renamed(found[2], names), text)
    if tomllib.loads(text) != wanted:
        raise Mistake(f"{scene}: write each of {', '.join(keys)} on one line, in quotes, such as file = \"tooth.stl\"")
    return text, files


def renamed(quoted, names):
    """A string of TOML, or that of the name which it has on a worker."""
    try:
        name = names.get(tomllib.loads(f"name = {quoted}")["name"])
    except tomllib.TOMLDecodeError:  # within a comment
        name = None
    return quoted if name is None else json.dumps(name, ensure_ascii=False)
