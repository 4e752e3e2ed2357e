"""scripts/docs/check_commands.py finds what is wrong in pages, and names page and line."""

import os
import subprocess
import sys

import pytest


@pytest.fixture
def check(planted, root):
    """Exit code and output of the checker for one page."""

    def run(text, **environment):
        folder = planted({"README.md": text, "docs/empty.md": "# Empty\n"})
        words = [sys.executable, root / "scripts/docs/check_commands.py", "--root", folder]
        # The planted repository has a target folder of its own; the environment of the tests must not say otherwise.
        inherited = {name: value for name, value in os.environ.items() if name != "CARGO_TARGET_DIR"}
        done = subprocess.run(words, env=inherited | environment, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    return run


def page(language, body, mark=None):
    """A page whose fence has its first line of content on line 4, or 5 below a mark."""
    above = f"{mark}\n" if mark else ""
    return f"# Page\n\n{above}```{language}\n{body}\n```\n"


def test_a_command_that_works_passes(check):
    code, said = check(page("sh", "coilwind check fig8\ntarget/release/coilwind variables >variables.txt"))
    assert code == 0, said
    assert "1 fences run" in said


def test_a_dead_command_is_named_with_page_line_and_output(check):
    code, said = check(page("sh", "echo first\necho to-be-seen >&2; ls no-such-file\necho last"))
    assert code == 1
    assert "README.md:5: `ls no-such-file` ended with 2" in said
    assert "to-be-seen" in said
    assert "    last" not in said


def test_a_command_that_dies_in_a_pipe_is_found(check):
    code, said = check(page("sh", "ls no-such-file | cat"))
    assert code == 1
    assert "README.md:4:" in said


def shown(text, mark=None):
    """A page that prints two lines and shows this text below."""
    return page("sh", "echo one 1.5; echo two") + "\n" + (f"{mark}\n" if mark else "") + f"```text\n{text}\n```\n"


@pytest.mark.parametrize("text", ["two", "one 1.5\ntwo", "...\ntwo", "one ...", "  two"])
def test_what_was_printed_may_be_shown_in_part(check, text):
    code, said = check(shown(text))
    assert code == 0, said


@pytest.mark.parametrize("text", ["one 1.4", "one", "on... 1.4"])
def test_a_shown_line_that_was_not_printed_is_named_with_the_nearest(check, text):
    code, said = check(shown(text))
    assert code == 1
    assert "README.md:8: shows a line that no fence above it printed" in said
    assert "    one 1.5" in said


def test_a_text_with_nothing_run_above_it_is_no_output(check):
    code, said = check("# Page\n\n```text\ntree\n```\n\n```sh\necho two\n```\n")
    assert code == 0, said


def test_a_marked_text_is_counted_and_not_compared(check):
    code, said = check(shown("three", "<!-- not compared: another each time -->"))
    assert code == 0, said
    assert "README.md:9: not compared: another each time" in said


def test_a_text_that_is_not_compared_needs_a_reason(check):
    code, said = check(shown("three", "<!-- not compared -->"))
    assert code == 1
    assert "gives no reason" in said


def test_a_fence_in_a_list_is_run(check):
    code, said = check("# Page\n\n- item\n\n    ```sh\n    false\n    ```\n")
    assert code == 1
    assert "README.md:6: `false` ended with 1" in said


def test_a_marked_fence_is_counted_and_not_run(check):
    code, said = check(page("sh", "false", "<!-- not run: takes an hour -->"))
    assert code == 0, said
    assert "README.md:5: not run: takes an hour" in said
    assert "0 fences run" in said and "1 not run or compared" in said


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        (page("sh", "true", "<!-- not run: -->"), "README.md:3: gives no reason"),
        ("# Page\n\n<!-- not run: why -->\n\nText.\n", "README.md:3: marks no fence"),
        ("# Page\n\n<!-- run -->\n", "README.md:3: marks no fence"),
        ("# Page\n\n```sh\ntrue\n", "README.md:3: opens a fence that does not end"),
        (page("bash", "true"), "README.md:3: is a fence of bash"),
    ],
)
def test_marks_and_fences_that_would_hide_a_command_are_refused(check, text, complaint):
    code, said = check(text)
    assert code == 1
    assert complaint in said


