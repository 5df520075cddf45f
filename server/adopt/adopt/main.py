"""dragonfly-adopt: the command line and the sequence of steps."""
import argparse
import os
import re
import shlex
import shutil
import signal
import sys
import tempfile

from . import bounded
from .building import Building
from .folder import FolderError, Limits
from .game import PROGRAM, Game
from .naiad import Installation
from .report import Report
from .running import Running
from .text import shown
from .trial import ScriptError, settings
from .verdicts import Verdicts

RUNS, FAILS, USAGE = 0, 1, 2
READ_SECONDS = 120  # time limit for reading the folder; a student's folder takes one or two seconds
BUILD_SECONDS = 7200  # time limit for building; the compiler gets 900 seconds of processor time

DESCRIPTION = """\
Builds and runs a game written for the published Dragonfly engine (4.1 to 4.25), or reports what prevents it.

FOLDER is only read. The program changes a private copy: it leaves out copies of the engine, and corrects lines that only other
compilers accept and the case of file names. It compiles the copy with Naiad's headers, links it with Naiad's library, and starts it as
a server, where a player presses random keys. Makefiles and project files are read, never run. The game runs in a sandbox without
a network and cannot write outside it.
"""
EPILOG = """\
The table lists what was done and, for each remaining problem, the file, the line, what to do, and where the fault is:
  the game          it does not compile with the published engine either, or a file is missing
  another engine    it was written for its author's own engine, which is in the folder
  another system    it uses something that only Windows or macOS has
  Naiad             the published engine accepts it and Naiad does not: please report it

Exit codes:
  0  it runs
  1  it does not build, or does not run
  2  wrong usage

Example: dragonfly-adopt ~/games/asteroids --keep ~/games/asteroids-naiad
"""


class Usage(Exception):
    """Raised for wrong usage. The text is the message."""


def _parser():
    parser = argparse.ArgumentParser(prog="dragonfly-adopt", description=DESCRIPTION, epilog=EPILOG, allow_abbrev=False,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="FOLDER", help="the folder with the game")
    parser.add_argument("--keep", metavar="DIR", help="keep the changed copy, with the built program, in this new folder")
    parser.add_argument("--main", metavar="FILE", help="source with the main() to build, if the folder has several programs")
    parser.add_argument("--seconds", metavar="N", type=float, default=10.0,
                        help="how long to run the game (default 10; 0: only build it)")
    parser.add_argument("--seed", metavar="N", type=int, default=1, help="seed of the random key presses (default 1)")
    parser.add_argument("--keys", metavar="SCRIPT",
                        help="press these keys instead: a script, or a file with one, as for dfbot --script")
    parser.add_argument("--players", metavar="N", type=int, default=1,
                        help="number of players that join and press keys, 1 to 16 (default 1)")
    parser.add_argument("--book", action="store_true",
                        help="build with the book's rules, as dragonfly_game() does, not the published engine's")
    parser.add_argument("--cxx", metavar="COMPILER", help="the compiler (default: $CXX, else g++, else clang++)")
    parser.add_argument("--unconfined", action="store_true",
                        help="run the game without the sandbox, if the kernel has none; only for a game that you trust")
    parser.add_argument("--json", action="store_true", help="print JSON instead of the table")
    parser.add_argument("--quiet", action="store_true", help="do not show progress on stderr")
    return parser


def _compiler(asked):
    for name in [asked] if asked else [os.environ.get("CXX"), "g++", "clang++"]:
        if name and shutil.which(name):
            return shutil.which(name)
    raise Usage(f"--cxx {asked}: compiler not found" if asked else "no compiler found: install g++")


def _check(options):
    if not os.path.isdir(options.folder):
        raise Usage(f"{options.folder}: no such folder")
    if not 0 <= options.seconds <= 3600:
        raise Usage(f"--seconds {options.seconds:g}: expected 0 to 3600")
    if not 1 <= options.players <= 16:
        raise Usage(f"--players {options.players}: expected 1 to 16")
    if options.keep:
        top, keep = os.path.realpath(options.folder), os.path.realpath(options.keep)
        if os.path.lexists(options.keep):
            raise Usage(f"--keep {options.keep}: already exists")
        if (keep + os.sep).startswith(top + os.sep):
            raise Usage(f"--keep {options.keep}: must be outside of the game's folder")
        if not os.path.isdir(os.path.dirname(keep)):
            raise Usage(f"--keep {options.keep}: {os.path.dirname(keep)} is not a folder")
    if options.keys and os.path.isfile(options.keys):
        with open(options.keys, encoding="utf-8", errors="replace") as file:
            options.keys = file.read(1 << 20)


