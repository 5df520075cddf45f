"""Finds the files of a folder that belong to an engine: copies of the published headers, or an engine of the author's own."""
import os
import re

from .folder import is_source
from .text import code_only, decoded

# Headers of early releases, which are not in the list of published names.
EARLY_HEADERS = {"justification", "solidness", "keyboard", "sentry", "gameobject"}
WITHOUT_CLASS = {"utility", "splash"}  # headers that have only functions
# Files that an engine of the author's own has, and a game never has.
CORE = {"gamemanager", "worldmanager", "displaymanager", "inputmanager", "logmanager", "resourcemanager", "objectlist",
        "objectlistiterator"}
# Files that students of a course write themselves on top of the published engine.
NETWORK = re.compile(r"(networkmanager|networknode|eventnetwork\w*|event\w*network|sentry)$")
_OPENS_DF = re.compile(r"(?<!using )\bnamespace\s+df\s*\{")
_USES_DF = re.compile(r"\b(namespace\s+df|df\s*::)")


def stem(name):
    return os.path.splitext(os.path.basename(name))[0].lower()


def published_stems(names):
    """Returns the stems of the published engine's headers, without Naiad's own: a game may use their names (Player, World)."""
    return {stem(name) for name in names if name.endswith(".h")} | EARLY_HEADERS


def _blocks(text):
    """Yields the contents of the blocks `namespace df { … }`."""
    end = 0
    for begin in _OPENS_DF.finditer(text):
        if begin.start() < end:
            continue
        depth, end = 1, len(text)
        for brace in re.compile(r"[{}]").finditer(text, begin.end()):
            depth += 1 if brace.group() == "{" else -1
            if depth == 0:
                end = brace.start()
                break
        yield text[begin.end():end]


def _defines(text, name):
    """Returns whether namespace df defines (not only declares) a class, enumeration or namespace of this name, in any case."""
    defined = re.compile(r"\b(?:class|struct|enum|namespace)\s+(?:class\s+)?" + re.escape(name) + r"\b[^;{}()]{0,500}\{", re.I)
    return any(defined.search(block) for block in _blocks(text))


class EngineCopies:
    """Finds the `files` of the copy that belong to an engine.

    `own`: the files include sources of an engine, so the author wrote that engine and it may differ from the published one.
    `core_folders`: the folders of those sources. `without_namespace`: no file uses namespace df.
    """

    def __init__(self, root, code_files, published):
        texts = {name: self._read(root, name) for name in code_files}
        known = published_stems(published)
        core = [name for name in code_files if is_source(name) and stem(name) in CORE]
        self.own = len({stem(name) for name in core}) >= 3
        self.core_folders = {os.path.dirname(name) for name in core}
        brings_network = not self.own and any(is_source(name) and NETWORK.match(stem(name)) for name in code_files)
        candidates = [name for name in code_files if stem(name) in known and not (brings_network and NETWORK.match(stem(name)))]
        headers = [name for name in candidates if not is_source(name) and self._is_engines_header(name, texts[name])]
        # A source belongs to the engine if its header does, else to the game.
        games = {stem(name) for name in code_files if not is_source(name)} - {stem(name) for name in headers}
        sources = [name for name in candidates if is_source(name) and self._is_engines_source(name, texts[name], games)]
        self.files = sorted(headers + sources)
        self.without_namespace = not any(_USES_DF.search(text) for text in texts.values())

    def _is_engines_header(self, name, text):
        if self.own and stem(name) in CORE:
            return True
        return _defines(text, stem(name)) or (stem(name) in WITHOUT_CLASS and any(_blocks(text)))

    def _is_engines_source(self, name, text, games):
        if not self.own or stem(name) in CORE:
            return self.own
        if stem(name) in games:
            return False
        member = re.compile(r"\bdf\s*::\s*" + re.escape(stem(name)) + r"\s*::", re.I)
        return os.path.dirname(name) in self.core_folders or _OPENS_DF.search(text) is not None or member.search(text) is not None

    @staticmethod
    def _read(root, name):
        with open(os.path.join(root, name), "rb") as file:
            return code_only(decoded(file.read())[0])

    def folders(self):
        """Returns {folder: number of its files that belong to an engine}."""
        count = {}
        for name in self.files:
            folder = os.path.dirname(name) or "."
            count[folder] = count.get(folder, 0) + 1
        return count
