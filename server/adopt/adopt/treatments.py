"""Changes the copy so that it compiles, based on the compiler's messages. Each change stays on its line."""
import re

from .compiler import Diagnostic
from .folder import is_source
from .text import named

_NAME = r"'(?:df::)?(?P<name>\w+)(?:<[^']*>)?'"
_UNKNOWN = [re.compile(pattern) for pattern in (
    _NAME + r" was not declared in this scope", _NAME + r" does not name a type", _NAME + r" has not been declared",
    r"unknown type name " + _NAME, r"use of undeclared identifier " + _NAME)]
_NOT_IN_DF = [re.compile(pattern) for pattern in (
    r"'(?P<name>\w+)' is not a member of 'df'", r"'(?P<name>\w+)' in namespace 'df' does not name",
    r"no (?:type|member) named '(?P<name>\w+)' in namespace 'df'",
    r"'df::(?P<name>\w+)' has not been declared", r"incomplete type '(?:class |struct |const )*df::(?P<name>\w+)'",
    r"'(?:class |struct |const )*df::(?P<name>\w+)[ \w]*' has (?:initializer but )?incomplete type")]
_UNKNOWN_PARAMETER = re.compile(r"expected '\)' before '\w+'|expected constructor, destructor, or type conversion before '\('")  # of a constructor
_CONFLICT = re.compile(r"conflicting return type specified for 'virtual (?P<type>.+?) (?:\w+::)*"
                       r"(?P<class>\w+)::(?P<name>\w+)\(")
_CLANG_CONFLICT = re.compile(r"function '(?P<name>\w+)' has a different return type \('(?P<type>.+?)'\) than the function it overrides "
                             r"\(which has return type '(?P<goal>.+?)'\)")
_CLANG_DEFINITION = re.compile(r"return type of out-of-line definition of '(?:\w+::)*(?P<class>\w+)::(?P<name>\w+)' differs from that in "
                               r"the declaration")
_OVERRIDDEN = re.compile(r"overridden function is 'virtual (?P<type>.+?) (?:\w+::)+\w+\(")
_FORGOT = re.compile(r"did you forget to '#include <(?P<header>[\w./]+)>'|is defined in header '<(?P<known>[\w./]+)>'")
_NO_BASE = re.compile(r"is an inaccessible base of '(?P<class>\w+)'")
_NO_NEW = re.compile(r"operator new.* is (?:inaccessible|private)")
_AMBIGUOUS = re.compile(r"reference to '(?P<name>\w+)' is ambiguous")
_ENUM = re.compile(r"use of enum '\w+' without previous declaration|forward references to 'enum' types")
# Errors that a change of their line corrects: message, pattern of the line in which \0 marks the column, its replacement, reason.
_LINES = [(re.compile(message), re.compile(pattern), after, why) for message, pattern, after, why in (
    (r"extra qualification .*on member '~?\w+'", r"\0?(?:\w+\s*::\s*)+\0?(?=~?\w+\s*\()", "",
     "extra class name before a member of the class; only MSVC accepts it"),
    (r"(?:return-statement with no value|should return a value).*'int'", r"\0return\s*;", "return 0;", "missing value after return"),
    (r"return-statement with no value|should return a value", r"\0return\s*;", "return {};", "missing value after return"),
    (r"'(?:::)?main' must return 'int'", r"\bvoid(\s+\0?main\b)", r"int\1", "main() must return int"),
    (r"need 'typename' before|missing 'typename' prior", r"\0", "typename ", "missing typename; only MSVC accepts it"),
    (r"duplicate '(?:const|volatile)'", r"\0(?:const|volatile)\s*", "", "const or volatile twice; only MSVC accepts it"),
    (r"invalid use of non-static member function", r"((?:\w+\s*::\s*)+)\0", r"&\1", "missing & before a member function; only MSVC accepts it"),
    (r"invalid operands .*'float'\)?(?: to binary|$)", r"\0%(?!=)", "%(int)", "coordinates were int in engines up to 4.1"),
    (r"invalid operands .*'float'", r"((?:\w+(?:\([^()]*\))?(?:\.|->))*\w+(?:\([^()]*\))?\s*)\0%(?!=)", r"(int)\1%",
     "coordinates were int in engines up to 4.1"),
    (r"non-const lvalue reference", r"(?<!&)&(\s*\w+\s*=[^;]*)\0", r"&&\1", "a temporary object for a reference that is not const; only MSVC accepts it"))]
_NO_TEMPORARY = re.compile(r"non-const lvalue reference of type '(?:\w+::)*(\w+)&'")
_ARGUMENT = re.compile(r"initializing argument \d+ of '.*?(\w+)\(")
_NUMBER = re.compile(r"'(?:virtual |static |constexpr )*(?:unsigned |signed |long |short )*"
                     r"(?:int|bool|float|double|char|long|unsigned|short)\b [\w:~]+\(")


