"""Fixes #include lines that work only on Windows: backslashes, wrong case, paths to an engine that is not there."""
import os
import re

from .folder import is_source
from .programs import is_secondary

_INCLUDE = re.compile(r'^(\s*#\s*include\s*)(["<])([^">]+)[">](.*)$', re.S)
MAX_FOLDERS = 200  # maximum folders to search for headers
# Headers of Visual Studio, which games do not need elsewhere.
_DROPPED = re.compile(r"(?:stdafx|pch|targetver|tchar|sdkddkver|crtdbg|afxwin|resource|vld|corecrt\w*|vcruntime\w*|sal|xstring|xutility|"
                      r"xmemory|process|io)(?:\.h)?$")
# Headers that Windows.h includes on Windows.
_OF_WINDOWS = re.compile(r"(?:winuser|winbase|windef|minwindef|wincon|consoleapi\d?|synchapi|mmsystem|playsoundapi|timeapi)\.h$", re.I)


class Includes:
    """Rewrites the include lines of the game's sources. Adds and removes no lines."""

    def __init__(self, sources, folders, naiad, system_folders):
        self._sources, self._folders, self._naiad, self._system = sources, folders, naiad, system_folders
        self._names, self._by_lower, self._by_base = set(sources.files), {}, {}
        for name in sources.files:
            self._by_lower.setdefault(name.lower(), name)
            self._by_base.setdefault(os.path.basename(name).lower(), []).append(name)
        self._ours = {}
        for name in sorted(naiad.headers):  # Vector.h before vector.h
            self._ours.setdefault(name.lower(), name)

    def treat(self):
        """Rewrites the lines. Returns [(file, line number, before, after, why)]."""
        done = []
        for name in self._sources.files:
            for number, line in enumerate(self._sources.text(name).split("\n"), 1):
                match = _INCLUDE.match(line.rstrip("\r"))
                change = self._change(name, match) if match else None
                if change:
                    after, why = change
                    self._sources.replace(name, number, after)
                    done.append((name, number, line.strip(), after.strip(), why))
        return done

    def _change(self, name, match):
        begin, mark, written, rest = match.groups()
        path = written.strip().replace("\\", "/")
        if mark == "<" and self._is_systems(os.path.dirname(name), path):
            return None
        goal = self._resolve(os.path.dirname(name), path)
        if goal is None:
            if _DROPPED.match(os.path.basename(path).lower()):
                return f"//{begin}{mark}{written}{'>' if mark == '<' else mark}{rest}", "a header that only Visual Studio has"
            return None
        found, is_ours = goal
        if found == written and (mark == '"' or is_ours):
            return None
        if "\\" in written:
            why = "folders are separated by /, not by a backslash"
        elif found == written:
            why = "headers of the game are included with quotation marks"
        elif found.lower() == path.lower():
            why = "upper and lower case must match the file name"
        else:
            why = "Naiad's header is used" if is_ours else "the path does not lead to the file"
        return f'{begin}"{found}"{rest}', why

    def _is_systems(self, here, path):
        """Returns whether <path> needs no change: a system header, or a header of Naiad if the game has no file of that name."""
        if path.startswith("SFML/") or any(os.path.exists(os.path.join(folder, path)) for folder in self._system):
            return True
        return path in self._naiad.headers and not any(place.lower() in self._by_lower for place in self._candidates(here, path))

    def _candidates(self, here, path):
        return [os.path.normpath(os.path.join(folder, path)) for folder in [here] + self._folders]

    def _resolve(self, here, path):
        """Returns (path to write, whether it is Naiad's header), or None if there is no such file. Prefers the game's files: a game
        with a Player.h of its own (or player.h) does not mean Naiad's."""
        places = self._candidates(here, path)
        if any(place in self._names for place in places):
            return path, False
        for place in places:
            real = self._by_lower.get(place.lower())
            if real:
                return self._spelt(path, real, here), False
        if path in self._naiad.headers:
            return path, True
        if _OF_WINDOWS.match(path):
            return "windows.h", True
        if path.lower() in self._ours:
            return self._ours[path.lower()], True
        base = os.path.basename(path).lower()
        if len(self._by_base.get(base, ())) == 1:
            return os.path.relpath(self._by_base[base][0], here or "."), False
        if base in self._ours and "sfml" not in path.lower():
            return self._ours[base], True
        return None

    @staticmethod
    def _spelt(path, real, here):
        """Returns the path of an #include with upper and lower case as in the name of the file."""
        return real[len(real) - len(path):] if real.lower().endswith(path.lower()) else os.path.relpath(real, here or ".")


def included_sources(sources):
    """Returns {source: the files that include it}. Such a source is not compiled alone, but as a part of those files."""
    by_lower = {name.lower(): name for name in sources.files if is_source(name)}
    found = {}
    for name in sources.files:
        for line, code in zip(sources.text(name).split("\n"), sources.code(name).split("\n")):
            match = _INCLUDE.match(line) if code.lstrip().startswith("#") else None
            path = match.group(3).strip().replace("\\", "/") if match else ""
            if is_source(path):
                goal = by_lower.get(os.path.normpath(os.path.join(os.path.dirname(name), path)).lower())
                if goal:
                    found.setdefault(goal, []).append(name)
    return found


def header_folders(sources, program):
    """Returns the folders with headers: that of the program first, those that look like tests or leftovers last."""
    home = os.path.dirname(program.main)
    folders = {os.path.dirname(name) for name in sources.files if not is_source(name)}
    return sorted(folders, key=lambda folder: (folder != home, is_secondary(folder), folder.count("/"), folder))[:MAX_FOLDERS]
