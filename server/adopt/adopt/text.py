"""Sources as lines that can be changed in place: no treatment adds or removes a line, so that numbers stay the student's."""
import os
import re

# Comments, strings and characters. Each alternative matches to the end of what it begins, closed or not: linear time.
_NOT_CODE = re.compile(r'//[^\n]*|/\*.*?(?:\*/|\Z)|"(?:\\.|[^"\\\n])*"?|\'(?:\\.|[^\'\\\n])*\'?', re.S)


_DIRECTIVE = re.compile(r"^[ \t]*#[ \t]*(if|ifdef|ifndef|elif|else|endif)\b(.*)$", re.M)
_NEVER = re.compile(r"[ \t(]*(?:0|false)[ \t\r)]*$")


def code_only(text):
    """The text with comments, strings and what stands behind #if 0 blanked out; lines and columns stay."""
    return _without_dead(_NOT_CODE.sub(lambda match: _blank(match.group()), text))


def _blank(text):
    return re.sub(r"[^\n]", " ", text)


def _without_dead(code):
    parts, begin = [], 0  # begin: of what is not yet in parts
    open_ifs, dead = 0, None  # dead: how many #if were open where the dead part began, and its begin
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


def shown(text, most=160):
    """A foreign text as it may be printed on a terminal: on one line, without control characters, not too long."""
    text = "".join(character if character.isprintable() else f"\\x{ord(character) & 0xff:02x}" for character in text)
    return text if len(text) <= most else text[:most - 1] + "…"


def decoded(data):
    """The text of a source, without a byte order mark, and the encoding that it had: Visual Studio saves UTF-16, too."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16", "replace"), "UTF-16"
    if data.startswith(b"\xef\xbb\xbf"):
        return data[3:].decode("utf-8", "surrogateescape"), "UTF-8 with a mark"
    return data.decode("utf-8", "surrogateescape"), "UTF-8"


class Sources:
    """The code files of the copy, read once. What is changed is written back by flush(), before another program reads it."""

    def __init__(self, root, files):
        self.root, self.files, self.recoded = root, sorted(files), []
        self._code = {}  # of files that have not been changed since
        self._changed = set()
        self._lines = {name: self._read(name) for name in self.files}

    def _read(self, name):
        with open(os.path.join(self.root, name), "rb") as file:
            text, encoding = decoded(file.read())
        lines = text.split("\n")
        if encoding == "UTF-16":
            self.recoded.append(name)
        if encoding != "UTF-8":
            self._write(name, lines)  # so that the compiler counts the same columns
        return lines

    def _write(self, name, lines):
        path = os.path.join(self.root, name)
        if os.path.islink(path):
            os.unlink(path)  # a file of its own from now on
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
        """Writes what was changed: once for all lines of a file."""
        for name in self._changed:
            self._write(name, self._lines[name])
        self._changed = set()

    def find(self, pattern, names=None):
        """Yields (file, line number, match) for a regular expression in code lines, comments and strings left out."""
        for name in names if names is not None else self.files:
            for number, line in enumerate(self.code(name).split("\n"), 1):
                for match in re.finditer(pattern, line):
                    yield name, number, match
