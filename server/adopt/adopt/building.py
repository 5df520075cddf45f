"""Compiles and links a game. Changes the copy of its sources ("treats" it) until they compile."""
import os
import re

from . import microsoft
from .compiler import STANDARDS, Compiler, Unit
from .includes import Includes, header_folders
from .naiad import system_headers
from .treatments import Treatments

MAX_ROUNDS = 12  # maximum number of times that the copy is treated and compiled again
# Errors about missing files or engine members, which no other C++ standard would fix.
_IN_EVERY_STANDARD = re.compile(r"No such file or directory|file not found|'(?:const )?(?:class |struct )?df::\w+' has no member named|"
                                r"no member named '\w+' in 'df::\w+'")
MAX_LINKS = 6  # maximum number of links; further sources are added after each failed one


class Building:
    """The build of a game's program: its `units`, its `compiler`, and the changes of the copy (`includes`, `changes`)."""

    def __init__(self, game, compiler, say):
        self._game, self._say = game, say
        folders = header_folders(game.sources, game.program)
        self.includes = Includes(game.sources, folders, game.naiad, system_headers(compiler)).treat()
        self._microsoft = microsoft.treat(game.sources)
        self.compiler = Compiler(compiler, game.tree, os.path.join(game.scratch, "objects"), game.naiad, folders)
        if game.program.source_list:
            self.compiler.definitions += game.program.source_list.definitions
        self._treatments = Treatments(game.sources, self.compiler, game.naiad)
        self.units = [Unit(name) for name in game.program.sources]
        self.said = None  # output of the linker, if it failed
        self._given_up = set()  # sources that do not compile

    @property
    def changes(self):
        return sorted(self._microsoft + self._treatments.changes, key=lambda one: (one.file, one.line))

    @property
    def broken(self):
        return [unit for unit in self.units if unit.object is None]

    def build(self):
        """Builds the program. Returns whether that succeeded."""
        self._compile(self.units)
        self._link()
        if self.broken:
            self._drop_unneeded_sources()
        for unit in self.units:
            if unit.name not in self._game.program.sources:
                self._game.report.add("treated", unit.name, "added: it defines symbols that the listed sources use")
        self._game.sources.flush()
        return not self.broken and self.said is None

    def _compile(self, pending):
        """Compiles and treats these units until nothing changes. Retries failed ones with -fpermissive, then as older C++."""
        self._treat(pending)
        helped = self._retry("permissive", True,
                             lambda unit: unit.errors and all("[-fpermissive]" in one.text for one in unit.errors))
        for standard in STANDARDS[1:]:
            helped += self._retry("standard", standard, lambda unit: any(one.line for one in unit.errors) and
                                  not any(_IN_EVERY_STANDARD.search(one.text) for one in unit.errors))
        if helped:  # the compiler may only now have reached functions without a return
            self._treat(self._treatments.treat(helped))

    def _treat(self, pending):
        label = "compiling"
        for _ in range(MAX_ROUNDS):
            if not pending:
                break
            self._game.sources.flush()
            self.compiler.compile(pending, lambda done, count: self._say(f"{label} {done} of {count}"))
            label = "treating"
            undone = self._treatments.undo_returns(self.units)
            pending = self._treatments.treat(self.units)
            if undone:
                pending = list(dict.fromkeys(pending + self.broken))

    def _retry(self, option, value, fits):
        """Compiles failed units with another option, and keeps the option for units that it helps. Returns those units."""
        before = {unit: (unit.diagnostics, getattr(unit, option)) for unit in self.broken if fits(unit)}
        for unit in before:
            setattr(unit, option, value)
        self._game.sources.flush()
        self.compiler.compile(list(before))
        for unit, (diagnostics, old) in before.items():
            if unit.object is None:
                setattr(unit, option, old)
                unit.diagnostics = diagnostics
            elif option == "permissive":
                unit.permitted = [one for one in diagnostics if one.is_error]
        return [unit for unit in before if unit.object]

    def _link(self):
        """Links the program. If symbols are missing, adds sources that define them, although no project file lists them."""
        for _ in range(MAX_LINKS):
            if self.broken:
                return
            self._say("linking")
            self.said = self.compiler.link(self.units, self._game.program_path)
            more = self._definers(undefined(self.said)) if self.said is not None else []
            if not more:
                return
            units = [Unit(name) for name in more]
            self.units += units
            self._compile(units)

    def _definers(self, symbols):
        """Returns sources outside of the program that define these symbols."""
        taken = {unit.name for unit in self.units} | self._given_up
        code = {name: self._game.sources.code(name) for name in self._game.all_sources if name not in taken}
        others = [name for name, text in code.items() if not re.search(r"\bmain\s*\(", text)]
        found = []
        for symbol, _ in symbols:
            pattern = _definition(symbol)
            found += [name for name in others if name not in found and pattern.search(code[name])][:1]
        return found

    def _drop_unneeded_sources(self):
        """Drops the sources that do not compile, if the program links without them. Project files may list unused sources."""
        bad, all_units = self.broken, self.units
        if self.units[0] in bad:
            return
        self._given_up = {unit.name for unit in bad}
        self.units = [unit for unit in all_units if unit not in bad]
        self._link()
        if self.broken or self.said is not None:
            self.units, self.said = all_units, None
            return
        for unit in bad:
            first = f"{unit.errors[0].file}:{unit.errors[0].line}: {unit.errors[0].text}" if unit.errors else "compiling it takes too long"
            self._game.report.add("left out", unit.name, f"it does not compile, and nothing needs it ({first})")

    def build_examined(self, program):
        """Builds the program again with an address sanitizer. Returns whether that succeeded."""
        self.compiler.extra = ["-fsanitize=address", "-fno-omit-frame-pointer"]
        self.compiler.objects += "-examined"
        os.makedirs(self.compiler.objects, exist_ok=True)
        units = [unit.again() for unit in self.units]
        self.compiler.compile(units)
        return all(unit.object for unit in units) and self.compiler.link(units, program) is None


def undefined(said):
    """Returns a list of (symbol, place that uses it) for the symbols that the linker did not find, each once."""
    found = {}
    for line in said.splitlines():
        match = re.search(r"^(?:/\S*ld: )?(?P<place>.*?):? ?undefined reference to [`'](?P<symbol>.+)'", line)
        if match:
            found.setdefault(match.group("symbol"), match.group("place").rstrip(": "))
    return list(found.items())


def _definition(symbol):
    """Returns a pattern that finds the definition of a symbol in a source."""
    table = re.match(r"(?:vtable|typeinfo|VTT|non-virtual thunk) (?:for|to) (.*)", symbol)
    plain = re.sub(r"\(.*|<.*|\[abi:\w+\]", "", table.group(1) if table else symbol).strip()
    parts = [re.escape(part) for part in plain.split("::")[-2:]]
    if table:
        return re.compile(rf"\b{parts[-1]}\s*::\s*~?\w+\s*\(")
    return re.compile(r"\b" + r"\s*::\s*".join(parts) + (r"\s*\(" if "(" in symbol else r"\b"))
