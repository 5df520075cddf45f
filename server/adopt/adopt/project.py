"""Finds the sources that Makefiles and project files list. These files are read as text and never executed.

They are untrusted: all patterns take linear time, and lengths and numbers of words are limited.
"""
import fnmatch
import html
import os
import re

from .folder import is_source

_SEPARATORS = re.compile(r"[\s\"'<>|;,()=:]+")
_SOURCE_WORD = re.compile(r".+\.(?:cpp|cc|cxx|c\+\+|C)(?!\w)")
_OBJECT_WORD = re.compile(r"([\w./-]+)\.o(?!\w)")
MAX_PROJECT_FILE = 1 << 20  # maximum bytes; larger project files are not read
MAX_PROJECT_FILES = 60  # maximum number read: those in the fewest subfolders
MAX_WORD = 300  # maximum characters of a source's path
MAX_WORDS = 5000
MAX_PATTERNS = 40
_DEFINITION = re.compile(r"(?<![^\s\"'(=])-D ?([A-Za-z_]\w{0,60}(?:=[\w.+-]{0,60})?)(?=[\s\"')]|\Z)")
_OTHER_SYSTEM = re.compile(r"_*(win(32|64|dows|nt)?|msvc|msc_ver|mac|macosx?|osx|apple|darwin)(_|\d|=|\Z)", re.I)
MAX_DEFINITIONS = 20


class SourceList:
    """The contents of a project file: `sources` that exist, `missing` ones, `unread` calls of programs, `definitions` (-DNAME=
    VALUE). `exact`: the file names each source. If not, it has patterns, which may match unused sources."""

    def __init__(self, file, sources, missing, unread=(), exact=True, definitions=()):
        self.file, self.sources, self.missing, self.unread, self.exact = file, sources, missing, list(unread), exact
        self.definitions = list(definitions)


def is_project_file(name):
    base = os.path.basename(name).lower()
    return (base.startswith(("makefile", "gnumakefile", "cmakelists")) and not base.endswith(".bak")) or \
        base.endswith((".mk", ".vcxproj", ".vcproj", ".cbp", ".pro")) or base == "project.pbxproj"


def read_lists(root, files, sources):
    """Reads the project files among `files`. Their words are resolved to files of `sources`, ignoring case."""
    known = _Known(sources)
    lists = []
    for name in sorted(filter(is_project_file, files), key=lambda one: one.count("/"))[:MAX_PROJECT_FILES]:
        path = os.path.join(root, name)
        if os.path.getsize(path) > MAX_PROJECT_FILE:
            continue
        with open(path, "rb") as file:
            text = file.read().decode("utf-8-sig", "replace")
        words, unread = _words(name, text)
        deep = "GLOB_RECURSE" in text and os.path.basename(name).lower().startswith("cmakelists")
        found, missing, patterns = {}, [], 0
        for word in words[:MAX_WORDS]:
            patterns += _is_pattern(word)
            here = known.meant(os.path.dirname(name), word, deep) if len(word) <= MAX_WORD and patterns <= MAX_PATTERNS else None
            if here is None:
                missing.append(word)
            else:
                found.update(dict.fromkeys(here))
        if found or missing:
            lists.append(SourceList(name, list(found), missing, unread, patterns == 0, _definitions(text)))
    return lists


def _words(name, text):
    """Returns the sources that a project file names, and the calls of other programs in it."""
    base = os.path.basename(name).lower()
    if base.endswith((".vcxproj", ".vcproj")):
        return _only_sources(html.unescape(word) for word in _visual_studio(text)), []
    if base.endswith(".cbp"):
        return _only_sources(html.unescape(word) for word in re.findall(r"<Unit\s+filename=\"([^\"]*)\"", text)), []
    if base == "project.pbxproj":
        return ["**/" + word for word in _only_sources(re.findall(r"/\* ([^*/]+) in Sources \*/", text))], []
    text = re.sub(r"\\\r?\n", " ", re.sub(r"(?m)(?<!\\)#.*$", "", text))
    unread = re.findall(r"\$\((?:shell|eval|call|file|guile)\b[^\n]*", text)
    text = re.sub(r"\$\((?:shell|eval|call|file|guile)\b[^\n]*", " ", text)
    # Removes rules that use sources for other purposes than building the program.
    text = re.sub(r"(?m)^\t.*(?:makedepend|-MM|\brm\b|\btar\b|\bzip\b|clang-format).*$", "", text)
    return _expanded(_with_variables(text)), unread


