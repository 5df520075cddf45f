"""Judges the errors that remain after all treatments: whose fault each error is, and what to change."""
import os
import re

from .text import named

OURS, THEIRS, OTHER, SYSTEM, UNCLEAR = "Naiad", "the game", "another engine", "another system", "Naiad or the game"

_MISSING_FILE = re.compile(r"^'?(?P<file>[^\s:']+)'?(?:: No such file or directory| file not found)")
_NAMED = [re.compile(pattern) for pattern in (
    r"has no member named '(?P<name>\w+)'", r"'(?P<name>\w+)' is not a member of",
    r"'(?P<name>\w+)' in namespace 'df'",
    r"no (?:type|member) named '(?P<name>\w+)'",
    r"'(?:df::)?(?P<name>\w+)' (?:was not declared|does not name|has not been declared)",
    r"undeclared identifier '(?P<name>\w+)'",
    r"unknown type name '(?P<name>\w+)'", r"no matching (?:member )?function for call to '(?:\w+::)*(?P<name>\w+)")]
_WINDOWS_HEADERS = re.compile(r"^(win\w+|ws2\w+|direct|conio|io|mmsystem|shlobj|shellapi|"
                              r"tlhelp32|psapi|dsound|xinput|fileapi|synchapi|process)\.h$", re.I)
_WINDOWS_NAMES = re.compile(r"^(\w+_s|__\w*(declspec|stdcall|int64)|_tmain|_T|TCHAR|LPC?W?STR|"
                            r"DWORD|WORD|BOOL|HANDLE|HWND|HINSTANCE|COORD|SOCKET|"
                            r"WSA\w+|INVALID_\w+|GetAsyncKeyState|Sleep\w*|"
                            r"SetConsole\w*|GetStdHandle|CONSOLE_\w+|PlaySound\w*|MessageBox\w*|"
                            r"_getch|_kbhit|VK_\w+|closesocket|ioctlsocket|_access|"
                            r"_mkdir|_getcwd|MAX_PATH|TEXT|SND_\w+|DebugBreak|OutputDebugString\w*)$")
_MAC_HEADERS = re.compile(r"(CoreFoundation|ApplicationServices|Cocoa|mach|mach-o|TargetConditionals|"
                          r"Carbon|AppKit|Foundation|CoreGraphics)\b")
_NETWORK_HEADERS = re.compile(r'#\s*include\s*[<"](winsock2?|ws2tcpip|sys/socket|netinet/in|arpa/inet|netdb)\.h[>"]', re.I)
_WINDOWS_MAIN = re.compile(r"\b(WINAPI|APIENTRY|w?WinMain)\b")
NETWORK_SENTENCE = ("it has its own network code, which is not needed here: the whole game runs on the server, and every "
                    "dfclient that joins sees it and presses keys; EventKeyboard::getPlayer() returns the player. Remove these files and the code that uses them")
_ASK_FOR_ENGINE = "the engine in this folder accepts {}, but Naiad does not: please report it if that is an unchanged published engine"
_MAIN_ADVICE = "WinMain() exists only on Windows: write int main()"


def missing_name(text):
    """Returns the name that is missing according to a compiler message, or None."""
    return named(_NAMED, text)


def missing_file(text):
    match = _MISSING_FILE.match(text)
    return match.group("file") if match else None


