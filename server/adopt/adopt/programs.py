"""Finds the sources of each program, and the program that is the game."""
import os
import re

from .folder import is_source

_MAIN = re.compile(r"\b(?:int|void|auto|INT)\s+(?:WINAPI\s+|APIENTRY\s+|CALLBACK\s+)?(main|wmain|_tmain|WinMain|wWinMain)\s*\(")
_RUN = re.compile(r"(?:\bGM\s*\.|->|\.|::)\s*run\s*\(")
_ASIDE = re.compile(r"(^|[/ _-])(tests?|testing|unit-?tests?|old|backup|tutorial|examples?|"
                    r"saucer[-_ ]?shoot|template|unused|archive)"
                    r"([/ _.-]|$)", re.I)
# Names of second copies of a file, as Explorer, Finder and students choose them.
_COPY = re.compile(r"(.+?)(?: - copy(?: \(\d+\))?| copy(?: \d+)?| ?\(\d+\)|[-_. ](?:old|bak|backup|orig|copy))$", re.I)
MAX_PROGRAMS = 24  # maximum number of programs considered; a folder rarely has more than three


class Program:
    """A program: its `main` file, its `sources` (main first), the SourceList that names them or None, `left_out` (file, reason)."""

    def __init__(self, main, sources, source_list, left_out):
        self.main, self.sources, self.source_list, self.left_out = main, sources, source_list, left_out


def is_secondary(name):
    """Returns whether this name of a file or folder looks like that of a test, tutorial or leftover."""
    return _ASIDE.search(name) is not None


def mains(sources, code):
    """Returns the files with a main()."""
    return [name for name in sources if _MAIN.search(code(name))]


def has_run(names, code):
    """Returns whether any file calls run(), as a game must."""
    return any(_RUN.search(code(name)) for name in names)


def programs(sources, lists, code, included=None):
    """Returns the programs of a folder, the most likely game first. included: {source: the files that include it}."""
    all_mains = mains(sources, code)
    found = [_program(main, all_mains, sources, lists, included or {}) for main in all_mains[:MAX_PROGRAMS]]

    def order(program):
        return (not has_run(program.sources, code), is_secondary(program.main), "client" in program.main.lower(),
                program.source_list is None, not has_run([program.main], code), -len(program.sources),
                program.main.count("/"), program.main)

    return sorted(found, key=order)


def _program(main, all_mains, sources, lists, included):
    others = set(all_mains) - {main}
    fitting = [one for one in lists if main in one.sources]
    if fitting:
        best = max(fitting, key=lambda one: (one.exact, len(set(one.sources) - others) - len(one.missing), -one.file.count("/")))
        taken = [name for name in best.sources if name not in others]
        listed = set(best.sources)
        left_out = [(name, f"not listed in {best.file}") for name in sources if name not in listed and name not in others]
    else:
        best, (taken, left_out) = None, _around(main, others, sources, included)
    taken.remove(main)
    return Program(main, [main] + taken, best, left_out)


def _around(main, others, sources, included):
    """Returns (sources, left out) of a program without a list: all sources except those of other programs and tests, second
    copies, and those that other files include."""
    home = os.path.dirname(main)
    foreign = {os.path.dirname(other) for other in others} - {home}
    foreign = {folder for folder in foreign if not (home + "/").startswith(folder + "/") and folder}
    there = {name.lower() for name in sources}
    taken, left_out, nearest = [], [], {}
    for name in sorted(sources, key=lambda one: (os.path.dirname(one) != home, one.count("/"), one)):
        if name in others:
            continue
        base, first = os.path.basename(name).lower(), _first_of(name)
        if any(folder in foreign for folder in _folders_above(name)):
            left_out.append((name, "in the folder of another program"))
        elif is_secondary(os.path.dirname(name)) and not is_secondary(home):
            left_out.append((name, "in a folder of tests, examples or leftovers"))
        elif base in nearest:
            left_out.append((name, f"{nearest[base]}, of this name, is used"))
        elif first.lower() in there and name != main:
            left_out.append((name, f"a second copy of {first}"))
        else:
            nearest[base] = name
            taken.append(name)
    compiled = set(taken)
    for name in taken[:]:
        by = [one for one in included.get(name, ()) if one in compiled or not (is_source(one) or is_secondary(one))]
        if by and name != main:
            taken.remove(name)
            left_out.append((name, f"{by[0]} includes it"))
    return taken, left_out


def _first_of(name):
    """Returns the original of a second copy, like Hero.cpp of "Hero - Copy.cpp"; "" if the name does not look like a copy."""
    root, extension = os.path.splitext(name)
    copy = _COPY.match(os.path.basename(root))
    return os.path.join(os.path.dirname(name), copy.group(1) + extension) if copy else ""


def _folders_above(name):
    while name := os.path.dirname(name):
        yield name