def _definitions(text):
    """Returns the -D options in the text of a project file, except those for other systems."""
    found = _DEFINITION.findall(re.sub(r"(?m)(?<!\\)#.*$", "", text))
    return [f"-D{one}" for one in dict.fromkeys(found) if not _OTHER_SYSTEM.match(one)][:MAX_DEFINITIONS]


def _visual_studio(text):
    """Yields the items of a Visual Studio project that are not excluded from the build."""
    for item in re.split(r"<(?:ClCompile|File)(?=\s)", text)[1:]:
        tag, _, inner = item.partition(">")
        path = re.search(r"(?:Include|RelativePath)\s*=\s*\"([^\"]*)\"", tag)
        if tag.endswith("/"):
            inner = ""
        inner = re.split(r"</(?:ClCompile|File)>", inner, maxsplit=1)[0]
        if path and not re.search(r"<ExcludedFromBuild[^<>]{0,300}>\s*true|\bExcludedFromBuild\s*=\s*\"true", inner, re.I):
            yield path.group(1)


def _with_variables(text):
    """Replaces variables whose value is one word, as in SRC = src or set(SRC src). Does not replace variables in such values."""
    found = re.findall(r"(?m)^[ \t]*([\w.-]+)[ \t]*[:?]?:?=[ \t]*([^\s$()]{1,100})[ \t\r]*$", text)
    found += re.findall(r"\bset\s*\(\s*([\w.-]+)\s+\"?([^\s$()\"]{1,100})\"?\s*\)", text)
    variables = dict(found[:100])
    return re.sub(r"\$[({]([\w.-]+)[)}]", lambda match: variables.get(match.group(1), match.group()), text)


def _expanded(text):
    """Returns the sources that a Makefile or the like names, with patterns. If it names none, derives them from object files."""
    here = "wildcard|CMAKE_CURRENT_SOURCE_DIR|CMAKE_SOURCE_DIR|PROJECT_SOURCE_DIR"
    plain = re.sub(r"\$[({](?:" + here + r")[)}]?", " ./ ", text)
    words = [word for word in _SEPARATORS.split(re.sub(r"\./\s+/?", "./", plain)) if len(word) <= MAX_WORD]
    names = _only_sources(match.group() for word in words if (match := _SOURCE_WORD.match(word)))
    if not names:
        objects = [match.group(1) for word in words if (match := _OBJECT_WORD.match(word))]
        names = [name + ".cpp" for name in dict.fromkeys(objects)]
    return names


def _only_sources(words):
    return list(dict.fromkeys(word for word in words if is_source(word) and "%" not in word and "$" not in word))


def _is_pattern(word):
    return "*" in word and not word.startswith("**/")  # "**/" marks a word of an Xcode project: in any folder


class _Known:
    """Finds the existing sources that words in project files refer to."""

    def __init__(self, sources):
        self._by_lower, self._by_base = {name.lower(): name for name in sources}, {}
        for name in sources:
            self._by_base.setdefault(os.path.basename(name).lower(), []).append(name)

    def meant(self, folder, word, deep):
        """Returns the sources that a word of a project file in `folder` means, or None. deep: patterns match in subfolders, too."""
        word = word.replace("\\", "/")
        path = os.path.normpath(os.path.join(folder, word)).lower()
        if _is_pattern(word):
            pattern = re.sub(r"\*+", "*", path).replace("[", "[[]")
            return [name for lower, name in self._by_lower.items() if _fits(lower, pattern, deep)] or None
        if path in self._by_lower:
            return [self._by_lower[path]]
        # Looks for the file name alone, because the path may be outdated or that of another machine.
        same = self._by_base.get(os.path.basename(word).lower(), ())
        return same if len(same) == 1 else None


def _fits(path, pattern, deep):
    """Returns whether a path matches a pattern with *, which does not match '/' unless `deep`. fnmatch does not backtrack."""
    if deep:
        return fnmatch.fnmatchcase(path, pattern)
    parts, wanted = path.split("/"), pattern.split("/")
    return len(parts) == len(wanted) and all(fnmatch.fnmatchcase(*pair) for pair in zip(parts, wanted))
