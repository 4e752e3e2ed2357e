"""How a script fails: one line on standard error, and the exit code that `coilwind` has for it."""

import contextlib
import os
import shlex
import signal
import sys

# 128 + SIGINT; `coilwind` ends with it on SIGTERM too.
STOPPED = 130


class Mistake(Exception):
    """What the user can mend, in a line."""

    code = 2


class Stuck(Mistake):
    """What ended the work on its way, such as a full disk or a lost scheduler."""

    code = 3


class Interrupted(Mistake):
    """Ctrl-C or SIGTERM."""

    code = STOPPED


@contextlib.contextmanager
def told(script):
    """Tells what goes wrong within in a line, and exits. Ctrl-C and SIGTERM raise `KeyboardInterrupt` there, a second one ends the script at once."""
    with stoppable():
        try:
            yield
            return
        except Mistake as mistake:
            code, reason = mistake.code, str(mistake)
        except KeyboardInterrupt:
            code, reason = STOPPED, "interrupted; nothing is kept"
        except OSError as error:
            if error.filename is None:
                raise
            code, reason = Mistake.code, f"{error.filename}: {error.strerror}"
        print(f"{script}: {reason}", file=sys.stderr)
    sys.exit(code)


@contextlib.contextmanager
def stoppable():
    def stop(_number, _frame):
        for number in numbers:
            signal.signal(number, lambda *_: os._exit(STOPPED))
        raise KeyboardInterrupt

    numbers = (signal.SIGINT, signal.SIGTERM)
    before = {number: signal.signal(number, stop) for number in numbers}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def same_command():
    """The command that was given, without --force."""
    words = [word for word in sys.argv if not (word.startswith("--fo") and "--force".startswith(word))]
    return shlex.join([sys.executable, *words])
