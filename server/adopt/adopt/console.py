"""What Visual Studio's template of a console program writes, as C++ has it: int _tmain(int argc, _TCHAR *argv[])."""
import functools
import re

from .treatments import Change

_WORDS = {"_tmain": "main", "wmain": "main", "_TCHAR": "char", "TCHAR": "char"}
_TEXT = r'_T(?:EXT)?\s{0,20}\(\s{0,20}("(?:\\.|[^"\\])*")\s{0,20}\)'
_DEFINED = r"#\s*define\s+(\w+)|\btypedef\s[^;]{0,200}\b(\w+)\s*;"


def treat(sources):
    """Returns what was changed. Names that the game defines itself are its own."""
    own = {match.group(1) or match.group(2) for _, _, match in sources.find(_DEFINED)}
    words = [word for word in _WORDS if word not in own]
    if not words:
        return []
    texts = [] if own & {"_T", "_TEXT"} else ["_T", "_TEXT"]
    pattern = re.compile("|".join([rf"\b(?P<word>{'|'.join(words)})\b"] + [r"\b" + _TEXT] * bool(texts)))
    lines = functools.lru_cache(1)(lambda name: sources.code(name).split("\n"))  # as they were
    changes = []
    for name, number in dict.fromkeys((name, number) for name, number, _ in sources.find(rf"\b(?:{'|'.join(words + texts)})\b")):
        before, code = sources.line(name, number), lines(name)[number - 1]

        def as_cpp(match, code=code):
            if code[match.start()] == " ":  # in a comment or a text
                return match.group()
            return _WORDS[match.group("word")] if match.group("word") else match.group(2)

        after = pattern.sub(as_cpp, before)
        if re.search(r"\bwmain\s*\(", before):
            after = re.sub(r"\bwchar_t\b", "char", after)
        if after != before:
            sources.replace(name, number, after)
            changes.append(Change(name, number, before, after, "Visual Studio's names for main(), char and texts"))
    return changes
