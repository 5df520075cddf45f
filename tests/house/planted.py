"""Plants bugs: changes one place in a copy of a source, and compiles with a build's commands what contains it.

Shared by the checks named planted-bugs, which expect that a test finds each bug.
"""
import os
import re
import shlex
import shutil
import subprocess

from commands import compile_commands

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
LAUNCHER = ["ccache"] if shutil.which("ccache") else []  # unchanged files are not compiled again in every check


class Trouble(Exception):
    """A failure of anything but the test."""


def run(command, **options):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)


def checked(command, **options):
    result = run(command, **options)
    if result.returncode != 0:
        raise Trouble(f"{shlex.join(command)}\n{result.stdout}")
    return result.stdout


class Build:
    """The object files of a build directory and their compile commands."""

    def __init__(self, directory):
        self.directory = os.path.abspath(directory)
        self.commands = {}
        for source, entry in compile_commands(self.directory):
            self.commands.setdefault(os.path.relpath(source, ROOT), entry)

    def output(self, entry):
        words = shlex.split(entry["command"])
        return os.path.join(entry["directory"], words[words.index("-o") + 1])

    def objects(self, folder):
        """Returns {source: object file} for `folder` and its subfolders."""
        found = {source: self.output(entry) for source, entry in self.commands.items()
                 if source.startswith(folder + "/")}
        missing = [path for path in found.values() if not os.path.exists(path)]
        if missing or not found:
            raise Trouble(f"not built: {folder} {' '.join(missing[:1])}")
        return found

    def plant(self, changed, old, new, sources, directory):
        """Replaces `old` in a copy of `changed`, a path below server/, and compiles all that contains `sources` with the copy.
        Returns {old object file: new object file}. All new files are in `directory`."""
        place, copy = os.path.join(ROOT, "server", changed), os.path.join(directory, changed)
        os.makedirs(os.path.dirname(copy))
        with open(copy, "w", encoding="utf-8") as file:
            file.write(planted("server/" + changed, old, new))
        made = {}
        for entry in {self.output(self.commands[source]): self.commands[source] for source in sources}.values():
            words = shlex.split(entry["command"])
            file = os.path.normpath(os.path.join(entry["directory"], entry["file"]))
            changed_file = copy
            if file != place:  # a unity source, or one that includes the changed header
                changed_file = os.path.join(directory, f"{len(made)}.cpp")
                with open(file, encoding="utf-8") as source, open(changed_file, "w", encoding="utf-8") as out:
                    text = source.read() if os.path.basename(os.path.dirname(file)) == "Unity" else f'#include "{file}"\n'
                    out.write(text.replace(f'"{place}"', f'"{copy}"'))
            words = [changed_file if os.path.normpath(os.path.join(entry["directory"], word)) == file else word for word in words]
            result = os.path.join(directory, f"{len(made)}.o")
            words[words.index("-o") + 1] = result
            # Sources include headers by folder and name, so the changed header is found first.
            checked([*LAUNCHER, *words, "-w", "-iquote", directory], cwd=entry["directory"])
            made[self.output(entry)] = result
        return made


def planted(source, old, new):
    """Returns the text of `source` with `new` in place of `old`, which must occur once, ignoring white space."""
    with open(os.path.join(ROOT, source), encoding="utf-8") as file:
        text = file.read()
    found = list(re.finditer(r"\s+".join(re.escape(word) for word in old.split()), text))
    if len(found) != 1:
        raise Trouble(f"found {len(found)} times in {source}, not once: {old!r}")
    return text[:found[0].start()] + new + text[found[0].end():]
