"""dragonfly-mark: builds and plays each game in a folder of games, and reports the results."""
import argparse
import concurrent.futures
import csv
import json
import os
import re
import signal
import subprocess
import sys

from .bounded import end_group
from .text import shown

MARKED, INCOMPLETE, USAGE = 0, 1, 2
MAX_TEXT = 200  # maximum characters of a finding in the list
_SPARE_SECONDS = 15_000  # time limit of a game, in addition to 4 times --seconds; dragonfly-adopt's own limits are lower

DESCRIPTION = """\
Builds and plays games with dragonfly-adopt. FOLDER contains a folder for each student. Each game is built from a private copy, with
the book's rules, and runs in a sandbox without a network, with players that press keys. Nothing in FOLDER is changed.
"""
EPILOG = """\
Prints a line for each folder: its name; "runs", "builds" (but does not run), "does not build", "not a game" or "not judged"; details.
Folders whose names begin with a dot are left out.

Exit codes:
  0  every game was judged, whatever the results
  1  a game could not be judged (no sandbox, or dragonfly-adopt failed), or a report could not be written
  2  wrong usage

Example: dragonfly-mark handed-in --report marks.md
"""


class Verdict:
    """The result of one folder: its `name`, dragonfly-adopt's `result`, the main finding as `text`, and the report's `rows`."""

    def __init__(self, name, result, text, rows=()):
        self.name, self.result, self.text, self.rows = name, result, text, rows

    @property
    def is_judged(self):
        return self.result != "not judged"


def verdict_of(name, answer):
    """Converts the JSON report of dragonfly-adopt to a Verdict."""
    rows, reason = answer["rows"], answer["reason"]
    if reason.startswith("not run:"):  # the sandbox failed, not the game
        return Verdict(name, "not judged", reason, rows)
    ran = next((row["text"] for row in rows if row["what"] == "ran"), "")
    left = next((": ".join(part for part in (row["where"], row["text"]) if part) for row in rows if row["what"] == "left"), "")
    if answer["result"] == "runs":
        return Verdict(name, "runs", ran or reason, rows)
    return Verdict(name, answer["result"], (f"{reason}: {ran}" if ran else left) or reason, rows)


def mark(adopt, folder, name, options):
    """Runs dragonfly-adopt on one folder. Returns the Verdict."""
    command = [adopt, os.path.join(folder, name), "--book", "--json", "--quiet", "--seconds", str(options.seconds), "--seed",
               str(options.seed), "--players", str(options.players)]
    for option in ("keys", "cxx"):
        if getattr(options, option):
            command += ["--" + option, getattr(options, option)]
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True)
    try:
        out, said = process.communicate(timeout=options.seconds * 4 + _SPARE_SECONDS)
        return verdict_of(name, json.loads(out))
    except subprocess.TimeoutExpired:
        return Verdict(name, "not judged", "it took too long and was stopped")
    except (ValueError, KeyError, TypeError):
        lines = said.decode("utf-8", "replace").strip().splitlines()
        return Verdict(name, "not judged", lines[0].removeprefix("dragonfly-adopt: ") if lines else "dragonfly-adopt failed")
    finally:
        end_group(process.pid)


def write_report(file, verdicts):
    """Writes a Markdown table of the results, then the findings of each folder."""
    cell = lambda text: shown(text, 400).replace("|", "\\|")
    file.write("| game | result | seen |\n|---|---|---|\n")
    for one in verdicts:
        file.write(f"| {cell(one.name)} | {one.result} | {cell(one.text)} |\n")
    for one in verdicts:
        findings = [row for row in one.rows if row["what"] in ("left", "ran", "note", "treated")]
        if not findings:
            continue
        file.write(f"\n## {shown(one.name)}\n\n")
        for row in findings:
            line = ": ".join(part for part in (row["where"], row["text"]) if part)
            advice = f" -> {row['change']}" if row["what"] == "left" and row["change"] else ""
            file.write(f"- {row['what']}: {_plain(line + advice)}\n")


def _plain(text):
    """Escapes text so that Markdown shows it unchanged."""
    return re.sub(r"([<>`*_\[\]|])", r"\\\1", shown(text, 600))


def _parser():
    parser = argparse.ArgumentParser(prog="dragonfly-mark", description=DESCRIPTION, epilog=EPILOG, allow_abbrev=False,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="FOLDER", help="a folder that contains a folder for each game")
    parser.add_argument("--seconds", metavar="N", type=float, default=10.0, help="seconds to play each game (default 10)")
    parser.add_argument("--players", metavar="N", type=int, default=2, help="number of players in each game, 1 to 16 (default 2)")
    parser.add_argument("--seed", metavar="N", type=int, default=1, help="seed of the random key presses (default 1)")
    parser.add_argument("--keys", metavar="SCRIPT", help="press these keys instead: a script, or a file with one, as for dfbot --script")
    parser.add_argument("--jobs", metavar="N", type=int, default=1, help="number of games to play in parallel, 1 to 64 (default 1)")
    parser.add_argument("--report", metavar="FILE", help="also write a Markdown table with the findings for each game to FILE")
    parser.add_argument("--csv", metavar="FILE", help="also write a table for a spreadsheet to FILE")
    parser.add_argument("--cxx", metavar="COMPILER", help="the compiler (default: $CXX, else g++, else clang++)")
    return parser


def _fault(options):
    """Returns a message about wrong usage, or None."""
    if not os.path.isdir(options.folder):
        return f"{options.folder}: no such folder"
    if not 0 < options.seconds <= 3600:
        return f"--seconds {options.seconds:g}: expected more than 0, at most 3600"
    if not 1 <= options.players <= 16:
        return f"--players {options.players}: expected 1 to 16"
    if not 1 <= options.jobs <= 64:
        return f"--jobs {options.jobs}: expected 1 to 64"
    return None


def main(adopt, arguments=None):
    """Runs the command line and returns the exit code. `adopt` is the path of dragonfly-adopt."""
    options = _parser().parse_args(arguments)
    fault = _fault(options)
    names = [] if fault else sorted(entry.name for entry in os.scandir(options.folder)
                                    if entry.is_dir(follow_symlinks=False) and not entry.name.startswith("."))
    if not fault and not names:
        fault = f"{options.folder}: contains no folders"
    if fault:
        sys.stderr.write(f"dragonfly-mark: {fault}\nTry dragonfly-mark --help.\n")
        return USAGE
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    verdicts, width = [], max(len(shown(name, 40)) for name in names)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for one in pool.map(lambda name: mark(adopt, options.folder, name, options), names):
            verdicts.append(one)
            print(f"{shown(one.name, 40):{width}}  {one.result:14}  {shown(one.text, MAX_TEXT)}", flush=True)
    running = sum(one.result == "runs" for one in verdicts)
    print(f"{len(verdicts)} games: {running} run, {len(verdicts) - running} do not")
    try:
        if options.report:
            with open(options.report, "w", encoding="utf-8") as file:
                write_report(file, verdicts)
        if options.csv:
            with open(options.csv, "w", encoding="utf-8", newline="") as file:
                table = csv.writer(file)
                table.writerow(("game", "result", "seen"))
                # A spreadsheet would execute a cell that begins with one of these.
                safe = lambda text: "'" + text if text[:1] in ("=", "+", "-", "@") else text
                table.writerows([safe(shown(text, 400)) for text in (one.name, one.result, one.text)] for one in verdicts)
    except OSError as error:
        sys.stderr.write(f"dragonfly-mark: {error}\n")
        return INCOMPLETE
    return MARKED if all(one.is_judged for one in verdicts) else INCOMPLETE
