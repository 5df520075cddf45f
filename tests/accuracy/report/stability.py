"""Maps of what stays bounded: one panel a method, a cell for each parameter and number of sub-steps."""

import math

from diagram import power_of_ten
from svg import INK, MUTED, page, text

CELL, GAP, PER_ROW = 24, 56, 3
LEFT, TOP, HEAD = 64, 112, 26
# Largest error, colour (Okabe and Ito), a sign for print, its meaning
BOUNDED = 1.0
CLASSES = [(1e-2, "#0072b2", "", "error below 0.01"), (BOUNDED, "#9fd0ee", "", "bounded: below 1"),
           (100.0, "#f2c14e", "!", "wrong: 1 and more"), (math.inf, "#c44e00", "×", "failed, or 100 and more")]


def kind(error):
    for largest, colour, sign, _ in CLASSES:
        if error < largest:
            return colour, sign
    return CLASSES[-1][1:3]


def panel(left, top, label, errors, values, counts):
    """`errors`: by (value, count)."""
    out = [text(left, top - 10, label, 14, weight="600")]
    for row, count in enumerate(reversed(counts)):
        y = top + row * CELL
        out.append(text(left - 8, y + CELL * 0.68, str(count), 11, MUTED, "end"))
        for column, value in enumerate(values):
            if (value, count) not in errors:
                continue
            colour, sign = kind(errors[value, count])
            x = left + column * CELL
            out.append(f'<rect x="{x:.1f}" y="{y:.1f}" width="{CELL - 1.5}" height="{CELL - 1.5}" fill="{colour}"/>')
            if sign:
                out.append(text(x + CELL / 2 - 0.7, y + CELL * 0.7, sign, 13, INK, "middle", "600"))
    bottom = top + len(counts) * CELL
    for column, value in enumerate(values):
        if column % 2 == 0:
            name = power_of_ten(round(math.log10(value)))
            out.append(text(left + column * CELL + CELL / 2, bottom + 15, name, 11, MUTED, "middle"))
    return out


def draw(panels, values, counts, title, x_label):
    """`panels`: a list of (label, errors)."""
    rows = math.ceil(len(panels) / PER_ROW)
    wide, high = len(values) * CELL + GAP, len(counts) * CELL + GAP + HEAD
    width, height = max(LEFT + PER_ROW * wide, 760), TOP + rows * high + 4
    parts = [text(LEFT - 40, 30, title, 18, weight="600"),
             text(LEFT - 40, 52, f"across: {x_label}; up: steps in 1/30 s", 12.5, MUTED)]
    at = LEFT - 40
    for _, colour, sign, meaning in CLASSES:
        parts.append(f'<rect x="{at}" y="64" width="15" height="15" fill="{colour}"/>')
        parts.append(text(at + 7.5, 76, sign, 12, INK, "middle", "600"))
        parts.append(text(at + 21, 76, meaning, 12.5, INK))
        at += 180
    for index, (label, errors) in enumerate(panels):
        left, top = LEFT + index % PER_ROW * wide, TOP + HEAD + index // PER_ROW * high
        parts += panel(left, top, label, errors, values, counts)
    return page(width, height, title, parts)
