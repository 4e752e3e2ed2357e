#!/usr/bin/env python3
"""Runs what the pages tell a reader to type.

    scripts/docs/check_commands.py [PAGE...]

Without a page: README.md and its neighbours, and everything under docs/. In each page, from top to bottom:

* ```sh fences run in bash, from the root of a copy of the repository; the first command that fails ends the page.
* ```python fences run if the line above them is <!-- run -->.
* ```toml fences have to pass `coilwind check`, unless they are manifests of cargo.
* A fence with title="NAME" is written to the file NAME first, so that later commands find it.
* ```text fences below one that has run show what those above printed: every line of theirs. A line "..." stands for lines that are left out,
  and "..." within a line for what is another each time, such as a time.
* Wherever code calls `coilwind SUBCOMMAND --option`, in fences that run, in others and in running text, both have to exist.

A fence under the line <!-- not run: REASON --> or <!-- not compared: REASON --> is skipped and counted. Fences of one page share one copy, pages do not.
In the copy, target/ holds what is built in the real one; the rest of it is thrown away with the copy. PATH begins with
the Python of scripts/venv.sh and target/release. A copy in which something failed stays in target/pages/.
"""

import argparse
import difflib
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import textwrap
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ROOT_PAGES = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"]
# What a page may use of the real target/: linked, since nothing but the same builds writes there, ...
LINKED = ["release", "debug", "portable", "venv", "venv-*", "node-docs"]
# ... and copied, since pages make it anew.
COPIED = ["fmu"]
# What the FMU is built from. One that is older than a source shows what the sources no longer do.
SOURCES = ["Cargo.toml", "Cargo.lock", "src", "fmu", "modelDescription"]
# Set while a page runs, to be seen by a check of pages that a page starts.
RUNNING = "COILWIND_PAGE_RUNS"
SHELLS_BY_OTHER_NAMES = {"bash", "shell", "zsh", "console", "shell-session", "terminal"}
MANIFEST_TABLES = {"package", "dependencies", "dev-dependencies", "features", "workspace", "profile", "toolchain", "lints"}
# Languages whose code calls no commands.
NO_COMMANDS = {"rust", "python", "toml", "json", "csv", "c", "math", "xml"}
# Marks of fences that are left alone, each with a reason.
SKIPPED = ("not run", "not compared")
# Languages of fences that are run or compared.
RUN = ("sh", "python", "toml", "text")
TIMEOUT_S = 600
TAIL_LINES = 30


class Failed(Exception):
    """A fence that does not do what its page says."""


@dataclass
class Fence:
    language: str
    title: str | None
    # number in the page of the first line inside
    line: int
    text: str
    # "run", "not run", "not compared" or None, and the reason for not running or comparing
    mark: str | None
    reason: str | None


def fences_of(text):
    """All fences of a page, and problems as pairs of line number and sentence."""
    fences, problems = [], []
    lines = text.splitlines()
    mark, number = None, 0
    while number < len(lines):
        line = lines[number]
        number += 1
        comment = re.fullmatch(r"\s*<!--\s*(not run|not compared|run)\b\s*:?\s*(.*?)\s*-->\s*", line)
        opening = re.match(r"\s*(`{3,}|~{3,})\s*([\w-]*)(.*)$", line)
        if comment:
            if mark:
                problems.append((mark[0], "marks no fence"))
            mark = (number, comment[1], comment[2])
            if comment[1] != "run" and not comment[2]:
                problems.append((number, f"gives no reason: <!-- {comment[1]}: REASON -->"))
        elif opening:
            first = number
            while number < len(lines) and not re.fullmatch(rf"\s*{opening[1]}{opening[1][0]}*\s*", lines[number]):
                number += 1
            if number == len(lines):
                problems.append((first, "opens a fence that does not end"))
            title = re.search(r'title="([^"]+)"', opening[3])
            inside = textwrap.dedent("\n".join(lines[first:number])) + "\n"
            _, verb, reason = mark or (None, None, None)
            fences.append(Fence(opening[2], title and title[1], first + 1, inside, verb, reason))
            mark = None
            number += 1
        elif line.strip() and mark:
            problems.append((mark[0], "marks no fence"))
            mark = None
    if mark:
        problems.append((mark[0], "marks no fence"))
    for fence in fences:
        if fence.language in SHELLS_BY_OTHER_NAMES:
            problems.append((fence.line - 1, f"is a fence of {fence.language}; call it sh, so that it is run"))
    return fences, problems


def spans_of(text):
    """Code in running text, with line numbers; fences are blanked out."""
    inside = None
    for number, line in enumerate(text.splitlines(), 1):
        mark = re.match(r"\s*(`{3,}|~{3,})", line)
        if mark and inside is None:
            inside = mark[1]
        elif mark and mark[1].startswith(inside) and line.strip() == mark[1]:
            inside = None
        elif inside is None:
            for code in re.findall(r"(?<!`)`([^`]+)`(?!`)", line):
                yield number, code


