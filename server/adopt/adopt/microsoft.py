"""Replaces names of Visual Studio's templates and library, like _tmain and _TCHAR, with standard ones."""
import re

from .text import code_only
from .treatments import Change

_WORDS = {"_tmain": "main", "wmain": "main", "_TCHAR": "char", "TCHAR": "char", "__int8": "char", "__int16": "short", "__int32": "int",
          "__int64": "long long", "_int64": "long long", "__forceinline": "inline", "__cdecl": "", "__stdcall": "", "__fastcall": "",
          "__FUNCSIG__": "__PRETTY_FUNCTION__", "__debugbreak": "abort", "kbhit": "_kbhit", "getch": "_getch",
          "_stricmp": "strcasecmp", "stricmp": "strcasecmp", "_strnicmp": "strncasecmp", "_strdup": "strdup", "_snprintf": "snprintf",
          "_vsnprintf": "vsnprintf", "printf_s": "printf", "fprintf_s": "fprintf", "strtok_s": "strtok_r"}
# Constructs that only Visual Studio accepts, and what replaces them.
_RULES = [(re.compile(pattern), after) for pattern, after in (
    (r'\b_T(?:EXT)?\s{0,20}\(\s{0,20}("(?:\\.|[^"\\])*")\s{0,20}\)', r"\1"),
    (r"\b_Crt\w+\s{0,20}\([^();]{0,300}\)(?=\s{0,20};)", ""),  # calls that make it report memory leaks
    (r"\bfor\s+each\s*\(([^;()]{1,200}?)\s+in\b", r"for (\1 :"),
    (r"\b__declspec\s*\((?:[^()]|\([^()]{0,100}\)){0,100}\)", ""),
    (r"\bstd\s*::\s*exception\s*\((?!\s*\))", "std::runtime_error("),
    (r"(\)\s*(?:const\s*)?)=\s*NULL(?=\s*;)", r"\1= 0"),  # a pure virtual function
    (r"(\bclass\s+\w+\s+|\)\s*(?:const\s+)?(?:override\s+)?)sealed\b", r"\1final"),
    (r"\b(f|s)?scanf_s(?=\s*\((?![^;]*%\d*[sc\[]))", r"\1scanf"),
    (r"\b(?:int|INT)\s+(?:WINAPI|APIENTRY|CALLBACK)\s+w?WinMain\s*\([^()]{0,300}\)", "int main()"))]
_HINT = re.compile(r"\b_|_s\b|\bfor\s+each|NULL|exception|sealed|Main|cmp|main|TCHAR|getch|kbhit")  # each of them has one of these
_DEFINED = r"#\s*define\s+(\w+)|\btypedef\s[^;]{0,200}\b(\w+)\s*;|\b(?:int|char)[ \t*]{1,20}(_?str\w+|_snprintf|getch|kbhit)\s*\("


def treat(sources):
    """Replaces the names and constructs, except names that the game defines itself. Returns the changes."""
    own = {match.group(match.lastindex) for _, _, match in sources.find(_DEFINED)}
    words = "|".join(word for word in _WORDS if word not in own) or r"(?!)"  # (?!) matches nothing
    rules = [(re.compile(rf"\b(?:{words})\b"), lambda match: _WORDS[match.group()])]
    theirs = ["_T(?:EXT)"] * bool(own & {"_T", "_TEXT"}) + ["_Crt"] * any(name.startswith("_Crt") for name in own)
    rules += [rule for rule in _RULES if not any(part in rule[0].pattern for part in theirs)]
    changes = []
    for name in sources.files:
        for number, code in enumerate(sources.code(name).split("\n"), 1):
            after = before = sources.line(name, number)
            for pattern, replacement in rules if code.strip() and _HINT.search(after) else ():
                after = _replaced(pattern, replacement, after)
            if re.search(r"\bwmain\s*\(", code):
                after = re.sub(r"\bwchar_t\b", "char", after)
            if after != before:
                sources.replace(name, number, after)
                changes.append(Change(name, number, before, after, "names and constructs that only Visual Studio has"))
    return changes


def _replaced(pattern, replacement, line):
    """Replaces a pattern in a line, except where it begins in a comment or a string."""
    code = code_only(line) if pattern.search(line) else line
    return pattern.sub(lambda match: match.group() if code[match.start()] == " " else
                       replacement(match) if callable(replacement) else match.expand(replacement), line)
