"""Compiles and links, and parses the compiler's messages."""
import concurrent.futures
import os
import re
import shutil
import zlib

from .bounded import children_seconds, run

_LINE = re.compile(r"^(?P<file>.+?):(?P<line>\d+):(?:(?P<column>\d+):)? "
                   r"(?P<kind>fatal error|error|warning|note): (?P<text>.*)$")
_WITHIN = re.compile(r"^.+?: (?:In|At) (?P<within>.*):$")
MAX_LINE = 4000  # maximum characters of a message, because names of templates can be very long
STANDARDS = ("gnu++20", "gnu++17", "gnu++14")  # the standard of dragonfly::dragonfly, then older ones that games were written for


class Diagnostic:
    """A compiler message with its place and notes. `within`: the enclosing function, as g++ names it."""

    def __init__(self, file, line, column, kind, text, within):
        self.file, self.line, self.column, self.kind, self.text, self.within = file, line, column, kind, text, within
        self.notes = []  # (file, text, line)

    @property
    def is_error(self):
        return "error" in self.kind

    @property
    def key(self):
        return self.file, self.line, self.text


def parse(output):
    """Parses a compiler's output into diagnostics, with paths relative to the copy."""
    found, within = [], ""
    for line in output.splitlines():
        line = line[:MAX_LINE]
        match = _LINE.match(line)
        if not match:
            place = _WITHIN.match(line)
            within = place.group("within") if place else within
            continue
        name = os.path.normpath(match.group("file"))
        if match.group("kind") == "note":
            if found:
                found[-1].notes.append((name, match.group("text"), int(match.group("line"))))
            continue
        found.append(Diagnostic(name, int(match.group("line")), int(match.group("column") or 1), match.group("kind"),
                                match.group("text"), within))
    return found


def _is_clang(program):
    """Returns whether the program is clang. Link targets do not show it: /usr/lib/ccache/clang++ is ccache, c++ may be either."""
    if "clang" in os.path.basename(program):
        return True
    try:
        return "clang" in run([program, "--version"], env={**os.environ, "LC_ALL": "C"}, timeout=20).output.lower()
    except OSError:
        return False


class Unit:
    """A source of the program, with its compile options and the result of compiling it."""

    def __init__(self, name):
        self.name, self.standard, self.permissive = name, STANDARDS[0], False
        self.forced = []  # headers to include before the source (-include)
        self.permitted = []  # errors that -fpermissive suppressed
        self.object, self.output, self.diagnostics, self.timed_out = None, "", [], False

    @property
    def errors(self):
        return [one for one in self.diagnostics if one.is_error]

    def again(self):
        """Returns an uncompiled unit with this source and these options."""
        other = Unit(self.name)
        other.standard, other.permissive, other.forced = self.standard, self.permissive, self.forced
        return other


class Compiler:
    """Compiles the units of a copy in parallel, one per processor. Each may take `seconds` of processor time, and all together
    about `total_seconds`."""

    def __init__(self, program, root, objects, naiad, folders, seconds=120, total_seconds=900):
        self.program, self.root, self.objects, self.naiad, self.folders = program, root, objects, naiad, folders
        self.seconds, self._limit = seconds, children_seconds() + total_seconds
        self.definitions, self.extra = [], []
        self.is_gcc = not _is_clang(program)
        self._launcher = [found] if (found := shutil.which("ccache")) else []
        # Paths are relative to the copy, so that ccache finds its results again although each run has another copy.
        self._environment = {**os.environ, "LC_ALL": "C", "CCACHE_BASEDIR": root, "CCACHE_NOHASHDIR": "1"}
        os.makedirs(objects, exist_ok=True)

    def compile(self, units, progress=lambda done, all: None):
        """Compiles these units. Calls progress(done, all) after each, with the numbers of finished units and of all units."""
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 1) as pool:
            for count, _ in enumerate(pool.map(self._compile, units), 1):
                progress(count, len(units))

    def _compile(self, unit):
        unit.object, result = self._object(unit), None
        left = self._limit - children_seconds()
        if left > 0:
            result = run(self._launcher + self._command(unit), self.root, self._environment, min(self.seconds, left))
        if result is None or result.timed_out:
            unit.object, unit.timed_out, unit.diagnostics = None, True, []
            return
        unit.timed_out, unit.output, unit.diagnostics = False, result.output, parse(result.output)
        if result.code != 0:
            unit.object = None
            if not unit.errors:  # the compiler failed without an error message
                said = result.output.strip().splitlines()
                unit.diagnostics.append(Diagnostic(unit.name, 0, 1, "error", said[-1] if said else "the compiler crashed", ""))

    def _object(self, unit):
        return os.path.join(self.objects, re.sub(r"\W", "_", unit.name)[-80:] + f"_{zlib.crc32(os.fsencode(unit.name)):08x}.o")

    def _command(self, unit, max_errors=30):
        command = [self.program, "-std=" + unit.standard, "-g1", "-O0", "-fPIC"]
        command.append(("-fmax-errors=" if self.is_gcc else "-ferror-limit=") + str(max_errors))
        if self.is_gcc:
            command += ["-fdiagnostics-column-unit=byte", "-fno-diagnostics-show-caret", "-fdiagnostics-color=never"]
        else:
            command += ["-fno-caret-diagnostics", "-fno-color-diagnostics", "-Wno-everything", "-Wreturn-type"]
        if unit.permissive:
            command.append("-fpermissive")
        command += self.definitions + self.extra
        for header in unit.forced:
            command += ["-include", header]
        for folder in self.folders:
            command += ["-iquote", "./" + folder]
        command += ["-I", self.naiad.include, "-I", os.path.join(self.naiad.include, "physics")]
        return command + ["-c", "-x", "c++", "./" + unit.name, "-o", self._object(unit)]  # -x: for names like Hero.Cpp

    def link(self, units, program):
        """Links the objects. Returns the linker's output on failure, else None."""
        result = run([self.program] + self.extra + [unit.object for unit in units] +
                     ["-L", self.naiad.lib, "-ldragonfly", "-Wl,-rpath," + self.naiad.lib, "-pthread", "-o", program],
                     self.root, self._environment, self.seconds)
        return None if result.code == 0 and not result.timed_out else result.output

    def check_with(self, unit, include):
        """Returns the diagnostics of a unit compiled against another engine's headers. Returns None if the compiler did not reach
        the unit's end or those headers do not compile, because then lines without an error prove nothing."""
        forced, unit.forced = unit.forced, []  # these may be Naiad's headers
        command = [word for word in self._command(unit, max_errors=0) if word != "-c"]
        unit.forced = forced
        at = command.index("-I")
        command = command[:at] + ["-I", include] + command[at:] + ["-fsyntax-only"]
        left = self._limit - children_seconds()
        if left <= 0:
            return None
        result = run(command, self.root, self._environment, min(self.seconds, left))
        found = parse(result.output)
        errors = [one for one in found if one.is_error]
        complete = not result.timed_out and not result.cut and result.code == (1 if errors else 0)
        return found if complete and not any(one.file.startswith(include) for one in errors) else None
