"""Helpers of the tests of dragonfly-adopt: a scratch folder, runs of the program, time limits."""
import atexit
import contextlib
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile

import fixtures

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
MODULES = os.path.join(ROOT, "server", "adopt")
BUILD = os.path.abspath(sys.argv[1])
PROGRAM = os.path.join(BUILD, "bin", "dragonfly-adopt")
WORK = tempfile.mkdtemp(prefix="adopt-test-")
atexit.register(shutil.rmtree, WORK, ignore_errors=True)


def fingerprint(place):
    """Returns path, mode, size and time of everything in a folder."""
    found = []
    for where, folders, files in os.walk(place):
        for name in sorted(folders + files):
            path = os.path.join(where, name)
            status = os.lstat(path)
            found.append((path, status.st_mode, status.st_size, status.st_mtime_ns))
    return sorted(found)


class Adopted:
    """A fixture's folder, and the output of dragonfly-adopt for it."""

    def __init__(self, name, files, *arguments, prepare=None):
        self.name, self.files, self.arguments, self.prepare, self.code = name, files, arguments, prepare, None

    def run(self):
        self.folder = os.path.join(WORK, self.name, "$(touch INJECTED) game")
        fixtures.write(self.folder, self.files)
        if self.prepare:
            self.prepare(self.folder)
        before = fingerprint(self.folder)
        self.keep = os.path.join(WORK, self.name, "kept")
        done = subprocess.run([PROGRAM, self.folder, "--json", "--quiet", "--seconds", "0.6", "--keep", self.keep,
                               *self.arguments], cwd=os.path.join(WORK, self.name), stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, timeout=300, check=False)
        self.code, self.stderr = done.returncode, done.stderr
        self.untouched = fingerprint(self.folder) == before
        self.answer = json.loads(done.stdout) if done.stdout.startswith("{") else None
        return self

    def rows(self, what, where=None):
        return [row for row in self.answer["rows"] if row["what"] == what and (where is None or row["where"] == where)]

    def changes(self):
        return {row["where"]: row["change"] for row in self.rows("treated")}


def made(files):
    """Writes these files into a new folder. Returns its path."""
    place = tempfile.mkdtemp(dir=WORK)
    fixtures.write(place, files)
    return place


@contextlib.contextmanager
def within(test, seconds, what):
    """Fails the test if the body of the `with` statement takes more than `seconds` of this process's CPU time."""
    before = signal.signal(signal.SIGPROF, lambda *_: test.fail(f"{what} takes longer than {seconds} s"))
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def run_as_user(test, script, *arguments):
    """Runs a Python script as an ordinary user, because root has other limits. Skips the test if that is impossible."""
    other = {"user": 65534, "group": 65534, "extra_groups": []} if os.geteuid() == 0 else {}
    try:
        return subprocess.run(["/usr/bin/python3", "-c", script, MODULES, *arguments], capture_output=True, text=True, check=False,
                              timeout=60, **other)
    except PermissionError as error:
        return test.skipTest(f"cannot run as another user: {error}")
