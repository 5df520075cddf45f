"""Reads the code blocks of a page, and applies them to files as the sentences before them say.

The sentence before a block tells the reader, and the test, what to do with it:

  The new file `X`:                      (or: The file `X`:)  the block is that file
  In `X`, below `LINE`, add:             the block goes below the only such line of X
  In `X`, instead of `LINE`, write:      the block replaces that line
  In `X`, take out `LINE`.               no block: the line is removed
"""
import os
import re

FENCE = re.compile(r"^```(\S*)(.*)$")
FILE = re.compile(r"(?:[Nn]ew file|[Tt]he file|made one,) `([^`]+)`:$")
EDIT = re.compile(r"In `([^`]+)`, (below|instead of) `([^`]+)`, (?:add|write):$")
OUT = re.compile(r"In `([^`]+)`, take out `([^`]+)`\.")
COMMENT = re.compile(r"^<!-- (.*) -->$")


class PageError(Exception):
    """An error in a page. Its text contains the place."""


class Block:
    """A fenced block. `before`: the paragraph before it, in one line; `comments`: HTML comments since the last block; `section`:
    the heading above it; `begin`, `end`: its lines of text, counted from 0, without the line `end`."""

    def __init__(self, page, language, begin, before, comments, section):
        self.page, self.language, self.begin, self.end = page, language, begin, begin
        self.before, self.comments, self.section, self.lines = before, comments, section, []

    @property
    def text(self):
        return "".join(line + "\n" for line in self.lines)

    @property
    def place(self):
        return f"{self.page}:{self.begin}"


def blocks(path, name=None):
    """Returns all fenced blocks of a page, and between them (file, line, place) for each sentence that removes a line."""
    with open(path, encoding="utf-8") as file:
        lines = file.read().split("\n")
    found, current, paragraph, comments, section = [], None, [], [], ""
    name = name or path
    for number, line in enumerate(lines):
        match = FENCE.match(line.strip()) if line.lstrip().startswith("```") else None
        if current is not None:
            if match:
                current.end = number
                found.append(current)
                current, paragraph, comments = None, [], []
            else:
                current.lines.append(line)
        elif match:
            found += [(one.group(1), one.group(2), f"{name}:{number}") for one in OUT.finditer(" ".join(paragraph))]
            current = Block(name, match.group(1), number + 1, " ".join(paragraph), comments, section)
        elif line.startswith("#"):
            section, paragraph, comments = line.lstrip("# "), [], []
        elif COMMENT.match(line.strip()):
            comments.append(COMMENT.match(line.strip()).group(1))
        elif line.strip():
            paragraph.append(line.strip())
        elif paragraph:
            found += [(one.group(1), one.group(2), f"{name}:{number}") for one in OUT.finditer(" ".join(paragraph))]
            last, paragraph = paragraph, []
            if lines[number + 1:number + 2] and lines[number + 1].startswith(("```", "<!--")):
                paragraph = last
    if current is not None:
        raise PageError(f"{name}:{current.begin}: the block has no end")
    return found


def _index(lines, wanted, where, file):
    hits = [i for i, line in enumerate(lines) if line.strip() == wanted.strip()]
    if len(hits) != 1:
        raise PageError(f"{where}: {file} has {len(hits)} lines that read: {wanted}")
    return hits[0]


def apply(block, folder):
    """Applies a block to the files of the folder as the page says. Returns false if the page does not say what the block is."""
    if isinstance(block, tuple):
        file, line, where = block
        _change(folder, file, where, lambda lines: lines.pop(_index(lines, line, where, file)))
        return True
    match = FILE.search(block.before)
    if match:
        path = os.path.join(folder, match.group(1))
        if os.path.exists(path):
            with open(path, encoding="utf-8") as file:
                if file.read() != block.text:
                    raise PageError(f"{block.place}: {match.group(1)} is there already, and reads otherwise")
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(block.text)
        return True
    match = EDIT.search(block.before)
    if match:
        file, how, line = match.groups()

        def edit(lines):
            at = _index(lines, line, block.place, file)
            lines[at + (how == "below"):at + 1] = block.lines
        _change(folder, file, block.place, edit)
        return True
    return False


def _change(folder, file, where, change):
    path = os.path.join(folder, file)
    if not os.path.isfile(path):
        raise PageError(f"{where}: there is no file {file}")
    with open(path, encoding="utf-8") as text:
        lines = text.read().split("\n")
    change(lines)
    with open(path, "w", encoding="utf-8") as text:
        text.write("\n".join(lines))


def unmet(outcome, picture):
    """Returns the parts of an outcome that the picture lacks. `N REGEX; N REGEX`: each must be found at least N times."""
    missing = []
    for one in outcome.split("; "):
        number, pattern = one.split(" ", 1)
        if len(re.findall(pattern, picture)) < int(number):
            missing.append(f"{number} of {pattern}")
    return missing
