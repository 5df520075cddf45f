"""One folder from copy to verdict."""
import os
import re
import shutil

from . import blame as faults
from . import sandbox
from .blame import Blame
from .compiler import STANDARDS, Compiler, Unit
from .engine import EngineCopies, stem
from .examine import frame_of
from .files import missing_files, refused_sprites, run_folder
from .folder import copy_folder, is_code, is_source
from .includes import Includes, header_folders
from .keys import keys_of
from .naiad import system_headers
from .project import has_run, programs, read_lists
from .report import Report
from .text import Sources
from .treatments import Treatments
from .trial import Trial

PROGRAM = "naiad-game"
MAX_ROUNDS = 12  # of treating and compiling again
MAX_ROWS = 12  # of one kind
MAX_ERRORS = 3  # of one source: the first is the cause of most others


class Adoption:
    """Does it, and keeps what the steps share."""

    def __init__(self, options, naiad, compiler, scratch, say, limits):
        self._options, self._naiad, self._compiler_path, self._say, self._limits = options, naiad, compiler, say, limits
        self._scratch = scratch
        self.tree = os.path.join(scratch, "copy")
        self.program_path = ""
        self._engine_tree = os.path.join(scratch, "engine")
        self.report = Report(options.folder)

    def run(self):
        """Returns the report."""
        if self._copy() and self._choose():
            self._treat_includes()
            if self._build():
                self._try()
        return self.report

    # Taking it in

    def _copy(self):
        self._say("copying")
        copy = copy_folder(self._options.folder, self.tree, self._limits)
        code = [name for name in copy.files if is_code(name)]
        self._engine = EngineCopies(self.tree, code, self._naiad.headers)
        self._say_left_out(copy.left_out)
        for name in self._engine.files:
            os.makedirs(os.path.join(self._engine_tree, os.path.dirname(name)), exist_ok=True)
            shutil.move(copy.path(name), os.path.join(self._engine_tree, name))
        for folder, count in sorted(self._engine.folders().items())[:MAX_ROWS]:
            what = "an engine of the author's own" if self._engine.own else "a copy of the engine"
            self.report.add("left out", folder, f"{count} file{'s' * (count > 1)} of {what}: Naiad's are taken")
        gone = set(self._engine.files)
        self._files = [name for name in copy.files if name not in gone]
        self._sources = Sources(self.tree, [name for name in self._files if is_code(name)])
        for name in self._sources.recoded:
            self.report.add("treated", name, "was in UTF-16, is in UTF-8 now")
        return True

    def _say_left_out(self, left_out):
        """Files that a build or a system made are one row; what might be missed has a row each."""
        usual = [one for one in left_out if one[1].startswith(("a product", "a folder of a system"))]
        rest = [one for one in left_out if one not in usual]
        for path, reason in rest[:MAX_ROWS]:
            self.report.add("left out", path, reason)
        if len(rest) > MAX_ROWS:
            self.report.add("left out", "", f"and {len(rest) - MAX_ROWS} more of the kind")
        if usual:
            self.report.add("left out", "", f"{len(usual)} products of builds, editors and systems, such as {usual[0][0]}")

    def _choose(self):
        """Chooses the program. Returns whether there is one."""
        sources = [name for name in self._sources.files if is_source(name)]
        if not sources:
            self._fail("is no game", "there is no C++ source in the folder" +
                       (" but that of an engine" if self._engine.own else ""))
            return False
        lists = read_lists(self.tree, self._files, sources)
        found = programs(sources, lists, self._sources.code)
        if self._options.main:
            wanted = os.path.normpath(self._options.main)
            found = [one for one in found if one.main in (wanted, os.path.relpath(self._options.main, self._options.folder))]
        if not found:
            self._left("", faults.THEIRS, f"there is no main() in {self._options.main or 'the sources of the folder'}",
                       "add the file with int main()")
            self._fail("does not build", "no main()")
            return False
        self._program, self._all_sources = found[0], sources
        self._say_program(found)
        return True

    def _say_program(self, found):
        program = self._program
        origin = f"as {program.source_list.file} lists them" if program.source_list else "all that are there"
        count = len(program.sources) - 1
        self.report.add("program", program.main, f"and {count} more source{'s' * (count != 1)}, {origin}" if count else f"the only source, {origin}")
        for other in found[1:MAX_ROWS]:
            self.report.add("program", other.main, "another one, not tried: --main takes it")
        if program.source_list:
            for call in program.source_list.unread[:3]:
                self.report.add("note", program.source_list.file, f"not run: {call}")
            for word in program.source_list.missing[:MAX_ROWS]:
                if stem(word.replace("\\", "/")) not in {stem(name) for name in self._engine.files + self._files}:
                    self.report.add("note", program.source_list.file, f"lists {word}, which is not there")
        for name, reason in program.left_out[:MAX_ROWS]:
            self.report.add("left out", name, reason)

    # Building it

    def _treat_includes(self):
        self._folders = header_folders(self._sources, self._program)
        self._changes_of_includes = Includes(self._sources, self._folders, self._naiad, system_headers(self._compiler_path)).treat()

    def _build(self):
        """Compiles, treats, links. Returns whether there is a program."""
        self._compiler = Compiler(self._compiler_path, self.tree, os.path.join(self._scratch, "objects"), self._naiad, self._folders)
        self._treatments = Treatments(self._sources, self._compiler, self._naiad)
        self._units = [Unit(name) for name in self._program.sources]
        self._blame = Blame(self._naiad, self._engine.own, self._engine_text(), self._against_engine)
        self._compile(self._units)
        said = self._link()
        if self._program.source_list is None:
            self._leave_out_what_nothing_needs()
        self._say_treated()
        networks = faults.networks(self._sources, self._program.sources + [name for name in self._sources.files if not is_source(name)])
        bad = [unit for unit in self._units if unit.object is None]
        for unit in bad:
            self._say_errors(unit)
        if networks:
            self.report.add("note", ", ".join(f"{name}:{line}" for name, line in networks[:4]), faults.NETWORK_SENTENCE)
        good = len(self._units) - len(bad)
        if bad or said is not None:
            if not bad:
                self._say_link_errors(said)
            if self._engine.without_namespace:
                self._left("", faults.OTHER, "nothing here names df:: it was written for an engine without that namespace",
                           "write df:: before the engine's names, or `using namespace df;` behind the includes of each source")
            self.report.add("built", "", f"{good} of {len(self._units)} sources compile" + ("; they do not link" if not bad else ""))
            self._fail("does not build", "")
            return False
        self.report.add("built", "", f"{good} source{'s' * (good != 1)}, linked with Naiad")
        return True

    def _compile(self, units):
        """Compiles these, and treats them until nothing changes; then as older C++, then with -fpermissive."""
        pending = units
        for number in range(MAX_ROUNDS):
            label = "compiling" if number == 0 else "treating"
            self._compiler.compile(pending, lambda done, all_of_them: self._say(f"{label} {done} of {all_of_them}"))
            undone = self._treatments.undo_returns(self._units)
            pending = self._treatments.treat(self._units)
            if undone:
                pending = list(dict.fromkeys(pending + [unit for unit in self._units if unit.object is None]))
            if not pending:
                break
        for standard in STANDARDS[1:]:
            self._retry(lambda unit: setattr(unit, "standard", standard), lambda unit: setattr(unit, "standard", STANDARDS[0]),
                        lambda unit: any(one.line for one in unit.errors))
        self._retry(lambda unit: setattr(unit, "permissive", True), lambda unit: setattr(unit, "permissive", False),
                    lambda unit: unit.errors and all("[-fpermissive]" in one.text for one in unit.errors))

    def _retry(self, change, restore, fits):
        """Compiles what failed in another way, and keeps that where it helps."""
        failed = [unit for unit in self._units if unit.object is None and fits(unit)]
        if not failed:
            return
        before = {unit: unit.diagnostics for unit in failed}
        for unit in failed:
            change(unit)
        self._compiler.compile(failed)
        for unit in failed:
            if unit.object is None:
                restore(unit)
                unit.diagnostics = before[unit]
            else:
                unit.diagnostics = before[unit] if unit.permissive else []

    def _link(self):
        """Links; sources that no list names and that define what is missing are taken. Returns what the linker said."""
        program = os.path.join(self.tree, PROGRAM)
        for _ in range(6):
            if any(unit.object is None for unit in self._units):
                return None
            self._say("linking")
            said = self._compiler.link(self._units, program)
            if said is None:
                return None
            more = self._definers(_undefined(said))
            if not more:
                return said
            units = [Unit(name) for name in more]
            self._units += units
            for name in more:
                self.report.add("treated", name, "is taken, too: it defines what the listed sources use")
            self._compile(units)
        return said

    def _leave_out_what_nothing_needs(self):
        """Without a list, a source that does not compile may be one that is no longer used."""
        good = [unit for unit in self._units if unit.object]
        bad = [unit for unit in self._units if unit.object is None]
        if not bad or self._units[0] in bad or self._compiler.link(good, os.path.join(self.tree, PROGRAM)) is not None:
            return
        for unit in bad:
            first = f"{unit.errors[0].file}:{unit.errors[0].line}: {unit.errors[0].text}" if unit.errors else "it takes too long"
            self.report.add("left out", unit.name, f"it does not compile, and nothing needs it ({first})")
        self._units = good

    def _definers(self, symbols):
        """Sources outside of the program that define these symbols."""
        taken = {unit.name for unit in self._units}
        others = [name for name in self._all_sources if name not in taken and not re.search(r"\bmain\s*\(", self._sources.code(name))]
        found = []
        for symbol, _ in symbols:
            plain = re.sub(r"\(.*|<.*|\[abi:\w+\]", "", re.sub(r"^(?:vtable|typeinfo|VTT|non-virtual thunk) (?:for|to) ", "", symbol)).strip()
            parts = plain.split("::")[-2:]
            pattern = r"\s*::\s*".join(map(re.escape, parts)) + (r"\s*\(" if "(" in symbol else r"\b")
            if symbol.startswith("vtable"):
                pattern = rf"\b{re.escape(parts[-1])}\s*::\s*~?\w+\s*\("
            found += [name for name in others if name not in found and re.search(r"\b" + pattern, self._sources.code(name))][:1]
        return found

    # Judging

    def _engine_text(self):
        texts = []
        for name in self._engine.files:
            with open(os.path.join(self._engine_tree, name), encoding="latin-1") as file:
                texts.append(file.read())
        return "\n".join(texts)

    def _against_engine(self, unit):
        """The diagnostics of a unit against the engine's headers that came in the folder; None without such."""
        folders = {}
        for name in self._engine.files:
            if not is_source(name):
                folders[os.path.dirname(name)] = folders.get(os.path.dirname(name), 0) + 1
        if not folders or max(folders.values()) < 10:
            return None  # not a whole engine
        return self._compiler.check_with(unit, os.path.join(self._engine_tree, max(folders, key=folders.get)))

    def _say_treated(self):
        for file, line, before, after, why in self._changes_of_includes[:MAX_ROWS]:
            self.report.add("treated", f"{file}:{line}", why, line=before, change=after)
        if len(self._changes_of_includes) > MAX_ROWS:
            self.report.add("treated", "", f"and {len(self._changes_of_includes) - MAX_ROWS} more include lines")
        changes = sorted(self._treatments.changes, key=lambda one: (one.file, one.line))
        for change in changes[:MAX_ROWS]:
            self.report.add("treated", f"{change.file}:{change.line}", change.why, line=change.before, change=change.after)
        if len(changes) > MAX_ROWS:
            self.report.add("treated", "", f"and {len(changes) - MAX_ROWS} more lines")
        for unit in self._units:
            if unit.object and unit.standard != STANDARDS[0]:
                self.report.add("treated", unit.name, f"compiled as {unit.standard.replace('gnu', 'C')}: as C++20 it has other meanings")
            if unit.object and unit.permissive:
                for one in unit.errors[:MAX_ERRORS]:
                    self.report.add("treated", f"{one.file}:{one.line}", "compiled with -fpermissive, as only MSVC takes it: " +
                                    one.text.replace(" [-fpermissive]", ""), line=self._sources.line(one.file, one.line))

    def _say_errors(self, unit):
        if unit.timed_out:
            self._left(unit.name, faults.THEIRS, "compiling it took too long", "")
            return
        seen = 0
        for one in unit.errors:
            place = f"{one.file}:{one.line}" if one.line else one.file
            if self.report.has_left(place):
                seen += 1
                continue
            if seen >= MAX_ERRORS:
                self.report.add("note", unit.name, f"and {len(unit.errors) - seen} more errors")
                break
            if not one.line:
                self._left(place, faults.THEIRS, one.text, "the compiler gave it up: look for what it includes, or for endless templates")
                return
            whose, change = self._blame.error(unit, one)
            self._left(place, whose, one.text, change, self._sources.line(one.file, one.line))
            seen += 1

    def _say_link_errors(self, said):
        symbols = _undefined(said)
        for symbol, place in symbols[:MAX_ROWS]:
            whose, change = self._blame.symbol(symbol)
            self._left(self._place_of(place), whose, f"undefined reference to {symbol}", change)
        twice = re.findall(r"multiple definition of [`']([^']+)'", said)
        for symbol in list(dict.fromkeys(twice))[:MAX_ROWS]:
            self._left("", faults.THEIRS, f"{symbol} is defined twice", "write `inline` before it in the header, or leave one of the files out")
        if not symbols and not twice:
            last = said.strip().splitlines()
            self._left("", faults.THEIRS, last[-1] if last else "the linker failed", "")

    def _place_of(self, place):
        match = re.match(r"(?:.*/copy/|\./|/game/)?(.+?):(\d+)$", place)
        return f"{os.path.normpath(match.group(1))}:{match.group(2)}" if match and not match.group(1).endswith(".o") else ""

    # Running it

    def _try(self):
        folder = run_folder(self._files, self._sources, self._program)
        self.program_path = os.path.join(self._options.keep or "", PROGRAM)
        if not has_run([unit.name for unit in self._units], self._sources.code):
            self._left(self._program.main, faults.THEIRS, "nothing calls GM.run()", "GM.run(); between startUp() and shutDown()")
        for file, line, path in missing_files(self._files, self._sources, [unit.name for unit in self._units], folder)[:MAX_ROWS]:
            self._left(f"{file}:{line}", faults.THEIRS, f"{path} is not in the folder", "add the file, or correct its name")
        if self._options.seconds == 0:
            self.report.result = "builds; it was not to run"
            return
        root = os.path.join(self._scratch, "root")
        os.makedirs(root, exist_ok=True)
        reason = None if self._options.unconfined else sandbox.why_unavailable(root)
        if reason:
            self._fail("builds", f"not run: this kernel gives no sandbox to this user ({reason}); --unconfined runs a game that you trust")
            return
        trial = Trial(self.tree, PROGRAM, folder, self._naiad, self._options.seconds, self._options.seed, self._options.keys,
                      keys_of(self._sources.code(name) for name in self._sources.files))
        self._say(f"running it for {self._options.seconds:g} s")
        outcome = trial.run(root, confined=not self._options.unconfined)
        self._say_outcome(outcome, folder, trial, root)

    def _say_outcome(self, outcome, folder, trial, root):
        for file, line, text in refused_sprites(outcome.log, folder)[:MAX_ROWS]:
            self._left(f"{file}:{line}" if line else file, faults.THEIRS, text, "correct this line of the sprite")
        where = folder or "."
        rounds = f", {outcome.rounds} times" if outcome.rounds > 1 else ""
        text = {
            "played": f"{outcome.ticks} ticks in {self._options.seconds:g} s with random keys, up to {outcome.objects} things to see",
            "over": f"it ended in order after {outcome.seconds:.1f} s{rounds}, as games do when they are over",
            "unplayed": "main() ended at once, with 0: no game began",
            "failed": f"main() ended with {outcome.code}",
            "crashed": f"it crashed after {outcome.seconds:.1f} s" + _signal_of(outcome.code),
            "deaf": "it did not begin to run within 20 s: it computes or waits before GM.run()",
            "hangs": f"it stood still after {outcome.ticks} ticks and could only be killed"}[outcome.state]
        self.report.add("ran", where, text)
        if outcome.runs:
            self.report.result = "runs"
            if not outcome.ended_well:
                self.report.add("note", "", "it crashes when it ends, behind GM.run()")
            return
        self._fail("builds", {"crashed": "it crashes", "unplayed": "it never calls GM.run()", "failed": "it ends with an error",
                              "deaf": "it never listens", "hangs": "it hangs"}.get(outcome.state, "nobody could play"))
        self._explain(outcome, trial, root)

    def _explain(self, outcome, trial, root):
        if outcome.state == "unplayed":
            if not any(row.what == "left" and "GM.run()" in row.text for row in self.report.rows):
                self._left(self._program.main, faults.THEIRS, "main() returns before a game has run",
                           "GM.startUp() must return 0, and GM.run() be reached; what it printed is below")
        elif outcome.state == "crashed":
            self._say_crash(outcome, trial, root)
        else:
            self._left(self._program.main, faults.UNCLEAR, {"failed": "it ends with an error", "deaf": "it never listens"}.get(
                outcome.state, "a handler, or main(), does not return"), "what it printed and logged is below")
        for name, text in (("printed", outcome.printed), ("logged", outcome.log)):
            lines = [line for line in text.splitlines() if line.strip()]
            for line in lines[-4:]:
                self.report.add("note", name, line)

    def _say_crash(self, outcome, trial, root):
        """Builds it again with an address sanitizer, which says where."""
        self._say("it crashed: building it again, to see where")
        self._compiler.extra = ["-fsanitize=address", "-fno-omit-frame-pointer"]
        program, printed = os.path.join(self.tree, PROGRAM), ""
        self._compiler.objects += "-examined"
        os.makedirs(self._compiler.objects, exist_ok=True)
        plain = program + ".plain"
        os.rename(program, plain)
        units = [self._again(unit) for unit in self._units]
        self._compiler.compile(units)
        if all(unit.object for unit in units) and self._compiler.link(units, program) is None:
            trial.examined = True
            self._say("running it again, to see where it crashes")
            examined = trial.run(root, confined=not self._options.unconfined)
            printed = examined.printed
        os.replace(plain, program)
        frame = frame_of(printed, self._sources.files)
        if frame:
            place, what = frame
            file, _, line = place.rpartition(":")
            self._left(place, faults.THEIRS, what, "look at the pointers of this line: what getSound(), getSprite() or objectWithId() did not find is null, and a deleted "
                       "Object is no more",
                       self._sources.line(file, int(line)))
        else:
            self._left(self._program.main, faults.UNCLEAR, f"it crashes{_signal_of(outcome.code)}, and where cannot be said",
                       "compile it with -g -fsanitize=address and run it")

    def _again(self, unit):
        other = Unit(unit.name)
        other.standard, other.permissive, other.forced = unit.standard, unit.permissive, unit.forced
        return other

    def _left(self, where, whose, text, change, line=""):
        self.report.add("left", where, text, whose, line, change)

    def _fail(self, result, reason):
        self.report.result, self.report.reason = result, reason


def _undefined(said):
    """[(symbol, place)] of what the linker did not find, each symbol once."""
    found = {}
    for line in said.splitlines():
        match = re.search(r"^(?:/\S*ld: )?(?P<place>.*?):? ?undefined reference to [`'](?P<symbol>.+)'", line)
        if match:
            symbol = match.group("symbol")
            found.setdefault(symbol, match.group("place").rstrip(": "))
    return list(found.items())


def _signal_of(code):
    names = {4: "an illegal instruction", 6: "abort()", 7: "a bus error", 8: "a division by zero", 11: "a segmentation fault",
             24: "too much processor time", 25: "a file of more than 32 MiB"}
    return f": {names.get(-code, f'signal {-code}')}" if code is not None and code < 0 else ""
