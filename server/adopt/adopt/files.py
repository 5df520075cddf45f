"""Checks the files that a game loads: finds the folder to start the game in, and the files that are missing."""
import os
import re

from .programs import is_secondary
from .project import is_project_file

_NAMED = re.compile(r'"([^"\n]{1,200}\.(?:txt|spr|wav|ogg|mp3|flac|csv|json|dat|map|lvl))"')
_FOLDER = re.compile(r'"([^"\n:]{1,100}?)[\\/]+"')  # "sprites/", to which a game appends names
_LOADED = re.compile(r'\bload(?:Sprite|Sound|Music)\s*\(\s*"([^"\n]{1,200})"')
_REFUSED = re.compile(r"Sprite [^:]*: (?P<file>[^:]+?)(?::(?P<line>\d+))?: (?P<text>.*)")
MAX_NAMED, MAX_FOLDERS = 2000, 500  # maximum number of file names, and of folders that are searched for these files
MAX_LINE = 2000  # maximum characters of a log line


def _plain(path):
    return os.path.normpath(path.replace("\\", "/")).lower()


def run_folder(files, sources, program):
    """Returns the folder, relative to the copy, in which most of the files and folders named in the sources are found. Among equal
    ones it prefers that of df-config.txt, then that of main(), then one with a project file, then the nearest to main()."""
    texts = [sources.text(name) for name in sources.files]
    named = sorted({_plain(path) for text in texts for pattern in (_NAMED, _FOLDER) for path in pattern.findall(text)})[:MAX_NAMED]
    there = {name.lower() for name in files} | {os.path.dirname(name).lower() for name in files}
    folders = {""}
    for name in files:
        folder = os.path.dirname(name)
        while folder and folder not in folders:
            folders.add(folder)
            folder = os.path.dirname(folder)
    home, projects = os.path.dirname(program.main), {os.path.dirname(name) for name in files if is_project_file(name)}
    config = {os.path.dirname(name) for name in files if os.path.basename(name) == "df-config.txt"}

    def score(folder):
        found = sum(os.path.normpath(os.path.join(folder.lower(), path)) in there for path in named)
        return (-found, is_secondary(folder) and not is_secondary(home), folder not in config, folder != home, folder not in projects,
                os.path.relpath(folder or ".", home or ".").count("/"), folder.count("/"), folder)

    tried = sorted(folders, key=lambda one: (one.count("/"), one))[:MAX_FOLDERS]
    return min(tried + [home], key=score)


def missing_files(files, sources, names, folder):
    """Returns [(file, line, path, actual path)] of files that code loads and that are not where Naiad looks. The actual path
    is that of the only file of this name, relative to `folder`, or ""."""
    there = {name.lower() for name in files}
    by_base = {}
    for name in files:
        by_base.setdefault(os.path.basename(name).lower(), []).append(name)
    missing = []
    for name in names:
        code = sources.code(name).split("\n")
        for number, line in enumerate(sources.text(name).split("\n"), 1):
            for match in _LOADED.finditer(line):
                if code[number - 1][match.start()] == " ":
                    continue
                path = _plain(match.group(1))
                places = [os.path.normpath(os.path.join(place, path)) for place in (folder.lower(), "")]
                if not any(place in there for place in places):
                    same = by_base.get(os.path.basename(path), [])
                    missing.append((name, number, match.group(1), os.path.relpath(same[0], folder or ".") if len(same) == 1 else ""))
    return missing


def refused_sprites(log, folder):
    """Returns [(file, line, text)] of sprites that the engine rejected, without those accepted in compatibility mode."""
    found = {}
    for line in log.splitlines():
        match = _REFUSED.search(line[:MAX_LINE])
        if match and match.group("line") and not match.group("text").endswith(" (compat)"):
            file = os.path.normpath(os.path.join(folder, match.group("file").replace("/game/", "")))
            found.setdefault((file, match.group("line"), match.group("text")), None)
    return list(found)
