"""What every picture of this project is drawn with: logarithmic axes, text and lines as SVG."""

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
    """Three digits and a unit."""
    for unit, size in (("ms", 1e6), ("µs", 1e3)):
        if ns >= size:
            return f"{ns / size:.3g} {unit}"
    return f"{ns:.3g} ns"


def text(x, y, words, size=13, colour=INK, anchor="start", weight="normal", turn=None):
    rotate = f' transform="rotate({turn:.1f} {x:.1f} {y:.1f})"' if turn is not None else ""
    return (f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" fill="{colour}" text-anchor="{anchor}" '
            f'font-weight="{weight}"{rotate}>{html.escape(words)}</text>')


def line(x1, y1, x2, y2, colour, width=1.0, dashes=""):
    dash = f' stroke-dasharray="{dashes}"' if dashes else ""
    return (f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" '
            f'stroke-width="{width}"{dash}/>')


def polyline(points, colour, width):
    path = " ".join(f"{px:.1f},{py:.1f}" for px, py in points)
    return (f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="{width}" '
            'stroke-linejoin="round" stroke-linecap="round"/>')


def page(width, height, title, parts):
    """The whole picture on white."""
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
           f'viewBox="0 0 {width} {height}" font-family="system-ui, -apple-system, Segoe UI, Helvetica, Arial, '
           f'sans-serif" role="img">',
           f"<title>{html.escape(title)}</title>",
           f'<rect width="{width}" height="{height}" fill="#ffffff"/>']
    return "\n".join(out + parts + ["</svg>"])