def test_python_without_a_mark_is_not_run(check):
    code, said = check(page("python", "1 / 0"))
    assert code == 0, said
    assert "0 fences run" in said


def test_python_with_a_mark_is_run_beside_fmpy(check):
    code, said = check(page("python", "import fmpy\n\n1 / 0", "<!-- run -->"))
    assert code == 1
    assert "README.md:5: the script ended with 1" in said
    # The traceback has the page's own line.
    assert "line 7" in said and "ZeroDivisionError" in said


def test_a_fence_with_a_title_is_a_file_for_later_commands(check):
    text = page("toml title=\"mine.toml\"", "[wire]\ndiameter_mm = 0.5") + page("sh", "coilwind check mine.toml")
    code, said = check(text)
    assert code == 0, said
    assert "2 fences run" in said


@pytest.mark.parametrize(
    ("scene", "passes"),
    [
        ("[wire]\ndiameter_mm = 0.5", True),
        ("[wire]\ndiametre_mm = 0.5", False),
        ("[wier]\ndiameter_mm = 0.5", False),
        ('[dependencies]\ncoilwind = { version = "0.1", default-features = false }', True),
    ],
)
def test_a_scene_has_to_pass_coilwind_check(check, scene, passes):
    code, said = check(page("toml", scene))
    assert (code == 0) == passes, said
    assert passes or "README.md:4: `coilwind check` of the scene ended with 2" in said


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("Text with `coilwind run fig8 --framez 3` in it.\n", "README.md:1: calls `coilwind run` with --framez"),
        ("\nText with `coilwind wind fig8` in it.\n", "README.md:2: calls `coilwind wind`"),
        (page("text", "$ coilwind check fig8 \\\n    --out x"), "README.md:4: calls `coilwind check` with --out"),
        (
            page("sh", "true\ntarget/release/coilwind verify --jsn", "<!-- not run: long -->"),
            "README.md:6: calls `coilwind verify` with --jsn",
        ),
    ],
)
def test_options_and_subcommands_that_do_not_exist_are_found(check, text, complaint):
    code, said = check(text)
    assert code == 1
    assert complaint in said


def test_options_of_other_programs_on_the_same_line_are_left_alone(check):
    code, said = check("`coilwind variables --json | jq --raw-output .` and `cargo build -p coilwind --lib`\n")
    assert code == 0, said


def test_pages_do_not_touch_the_repository_nor_its_results(check, tmp_path):
    code, said = check(page("sh", "touch new README.md\nrm -r docs\nmkdir target/demo\necho x >target/fmu/CoilWinding.fmu"))
    assert code == 0, said
    left = {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*") if not path.is_symlink()}
    assert left == {"README.md", "docs", "docs/empty.md", "target", "target/pages"}
    assert (tmp_path / "target/fmu/CoilWinding.fmu").stat().st_size > 100_000


def test_a_page_that_checks_pages_is_refused(check, root):
    code, said = check(page("sh", f"{sys.executable} {root}/scripts/docs/check_commands.py"))
    assert code == 1
    assert "a page runs the check of pages" in said


def test_an_fmu_older_than_its_sources_is_refused(planted, root):
    folder = planted({"README.md": "# Page\n", "src/lib.rs": "// newer than any FMU\n"})
    words = [sys.executable, root / "scripts/docs/check_commands.py", "--root", folder]
    inherited = {name: value for name, value in os.environ.items() if name != "CARGO_TARGET_DIR"}
    done = subprocess.run(words, env=inherited, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "CoilWinding.fmu is older than src/lib.rs; build it with scripts/build_fmu.sh" in done.stderr