class Command:
    """What `coilwind help` says there is."""

    def __init__(self, path):
        self.path = path
        listed = re.search(r"^Commands:\n(.*?)(?:\n\n|\Z)", self.help(), re.DOTALL | re.MULTILINE)
        names = re.findall(r"^ {2}(\w[\w-]*)", listed[1], re.MULTILINE)
        self.options = {name: self.options_of(name) for name in names}
        self.options[None] = self.options_of()

    def help(self, *words):
        return subprocess.run([self.path, "help", *words], capture_output=True, text=True, check=True).stdout

    def options_of(self, *words):
        return set(re.findall(r"(?<![\w-])--[a-z][a-z0-9-]*", self.help(*words)))

    def problems(self, line, code):
        """What is called in a piece of code that does not exist."""
        code = code.replace("\\\n", "  ")
        for offset, one in enumerate(code.splitlines()):
            for call in re.finditer(r"(?:^|[\s/(])coilwind(?= )([^|;&#<>)]*)", one):
                words = call[1].split()
                name = words[0] if words and re.fullmatch(r"[a-z][a-z-]*", words[0]) else None
                if name is not None and name not in self.options:
                    yield line + offset, f"calls `coilwind {name}`, which does not exist"
                    continue
                # `-p coilwind --lib` speaks to cargo.
                if name is None and re.search(r"(-p|--package|--bin) coilwind", one):
                    continue
                for word in words:
                    option = re.match(r"--[a-z][a-z0-9-]*", word)
                    if option and option[0] not in self.options[name]:
                        yield line + offset, f"calls `coilwind {name or ''}` with {option[0]}, which does not exist"


