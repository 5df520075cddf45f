"""Finds the comments and string literals of a file, for words and draw.

Both are Texts. A comment block is one line of a Text, so a phrase is also found across a line break of the source. Adjacent string
literals and a paragraph of a page are one line, too.
"""
import bisect
import contextlib
import io
import os
import re
import subprocess
import tempfile

PRODUCT = ("server", "client", "shared", "proto", "deploy")
SLASHES = (".h", ".cpp", ".js", ".mjs", ".proto")  # languages with // comments
SCRIPTS = ("", ".py", ".sh", ".in", ".cmake", ".yml", ".yaml", ".html", ".json", ".conf", ".service", ".socket", ".env", ".bash",
           ".zsh", ".fish", ".desktop")
LEFT_OUT = ("docs/physics/report/", "deploy/debian/copyright")
TOKENS = {kind: re.compile(pattern, re.S) for kind, pattern in {
    "C++": r"""//[^\n]*|/\*.*?\*/|R"([^(\s"]*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|'(?:\\.[^'\n]{0,8}|[^'\\\n])'""",
    "JavaScript": r"""//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'|`(?:\\.|[^`\\])*`""",
    "Python": r"""\#[^\n]*|"{3}.*?"{3}|'{3}.*?'{3}|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'"""}.items()}
TEST = re.compile(r"^(?:TYPED_)?TEST(?:_[FP])?\(\s*(\w+),\s*(\w+)\)", re.M)


class Text:
    """Pieces of a file, joined by the separators ("glue") before them, with the line of the file that each piece comes from."""

    def __init__(self):
        self.text, self.starts, self.lines, self.begins = io.StringIO(), [], [], []

    def add(self, line, glue, piece):
        self.text.write(glue)
        self.starts.append(self.text.tell())
        self.lines.append(line)
        self.begins.append(glue == "\n")
        self.text.write(piece)

    def hits(self, pattern):
        for match in pattern.finditer(self.text.getvalue()):
            yield self.lines[bisect.bisect_right(self.starts, match.start()) - 1]

    def blocks(self):
        """Yields (first line, last line, text) for each block."""
        first = [at for at, begins in enumerate(self.begins) if begins]
        for at, behind, words in zip(first, [*first[1:], len(self.lines)], self.text.getvalue().split("\n")[1:]):
            yield self.lines[at], self.lines[behind - 1], words


def split(text, kind):
    """Returns the comment blocks and the string literals of a source."""
    comments, strings = Text(), Text()
    line, last, end, place = 1, 0, 0, None
    for match in TOKENS[kind].finditer(text):
        found, start = match.group(), match.start()
        line, last = line + text.count("\n", last, start), start
        before = text[text.rfind("\n", 0, start) + 1:start]
        if found[0] in "/#":
            for number, part in enumerate(found.splitlines(), line):
                words = re.sub(r"^(?://[/!]?<?|/\*+|\*|#+)\s*|\*/$", "", part.strip())
                same_block = place == (number - 1, len(before)) and not before.strip()
                marker = part[:4] if part.startswith("///<") else "//"
                comments.add(number, " " if same_block else "\n", words if same_block else f"{marker} {words}")
                place = (number, len(before))
        elif (found[0] != "'" or kind != "C++") and not before.startswith("#include"):
            glue = "" if end and text[end:start].isspace() else "\n"
            for number, part in enumerate(found.split("\n"), line):
                words = re.sub(r"""^["'`]{1,3}|(?<!\\)["'`]{1,3}$""", "", part).replace("\\n", "  ")
                strings.add(number, glue if number == line else " ", words)
            end = match.end()
    return comments, strings


def by_lines(text, comment_start):
    """Returns the # comments of a script, and its other lines joined by paragraph."""
    comments, others, in_comment = Text(), Text(), False
    for number, line in enumerate(text.splitlines(), 1):
        line = line.strip()
        was_comment, in_comment = in_comment, comment_start and re.match(comment_start, line)
        if in_comment:
            comments.add(number, " " if was_comment else "\n", "// " * (not was_comment) + line.lstrip("# "))
        else:
            others.add(number, " " if line[:1].isalnum() else "\n", line)
    return comments, others


def comments_and_others(path, text):
    """Returns the comments of a file, and its string literals. For a script not in Python, all other lines instead of literals."""
    suffix = os.path.splitext(path)[1]
    if suffix in SLASHES:
        return split(text, "JavaScript" if "js" in suffix else "C++")
    return split(text, "Python") if suffix == ".py" or re.match("#!.*python", text) else by_lines(text, r"#(?:\s|$)")


def files(root):
    """Yields (path, text) for each file of the product, the tests and the pages."""
    paths = [name for name in os.listdir(root) if name.endswith(".md")]
    for top in (*PRODUCT, "tests", "docs"):
        for folder, _, names in os.walk(f"{root}/{top}"):
            paths += [os.path.relpath(f"{folder}/{name}", root) for name in names]
    for path in sorted(paths):
        suffix = os.path.splitext(path)[1]
        if not path.startswith(LEFT_OUT) and (suffix in (".md", *SLASHES, *SCRIPTS) or path.endswith("CMakeLists.txt")):
            with open(f"{root}/{path}", encoding="utf-8", errors="replace") as file:
                yield path, file.read()


@contextlib.contextmanager
def tree(root, commit=None):
    """Yields the folder of the sources: `root`, or a temporary folder with `commit`. Exits with 2 if the commit does not exist."""
    if not commit:
        yield root
        return
    with tempfile.TemporaryDirectory() as folder:
        archive = subprocess.run(["git", "-C", root, "archive", commit], stdout=subprocess.PIPE)
        if archive.returncode:
            raise SystemExit(2)
        subprocess.run(["tar", "x", "-C", folder], input=archive.stdout, check=True)
        yield folder
