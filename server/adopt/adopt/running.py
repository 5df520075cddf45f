"""Runs a built game and reports the result."""
import os

from . import blame as faults
from . import sandbox
from .examine import frame_of
from .files import missing_files, refused_sprites, run_folder
from .game import PROGRAM
from .keys import keys_of
from .programs import has_run
from .report import MAX_ROWS
from .trial import START_SECONDS, Trial

_CRASH_ADVICE = ("check the pointers in this line: getSound(), getSprite() and objectWithId() return null if they find nothing, "
                 "and a deleted Object must not be used")
FAILURES = (sandbox.SandboxError, RuntimeError, OSError)  # failures of the sandbox or of copying into it
_NOTED_LINES = 4  # maximum lines that the report shows of a game's output, and of its log


class Running:
    """The run of a built game. `options` are those of the command line."""

    def __init__(self, game, building, options, say):
        self._game, self._building, self._options, self._say, self._report = game, building, options, say, game.report
        self._names = [unit.name for unit in building.units]
        self.folder = run_folder(game.files, game.sources, game.program)
        self._root = os.path.join(game.scratch, "root")

    def run(self):
        """Runs the game. Writes rows and the result into the report."""
        self._report_missing()
        if self._options.seconds == 0:
            self._report.result = "builds; not run"
            return
        os.makedirs(self._root, exist_ok=True)
        reason = None if self._options.unconfined else sandbox.unavailable_reason(self._root)
        if reason:
            self._report.fail("builds", f"not run: no sandbox for this user on this kernel ({reason}); if you trust the game, "
                                        "use --unconfined")
            return
        named_keys = keys_of(self._game.sources.code(name) for name in self._game.sources.files)
        trial = Trial(self._game.tree, PROGRAM, self.folder, self._game.naiad, self._options.seconds, self._options.seed,
                      self._options.keys, named_keys, players=self._options.players)
        self._say(f"running the game for {self._options.seconds:g} s")
        try:
            outcome = trial.run(self._root, confined=not self._options.unconfined)
        except FAILURES as error:
            self._report.fail("builds", f"not run: {error}")
            return
        self._report_outcome(outcome)
        if not outcome.runs:
            self._explain(outcome, trial)

    def _report_missing(self):
        if not has_run(self._names, self._game.sources.code):
            self._report.add_left(self._game.program.main, faults.THEIRS, "nothing calls GM.run()",
                                  "call GM.run() between GM.startUp() and GM.shutDown()")
        for file, line, event in faults.unregistered(self._game.sources, self._names):
            self._report.add("note", f"{file}:{line}", f"no Object registers interest in {event}, so it never arrives here")
        missing = missing_files(self._game.files, self._game.sources, self._names, self.folder)
        for file, line, path, instead in missing[:MAX_ROWS]:
            self._report.add_left(f"{file}:{line}", faults.THEIRS, f"{path} is not in the folder",
                                  f"write {instead}" if instead else "add the file, or correct its name",
                                  self._game.sources.line(file, line))

    def _report_outcome(self, outcome):
        for file, line, text in refused_sprites(outcome.log, self.folder)[:MAX_ROWS]:
            self._report.add_left(f"{file}:{line}", faults.UNCLEAR, text,
                                  "correct this line of the sprite, or report it if the published engine loads this sprite")
        seconds, rounds = self._options.seconds, f", {outcome.rounds} times" if outcome.rounds > 1 else ""
        text = {
            "played": f"{outcome.ticks} ticks in {seconds:g} s with key presses, {outcome.objects} Objects in view at the end",
            "over": f"it ended normally after {outcome.seconds:.1f} s{rounds}: the game was over",
            "unplayed": "main() returned 0 before a game started",
            "failed": f"it ended with exit code {outcome.code}",
            "crashed": f"it crashed after {outcome.seconds:.1f} s{_signal_of(outcome.code)}",
            "deaf": f"it did not start within {START_SECONDS} s: it computes or waits before GM.run()",
            "hangs": f"it stopped responding after {outcome.ticks} ticks" + f": {outcome.text}" * bool(outcome.text),
            "refused": f"the player could not play: {outcome.text}"}[outcome.state]
        self._report.add("ran", f"in {self.folder}/" if self.folder else "", text)
        if outcome.runs:
            self._report.result = "runs"
            if not outcome.ended_well:
                self._report.add("note", "", "it crashes or does not end after GM.run()")
            return
        self._report.fail("builds", {
            "crashed": "it crashes", "unplayed": "it never calls GM.run()", "failed": "it ends with an error",
            "deaf": "it does not start", "hangs": "it hangs", "refused": "no player can join it"}.get(
                outcome.state, "it ends before a player can play"))

    def _explain(self, outcome, trial):
        main = self._game.program.main
        if outcome.state == "unplayed":
            if not self._report.has_left(main):
                self._report.add_left(main, faults.THEIRS, "main() returns before a game has run",
                                      "GM.startUp() must return 0, and GM.run() must be called; the game's output is below")
        elif outcome.state == "crashed":
            self._report_crash(outcome, trial)
        else:
            text = {"failed": "it ends with an error", "deaf": "it does not start", "over": "it ends at once",
                    "refused": "the player could not play"}.get(outcome.state, "a handler does not return")
            self._report.add_left(main, faults.UNCLEAR, text, "the game's output and log are below")
        for name, said in (("printed", outcome.printed), ("logged", outcome.log)):
            for line in [line for line in said.splitlines() if line.strip()][-_NOTED_LINES:]:
                self._report.add("note", name, line)

    def _report_crash(self, outcome, trial):
        """Reports the place of a crash, found by building and running the game with an address sanitizer."""
        frame = self._crash_location(trial)
        if frame:
            place, what = frame
            file, _, line = place.rpartition(":")
            code = self._game.sources.line(file, int(line))
            # getSprite() of a refused sprite may be the bad pointer; the line of GM.run() only says that the game was running.
            unclear = ".run()" in code or refused_sprites(outcome.log, self.folder)
            self._report.add_left(place, faults.UNCLEAR if unclear else faults.THEIRS, what, _CRASH_ADVICE, code)
        else:
            self._report.add_left(self._game.program.main, faults.UNCLEAR,
                                  f"it crashes{_signal_of(outcome.code)}; the line is unknown",
                                  "compile it with -g -fsanitize=address and run it")

    def _crash_location(self, trial):
        self._say("it crashed: building it again to find the line")
        program = self._game.program_path
        plain = program + ".plain"
        os.rename(program, plain)
        try:
            if not self._building.build_examined(program):
                return None
            trial.examined = True
            self._say("running it again to find the line of the crash")
            printed = trial.run(self._root, confined=not self._options.unconfined).printed
            return frame_of(printed, self._game.sources.files)
        except FAILURES:
            return None
        finally:
            os.replace(plain, program)


def _signal_of(code):
    names = {4: "an illegal instruction", 6: "abort()", 7: "a bus error", 8: "a division by zero", 11: "a segmentation fault",
             24: "too much processor time", 25: "a file of more than 32 MiB"}
    return f": {names.get(-code, f'signal {-code}')}" if code is not None and code < 0 else ""
