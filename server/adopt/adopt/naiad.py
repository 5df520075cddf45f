"""The installed Naiad: its headers, library and dfbot, and the names that the headers declare in namespace df."""
import os
import re
import subprocess

from .text import code_only

_DECLARED = re.compile(r"^(?:\s*(?:template\s*<[^>]*>\s*)?(?:class|struct|enum(?:\s+class)?)|using(?=\s+\w+\s*=))\s+(\w+)", re.M)
_FUNCTION = re.compile(r"^(?=[\w\[])(?:\[\[nodiscard\]\] )?(?:inline |constexpr |const |extern |static )*"
                       r"[\w:<>,*& ]+?[ *&](\w+)\s*[(={;]", re.M)
_SCOPED = re.compile(r"\benum\s+class\s+(\w+)[^{;]*\{([^}]*)\}")
_NOT_NAMES = {"if", "for", "while", "return", "switch", "operator", "public", "private", "protected",
              "default", "using", "namespace", "df"}


class Installation:
    """A Naiad in an installation or in its build folder."""

    def __init__(self, include, lib, bin_folder, names_file):
        self.include, self.lib, self.bin = include, lib, bin_folder
        self.headers = sorted(name for name in os.listdir(include) if name.endswith((".h", ".hpp")))
        self.published = _published(names_file)
        self._where, self._scoped, self._words = {}, {}, set()
        for header in self.headers:
            self._index(header)

    def _index(self, header):
        # Most headers only undefine the game's one-letter macros and include the header of their name in text/. Some declare
        # published names in a file of detail/.
        text = self._read(os.path.join("text", header)) or self._read(header)
        details = "\n".join(self._read(name) for name in re.findall(r'#include "(detail/\w+\.h)"', text))
        text, details = code_only(text), code_only(details)
        self._words.update(re.findall(r"\w+", text + details))
        for pattern in (_DECLARED, _FUNCTION):
            for part in [text] * ("namespace df" in text) + [details]:
                for name in pattern.findall(part):
                    if name in self.published or (part is text and name not in _NOT_NAMES):
                        self._where.setdefault(name, header)
        for scope, names in _SCOPED.findall(text):
            for name in re.findall(r"(\w+)\s*(?:=[^,]*)?(?:,|$)", names):
                self._scoped.setdefault(name, set()).add(scope)
        own = os.path.splitext(header)[0]
        if own in self._where:
            self._where[own] = header

    def _read(self, header):
        """Returns the text of an installed header; "" if it does not exist."""
        try:
            with open(os.path.join(self.include, header), encoding="utf-8") as file:
                return file.read()
        except OSError:
            return ""

    def header_of(self, name):
        """Returns the header that declares a name of namespace df, or None."""
        header = self._where.get(name)
        return os.path.join(self.include, header) if header else None

    def has(self, name):
        """Returns whether a header for games has this name at all, for example as that of a member."""
        return name in self._words

    def scope_of(self, enumerator):
        """Returns the scoped enumeration of this enumerator; None if there is not exactly one."""
        scopes = self._scoped.get(enumerator, ())
        return next(iter(scopes)) if len(scopes) == 1 else None

    def was_published(self, name, classes=()):
        """Returns whether the published engine has this class, constant or header; with `classes`, whether one of these has such a
    member."""
        if classes:
            return any(f"{one}::{name}" in self.published for one in classes)
        return name in self.published or any(one.endswith("::" + name) and one.split("::")[0][:1].isupper() and name.isupper()
                                             for one in self.published)


def _published(path):
    with open(path, encoding="utf-8") as file:
        return {line.strip() for line in file if line.strip() and not line.startswith("#")}


def system_headers(compiler):
    """Returns the folders in which the compiler looks for <headers>."""
    try:
        said = subprocess.run([compiler, "-E", "-v", "-x", "c++", os.devnull], capture_output=True, timeout=30, check=False,
                              stdin=subprocess.DEVNULL, env={**os.environ, "LC_ALL": "C"}).stderr.decode("utf-8", "replace")
    except (OSError, subprocess.TimeoutExpired):
        return []
    match = re.search(r"#include <\.\.\.> search starts here:\n(.*?)End of search list", said, re.S)
    return [line.strip() for line in match.group(1).splitlines()] if match else []
