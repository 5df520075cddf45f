"""Replaces names of Visual Studio's templates and library, like _tmain and _TCHAR, with standard ones."""
import re

from .treatments import Change

_WORDS = {"_tmain": "main", "wmain": "main", "_TCHAR": "char", "TCHAR": "char", "__int64": "long long", "__forceinline": "inline",
          "_stricmp": "strcasecmp", "stricmp": "strcasecmp", "_strnicmp": "strncasecmp", "_strdup": "strdup", "_snprintf": "snprintf"}
_TEXT = r'\b_T(?:EXT)?\s{0,20}\(\s{0,20}("(?:\\.|[^"\\])*")\s{0,20}\)'
# Calls that make Visual Studio report memory leaks. They are removed.
_LEAKS = r"\b_Crt\w+\s{0,20}\([^();]{0,300}\)(?=\s{0,20};)"
_DEFINED = r"#\s*define\s+(\w+)|\btypedef\s[^;]{0,200}\b(\w+)\s*;|\b(?:int|char)[ \t*]{1,20}(_?str\w+|_snprintf)\s*\("
_ANY = re.compile(r"\b(?:_T|_TEXT|_Crt\w+|" + "|".join(_WORDS) + r")\b")


def treat(sources):
    """Replaces the names, except those that the game defines itself. Returns the changes."""
    own = {match.group(match.lastindex) for _, _, match in sources.find(_DEFINED)}
    pattern = _pattern(own)
    changes = []
    for name in sources.files:
        if not _ANY.search(sources.code(name)):
            continue
        for number, code in enumerate(sources.code(name).split("\n"), 1):
            before = sources.line(name, number)
            after = _as_cpp(pattern, before, code)
            if after != before:
                sources.replace(name, number, after)
                changes.append(Change(name, number, before, after, "names that only Visual Studio has"))
    return changes


def _pattern(own):
    words = "|".join(word for word in _WORDS if word not in own) or r"(?!)"  # (?!) matches nothing
    texts = r"(?!)()" if own & {"_T", "_TEXT"} else _TEXT
    leaks = r"(?!)" if any(name.startswith("_Crt") for name in own) else _LEAKS
    return re.compile(rf"\b(?P<word>{words})\b|(?P<leaks>{leaks})|{texts}")


def _as_cpp(pattern, line, code):
    def one(match):
        if code[match.start()] == " ":  # in a comment or string
            return match.group()
        if match.group("word"):
            return _WORDS[match.group("word")]
        return "" if match.group("leaks") else match.group(3)

    after = pattern.sub(one, line)
    return re.sub(r"\bwchar_t\b", "char", after) if re.search(r"\bwmain\s*\(", code) else after