class Blame:
    """Judges errors of the compiler and the linker.

    with_engine(unit) compiles a unit against the engine headers in the folder and returns its diagnostics, or None if there are
    no such headers or the compilation proves nothing. `own_engine`: the author wrote that engine. `main_code`: code of the
    program's main file. `early`: the sources were written for an engine without namespace df.
    """

    def __init__(self, naiad, own_engine, engine_text, with_engine, main_code="", early=False):
        self._windows_main, self._early = _WINDOWS_MAIN.search(main_code) is not None, early
        self._naiad, self._own, self._engine_text, self._with_engine = naiad, own_engine, engine_text, with_engine
        self._checked, self._spoiled = {}, {}

    def error(self, unit, diagnostic, line=""):
        """Returns (whose fault, what to do) for a compiler error in this line. If an earlier line that should have declared the
        missing name was not the game's fault, neither is this error."""
        whose, change = self._error(unit, diagnostic, line)
        name, spoiled = missing_name(diagnostic.text), self._spoiled.setdefault(unit and unit.name, {})
        if whose == THEIRS and name in spoiled:
            return spoiled[name], "it follows from an error above"
        if whose != THEIRS:
            spoiled.update({word: whose for word in re.findall(r"\w+", line) if word not in spoiled})
        return whose, change

    def _error(self, unit, diagnostic, line):
        file, name = missing_file(diagnostic.text), missing_name(diagnostic.text)
        if file:
            return self._file(os.path.basename(file.replace("\\", "/")), file)
        if name and _WINDOWS_NAMES.match(name):
            return SYSTEM, f"{name} exists only on Windows: {_suggestion(name)}"
        if _WINDOWS_MAIN.search(line):
            return SYSTEM, _MAIN_ADVICE
        published = name and self._is_engines(name, diagnostic.text)
        # A function that was called with other arguments exists. A name without df:: may be the game's own.
        if published and not self._naiad.has(name) and "no matching" not in diagnostic.text:
            return OURS if re.search(r"\bdf\b", diagnostic.text) else UNCLEAR, f"the published engine has {name}, but Naiad does not: please report it"
        if self._is_gone_with_engine(unit, diagnostic, name):
            if self._own:
                return OTHER, (f"the engine in this folder has {name or 'this'}, but the published engine may not: use "
                               "what Naiad's headers declare")
            return UNCLEAR, _ASK_FOR_ENGINE.format("this line")
        if published and not self._is_member_of_game(diagnostic.text):
            return UNCLEAR, f"Naiad has {name}, but not here or not with these arguments: compare it with the headers, or report it"
        if os.path.isabs(diagnostic.file):
            return UNCLEAR, "look for a macro or a name of the game that changes this header; else report it"
        if name and self._own and re.search(rf"\b{name}\b", self._engine_text):
            return OTHER, f"{name} belongs to the engine in this folder: the published engine does not have it"
        if name and not self._naiad.has(name) and re.search(rf"\b(?:class|struct|enum)\s+{name}\b|\b{name}\s*[=(]", self._engine_text):
            return UNCLEAR, _ASK_FOR_ENGINE.format(name)
        if self._own and any(not self._naiad.has(one) for one in re.findall(r"\bdf\s*::\s*(\w+)", diagnostic.text + line)):
            return OTHER, "it uses a name of the engine in this folder that the published engine does not have"
        return THEIRS, _advice(diagnostic.text, name)

    def _is_engines(self, name, text):
        """Returns whether the published engine declares the name that is missing according to this message."""
        owner = re.search(r"'(?:class |struct |const )*(?:df::)?(\w+)[ *&]*' has no member|call to '(?:df::)?(\w+)::", text)
        if owner:
            one = owner.group(1) or owner.group(2)
            known = self._naiad.header_of(one) is not None
            return self._naiad.was_published(name, (one,) if known else ("Object", "ViewObject", "Event", "Manager"))
        if "call to" in text:
            return self._naiad.header_of(name) is not None and f"df::{name}" in text
        return self._naiad.was_published(name)

    def _file(self, base, path):
        if _WINDOWS_HEADERS.match(base):
            return SYSTEM, f"{base} exists only on Windows: remove the code that uses it"
        if _MAC_HEADERS.match(path):
            return SYSTEM, f"{path} exists only on macOS: remove the code that uses it"
        if re.fullmatch(r"(?:.*/)?n?curses\.h", path):
            return OTHER, "only engines before 3.0, which are not supported, draw with curses"
        if re.fullmatch(r"[a-z_]+", path):
            return SYSTEM, f"<{path}> is a header of the standard library that this compiler lacks: use a newer one (--cxx)"
        if self._naiad.was_published(base):
            return UNCLEAR, f"{base} is not in the folder: add it, or report it if the published engine's is meant, which Naiad lacks"
        return THEIRS, f"{base} is not in the folder: add it, or remove this line and the code that needs it"

    def _is_member_of_game(self, text):
        """Returns whether this message says that a class of the game lacks a member, as it does if its base is unknown."""
        owner = re.search(r"'(?:class |struct |const )*(\w+)[ *&]*' has no member", text)
        return owner is not None and not self._naiad.header_of(owner.group(1))

    def _is_gone_with_engine(self, unit, diagnostic, name):
        if unit is None or os.path.isabs(diagnostic.file):
            return False
        if unit.name not in self._checked:
            self._checked[unit.name] = self._with_engine(unit)
        found = self._checked[unit.name]
        # If that compilation stopped at a missing file, it proves nothing about the other lines.
        if found is None or any(one.kind == "fatal error" for one in found):
            return False
        return not any(one.is_error and ((one.file, one.line) == (diagnostic.file, diagnostic.line) or
                                         (name and missing_name(one.text) == name)) for one in found)

    def symbol(self, symbol):
        """Like error(), for a symbol that no object file defines."""
        plain = re.sub(r"\(.*", "", symbol).replace("[abi:cxx11]", "")
        parts = [part for part in re.split(r"::|\s", plain) if part]
        name = parts[-1] if parts else plain
        if plain.strip() in ("main", "WinMain"):
            if self._windows_main:
                return SYSTEM, _MAIN_ADVICE
            return THEIRS, "no file of the program has a main()"
        if self._early and any(map(self._naiad.header_of, parts)):
            return OTHER, f"{plain} belongs to an engine without namespace df"
        if "df" in parts[:1] or (len(parts) > 1 and self._naiad.header_of(parts[-2]) and not self._own):
            if self._own:
                return OTHER, f"{plain} belongs to the engine in this folder"
            if self._naiad.was_published(name) and not self._naiad.has(name):
                return OURS, f"the published engine has {plain}, but Naiad does not: please report it"
            return (UNCLEAR if self._naiad.has(name) else THEIRS,
                    f"{plain} is declared like this by a header that is not Naiad's, but not defined")
        if symbol.startswith("__imp_") or _WINDOWS_NAMES.match(name):
            return SYSTEM, f"{plain} exists only on Windows"
        return THEIRS, f"{plain} is declared, but no source in the folder defines it: add the source, or write the function"


