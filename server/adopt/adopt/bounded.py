"""Commands with a deadline, a limit of what they print, and nothing left behind. Never through a shell."""
import os
import resource
import selectors
import signal
import subprocess
import time

MAX_OUTPUT = 1 << 20  # bytes that are kept; the rest is read and thrown away


class Stalled(Exception):
    """Something of this program itself takes too long; the text says what."""


def phase(what, seconds):
    """From now on `what` must not take longer than this, until the next phase (0 seconds: no limit). The patterns and loops
    that read a stranger's text have limits of their own; this one is for what those forget."""
    def stop(*_):
        raise Stalled(f"{what} takes more than {seconds:g} s")

    signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds)


class Result:
    """What became of a command: its exit code (negative: the signal), what it printed and whether that was `cut`, whether the
    deadline ended it."""

    def __init__(self, code, output, timed_out, cut=False):
        self.code, self.output, self.timed_out, self.cut = code, output, timed_out, cut


def limit_self():
    """Limits that compilers inherit: a source that asks for endless memory or output must not take the machine down."""
    for what, most in ((resource.RLIMIT_CORE, 0), (resource.RLIMIT_FSIZE, 1 << 30), (resource.RLIMIT_AS, 3 << 30)):
        limit_to(what, most, for_good=False)


def limit_to(what, most, for_good=True):
    """Limits a resource to `most`, or to less where the system gives less. Not for good: a program may raise it again."""
    hard = resource.getrlimit(what)[1]
    soft = most if hard == resource.RLIM_INFINITY else min(most, hard)
    resource.setrlimit(what, (soft, soft if for_good else hard))


def run(argv, cwd=None, env=None, timeout=120.0):
    """Runs argv without input, in a process group of its own, which is ended with it."""
    process = subprocess.Popen(argv, cwd=cwd, env=env, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, start_new_session=True)
    kept, timed_out = bytearray(), False
    deadline = time.monotonic() + timeout
    try:
        with selectors.DefaultSelector() as selector:
            selector.register(process.stdout, selectors.EVENT_READ)
            while True:
                left = deadline - time.monotonic()
                if left <= 0 or not selector.select(left):
                    timed_out = True
                    break
                chunk = os.read(process.stdout.fileno(), 1 << 16)
                if not chunk:
                    break
                kept += chunk[:MAX_OUTPUT - len(kept)]
        if not timed_out:
            try:
                process.wait(max(deadline - time.monotonic(), 0.1))
            except subprocess.TimeoutExpired:
                timed_out = True
    finally:
        end_group(process.pid)
        process.wait()
        process.stdout.close()
    return Result(process.returncode, kept.decode("utf-8", "replace"), timed_out, len(kept) >= MAX_OUTPUT)


def end_group(group):
    """Ends every process of a group at once."""
    try:
        os.killpg(group, signal.SIGKILL)
    except (ProcessLookupError, PermissionError):
        pass