def files_of(root):
    """What a copy holds: files that git tracks or does not ignore, as they lie here."""
    if (root / ".git").exists():
        words = ["git", "-C", root, "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
        names = subprocess.run(words, capture_output=True, text=True, check=True).stdout.split("\0")
        return [name for name in names if name and (root / name).is_file()]
    found = (path.relative_to(root) for path in root.rglob("*") if path.is_file())
    return [str(path) for path in found if path.parts[0] != "target"]


def copy_of(root, target, folder):
    for name in files_of(root):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        # With its time, so that cargo sees nothing to build anew.
        shutil.copy2(root / name, folder / name)
    (folder / "target").mkdir()
    for pattern in LINKED:
        for path in target.glob(pattern):
            (folder / "target" / path.name).symlink_to(path)
    for name in COPIED:
        if (target / name).is_dir():
            shutil.copytree(target / name, folder / "target" / name)


class Runner:
    def __init__(self, folder, python, command):
        self.folder, self.python, self.command = folder, python, command
        # what the fences of the page have printed so far, and the problems of those that show it
        self.printed, self.stale = [], []

    def run(self, fence):
        """Runs a fence; says whether there was anything to run."""
        if fence.title:
            (self.folder / fence.title).write_text(fence.text, encoding="utf-8")
        if fence.mark in SKIPPED:
            return False
        if fence.language == "sh":
            self.shell(fence)
        elif fence.language == "python" and fence.mark == "run":
            self.script(fence)
        elif fence.language == "text" and self.printed:
            self.compare(fence)
        elif fence.language == "toml":
            return self.scene(fence)
        else:
            return False
        return True

    def execute(self, words):
        """Runs a program to its end or the time limit; its exit code (None: limit) and what it printed."""
        environment = os.environ | {RUNNING: "1", "PATH": self.search_path()}
        environment.pop("CARGO_TARGET_DIR", None)
        with tempfile.TemporaryFile() as printed:
            process = subprocess.Popen(
                words, cwd=self.folder, env=environment, stdin=subprocess.DEVNULL,
                stdout=printed, stderr=subprocess.STDOUT, start_new_session=True,
            )
            try:
                code = process.wait(TIMEOUT_S)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
                code = None
            printed.seek(0)
            return code, printed.read().decode("utf-8", "replace")

    def search_path(self):
        return os.pathsep.join([str(self.python.parent), str(self.folder / "target/release"), os.environ["PATH"]])

    @staticmethod
    def judge(code, printed, line, what):
        if code == 0:
            return
        ended = f"took more than {TIMEOUT_S} s" if code is None else f"ended with {code}"
        tail = "\n".join(f"    {line}" for line in printed.splitlines()[-TAIL_LINES:])
        raise Failed(line, f"{what} {ended}; what it printed last:\n{tail}")

    def shell(self, fence):
        with tempfile.TemporaryDirectory() as aside:
            failures, script = Path(aside) / "failures", Path(aside) / "page.sh"
            trap = f"""set -eE -o pipefail; trap 'echo "$LINENO $BASH_COMMAND" >>{failures}' ERR"""
            # Line numbers in the script are those in the page.
            script.write_text(trap + "\n" * (fence.line - 1) + fence.text, encoding="utf-8")
            code, printed = self.execute(["bash", script])
            line, what = fence.line, "the fence"
            if failures.exists():
                number, _, called = failures.read_text(encoding="utf-8").partition("\n")[0].partition(" ")
                line, what = int(number), f"`{called}`"
        self.judge(code, printed, line, what)
        self.printed += printed.splitlines()

    def script(self, fence):
        with tempfile.TemporaryDirectory() as aside:
            script = Path(aside) / "page.py"
            script.write_text("\n" * (fence.line - 1) + fence.text, encoding="utf-8")
            code, printed = self.execute([str(self.python), script])
        self.judge(code, printed, fence.line, "the script")
        self.printed += printed.splitlines()

    def compare(self, fence):
        """Looks for every line of a fence among what was printed."""
        printed = [line.strip() for line in self.printed]
        for line, shown in enumerate(map(str.strip, fence.text.splitlines()), fence.line):
            pattern = re.compile(".*".join(map(re.escape, shown.split("..."))))
            if any(map(pattern.fullmatch, printed)):
                continue
            near = difflib.get_close_matches(shown, printed, 1, 0.0)
            instead = f"; the nearest that was:\n    {near[0]}" if near else ""
            self.stale.append((line, f"shows a line that no fence above it printed{instead}"))

    def scene(self, fence):
        tables = set(re.findall(r"^\s*\[+\s*([\w-]+)", fence.text, re.MULTILINE))
        if tables & MANIFEST_TABLES:
            return False
        # At the root, from which pages name meshes.
        path = self.folder / f"page-line-{fence.line}.toml"
        path.write_text(fence.text, encoding="utf-8")
        code, printed = self.execute([self.command.path, "check", path.name])
        path.unlink()
        self.judge(code, printed, fence.line, "`coilwind check` of the scene")
        return True


def refuse_what_is_old(root, fmu):
    """Ends the check where the FMU is older than a source. (The command is cargo's to judge.)"""
    sources = [path for name in SOURCES for path in [root / name, *(root / name).rglob("*")] if path.is_file()]
    newest = max(sources, key=lambda path: path.stat().st_mtime, default=None)
    if newest and fmu.exists() and fmu.stat().st_mtime < newest.stat().st_mtime:
        sys.exit(f"check_commands.py: {fmu} is older than {newest.relative_to(root)}; build it with scripts/build_fmu.sh")


def check_page(page, text, root, target, python, command):
    """Problems of a page as pairs of line number and sentence; its fences, and those that ran with their times."""
    fences, problems = fences_of(text)
    pieces = [(fence.line, fence.text) for fence in fences if fence.language not in NO_COMMANDS]
    for line, code in [*pieces, *spans_of(text)]:
        problems += command.problems(line, code)
    ran = []
    runnable = any(fence.mark not in SKIPPED and fence.language in RUN for fence in fences)
    if not problems and runnable:
        folder = target / "pages" / re.sub(r"\W+", "-", page)
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        copy_of(root, target, folder)
        runner = Runner(folder, python, command)
        try:
            for fence in fences:
                began = time.monotonic()
                if runner.run(fence):
                    ran.append((fence, time.monotonic() - began))
            problems += runner.stale
            shutil.rmtree(folder)
        except Failed as failed:
            line, sentence = failed.args
            problems.append((line, f"{sentence}\n  (its copy of the repository is left in {folder})"))
    return problems, fences, ran


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pages", nargs="*", metavar="PAGE", help="pages to check (default: all)")
    parser.add_argument("--root", type=Path, default=ROOT, help="the repository (default: this one)")
    args = parser.parse_args()
    if os.environ.get(RUNNING):
        sys.exit("check_commands.py: a page runs the check of pages; mark its fence <!-- not run: REASON -->")
    root = args.root.resolve()
    target = (root / (os.environ.get("CARGO_TARGET_DIR") or "target")).resolve()
    refuse_what_is_old(root, target / "fmu/CoilWinding.fmu")
    command = Command(str(target / "release/coilwind"))
    pages = [Path(page).resolve().relative_to(root).as_posix() for page in args.pages] or [
        *(name for name in ROOT_PAGES if (root / name).exists()),
        *sorted(path.relative_to(root).as_posix() for path in (root / "docs").rglob("*.md")),
    ]
    venv = subprocess.run([ROOT / "scripts/venv.sh"], stdout=subprocess.PIPE, text=True, check=True)
    # The path as it is printed, not what its link leads to.
    python = ROOT / venv.stdout.strip()

    began, found, total, skipped = time.monotonic(), 0, 0, 0
    for page in pages:
        text = (root / page).read_text(encoding="utf-8")
        problems, fences, ran = check_page(page, text, root, target, python, command)
        for line, sentence in sorted(problems):
            print(f"{page}:{line}: {sentence}", flush=True)
        for fence in fences:
            if fence.mark in SKIPPED:
                print(f"{page}:{fence.line}: {fence.mark}: {fence.reason}", flush=True)
                skipped += 1
        for fence, seconds in ran:
            if seconds > 20:
                print(f"{page}:{fence.line}: took {seconds:.0f} s", flush=True)
        found += len(problems)
        total += len(ran)
    took = time.monotonic() - began
    print(f"{len(pages)} pages, {total} fences run in {took:.0f} s, {skipped} not run or compared, {found} problems")
    sys.exit(found > 0)


if __name__ == "__main__":
    main()
