"""What a game loads: where it must be started so that its sprites are found, and which of them are not there."""
import os
import re

_NAMED = re.compile(r'"([^"\n]{1,200}\.(?:txt|spr|wav|ogg|mp3|flac|csv|json|dat|map|lvl))"')
_LOADED = re.compile(r'\bload(?:Sprite|Sound|Music)\s*\(\s*"([^"\n]{1,200})"')
_REFUSED = re.compile(r"Sprite [^:]*: (?P<file>[^:]+?)(?::(?P<line>\d+))?: (?P<text>.*)")


def _plain(path):
    return os.path.normpath(path.replace("\\", "/")).lower()


def run_folder(files, sources, program):
    """The folder, from the top of the copy, from which most of what the sources name is found."""
    named = {_plain(path) for name in sources.files for path in _NAMED.findall(sources.text(name))}
    there = {name.lower() for name in files}
    folders = {""} | {os.path.dirname(program.main)}
    for name in files:
        folder = os.path.dirname(name)
        while folder:
            folders.add(folder)
            folder = os.path.dirname(folder)

    def score(folder):
        found = sum(os.path.normpath(os.path.join(folder.lower(), path)) in there for path in named)
        config = os.path.join(folder, "df-config.txt") in files
        return -found, not config, folder != os.path.dirname(program.main), folder.count("/"), folder

    return min(folders, key=score)


def missing_files(files, sources, names, folder):
    """[(file, line, path)] of what is loaded by a name in the source and lies nowhere that Naiad looks."""
    there = {name.lower() for name in files}
    missing = []
    for name in names:
        for number, line in enumerate(sources.text(name).split("\n"), 1):
            begin = line.find("//")
            for match in _LOADED.finditer(line if begin < 0 else line[:begin]):
                path = _plain(match.group(1))
                places = [os.path.normpath(os.path.join(place, path)) for place in (folder.lower(), "")]
                if not any(place in there for place in places):
                    missing.append((name, number, match.group(1)))
    return missing


def refused_sprites(log, folder):
    """[(file, line, text)] of sprites that the engine logged as refused, not of what compat took as the published engine does."""
    found = {}
    for line in log.splitlines():
        match = _REFUSED.search(line)
        if match and match.group("line") and not match.group("text").endswith(" (compat)"):
            file = os.path.normpath(os.path.join(folder, match.group("file").replace("/game/", "")))
            found.setdefault((file, match.group("line"), match.group("text")), None)
    return list(found)
