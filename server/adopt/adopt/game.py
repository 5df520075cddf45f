"""The game in the folder: its copy, its sources, and the program that is built from the sources."""
import os
import shutil

from . import blame as faults
from .engine import EngineCopies, stem
from .folder import copy_folder, drop_broken_links, is_code, is_source
from .includes import included_sources
from .programs import programs
from .project import read_lists
from .report import MAX_ROWS
from .text import Sources

ARCHIVES = (".zip", ".rar", ".7z", ".tar", ".gz", ".tgz")
PROGRAM = "naiad-game"  # file name of the built program


class Game:
    """A game's folder. The copy is in `tree`, except the files of an engine, which are in `engine_tree`."""

    def __init__(self, folder, scratch, naiad, report, limits):
        self.folder, self.scratch, self.naiad, self.report, self._limits = folder, scratch, naiad, report, limits
        self.tree, self.engine_tree = os.path.join(scratch, "copy"), os.path.join(scratch, "engine")
        self.files, self.sources, self.all_sources, self.engine, self.program, self._archives = [], None, [], None, None, []

    @property
    def program_path(self):
        return os.path.join(self.tree, PROGRAM)

    def copy_in(self):
        """Copies the folder and moves the files of an engine to `engine_tree`."""
        copy = copy_folder(self.folder, self.tree, self._limits)
        self._archives = [name for name, _ in copy.left_out if name.lower().endswith(ARCHIVES)]
        self.engine = EngineCopies(self.tree, [name for name in copy.files if is_code(name)], self.naiad.published)
        for name in self.engine.files:
            os.makedirs(os.path.join(self.engine_tree, os.path.dirname(name)), exist_ok=True)
            shutil.move(copy.path(name), os.path.join(self.engine_tree, name))
        gone = set(self.engine.files)
        copy.files = [name for name in copy.files if name not in gone]
        drop_broken_links(copy)  # those to the files that were just moved
        self.files = copy.files
        self._report_left_out(copy.left_out)
        for folder, count in sorted(self.engine.folders().items())[:MAX_ROWS]:
            what = "the author's own engine" if self.engine.own else "a copy of the engine"
            self.report.add("left out", folder, f"{count} file{'s' * (count > 1)} of {what}: Naiad's are used instead")
        self.sources = Sources(self.tree, [name for name in self.files if is_code(name)])
        for name in self.sources.recoded:
            self.report.add("treated", name, "converted from UTF-16 to UTF-8")

    def _report_left_out(self, left_out):
        """Reports files that were not copied: those made by builds or the system in one row, every other file in its own row."""
        usual, rest = [], []
        for one in left_out:
            (usual if one[1].startswith(("a file made by", "a folder of the system")) else rest).append(one)
        for path, reason in rest[:MAX_ROWS]:
            self.report.add("left out", path, reason)
        if len(rest) > MAX_ROWS:
            self.report.add("left out", "", f"and {len(rest) - MAX_ROWS} more files or folders")
        if usual:
            self.report.add("left out", "", f"{len(usual)} product{'s' * (len(usual) > 1)} of builds, editors or the system, such as {usual[0][0]}")

    def choose_program(self, main):
        """Chooses the program: that of the file `main` if it is given, else the most likely one. Returns False if none is found."""
        self.all_sources = [name for name in self.sources.files if is_source(name)]
        if not self.all_sources:
            unpack = f": unpack {self._archives[0]} first" if self._archives else ""
            self.report.fail("not a game", "the folder has no C++ source" + " except an engine's" * self.engine.own + unpack)
            return False
        lists = read_lists(self.tree, self.files, self.all_sources)
        found = programs(self.all_sources, lists, self.sources.code, included_sources(self.sources))
        if main:
            wanted = (os.path.normpath(main), os.path.relpath(main, self.folder))
            found = [one for one in found if one.main in wanted]
        if not found:
            self.report.add_left("", faults.THEIRS, f"no main() in {main or 'the sources of the folder'}",
                                 "add the file with int main()")
            self.report.fail("does not build", "no main()")
            return False
        self.program = found[0]
        self._report_program(found)
        return True

    def _report_program(self, found):
        program = self.program
        origin = f"listed in {program.source_list.file}" if program.source_list else "found in the folder"
        count = len(program.sources) - 1
        self.report.add("program", program.main, f"and {count} more source{'s' * (count != 1)}, {origin}" if count
                        else f"the only source, {origin}")
        for other in found[1:MAX_ROWS]:
            self.report.add("program", other.main, "another program, not built: use --main to choose it")
        if program.source_list:
            self._report_list(program.source_list)
        for name, reason in program.left_out[:MAX_ROWS]:
            self.report.add("left out", name, reason)

    def _report_list(self, source_list):
        if source_list.definitions:
            self.report.add("note", source_list.file, "compiled with " + " ".join(source_list.definitions) + ", as in this file")
        for call in source_list.unread[:3]:
            self.report.add("note", source_list.file, f"not run: {call}")
        known = {stem(name) for name in self.engine.files + self.files}
        for word in source_list.missing[:MAX_ROWS]:
            if stem(word.replace("\\", "/")) not in known:
                self.report.add("note", source_list.file, f"lists {word}, which does not exist")
