"""A work-precision diagram: error on x, CPU time on y, a curve per method, a point per number of sub-steps."""

import math

from svg import GRID, INK, MUTED, Axis, duration, line, number, page, polyline, text

WIDTH, HEIGHT = 900, 520
LEFT, RIGHT, TOP, BOTTOM = 92, 214, 84, 72
STRIP = 26        # width of the edges: exactly 0 on the left, failures on the right
LARGEST = 100.0   # larger errors are drawn with the failures
SMALLEST = 1e-17  # smaller errors are drawn as 0
ORDERS = (1, 2, 4)
MINOR = "#f1f3f5"  # lines between decades
FEW = 2.5          # decades; a shorter axis also has lines at 2 and 5

# Colours by Okabe and Ito and by Tol, which colour-blind people can tell apart, and shapes for print.
STYLES = {
    "default": ("#000000", "circle", 3.4),
    "fast": ("#b0209a", "diamond", 3.4),
    "box2d": ("#d55e00", "square", 2.2),
    "chipmunk": ("#0072b2", "triangle", 2.2),
    "box2d3": ("#d55e00", "diamond", 1.5),
    "rapier": ("#cc3311", "down", 1.5),
    "xpbd": ("#009e73", "diamond", 2.2),
    "rigid": ("#444444", "triangle", 2.2),
    "tgs_ngs": ("#aa4499", "square", 2.2),
    "soft_step": ("#999933", "diamond", 2.2),
    "xpbd_contacts": ("#009e73", "diamond", 2.2),
    "avbd": ("#6699cc", "down", 2.2),
    "soft": ("#44aa99", "square", 2.2),
    "soft_euler": ("#661100", "circle", 2.2),
    "soft_xpbd": ("#ee6677", "plus", 2.2),
    "euler": ("#8c8c8c", "cross", 1.5),
    "semi_implicit": ("#cc79a7", "circle", 1.5),
    "verlet": ("#56b4e9", "square", 1.5),
    "yoshida4": ("#332288", "diamond", 1.5),
    "rk4": ("#e69f00", "triangle", 1.5),
    "backward_euler": ("#882255", "down", 1.5),
    "tr_bdf2": ("#117733", "plus", 1.5),
}

# Outlines as a part of a path, relative to a point's position.
OUTLINES = {
    "circle": "m-3.9 0a3.9 3.9 0 1 1 0 .01z",
    "square": "m-3.9-3.9h7.8v7.8h-7.8z",
    "triangle": "m0-4.5l4.3 7.8h-8.6z",
    "down": "m0 4.5l4.3-7.8h-8.6z",
    "diamond": "m0-5.1l4.7 5.1-4.7 5.1-4.7-5.1z",
    "cross": "m-3.7-3.7l7.4 7.4m0-7.4l-7.4 7.4",
    "plus": "m-4.6 0h9.2m-4.6-4.6v9.2",
}


def markers(places, shape, colour, hollow=False):
    """Returns all markers of a curve as one path."""
    if not places:
        return []
    fill, width = ("#ffffff" if hollow else colour, 1.6) if shape not in ("cross", "plus") else ("none", 2.2)
    pieces = "".join(f"M{number(x)} {number(y)}{OUTLINES[shape]}" for x, y in places)
    return [f'<path d="{pieces}" fill="{fill}" stroke="{colour}" stroke-width="{width}"/>']


def power_of_ten(exponent):
    return "10" + str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def failed(error):
    return not error < LARGEST


def targets(metric):
    """Returns (value, words) for each target that the metric sets for the product's levels."""
    asked = [(metric["target"], "must reach"), (metric.get("fast_target", -1), "fast level must reach")]
    if asked[0][0] == asked[1][0]:
        asked = [(asked[0][0], "must reach")]
    return [(value, words) for value, words in asked if value >= 0]


def stretch(values, least):
    """Returns the limits of an axis that holds all values with a margin at both ends and spans at least `least` decades."""
    low, high = math.log10(min(values)), math.log10(max(values))
    room = max(0.06 * (high - low), (least - (high - low)) / 2, 0.05)
    return 10.0**(low - room), 10.0**(high + room)


def ranges(points, metric):
    """Returns the limits of both axes, which fit the points and targets drawn."""
    errors = [p["error"] for p in points if not failed(p["error"]) and p["error"] > SMALLEST]
    errors += [value for value, _ in targets(metric) if SMALLEST < value < LARGEST]
    times = [p[key] for p in points for key in ("cpu_us_min", "cpu_us_max") if p[key] > 0]
    return [stretch(errors or [1e-2, 1], 1), stretch(times or [1, 10], 0.7)]


def ticks(axis):
    """Returns the values between the decades that get a grid line, and the values that get a label."""
    decades = axis.decades()
    if axis.high - axis.low >= FEW:
        every = max(1, math.ceil(len(decades) / 9))
        return [], decades[::every]
    between = [factor * 10.0**e for e in range(math.floor(axis.low), math.ceil(axis.high) + 1) for factor in (2, 5)]
    between = [value for value in between if axis.low <= math.log10(value) <= axis.high]
    return between, sorted(decades + between)


