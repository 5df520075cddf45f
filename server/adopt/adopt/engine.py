"""What of a folder is the engine and not the game: copies of the published engine's headers, or an engine of one's own."""
import os
import re

from .folder import is_source
from .text import code_only, decoded

# Headers of early releases, which the list of published names does not have.
EARLY_HEADERS = {"justification", "solidness", "keyboard", "sentry", "gameobject"}
WITHOUT_CLASS = {"utility", "splash"}  # these have functions alone
# An engine of one's own has sources of these; a game has none of them.
CORE = {"gamemanager", "worldmanager", "displaymanager", "inputmanager", "logmanager", "resourcemanager", "objectlist",
        "objectlistiterator"}
# A course has its students write these themselves, over the published engine.
NETWORK = re.compile(r"(networkmanager|networknode|eventnetwork\w*|event\w*network|sentry)$")
_OPENS_DF = re.compile(r"(?<!using )\bnamespace\s+df\s*\{")
_USES_DF = re.compile(r"\b(namespace\s+df|df\s*::)")


def stem(name):
    return os.path.splitext(os.path.basename(name))[0].lower()


def published_stems(names):
    """The stems of the published engine's headers. Naiad has more of its own, whose names a game may use: Player, World, Random."""
    return {stem(name) for name in names if name.endswith(".h")} | EARLY_HEADERS


def _blocks(text):
    """What stands in the blocks `namespace df { … }` of a code text."""
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
    """Whether a class, an enumeration or a namespace of this name (any case) is defined, not only announced, in namespace df."""
    defined = re.compile(r"\b(?:class|struct|enum|namespace)\s+(?:class\s+)?" + re.escape(name) + r"\b[^;{}()]{0,500}\{", re.I)
    return any(defined.search(block) for block in _blocks(text))


class EngineCopies:
    """Which files of the copy belong to an engine.

    `files` they are, `own` says that sources of an engine are among them: it was made by the author, and may have changed
    what the published one has. `without_namespace`: the game speaks to an engine outside of namespace df.
    """

    def __init__(self, root, code_files, published):
        texts = {name: self._read(root, name) for name in code_files}
        known = published_stems(published)
        core = [name for name in code_files if is_source(name) and stem(name) in CORE]
        self.own = len({stem(name) for name in core}) >= 3
        self._core_folders = {os.path.dirname(name) for name in core}
        brings_network = not self.own and any(is_source(name) and NETWORK.match(stem(name)) for name in code_files)
        candidates = [name for name in code_files if stem(name) in known and not (brings_network and NETWORK.match(stem(name)))]
        headers = [name for name in candidates if not is_source(name) and self._is_engines_header(name, texts[name])]
        # A source goes with its header: where the header is the game's, so is the source.
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
        return os.path.dirname(name) in self._core_folders or _OPENS_DF.search(text) is not None or member.search(text) is not None

    @staticmethod
    def _read(root, name):
        with open(os.path.join(root, name), "rb") as file:
            return code_only(decoded(file.read())[0])

    def folders(self):
        """{folder: how many files of it are an engine's}"""
        count = {}
        for name in self.files:
            folder = os.path.dirname(name) or "."
            count[folder] = count.get(folder, 0) + 1
        return count
