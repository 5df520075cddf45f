"""Reads the compile commands of a build, including those that compile several sources of a folder together."""
import json
import pathlib
import re


def compile_commands(build):
    """Yields (source, entry): the path of each source, and the entry of compile_commands.json that compiles it."""
    for entry in json.loads((pathlib.Path(build) / "compile_commands.json").read_text()):
        file = pathlib.Path(entry["directory"], entry["file"])
        if file.parent.name != "Unity":
            yield str(file), entry
            continue
        for source in re.findall(r'^#include "(.*)"$', file.read_text(), re.M):
            yield source, entry