class Change:
    """A change: its place, the line before and after (or an equivalent, like an option), and the reason."""

    def __init__(self, file, line, before, after, why):
        self.file, self.line, self.before, self.after, self.why = file, line, before.strip(), after.strip(), why


class Treatments:
    """Changes the copy according to the compiler's diagnostics, and records the changes."""

    def __init__(self, sources, compiler, naiad):
        self._sources, self._compiler, self._naiad = sources, compiler, naiad
        self.changes, self._returns, self._types, self._tried, self._engines = [], {}, {}, set(), {}
        self._kinds = (self._line, self._return_type, self._missing_return, self._missing_header, self._missing_prefix, self._private_base,
                       self._ambiguous, self._undeclared_enum, self._temporary, self._skipped_initialization)

    def treat(self, units):
        """Changes the copy according to the diagnostics of these units. Returns the units to compile again."""
        definitions = len(self._compiler.definitions)
        again, touched = [], set()
        for unit in units:
            before = len(self.changes), len(unit.forced)
            files = self._treat_unit(unit, touched)
            if files or (len(self.changes), len(unit.forced)) != before:
                again.append(unit)
            touched |= files
        if len(self._compiler.definitions) > definitions:
            return list(units)
        files = {file for file, _ in touched}
        return [unit for unit in units if unit in again or (unit.errors and touched) or unit.name in files or
                any(one.file in files for one in unit.diagnostics)]

    def _treat_unit(self, unit, touched):
        """Changes lines for a unit's diagnostics. Returns these lines. Skips lines that another unit changed, because their columns
        may have moved. Replaces several unknown names in a line from right to left, which keeps their columns valid."""
        lines = {}
        for diagnostic in sorted(unit.diagnostics, key=lambda one: (one.file, one.line, -one.column)):
            place = diagnostic.file, diagnostic.line
            is_name = named(_UNKNOWN, diagnostic.text) is not None
            if place in touched or (place in lines and not (is_name and lines[place])):
                continue
            before = [(one.file, one.line, one.after) for one in self.changes]
            if self._treat_one(unit, diagnostic):
                for one in self.changes:
                    if (one.file, one.line, one.after) not in before:
                        lines[one.file, one.line] = is_name
        return set(lines)

    def _treat_one(self, unit, diagnostic):
        if diagnostic.file not in self._sources.files:
            return False
        key = (unit.name,) + diagnostic.key + (diagnostic.column, self._sources.line(diagnostic.file, diagnostic.line))
        if key in self._tried:
            return False
        self._tried.add(key)
        return any(kind(unit, diagnostic) for kind in self._kinds)

    def _edit(self, diagnostic, after, why):
        before = self._sources.line(diagnostic.file, diagnostic.line)
        if after == before:
            return False
        self._sources.replace(diagnostic.file, diagnostic.line, after)
        same = [one for one in self.changes if (one.file, one.line) == (diagnostic.file, diagnostic.line)]
        if same:
            same[0].after = after.strip()
            self.changes.remove(same[0])
            self.changes.append(same[0])
        else:
            self.changes.append(Change(diagnostic.file, diagnostic.line, before, after, why))
        return True

    def _at(self, diagnostic):
        """Returns the line's text before the column and from the column on (in bytes, as compilers count)."""
        data = self._sources.line(diagnostic.file, diagnostic.line).encode("utf-8", "surrogateescape")
        cut = max(diagnostic.column - 1, 0)
        return data[:cut].decode("utf-8", "surrogateescape"), data[cut:].decode("utf-8", "surrogateescape")

    def _return_type(self, _, diagnostic):
        match = _CONFLICT.search(diagnostic.text)
        goal = next((found.group("type") for _, text, _ in diagnostic.notes if (found := _OVERRIDDEN.search(text))), None)
        if not match or not goal:
            return self._clang_return_type(diagnostic)
        name, old = match.group("name"), match.group("type")
        if name == "draw" and old == "void" and not any(self._sources.find(r"\bint\s+(?:\w+\s*::\s*)?draw\s*\(")):
            if "-DDF_DRAW=void" not in self._compiler.definitions:
                self._compiler.definitions.append("-DDF_DRAW=void")
                self.changes.append(Change(diagnostic.file, diagnostic.line, "void draw()", "-DDF_DRAW=void",
                                           "draw() returns nothing, as in the earliest engines; this option suits all of them"))
            return True
        place, owner = (diagnostic.file, diagnostic.line), match.group("class")
        return self._elsewhere(rf"\b{re.escape(old)}(\s+(?:{owner}\s*::\s*)?{name}\s*\()", goal + r"\1",
                               f"must return the type of the engine's {name}()",
                               lambda file, number, found: (file, number) == place or owner in found.group())

    def _clang_return_type(self, diagnostic):
        """Like _return_type(), for clang, whose message names no class. Changes the declaration; a later message, the definition."""
        match = _CLANG_CONFLICT.search(diagnostic.text)
        if match:
            name, old, goal = match.group("name"), match.group("type"), match.group("goal")
            self._types[name] = old, goal
        else:
            match = _CLANG_DEFINITION.search(diagnostic.text)
            if not match or match.group("name") not in self._types:
                return False
            name = match.group("name")
            old, goal = self._types[name]
        line = self._sources.line(diagnostic.file, diagnostic.line)
        after = re.sub(rf"\b{re.escape(old)}(\s+(?:\w+\s*::\s*)*{name}\s*\()", goal + r"\1", line, count=1)
        return self._edit(diagnostic, after, f"must return the type of the engine's {name}()")

    def _missing_return(self, _, diagnostic):
        if not ("no return statement in function" in diagnostic.text or "control reaches end of non-void" in diagnostic.text or
                "non-void function does not return" in diagnostic.text or "non-void lambda does not return" in diagnostic.text):
            return False
        before, behind = self._at(diagnostic)
        if not behind.startswith("}"):
            return False
        value = "0" if _NUMBER.search(diagnostic.within) else "{}"
        place = (diagnostic.file, diagnostic.line)
        self._returns[place] = self._returns.get(place, self._sources.line(*place))
        return self._edit(diagnostic, before + f"return {value}; " + behind, "missing return at the end of the function")

    def _missing_header(self, unit, diagnostic):
        """Includes the header of a name that other compilers or engines include indirectly."""
        if not diagnostic.is_error:
            return False
        if name := named(_NOT_IN_DF, diagnostic.text):
            return self._force(unit, diagnostic, self._naiad.header_of(name)) or self._scope(diagnostic, name)
        if _UNKNOWN_PARAMETER.search(diagnostic.text):
            names = re.findall(r"\bdf\s*::\s*(\w+)", self._sources.line(diagnostic.file, diagnostic.line))
            return any([self._force(unit, diagnostic, self._naiad.header_of(name)) for name in names])
        hint = next((found for _, text, _ in diagnostic.notes if (found := _FORGOT.search(text))), None)
        return bool(hint) and self._force(unit, diagnostic, hint.group("header") or hint.group("known"))

    def _force(self, unit, diagnostic, header):
        if not header or header in unit.forced:
            return False
        unit.forced.append(header)
        name = f'"{header.rsplit("/", 1)[-1]}"' if header.startswith("/") else f"<{header}>"
        if not any(one.file == diagnostic.file and name in one.after for one in self.changes):
            self.changes.append(Change(diagnostic.file, diagnostic.line, self._sources.line(diagnostic.file, diagnostic.line),
                                       f"#include {name}", "missing header, which other compilers or engines include indirectly"))
        return True

    def _scope(self, diagnostic, name):
        scope = self._naiad.scope_of(name)
        if not scope:
            return False
        line = self._sources.line(diagnostic.file, diagnostic.line)
        after = re.sub(rf"\bdf\s*::\s*{name}\b", f"df::{scope}::{name}", line)
        return self._edit(diagnostic, after, "missing type before a scoped enumerator")

    def _missing_prefix(self, _, diagnostic):
        if not diagnostic.is_error:
            return False
        before, behind = self._at(diagnostic)
        if "expected class-name before" in diagnostic.text:
            return self._bases(diagnostic, before)
        name = named(_UNKNOWN, diagnostic.text)
        if not name or not self._is_engines(name) or not re.match(rf"{name}\b", behind) or re.search(r"(::|\.|->)\s*$", before):
            return False
        return self._edit(diagnostic, before + "df::" + behind, "missing df:: before a name of the engine")

    def _is_engines(self, name):
        """Returns whether a name without df:: can be the engine's: the engine has it, and the game has no class of that name."""
        if name not in self._engines:
            self._engines[name] = self._naiad.header_of(name) is not None and \
                not any(self._sources.find(rf"\b(?:class|struct|enum|union)\s+{name}\b(?!\s*;)"))
        return self._engines[name]

    def _bases(self, diagnostic, before):
        match = re.search(r"(?<!:):(?!:)\s*(?:(?:public|protected|private|virtual)\s+)*(\w+)\s*$", before)
        if not match or not self._is_engines(match.group(1)):
            return False
        _, behind = self._at(diagnostic)
        return self._edit(diagnostic, before[:match.start(1)] + "df::" + before[match.start(1):] + behind,
                          "missing df:: before a name of the engine")

    def _private_base(self, _, diagnostic):
        match = _NO_BASE.search(diagnostic.text)
        name = match.group("class") if match else None
        if not name and _NO_NEW.search(diagnostic.text):
            made = re.search(r"\bnew\s+(\w+)", self._sources.line(diagnostic.file, diagnostic.line))
            name = made.group(1) if made else None
        if not name:
            return False
        return self._elsewhere(rf"\bclass\s+{name}\s*:\s*(?=[\w:])(?!public\b|protected\b|private\b|virtual\b)", r"\g<0>public ",
                               "missing public: base classes are private by default")

    def _ambiguous(self, _, diagnostic):
        match = _AMBIGUOUS.search(diagnostic.text)
        if not match or not any(file in self._sources.files for file, _, _ in diagnostic.notes):
            return False
        before, behind = self._at(diagnostic)
        if not re.match(rf"{match.group('name')}\b", behind) or before.rstrip().endswith("::"):
            return False
        return self._edit(diagnostic, before + "::" + behind, "ambiguous name: the game's own is used")

    def _line(self, _, diagnostic):
        line = "\0".join(self._at(diagnostic))
        for message, pattern, after, why in _LINES:
            if message.search(diagnostic.text) and pattern.search(line):
                return self._edit(diagnostic, pattern.sub(after, line, count=1).replace("\0", ""), why)
        return False

    def _elsewhere(self, pattern, after, why, fits=lambda file, number, match: True):
        """Changes the lines of the sources that match a pattern and fit. Returns whether there was one."""
        places = [one[:2] for one in self._sources.find(pattern) if fits(*one)]
        return any([self._edit(Diagnostic(file, number, 1, "error", "", ""),
                               re.sub(pattern, after, self._sources.line(file, number), count=1), why)
                    for file, number in places])

    def _undeclared_enum(self, unit, diagnostic):
        """Treats `enum X x;` and `enum X;` before a definition of X, for which MSVC assumes int."""
        line = self._sources.line(diagnostic.file, diagnostic.line)
        used = re.search(r"\benum\s+(\w+)(\s*;)?", line) if _ENUM.search(diagnostic.text) else None
        if not used or any(self._sources.find(rf"\benum\s+{used.group(1)}\s*:\s*int\b")):
            return False
        name, why = used.group(1), "an enumeration that is not defined before; only MSVC accepts it"
        defined = rf"\benum\s+{name}\b(?=\s*(?:\{{|$))"
        for file, _, _ in self._sources.find(defined):
            if file != diagnostic.file and not is_source(file):
                return self._force(unit, diagnostic, f"{self._sources.root}/{file}")
        here = self._elsewhere(defined, f"enum {name} : int", why)
        if used.group(2) or (here and line.startswith("enum")):
            rest = "" if used.group(2) else line[used.start():used.end()]
            return self._edit(diagnostic, line[:used.start()] + f"enum {name} : int; {rest}".rstrip() + line[used.end():], why)
        return self._edit(diagnostic, line[:used.start()] + "int" + line[used.end():], why)

    def _temporary(self, _, diagnostic):
        """Makes the parameter const to which a temporary object is passed."""
        match = _NO_TEMPORARY.search(diagnostic.text)
        called = [found for _, text, _ in diagnostic.notes if (found := _ARGUMENT.search(text))] if match else []
        return bool(called) and self._elsewhere(rf"(\b{called[0].group(1)}\s*\([^;{{]*?)\b((?:\w+::)*{match.group(1)}\s*&)", r"\1const \2",
                                                "a temporary object for a reference that is not const; only MSVC accepts it")

    def _skipped_initialization(self, _, diagnostic):
        """Separates the initialization that a goto skips from the declaration."""
        if "jump to label" not in diagnostic.text and "cannot jump from this goto" not in diagnostic.text:
            return False
        for file, text, number in diagnostic.notes:
            line = self._sources.line(file, number)
            after = re.sub(r"^(\s*)((?:unsigned\s+)?\w+[\s*]+)(\w+)\s*=", r"\1\2\3; \3 =", line)
            if ("initialization" in text or "bypasses" in text) and file in self._sources.files:
                return self._edit(Diagnostic(file, number, 1, "error", "", ""), after, "goto skips an initialization; only MSVC accepts it")
        return False

    def undo_returns(self, units):
        """Undoes added returns that do not compile. Returns whether there was one."""
        undone = False
        for unit in units:
            for diagnostic in unit.errors:
                place = (diagnostic.file, diagnostic.line)
                if place in self._returns:
                    self._sources.replace(*place, self._returns.pop(place))
                    self.changes = [one for one in self.changes if (one.file, one.line) != place]
                    undone = True
        return undone
