"""Parses the report of an address sanitizer."""
import re

_WHAT = re.compile(r"ERROR: AddressSanitizer: ([\w-]+)(.*)")
_FRAME = re.compile(r"^\s*#\d+ 0x[0-9a-f]+ in .*? (\S.*?):(\d+)(?::\d+)?\s*$")
_WORDS = {"SEGV": "a bad pointer", "heap-use-after-free": "use of a deleted object", "heap-buffer-overflow": "access beyond the end of an array",
          "stack-buffer-overflow": "access beyond the end of an array", "global-buffer-overflow": "access beyond the end of an array",
          "stack-overflow": "infinite recursion", "FPE": "a division by zero", "ABRT": "abort()",
          "attempting": "deleted twice, or not made with new"}
MAX_LINE = 1000  # maximum characters of a line, because a game's output is untrusted


def frame_of(printed, files):
    """Returns ("file:line", error) of the innermost function of the game in a sanitizer's report, or None."""
    what = _WHAT.search(printed)
    if not what:
        return None
    known = set(files)
    for line in printed[what.end():].splitlines():
        match = _FRAME.match(line[:MAX_LINE])
        if not match:
            continue
        path = match.group(1)
        name = next((one for one in known if path == one or path.endswith("/" + one)), None)
        if name:
            return f"{name}:{match.group(2)}", _WORDS.get(what.group(1), what.group(1).replace("-", " "))
    return None