def plain(value):
    """Formats the label of an axis that also has labels between its decades."""
    if 1e-4 <= value < 1e5:
        return f"{value:g}"
    exponent = math.floor(math.log10(value) + 1e-9)
    factor = f"{value / 10.0**exponent:.2g}"
    return power_of_ten(exponent) if factor == "1" else f"{factor}·{power_of_ten(exponent)}"


def edge_left(points, metric):
    """True if the picture needs a strip for errors of exactly 0."""
    return any(p["error"] <= SMALLEST for p in points) or any(value <= SMALLEST for value, _ in targets(metric))


def edge_right(points):
    """True if the picture needs a strip for failures."""
    return any(failed(p["error"]) for p in points)


def lines(x, y, along_x, along_y):
    right = WIDTH - RIGHT
    return ("".join(f"M{LEFT} {number(y(value))}H{right}" for value in along_y)
            + "".join(f"M{number(x(value))} {TOP}V{HEIGHT - BOTTOM}" for value in along_x))


def frame(x, y, metric, title, subtitle):
    right = WIDTH - RIGHT
    out = [text(LEFT, 28, title, 18, weight="600"), text(LEFT, 47, subtitle, 12.5, MUTED)]
    between_x, named_x = ticks(x)
    between_y, named_y = ticks(y)
    out.append(f'<path d="{lines(x, y, between_x, between_y)}" stroke="{MINOR}"/>')
    out.append(f'<path d="{lines(x, y, x.decades(), y.decades())}" stroke="{GRID}"/>')
    for value in named_y:
        out.append(text(LEFT - 10, y(value) + 4.5, duration(value * 1e3), anchor="end", colour=MUTED))
    for value in named_x:
        name = plain(value) if between_x else power_of_ten(round(math.log10(value)))
        out.append(text(x(value), HEIGHT - BOTTOM + 20, name, anchor="middle", colour=MUTED))
    out.append(text((LEFT + right) / 2, HEIGHT - 16, metric["label"], anchor="middle"))
    out.append(text(20, (TOP + HEIGHT - BOTTOM) / 2, "CPU time per tick", anchor="middle", turn=-90))
    return out


def edges(x, metric, has_left, has_right):
    """Draws the strips for 0 and for failures, and the range of errors below rounding."""
    right, bottom = WIDTH - RIGHT, HEIGHT - BOTTOM
    out = []
    if has_left:
        out += [f'<rect x="{LEFT}" y="{TOP}" width="{STRIP}" height="{bottom - TOP}" fill="#eef3ee"/>',
                text(LEFT + STRIP / 2, TOP - 6, "0", 12, MUTED, "middle")]
    if has_right:
        out += [f'<rect x="{right - STRIP}" y="{TOP}" width="{STRIP}" height="{bottom - TOP}" fill="#f7ecec"/>',
                text(right - STRIP / 2, TOP - 6, "failed", 12, MUTED, "middle")]
    left = LEFT + (STRIP if has_left else 0)
    if metric["floor"] > SMALLEST and x(metric["floor"]) > left + 14:
        at = x(metric["floor"])
        out.append(f'<rect x="{left}" y="{TOP}" width="{at - left:.1f}" height="{bottom - TOP}" '
                   'fill="#f3f3f3"/>')
        out.append(text(at - 4, bottom - 8, "rounding", 11, MUTED, turn=-90))
    return out


def goals(x, metric, has_left, has_right):
    """Draws each target as a line with its name in the margin above, one row of names per target."""
    right, bottom = WIDTH - RIGHT, HEIGHT - BOTTOM
    out = []
    for row, (value, words) in enumerate(targets(metric)):
        name = f"{words} {plain(float(f'{value:.3g}')) if value else 0}"
        half = 3.3 * len(name)
        if value > SMALLEST:
            at = x(value)
            out.append(line(at, TOP - 14 * row, at, bottom, INK, 1.3, "6 4"))
        else:
            at = LEFT + STRIP / 2
        # The label is centred at the line, but moved so far that it does not cover the names of the edges.
        least = LEFT + (STRIP + 4 if has_left and row == 0 else 0) + half
        most = right - (STRIP + 12 if has_right and row == 0 else 0) - half
        out.append(text(min(max(at, least), most), TOP - 6 - 14 * row, name, 12, INK, "middle"))
    return out


def samples(points):
    """Returns points along all curves, in decades. The fan of guides is placed away from them."""
    out = []
    for method in dict.fromkeys(p["method"] for p in points):
        run = [(math.log10(p["error"]), math.log10(p["cpu_us"])) for p in points
               if p["method"] == method and p["cpu_us"] > 0 and SMALLEST < p["error"] < LARGEST]
        out += run
        for (x1, y1), (x2, y2) in zip(run, run[1:]):
            out += [(x1 + (x2 - x1) * part / 8, y1 + (y2 - y1) * part / 8) for part in range(1, 8)]
    return out


