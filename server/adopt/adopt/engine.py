"""What of a folder is the engine and not the game: copies of the published engine's headers, or an engine of one's own."""
import os
import re

from .folder import is_source
from .text import code_only, decoded

# Headers of published releases that are not among ours, or not in every release of ours.
PUBLISHED_HEADERS = """Splash SplashDragonfly PathManager QuadtreeNode EventCustomNetwork EventNetworkCustom Grid Justification
 Solidness Keyboard Sentry GameObject""".split()
# An engine of one's own has sources of these; a game has none of them.
CORE = {"gamemanager", "worldmanager", "displaymanager", "inputmanager", "logmanager", "resourcemanager", "objectlist",
        "objectlistiterator"}
# A course has its students write these themselves, over the published engine.
NETWORK = re.compile(r"(networkmanager|networknode|eventnetwork\w*|event\w*network|sentry)$")
_IN_DF = re.compile(r"\bnamespace\s+df\b")
_USES_DF = re.compile(r"\b(namespace\s+df|df\s*::)")


def stem(name):
    return os.path.splitext(os.path.basename(name))[0].lower()


class EngineCopies:
    """Which files of the copy belong to an engine.

    `files` they are, `own` says that sources of an engine are among them: it was made by the author, and may have changed
    what the published one has. `without_namespace`: the game speaks to an engine outside of namespace df.
    """

    def __init__(self, root, code_files, our_headers):
        texts = {name: self._read(root, name) for name in code_files}
        known = {stem(name) for name in our_headers} | {name.lower() for name in PUBLISHED_HEADERS}
        core = {stem(name) for name in code_files if is_source(name) and stem(name) in CORE}
        self.own = len(core) >= 3
        brings_network = not self.own and any(is_source(name) and NETWORK.match(stem(name)) for name in code_files)
        self.files = [name for name, text in texts.items()
                      if stem(name) in known and self._is_engines(name, text, brings_network)]
        self.without_namespace = not any(_USES_DF.search(text) for text in texts.values())

    def _is_engines(self, name, text, brings_network):
        if NETWORK.match(stem(name)) and brings_network:
            return False
        if is_source(name):
            return self.own and (_USES_DF.search(text) is not None or stem(name) in CORE)
        return _IN_DF.search(text) is not None or (self.own and stem(name) in CORE)

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
