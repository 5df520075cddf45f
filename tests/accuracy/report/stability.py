"""Maps of stability: a panel per method, with a cell for each parameter and number of sub-steps."""

import math
from itertools import groupby

from diagram import power_of_ten
from svg import INK, MUTED, number, page, text

CELL, GAP, PER_ROW = 24, 56, 3
SIDE = CELL - 1.5
LEFT, TOP, HEAD = 64, 112, 26
# Each class of errors has a largest error, a colour (Okabe and Ito), a character for print, and a meaning.
BOUNDED = 1.0
CLASSES = [(1e-2, "#0072b2", "", "error below 0.01"), (BOUNDED, "#9fd0ee", "", "bounded: below 1"),
           (100.0, "#f2c14e", "!", "wrong: 1 and more"), (math.inf, "#c44e00", "×", "failed, or 100 and more")]


def kind(error):
    """Returns the index of the error's class in CLASSES."""
    return next((index for index, (largest, *_) in enumerate(CLASSES) if error < largest), len(CLASSES) - 1)


def tile(name, colour, sign):
    """Returns the pattern of a class. An area filled with `url(#c…)` is tiled with its cells."""
    return (f'<pattern id="c{name}" width="{CELL}" height="{CELL}" patternUnits="userSpaceOnUse">'
            f'<rect width="{SIDE}" height="{SIDE}" fill="{colour}"/>'
            + (text(CELL / 2 - 0.7, CELL * 0.7, sign, 13, INK, "middle", "600") if sign else "") + "</pattern>")


def panel(left, top, label, errors, values, counts):
    """Draws the panel of a method. `errors` maps (value, count) to an error."""
    out = [text(left, top - 10, label, 14, weight="600")]
    areas = {}
    for row, count in enumerate(reversed(counts)):
        out.append(text(left - 8, top + (row + 0.68) * CELL, str(count), 11, MUTED, "end"))
        kinds = [kind(errors[value, count]) if (value, count) in errors else None for value in values]
        column = 0
        for name, run in groupby(kinds):
            wide = len(list(run)) * CELL
            if name is not None:
                areas[name] = areas.get(name, "") + f"M{column} {row * CELL}h{wide}v{CELL}h-{wide}z"
            column += wide
    out.append(f'<g transform="translate({number(left)} {number(top)})">'
               + "".join(f'<path d="{path}" fill="url(#c{name})"/>' for name, path in sorted(areas.items())) + "</g>")
    bottom = top + len(counts) * CELL
    for column, value in enumerate(values):
        if column % 2 == 0:
            name = power_of_ten(round(math.log10(value)))
            out.append(text(left + column * CELL + CELL / 2, bottom + 15, name, 11, MUTED, "middle"))
    return out


def draw(panels, values, counts, title, x_label):
    """Draws a map. `panels` is a list of (label, errors)."""
    rows = math.ceil(len(panels) / PER_ROW)
    wide, high = len(values) * CELL + GAP, len(counts) * CELL + GAP + HEAD
    width, height = max(LEFT + PER_ROW * wide, 760), TOP + rows * high + 4
    parts = [tile(name, colour, sign) for name, (_, colour, sign, _) in enumerate(CLASSES)]
    parts += [text(LEFT - 40, 30, title, 18, weight="600"),
              text(LEFT - 40, 52, f"across: {x_label}; up: steps in 1/30 s", 12.5, MUTED)]
    at = LEFT - 40
    for _, colour, sign, meaning in CLASSES:
        parts.append(f'<rect x="{at}" y="64" width="15" height="15" fill="{colour}"/>')
        if sign:
            parts.append(text(at + 7.5, 76, sign, 12, INK, "middle", "600"))
        parts.append(text(at + 21, 76, meaning, 12.5, INK))
        at += 180
    for index, (label, errors) in enumerate(panels):
        left, top = LEFT + index % PER_ROW * wide, TOP + HEAD + index // PER_ROW * high
        parts += panel(left, top, label, errors, values, counts)
    return page(width, height, title, parts)
