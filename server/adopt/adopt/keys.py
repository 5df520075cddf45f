"""Makes random scripts for dfbot. They press the keys that a game's sources name."""
import random
import re

_NAMED = re.compile(r"\bKeyboard\s*::\s*(?:Key\s*::\s*)?([A-Z][A-Z0-9]*)\b")
_USUAL = ["SPACE", "RETURN", "LEFTARROW", "RIGHTARROW", "UPARROW", "DOWNARROW", "W", "A", "S", "D"]
_BEGIN = ["P", "SPACE", "RETURN"]  # keys that usually start a game from its title screen
_END = {"Q", "ESCAPE"}
_KNOWN = re.compile(r"([A-Z]|NUM[0-9]|F([1-9]|1[0-2])|SPACE|RETURN|TAB|BACKSPACE|(LEFT|RIGHT|UP|DOWN)ARROW|PERIOD|COMMA|SLASH|MINUS|"
                    r"(LEFT|RIGHT)SHIFT|(LEFT|RIGHT)CONTROL)$")


def keys_of(texts):
    """Returns the keys that the sources name, except those that usually end a game."""
    found = {name for text in texts for name in _NAMED.findall(text)}
    return sorted(name for name in found if _KNOWN.match(name) and name not in _END)


def random_script(named, seed, ticks, width=80, height=24):
    """Returns a script of about `ticks` ticks. Equal arguments give equal scripts."""
    dice = random.Random(seed)
    lines = [f"wait 5; press {key}; wait 10" for key in _BEGIN]
    pool = named * 3 + _USUAL if named else _USUAL
    left = ticks - 15 * len(_BEGIN)
    while left > 0:
        wait = 1 + dice.randrange(12)
        choice = dice.random()
        if choice < 0.45:
            lines.append(f"press {dice.choice(pool)}; wait {wait}")
        elif choice < 0.75:
            lines.append(f"hold {dice.choice(pool)} {wait}")
        else:
            x, y = dice.randrange(width), dice.randrange(height)
            lines.append(f"move {x} {y}; click {x} {y}; wait {wait}")
        left -= wait
    return "\n".join(lines) + "\n"
