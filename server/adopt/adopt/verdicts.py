"""Reports a build: the changes made, the errors that remain, and whose fault they are."""
import os
import re

from . import blame as faults
from .blame import Blame
from .building import undefined
from .compiler import STANDARDS
from .folder import is_source
from .report import MAX_ROWS

MAX_ERRORS = 3  # maximum errors reported of a source, because the first error usually causes the others
WHOLE_ENGINE = 10  # minimum headers in a folder for a copy of the engine that sources can be compiled against


class Verdicts:
    """Writes the rows of a build into the game's report."""

    def __init__(self, game, building):
        self._game, self._building, self._report = game, building, game.report
        self._blame = Blame(game.naiad, game.engine.own, self._engine_text(), self._against_engine,
                            game.sources.code(game.program.main) if game.program else "", game.engine.without_namespace)

    def say(self, built):
        """Writes the rows of a build. `built`: whether the build succeeded."""
        self._report_treated()
        broken, units = self._building.broken, self._building.units
        if not built:
            for unit in broken:
                self._report_errors(unit)
            if not broken:
                self._report_link_errors(self._building.said)
            self._report_namespace()
        self._report_network()
        if built:
            self._report.add("built", "", f"{len(units)} source{'s' * (len(units) != 1)}, linked with Naiad")
            return
        link = "" if broken else "; linking fails"
        self._report.add("built", "", f"{len(units) - len(broken)} of {len(units)} sources compile{link}")
        self._report.fail("does not build", "")

    def _engine_text(self):
        texts = []
        for name in self._game.engine.files:
            try:
                with open(os.path.join(self._game.engine_tree, name), encoding="latin-1") as file:
                    texts.append(file.read())
            except OSError:
                pass  # it is a link to a file of the game, which is not in this tree
        return "\n".join(texts)

    def _against_engine(self, unit):
        """Returns the diagnostics of a unit compiled against the engine headers in the folder; None without such headers, or if
        check_with() returns None."""
        count = {}
        for name in self._game.engine.files:
            if not is_source(name):
                count[os.path.dirname(name)] = count.get(os.path.dirname(name), 0) + 1
        # The author's own engine is preferred to a larger copy of the published one.
        folder = max(self._game.engine.core_folders & set(count) or count, key=count.get, default="")
        if count.get(folder, 0) < WHOLE_ENGINE:
            return None
        return self._building.compiler.check_with(unit, os.path.join(self._game.engine_tree, folder))

    def _report_treated(self):
        for file, line, before, after, why in self._building.includes[:MAX_ROWS]:
            self._report.add("treated", f"{file}:{line}", why, line=before, change=after)
        for change in self._building.changes[:MAX_ROWS]:
            self._report.add("treated", f"{change.file}:{change.line}", change.why, line=change.before, change=change.after)
        for more, what in ((self._building.includes[MAX_ROWS:], "include lines"), (self._building.changes[MAX_ROWS:], "lines")):
            if more:
                self._report.add("treated", "", f"and {len(more)} more {what}")
        for unit in self._building.units:
            if unit.object and unit.standard != STANDARDS[0]:
                standard = unit.standard.replace("gnu", "C")
                self._report.add("treated", unit.name, f"compiled as {standard}: it does not compile as C++20")
            if unit.object and unit.permissive:
                for one in unit.permitted[:MAX_ERRORS]:
                    self._report.add("treated", f"{one.file}:{one.line}", "compiled with -fpermissive, because only MSVC accepts it: " +
                                     one.text.replace(" [-fpermissive]", ""), line=self._game.sources.line(one.file, one.line))

    def _report_errors(self, unit):
        if unit.timed_out:
            self._report.add_left(unit.name, faults.THEIRS, "compiling it takes too long", "look for infinite template recursion")
            return
        for seen, one in enumerate(unit.errors):
            place = f"{one.file}:{one.line}" if one.line else one.file
            if not one.line:
                self._report.add_left(place, faults.THEIRS, one.text,
                                      "the compiler failed: check the includes, and look for infinite template recursion")
                return
            if self._report.has_left(place):
                continue
            if seen >= MAX_ERRORS:
                self._report.add("note", unit.name, f"and {len(unit.errors) - seen} more errors")
                return
            line = self._game.sources.line(one.file, one.line)
            whose, change = self._blame.error(unit, one, line)
            self._report.add_left(place, whose, one.text, change, line)

    def _report_link_errors(self, said):
        symbols = undefined(said)
        for symbol, place in symbols[:MAX_ROWS]:
            whose, change = self._blame.symbol(symbol)
            self._report.add_left(_location_text(place), whose, f"undefined reference to {symbol}", change)
        twice = list(dict.fromkeys(re.findall(r"multiple definition of [`']([^']+)'", said)))
        for symbol in twice[:MAX_ROWS]:
            self._report.add_left("", faults.THEIRS, f"{symbol} is defined twice",
                                  "write `inline` before it in the header, or remove one of the files")
        if not symbols and not twice:
            last = said.strip().splitlines()
            self._report.add_left("", faults.THEIRS, last[-1] if last else "the linker failed", "")

    def _report_namespace(self):
        if self._game.engine.without_namespace:
            self._report.add_left("", faults.OTHER, "no df:: in the sources: they were written for an engine without that namespace",
                                  "write df:: before the engine's names, or `using namespace df;` after the includes")

    def _report_network(self):
        headers = [name for name in self._game.sources.files if not is_source(name)]
        found = faults.networks(self._game.sources, self._game.program.sources + headers)
        if found:
            self._report.add("note", ", ".join(f"{name}:{line}" for name, line in found[:4]), faults.NETWORK_SENTENCE)


def _location_text(place):
    """Returns file:line of a place named by the linker; "" if it is not in a source of the game."""
    match = re.match(r"(?:.*/copy/|\./|/game/)?(.+?):(\d+)$", place)
    return f"{os.path.normpath(match.group(1))}:{match.group(2)}" if match and not match.group(1).endswith(".o") else ""
