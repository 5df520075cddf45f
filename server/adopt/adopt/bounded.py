"""Runs commands with a deadline and limited output, leaving no processes behind. Never uses a shell."""
import math
import os
import resource
import selectors
import signal
import subprocess
import time

MAX_OUTPUT = 1 << 20  # maximum bytes of a command's output that are kept; further output is discarded
WALL_FACTOR = 8  # how many times a command's processor time it may take in all, because the machine may be loaded


class Stalled(Exception):
    """Raised when a phase of this program takes too long. The text names the phase."""


def phase(what, seconds):
    """Begins a phase of this program; raises Stalled if it takes longer than `seconds` (0: no limit). This is a safety net: code
    that reads untrusted text has limits of its own."""
    def stop(*_):
        raise Stalled(f"{what} took more than {seconds:g} s")

    signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds)


class Result:
    """The result of a command: exit code (negative: signal), output, whether the output was `cut`, and whether it timed out."""

    def __init__(self, code, output, timed_out, cut=False):
        self.code, self.output, self.timed_out, self.cut = code, output, timed_out, cut


def limit_self():
    """Limits this process and the compilers it starts, because a source can make a compiler use endless memory or disk."""
    for what, most in ((resource.RLIMIT_CORE, 0), (resource.RLIMIT_FSIZE, 1 << 30), (resource.RLIMIT_AS, 3 << 30)):
        limit_to(what, most, for_good=False)


def limit_to(what, most, for_good=True):
    """Limits a resource to `most`, or to the system's limit if that is lower. Programs may raise it again if not `for_good`."""
    hard = resource.getrlimit(what)[1]
    soft = most if hard == resource.RLIM_INFINITY else min(most, hard)
    resource.setrlimit(what, (soft, soft if for_good else hard))


def run(argv, cwd=None, env=None, timeout=120.0):
    """Runs argv without input, in a process group of its own that is killed at the end. Each of its processes may use `timeout`
    seconds of processor time, rounded up; all may take WALL_FACTOR times as long."""
    process = subprocess.Popen(argv, cwd=cwd, env=env, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, start_new_session=True)
    hard = resource.getrlimit(resource.RLIMIT_CPU)[1]
    cpu = math.ceil(timeout) if hard == resource.RLIM_INFINITY else min(math.ceil(timeout), hard)
    resource.prlimit(process.pid, resource.RLIMIT_CPU, (cpu, hard))  # before it has started others
    kept, timed_out = bytearray(), False
    deadline = time.monotonic() + timeout * WALL_FACTOR
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
    output = kept.decode("utf-8", "replace")
    timed_out = timed_out or process.returncode == -signal.SIGXCPU or "CPU time limit exceeded" in output
    return Result(process.returncode, output, timed_out, len(kept) >= MAX_OUTPUT)


def children_seconds():
    """Returns the processor time of all ended processes that this one has started."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def end_group(group):
    """Kills all processes of a group."""
    try:
        os.killpg(group, signal.SIGKILL)
    except (ProcessLookupError, PermissionError):
        pass