def guides(x, y, points):
    """Draws a fan of guides, which show the slope of a method of each order, where few curves are."""
    wide, high = x.high - x.low, y.high - y.low
    rise = min(0.7, 0.18 * high)
    drawn = [p["method"] for p in points if p["cpu_us"] > 0 and SMALLEST < p["error"] < LARGEST]
    if len(drawn) == len(set(drawn)):
        return []  # there is no curve to compare with
    orders = [order for order in ORDERS if order * rise < 0.5 * wide]
    if not orders:
        return []
    reach = orders[-1] * rise
    crowd = samples(points)

    def crowded(foot):
        across, up = foot
        return sum(across - reach - 0.03 * wide <= a <= across + 0.06 * wide and up - 0.07 * high <= b <= up + rise + 0.06 * high
                   for a, b in crowd)

    places = [(x.low + fraction * wide, y.low + part * high) for part in (0.76, 0.08, 0.4)
              for fraction in (0.94, 0.85, 0.75, 0.65, 0.55, 0.45, 0.35)]
    places = [place for place in places if place[0] - reach > x.low + 0.03 * wide]
    if not places:
        return []
    foot_x, foot_y = min(places, key=crowded)  # the first of the places with the fewest points and curves
    x1, y1 = x(10**foot_x), y(10**foot_y)
    out = [text(x1, y1 + 15, "order", 11, MUTED, "middle")]
    for order in orders:
        x2, y2 = x(10**(foot_x - order * rise)), y(10**(foot_y + rise))
        out.append(line(x1, y1, x2, y2, "#a3a9b0", 1.2, "3 3"))
        out.append(text(x2, y2 - 4, str(order), 11, MUTED, "middle"))
    return out


def place(point, x, y):
    """Returns the pixel position of a point, and whether it lies in one of the strips."""
    time = point["cpu_us"] if point["cpu_us"] > 0 else 10**y.low
    if failed(point["error"]):
        return WIDTH - RIGHT - STRIP / 2, y(time), True
    if point["error"] <= SMALLEST:
        return LEFT + STRIP / 2, y(time), True
    return x(point["error"]), y(time), False


def curve(points, style, x, y):
    colour, shape, width = style
    places = [place(point, x, y) for point in points]
    out, run = [], []
    for px, py, edge in places + [(0, 0, True)]:  # a curve connects the points whose errors are numbers on the axis
        if not edge:
            run.append((px, py))
            continue
        if len(run) > 1:
            out.append(polyline(run, colour, width))
        run = []
    spans = "".join(f'M{number(px)} {number(y(point["cpu_us_min"]))}V{number(y(point["cpu_us_max"]))}'
                    for point, (px, _, _) in zip(points, places) if point["cpu_us_max"] > 0)
    if spans:
        out.append(f'<path d="{spans}" stroke="{colour}"/>')
    out += markers([(px, py) for px, py, edge in places if edge], shape, colour, hollow=True)
    out += markers([(px, py) for px, py, edge in places if not edge], shape, colour)
    return out


def legend(methods, labels):
    out = []
    at = TOP + 8
    left = WIDTH - RIGHT + 18
    for method in methods:
        colour, shape, width = STYLES[method]
        out.append(line(left, at, left + 28, at, colour, width))
        out += markers([(left + 14, at)], shape, colour)
        out.append(text(left + 38, at + 4.5, labels.get(method, method), 13, INK))
        at += 23
    for row, words in enumerate(("a point for 1, 2, 4 … steps", "a tick, usually upwards", "hollow: exactly 0, or failed",
                                 "(also errors from 100 on)", "on the lower edge: not timed")):
        out.append(text(left, at + 12 + 15 * row, words, 11.5, MUTED))
    return out


def draw(points, metric, labels, title, subtitle):
    """Draws a diagram. `points` are dictionaries with method, substeps, error, cpu_us, cpu_us_min, cpu_us_max, in drawing order."""
    (x_low, x_high), (y_low, y_high) = ranges(points, metric)
    has_left, has_right = edge_left(points, metric), edge_right(points)
    x = Axis(x_low, x_high, LEFT + (STRIP if has_left else 0), WIDTH - RIGHT - (STRIP if has_right else 0))
    y = Axis(y_low, y_high, HEIGHT - BOTTOM, TOP)
    methods = list(dict.fromkeys(point["method"] for point in points))
    parts = edges(x, metric, has_left, has_right) + frame(x, y, metric, title, subtitle) + guides(x, y, points)
    parts += goals(x, metric, has_left, has_right)
    for method in reversed(methods):  # draws the product on top
        parts += curve([p for p in points if p["method"] == method], STYLES[method], x, y)
    return page(WIDTH, HEIGHT, title, parts + legend(methods, labels))
