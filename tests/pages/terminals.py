"""Terminals of tmux, in which the tests of pages press keys and read the screen, and conversion of their rows to SVG."""
import html
import os
import re
import subprocess
import time

COLUMNS, ROWS = 80, 24  # plus a status line below
CELL_WIDTH, CELL_HEIGHT = 8, 16
COLORS = ("#777", "#f66", "#6d6", "#ee5", "#79f", "#d7d", "#5dd", "#ddd")


class Failed(Exception):
    """Raised when no picture can be made. Its text is the reason."""


def write(path, text, mode=0o600):
    with open(path, "w", encoding="utf-8", opener=lambda name, flags: os.open(name, flags, mode)) as file:
        file.write(text)


def wait_for(what, condition, seconds=30):
    late = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > late:
            raise Failed(f"{what} did not come")
        time.sleep(0.05)


class Terminals:
    """A tmux server, controlled through one client that stays connected."""

    def __init__(self, folder):
        self.command = ["tmux", "-S", f"{folder}/tmux", "-f", "/dev/null", "-u"]
        environment = {**os.environ, "LC_ALL": "C.UTF-8", "TERM": "xterm-256color"}
        environment.pop("TMUX", None)
        first = ["new-session", "-d", "-s", "idle", "-x", str(COLUMNS), "-y", str(ROWS + 1), "cat"]
        options = ["set-option", "-g", "status", "off", ";", "set-option", "-g", "default-terminal", "tmux-256color"]
        subprocess.run([*self.command, *first, ";", *options], env=environment, check=True)
        self.client = subprocess.Popen([*self.command, "-C", "attach", "-t", "idle", "-f", "no-output,ignore-size"], env=environment,
                                       text=True, encoding="utf-8", stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self._answer()

    def _answer(self):
        """Returns the lines of tmux's next answer."""
        lines = []
        inside = False
        for line in self.client.stdout:
            if line.startswith("%begin"):
                inside = True
            elif line.startswith("%end") and inside:
                return lines
            elif line.startswith("%error"):
                raise Failed("tmux: " + "".join(lines))
            elif inside:
                lines.append(line.rstrip("\n"))
        raise Failed("tmux ended")

    def ask(self, command):
        self.client.stdin.write(command + "\n")
        self.client.stdin.flush()
        return self._answer()

    def open(self, name, script):
        self.ask(f"new-session -d -s {name} -x {COLUMNS} -y {ROWS + 1} 'sh {script}'")

    def screen(self, name):
        """Returns the terminal's rows of (character, colour)."""
        return [colored(line) for line in self.ask(f"capture-pane -p -e -t {name}:")]

    def text(self, name):
        return "\n".join(self.ask(f"capture-pane -p -t {name}:"))

    def press(self, key, names):
        """Presses a key in all these terminals at once."""
        self.client.stdin.write("".join(f"send-keys -t {name}: {key}\n" for name in names))
        self.client.stdin.flush()
        for _ in names:
            self._answer()

    def close(self):
        subprocess.run([*self.command, "kill-server"], check=False)


def colored(line):
    """Returns the cells of a line with SGR sequences as (character, colour from 0 to 15)."""
    cells, color = [], 7
    for match in re.finditer(r"\x1b\[([0-9;]*)m|\x1b[()].|(.)|\x0f|\x0e", line):
        if match.group(2) is not None:
            cells.append((match.group(2), color))
        elif match.group(1) is not None:
            color = after(match.group(1), color)
    return cells


def after(sequence, color):
    numbers = [int(one or 0) for one in sequence.split(";")]
    while numbers:
        one = numbers.pop(0)
        if one in (0, 39):
            color = 7
        elif 30 <= one <= 37:
            color = one - 30
        elif 90 <= one <= 97:
            color = one - 82
        elif one == 38 and len(numbers) >= 2 and numbers[0] == 5:
            color = numbers[1] if numbers[1] < 16 else 7
            del numbers[:2]
    return color


def row_as_svg(row, left, top):
    cells = "".join(ch for ch, _ in row).rstrip()
    begin = len(cells) - len(cells.lstrip())
    if begin == len(cells):
        return ""
    spans, at = [], begin
    while at < len(cells):
        end = at + 1
        while end < len(cells) and (row[end][1] == row[at][1] or cells[end] == " "):
            end += 1
        spans.append(f'<tspan class="c{row[at][1] & 7}">{html.escape(cells[at:end], quote=False)}</tspan>')
        at = end
    length = (len(cells) - begin) * CELL_WIDTH
    return f'<text x="{left + begin * CELL_WIDTH}" y="{top + 12}" textLength="{length}">{"".join(spans)}</text>'
