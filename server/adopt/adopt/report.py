"""The final report: a text table or JSON."""
import json

from .text import shown

MAX_ROWS = 12  # maximum rows of one kind
_INDENT = 12  # columns of the table before its text


class Row:
    """A row of the table.

    what: "program", "left out", "treated", "built", "ran", "left" (an error), "note" or "kept"; where: file:line, or empty; text:
    action or error; whose: whose fault an error is; line: the source line; change: the changed line, or what to do.
    """

    def __init__(self, what, where, text, whose, line, change):
        self.what, self.where, self.text, self.whose, self.line, self.change = what, where, text, whose, line.strip(), change


class Report:
    """The rows and the result of a run: "runs", "builds" (but does not run, or cannot be run here), "builds; not run" (--seconds 0),
    "does not build", "not a game"."""

    def __init__(self, folder):
        self.folder, self.rows, self.result, self.reason = folder, [], "not a game", ""

    def add(self, what, where="", text="", whose="", line="", change=""):
        self.rows.append(Row(what, where, text, whose, line, change))

    def add_left(self, where, whose, text, change, line=""):
        """Adds a row for an error that remains: whose fault it is, and what to do."""
        self.add("left", where, text, whose, line, change)

    def fail(self, result, reason):
        self.result, self.reason = result, reason

    def has_left(self, where):
        return any(row.what == "left" and row.where == where for row in self.rows)

    def write(self, out):
        out.write(f"dragonfly-adopt {shown(self.folder)}\n\n")
        last = ""
        for row in self.rows:
            label = row.what if row.what != last else ""
            last = row.what
            whose = f" [fault: {row.whose}]" if row.whose else ""
            where = shown(row.where) + whose + (": " if row.text and (row.where or whose) else "")
            _wrapped(out, where + shown(row.text, 400), f"  {label}")
            if row.line:
                out.write(" " * _INDENT + "| " + shown(row.line) + "\n")
            if row.change:
                mark = "> " if row.what == "treated" else "-> "
                _wrapped(out, mark + shown(row.change, 400))
        out.write(f"\nresult: {self.result}" + (f" ({shown(self.reason, 400)})" if self.reason else "") + "\n")

    def write_json(self, out):
        names = ("what", "where", "whose", "text", "line", "change")
        rows = [{name: shown(getattr(row, name), 400) for name in names} for row in self.rows]
        answer = {"folder": shown(self.folder), "result": self.result, "reason": shown(self.reason, 400), "rows": rows}
        json.dump(answer, out, indent=1)
        out.write("\n")


def _wrapped(out, text, label=""):
    """Writes text in lines of at most 100 columns with the table's indentation."""
    line = label.ljust(_INDENT)
    for word in text.split():
        if len(line) + len(word) > 100 and line.strip():
            out.write(line.rstrip() + "\n")
            line = " " * _INDENT + "  "
        line += word + " "
    out.write(line.rstrip() + "\n")