def _suggestion(name):
    if name.endswith("_s"):
        return f"use {name[:-2]}(), and adapt the arguments"
    if re.match(r"GetAsyncKeyState|_getch|_kbhit|VK_", name):
        return "keys arrive as events (EventKeyboard)"
    if re.match(r"SOCKET|WSA|closesocket|ioctlsocket|INVALID_", name):
        return "no network code is needed here, see below"
    return "remove it"


def _advice(text, name):
    """Returns advice for an error that is the author's own."""
    for pattern, advice in (
            (r"is ambiguous", f"write ::{name or 'X'} for the game's own, or remove `using namespace`"),
            (r"marked 'override', but does not override",
             "give it the arguments of the engine's function: int eventHandler(const df::Event *p_e)"),
            (r"invalid conversion from 'const ", "add the missing const"),
            (r"invalid new-expression of abstract class|abstract", "define the pure virtual functions of its base class"),
            (r"redefinition of|multiple definition", "define it once: #pragma once in headers, functions in a .cpp"),
            (r"expected ", "syntax error in this line or the one before"),
            (r"no matching function|no declaration matches|candidate expects", "compare the arguments with the declaration"),
            (r"was not declared|does not name a type|has not been declared|undeclared|unknown type",
             f"{name or 'the name'} is not declared: include its header, or correct the name"),
            (r"has no member named", f"the class has no {name}: correct the name"),
            (r"cannot convert|could not convert", "the types do not match")):
        if re.search(pattern, text):
            return advice
    return "correct this line"


def networks(sources, names):
    """Returns (file, line) of the first #include of a network header, for each source that has one."""
    found = []
    for name in names:
        for number, line in enumerate(sources.text(name).split("\n"), 1):
            if _NETWORK_HEADERS.search(line):
                found.append((name, number))
                break
    return found


def unregistered(sources, names):
    """Returns (file, line, type of event) for each type that an eventHandler() tests although nothing in the program registers
    interest in it. Returns nothing if that is uncertain, as with classes of the engine that register themselves."""
    code = "\n".join(map(sources.code, names))
    if re.search(r"\bregisterInterest\s*\(\s*(?!(?:df\s*::\s*)?\w+_EVENT\b)\w|\b(TextEntry|Button|Pause|PlayerObject)\b", code):
        return []
    registered = set(re.findall(r"\bregisterInterest\s*\(\s*(?:df\s*::\s*)?(\w+_EVENT)\b", code))
    tested = sources.find(r"\bgetType\s*\(\s*\)\s*==\s*(?:df\s*::\s*)?((?:STEP|KEYBOARD|MSE)_EVENT)\b", names)
    found = {match.group(1): (file, line) for file, line, match in tested if match.group(1) not in registered}
    return [(*place, event) for event, place in found.items()]
