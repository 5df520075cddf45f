"""Elements of the project's pictures: logarithmic axes, text and lines as SVG."""

import html
import math

INK, MUTED, GRID = "#1f2328", "#59636e", "#e3e6ea"


class Axis:
    """A logarithmic scale between two pixels."""

    def __init__(self, low, high, first_pixel, last_pixel):
        self.low, self.high = math.log10(low), math.log10(high)
        self.first, self.last = first_pixel, last_pixel

    def __call__(self, value):
        part = (math.log10(value) - self.low) / (self.high - self.low)
        return self.first + part * (self.last - self.first)

    def decades(self):
        return [10.0**e for e in range(math.ceil(self.low - 1e-9), math.floor(self.high + 1e-9) + 1)]


def duration(ns):
    """Formats a duration with three digits and a unit."""
    for unit, size in (("ms", 1e6), ("µs", 1e3)):
        if ns >= size:
            return f"{ns / size:.3g} {unit}"
    return f"{ns:.3g} ns"


def number(value):
    """Formats a coordinate to a tenth of a pixel, without a trailing zero."""
    digits = f"{value:.1f}".removesuffix(".0")
    return "0" if digits == "-0" else digits


def text(x, y, words, size=13, colour=INK, anchor="start", weight="normal", turn=None):
    """Returns a text element. Attributes that equal the page's defaults (size 13, INK, anchored left) are left out."""
    more = "".join(f' {name}="{value}"' for name, value, usual in
                   (("font-size", size, 13), ("fill", colour, INK), ("text-anchor", anchor, "start"),
                    ("font-weight", weight, "normal")) if value != usual)
    rotate = f' transform="rotate({number(turn)} {number(x)} {number(y)})"' if turn is not None else ""
    return f'<text x="{number(x)}" y="{number(y)}"{more}{rotate}>{html.escape(words)}</text>'


def line(x1, y1, x2, y2, colour, width=1.0, dashes=""):
    thick = f' stroke-width="{number(width)}"' if width != 1 else ""
    dash = f' stroke-dasharray="{dashes}"' if dashes else ""
    return (f'<line x1="{number(x1)}" y1="{number(y1)}" x2="{number(x2)}" y2="{number(y2)}" stroke="{colour}"'
            f'{thick}{dash}/>')


def polyline(points, colour, width):
    path = " ".join(f"{number(px)},{number(py)}" for px, py in points)
    return (f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="{width}" '
            'stroke-linejoin="round"/>')


def page(width, height, title, parts):
    """Returns the whole picture on a white background."""
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
           f'viewBox="0 0 {width} {height}" font-family="system-ui, -apple-system, Segoe UI, Helvetica, Arial, '
           f'sans-serif" font-size="13" fill="{INK}" role="img">',
           f"<title>{html.escape(title)}</title>",
           f'<rect width="{width}" height="{height}" fill="#ffffff"/>']
    return "\n".join(out + parts + ["</svg>"])