def _progress(quiet):
    if quiet:
        return lambda text: None
    if sys.stderr.isatty():
        def say(text):
            sys.stderr.write(f"\r\x1b[K{text}")
            sys.stderr.flush()
        return say
    last = [""]

    def say_once(text):
        step = re.sub(r" \d+ of ", " ", text)  # not a terminal: one line for each step
        if text and step != last[0]:
            sys.stderr.write(step + "\n")
        last[0] = step
    return say_once


def adopt(game, compiler, options, say):
    """Copies, builds and runs a game. The verdict is in the game's report."""
    program = None
    try:
        program = _judge(game, compiler, options, say)
    except bounded.Stalled as error:
        game.report.fail(game.report.result, str(error))
    finally:
        bounded.phase("", 0)
    if options.keep and os.path.isdir(game.tree):
        shutil.move(game.tree, options.keep)
        place, command = program or ("", "")
        play = f"; to play it as it was run here: cd {shlex.quote(os.path.normpath(os.path.join(options.keep, place)))} && {command}" if program else ""
        game.report.add("kept", options.keep, "the changed copy" + play)


def _judge(game, compiler, options, say):
    """Builds and runs the game. Returns (folder of the copy to start it in, command), or None if it does not build."""
    bounded.phase("reading the folder", READ_SECONDS)
    say("copying")
    game.copy_in()
    if not game.choose_program(options.main):
        return None
    building = Building(game, compiler, say)
    if options.book:
        building.compiler.definitions.append("-DDF_COMPAT=0")
    game.report.result = "does not build"
    bounded.phase("building the game", BUILD_SECONDS)
    built = building.build()
    Verdicts(game, building).say(built)
    if not built:
        return None
    game.report.result = "builds"
    bounded.phase("running the game", 2 * options.seconds + BUILD_SECONDS)  # after a crash it is built and run again
    running = Running(game, building, options, say)
    running.run()
    words = [f"{name}={value}" for name, value in settings(options.seed).items()]
    return running.folder, " ".join(words + [os.path.join(os.path.relpath(".", running.folder or "."), PROGRAM)])


def _print(report, as_json):
    """Prints the report. Returns whether it could be written."""
    try:
        (report.write_json if as_json else report.write)(sys.stdout)
        sys.stdout.flush()
        return True
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # because Python flushes stdout again when it exits
        if not isinstance(error, BrokenPipeError):  # expected with `| head`
            sys.stderr.write(f"dragonfly-adopt: {error}\n")
        return False


def main(include, lib, bin_folder, names, arguments=None):
    """Runs the command line and returns the exit code. The folders are those of the installation."""
    arguments = sys.argv[1:] if arguments is None else arguments
    parser = _parser()
    options = parser.parse_args(arguments)
    try:
        _check(options)
        compiler = _compiler(options.cxx)
    except Usage as error:
        sys.stderr.write(f"dragonfly-adopt: {error}\nTry dragonfly-adopt --help.\n")
        return USAGE
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))  # so that the scratch folder is removed
    bounded.limit_self()
    say = _progress(options.quiet)
    scratch = tempfile.mkdtemp(prefix="dragonfly-adopt-")
    try:
        naiad, report = Installation(include, lib, bin_folder, names), Report(options.folder)
        adopt(Game(options.folder, scratch, naiad, report, Limits()), compiler, options, say)
    except FolderError as error:
        say("")
        sys.stderr.write(f"dragonfly-adopt: {error}\n")
        return USAGE
    except ScriptError as error:
        say("")
        sys.stderr.write(f"dragonfly-adopt: --keys: {error}\nTry dragonfly-adopt --help.\n")
        return USAGE
    except (OSError, MemoryError) as error:
        say("")
        sys.stderr.write(f"dragonfly-adopt: {shown(str(error) or 'out of memory')}\n")
        return FAILS
    except KeyboardInterrupt:
        say("")
        return 128 + signal.SIGINT
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
    say("")
    if not _print(report, options.json):
        return FAILS
    return RUNS if report.result in ("runs", "builds; not run") else FAILS
