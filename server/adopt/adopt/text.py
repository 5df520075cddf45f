"""Sources as lists of lines that can be changed. No change adds or removes a line, so the author's line numbers stay valid."""
import os
import re

# Comments, strings and characters. Each alternative also matches if it is not closed, so matching takes linear time.
_NOT_CODE = re.compile(r'//[^\n]*|/\*.*?(?:\*/|\Z)|"(?:\\.|[^"\\\n])*"?|\'(?:\\.|[^\'\\\n])*\'?', re.S)


_DIRECTIVE = re.compile(r"^[ \t]*#[ \t]*(if|ifdef|ifndef|elif|else|endif)\b(.*)$", re.M)
_NEVER = re.compile(r"[ \t(]*(?:0|false)[ \t\r)]*$")


def code_only(text):
    """Returns the text with comments, strings and code after #if 0 replaced by blanks. Keeps lines and columns."""
    return _without_dead(_NOT_CODE.sub(lambda match: _blank(match.group()), text))


def _blank(text):
    return re.sub(r"[^\n]", " ", text)


def _without_dead(code):
    parts, begin = [], 0  # begin: start of the text that is not yet in parts
    open_ifs, dead = 0, None  # dead: (number of open #if, offset) at the start of a dead part
    for found in _DIRECTIVE.finditer(code):
        word = found.group(1)
        if dead and word in ("else", "elif", "endif") and open_ifs == dead[0]:
            parts += [code[begin:dead[1]], _blank(code[dead[1]:found.start()])]
            begin, dead = found.start(), None
        if word in ("if", "elif") and not dead and _NEVER.match(found.group(2)):
            dead = open_ifs + (word == "if"), found.end()
        open_ifs += {"if": 1, "ifdef": 1, "ifndef": 1, "endif": -1}.get(word, 0)
    if dead:
        parts += [code[begin:dead[1]], _blank(code[dead[1]:])]
        begin = len(code)
    return "".join(parts) + code[begin:]


def named(patterns, text):
    """Returns the group "name" of the first of these patterns that the text has, or None."""
    return next((match.group("name") for pattern in patterns if (match := pattern.search(text))), None)


def shown(text, most=160):
    """Makes untrusted text safe to print on a terminal: one line, no control characters, at most `most` characters."""
    text = "".join(character if character.isprintable() else f"\\x{ord(character) & 0xff:02x}" for character in text)
    return text if len(text) <= most else text[:most - 1] + "…"


def decoded(data):
    """Returns the text of a source without byte order mark, and its encoding, which with Visual Studio may be UTF-16."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16", "replace"), "UTF-16"
    if data.startswith(b"\xef\xbb\xbf"):
        return data[3:].decode("utf-8", "surrogateescape"), "UTF-8 with a mark"
    return data.decode("utf-8", "surrogateescape"), "UTF-8"


class Sources:
    """The code files of the copy, read once. Call flush() to write changes before another program reads the files."""

    def __init__(self, root, files):
        self.root, self.files, self.recoded = root, sorted(files), []
        self._code = {}  # cached code_only() texts by file; changing a file removes its entry
        self._changed = set()
        self._lines = {name: self._read(name) for name in self.files}

    def _read(self, name):
        with open(os.path.join(self.root, name), "rb") as file:
            text, encoding = decoded(file.read())
        lines = text.split("\n")
        if encoding == "UTF-16":
            self.recoded.append(name)
        if encoding != "UTF-8":
            self._write(name, lines)  # so that the compiler's column numbers refer to the text as it was read here
        return lines

    def _write(self, name, lines):
        path = os.path.join(self.root, name)
        if os.path.islink(path):
            os.unlink(path)  # replaces the link by a file
        with open(path, "wb") as file:
            file.write("\n".join(lines).encode("utf-8", "surrogateescape"))

    def text(self, name):
        return "\n".join(self._lines[name])

    def code(self, name):
        if name not in self._code:
            self._code[name] = code_only(self.text(name))
        return self._code[name]

    def line(self, name, number):
        lines = self._lines.get(name, ())
        return lines[number - 1].rstrip("\r") if 0 < number <= len(lines) else ""

    def replace(self, name, number, line):
        end = "\r" if self._lines[name][number - 1].endswith("\r") else ""
        self._lines[name][number - 1] = line + end
        self._code.pop(name, None)
        self._changed.add(name)

    def flush(self):
        """Writes the files that have changed."""
        for name in self._changed:
            self._write(name, self._lines[name])
        self._changed = set()

    def find(self, pattern, names=None):
        """Yields (file, line number, match) of a regular expression in code, without comments and strings."""
        for name in names if names is not None else self.files:
            for number, line in enumerate(self.code(name).split("\n"), 1):
                for match in re.finditer(pattern, line):
                    yield name, number, match
