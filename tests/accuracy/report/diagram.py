"""A work-precision diagram: error on x, CPU time on y, a curve per method, a point per number of sub-steps."""

import math

from svg import GRID, INK, MUTED, Axis, duration, line, number, page, polyline, text

WIDTH, HEIGHT = 900, 520
LEFT, RIGHT, TOP, BOTTOM = 92, 214, 84, 72
STRIP = 26        # the edges: exactly 0 on the left, failures on the right
LARGEST = 100.0   # an error from here on is drawn with the failures
SMALLEST = 1e-17  # below that, as 0
ORDERS = (1, 2, 4)

# Colours by Okabe and Ito and by Tol, which colour-blind people can tell apart; shapes besides, for print.
STYLES = {
    "default": ("#000000", "circle", 3.4),
    "box2d": ("#d55e00", "square", 2.2),
    "chipmunk": ("#0072b2", "triangle", 2.2),
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
SPARE = [("#44aa99", "square", 2.2), ("#aa4499", "triangle", 2.2), ("#999933", "diamond", 2.2),
         ("#661100", "circle", 2.2), ("#6699cc", "down", 2.2), ("#888888", "plus", 2.2)]


def styles(methods):
    """A style for each method, the same in every picture as long as the list of methods is."""
    spare = iter(SPARE * 10)
    return {method: STYLES[method] if method in STYLES else next(spare) for method in methods}


# Outlines from a point's place on, as a piece of a path.
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
    """All markers of a curve in one path."""
    if not places:
        return []
    fill, width = ("#ffffff" if hollow else colour, 1.6) if shape not in ("cross", "plus") else ("none", 2.2)
    pieces = "".join(f"M{number(x)} {number(y)}{OUTLINES[shape]}" for x, y in places)
    return [f'<path d="{pieces}" fill="{fill}" stroke="{colour}" stroke-width="{width}"/>']


def power_of_ten(exponent):
    return "10" + str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def failed(error):
    return not error < LARGEST


def ranges(points, metric):
    """The axes: both at least two decades, from and to whole ones."""
    errors = [p["error"] for p in points if not failed(p["error"]) and p["error"] > SMALLEST]
    errors += [value for value in (metric["target"], metric["floor"]) if SMALLEST < value < LARGEST]
    times = [p[key] for p in points for key in ("cpu_us_min", "cpu_us_max") if p[key] > 0]
    out = []
    for values in (errors or [1e-3, 1], times or [1, 10]):
        low, high = math.floor(math.log10(min(values)) + 1e-9), math.ceil(math.log10(max(values)) - 1e-9)
        if high - low < 2:
            high, low = high + (high - low < 1), low - 1
        out.append((10.0**low, 10.0**high))
    return out


def frame(x, y, metric, title, subtitle):
    right = WIDTH - RIGHT
    out = [text(LEFT, 30, title, 18, weight="600"), text(LEFT, 51, subtitle, 12.5, MUTED)]
    across = "".join(f"M{LEFT} {number(y(value))}H{right}" for value in y.decades())
    up = "".join(f"M{number(x(value))} {TOP}V{HEIGHT - BOTTOM}" for value in x.decades())
    out.append(f'<path d="{across}{up}" stroke="{GRID}"/>')
    for value in y.decades():
        out.append(text(LEFT - 10, y(value) + 4.5, duration(value * 1e3), anchor="end", colour=MUTED))
    decades = x.decades()
    every = max(1, math.ceil(len(decades) / 9))
    for index, value in enumerate(decades):
        if index % every == 0:
            exponent = power_of_ten(round(math.log10(value)))
            out.append(text(x(value), HEIGHT - BOTTOM + 20, exponent, anchor="middle", colour=MUTED))
    out.append(text((LEFT + right) / 2, HEIGHT - 16, metric["label"], anchor="middle"))
    out.append(text(20, (TOP + HEIGHT - BOTTOM) / 2, "CPU time per tick", anchor="middle", turn=-90))
    return out


def edges(x, metric):
    """Where 0 and failures are drawn, and what rounding leaves."""
    right, bottom = WIDTH - RIGHT, HEIGHT - BOTTOM
    out = [f'<rect x="{LEFT}" y="{TOP}" width="{STRIP}" height="{bottom - TOP}" fill="#eef3ee"/>',
           f'<rect x="{right - STRIP}" y="{TOP}" width="{STRIP}" height="{bottom - TOP}" fill="#f7ecec"/>',
           text(LEFT + STRIP / 2, TOP - 8, "0", 12, MUTED, "middle"),
           text(right, TOP - 8, "≥ 100, failed", 12, MUTED, "end")]
    if metric["floor"] > SMALLEST and x(metric["floor"]) > LEFT + STRIP + 2:
        at = x(metric["floor"])
        out.append(f'<rect x="{LEFT + STRIP}" y="{TOP}" width="{at - LEFT - STRIP:.1f}" height="{bottom - TOP}" '
                   'fill="#f3f3f3"/>')
        out.append(text(at - 4, bottom - 8, "rounding", 11, MUTED, turn=-90))
    return out


def target(x, metric):
    """What the product must reach: a line, named in the margin above."""
    right, bottom = WIDTH - RIGHT, HEIGHT - BOTTOM
    if not SMALLEST < metric["target"] < LARGEST:
        return []
    at = x(metric["target"])
    out = [line(at, TOP, at, bottom, INK, 1.3, "6 4")]
    # Centred, but not over the names of the edges.
    at = min(max(at, LEFT + STRIP + 66), right - STRIP - 90)
    out.append(text(at, TOP - 8, f"must reach {metric['target']:.2g}", 12, INK, "middle"))
    return out


def samples(points):
    """Along the curves, in decades: what a fan of guides should keep away from."""
    out = []
    for method in dict.fromkeys(p["method"] for p in points):
        run = [(math.log10(p["error"]), math.log10(p["cpu_us"])) for p in points
               if p["method"] == method and p["cpu_us"] > 0 and SMALLEST < p["error"] < LARGEST]
        out += run
        for (x1, y1), (x2, y2) in zip(run, run[1:]):
            out += [(x1 + (x2 - x1) * part / 8, y1 + (y2 - y1) * part / 8) for part in range(1, 8)]
    return out


def guides(x, y, points):
    """How steep a method of a given order is, where there are no curves."""
    wide, high = x.high - x.low, y.high - y.low
    rise = min(0.7, 0.18 * high)
    orders = [order for order in ORDERS if order * rise < 0.5 * wide]
    reach = orders[-1] * rise if orders else 0
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
    foot_x, foot_y = min(places, key=crowded)  # the first of the emptiest
    x1, y1 = x(10**foot_x), y(10**foot_y)
    out = [text(x1, y1 + 15, "order", 11, MUTED, "middle")]
    for order in orders:
        x2, y2 = x(10**(foot_x - order * rise)), y(10**(foot_y + rise))
        out.append(line(x1, y1, x2, y2, "#a3a9b0", 1.2, "3 3"))
        out.append(text(x2, y2 - 4, str(order), 11, MUTED, "middle"))
    return out


def place(point, x, y):
    """Pixels, and whether the point lies at an edge."""
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
    for px, py, edge in places + [(0, 0, True)]:  # a curve goes where its errors are numbers on the axis
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


def legend(methods, labels, chosen):
    out = []
    at = TOP + 8
    left = WIDTH - RIGHT + 18
    for method in methods:
        colour, shape, width = chosen[method]
        out.append(line(left, at, left + 28, at, colour, width))
        out += markers([(left + 14, at)], shape, colour)
        out.append(text(left + 38, at + 4.5, labels.get(method, method), 13, INK))
        at += 23
    out.append(text(left, at + 12, "points: sub-steps a tick,", 11.5, MUTED))
    out.append(text(left, at + 27, "few at the bottom, 64 on top", 11.5, MUTED))
    out.append(text(left, at + 42, "hollow: at an edge", 11.5, MUTED))
    return out


def draw(points, metric, labels, title, subtitle, chosen):
    """`points`: dictionaries with method, substeps, error, cpu_us, cpu_us_min, cpu_us_max, in the order to draw."""
    (x_low, x_high), (y_low, y_high) = ranges(points, metric)
    x = Axis(x_low, x_high, LEFT + STRIP + 8, WIDTH - RIGHT - STRIP - 8)
    y = Axis(y_low, y_high, HEIGHT - BOTTOM, TOP)
    methods = list(dict.fromkeys(point["method"] for point in points))
    parts = edges(x, metric) + frame(x, y, metric, title, subtitle) + guides(x, y, points) + target(x, metric)
    for method in reversed(methods):  # the product on top
        parts += curve([p for p in points if p["method"] == method], chosen[method], x, y)
    return page(WIDTH, HEIGHT, title, parts + legend(methods, labels, chosen))
