"""Line plots as SVG: two axes, some curves, a legend."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

COLOURS = ("#1b6ca8", "#c8553d", "#3c8d53", "#8a5aa8", "#b58900", "#555555")
WIDTH, HEIGHT = 800, 360
#: The legend stands in the margin to the right.
LEFT, RIGHT, TOP, BOTTOM = 100, 210, 20, 50


@dataclass(frozen=True)
class Curve:
    """Points that a line goes through; dashed where it is somebody else's."""

    label: str
    x: Sequence[float]
    y: Sequence[float]
    dashed: bool = False


def plot(curves: Sequence[Curve], x_label: str, y_label: str, *, log: bool = False) -> str:
    """Draw curves; `log` makes the vertical axis logarithmic, for values above zero."""
    xs = [x for curve in curves for x in curve.x]
    ys = [_scaled(y, log) for curve in curves for y in curve.y]
    low_x, high_x = min(xs), max(max(xs), min(xs) + 1e-12)
    low_y, high_y = (min(ys) if log else 0.0), max(ys)
    span = (high_y - low_y) or 1.0
    # A curve that ends at its least value must not lie on the axis.
    low_y, high_y = low_y - (0.04 * span if log else 0.0), high_y + 0.05 * span

    def at(x: float, y: float) -> tuple[float, float]:
        right = LEFT + (WIDTH - LEFT - RIGHT) * (x - low_x) / (high_x - low_x)
        down = HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * (y - low_y) / (high_y - low_y)
        return right, down

    parts = [f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" font-size="12">']
    for value in _log_ticks(10**low_y, 10**high_y) if log else _ticks(low_y, high_y):
        x, y = at(low_x, _scaled(value, log))
        shown = f"{value:.3g}"
        parts.append(f'<path d="M{x:.1f} {y:.1f}H{WIDTH - RIGHT}" stroke="#e5e5e5"/>')
        parts.append(f'<text x="{x - 6:.1f}" y="{y + 4:.1f}" text-anchor="end">{shown}</text>')
    for tick in _ticks(low_x, high_x):
        x, y = at(tick, low_y)
        parts.append(f'<text x="{x:.1f}" y="{y + 18:.1f}" text-anchor="middle">{tick:.3g}</text>')
    parts.append(
        f'<path d="M{LEFT} {TOP}V{HEIGHT - BOTTOM}H{WIDTH - RIGHT}" fill="none" stroke="#888"/>'
    )
    for number, curve in enumerate(curves):
        points = (at(x, _scaled(y, log)) for x, y in zip(curve.x, curve.y, strict=True))
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        style = f'fill="none" stroke="{COLOURS[number % len(COLOURS)]}" stroke-width="2"'
        dashes = ' stroke-dasharray="5 4"' if curve.dashed else ""
        parts.append(f'<polyline points="{path}" {style}{dashes}/>')
        below = TOP + 16 * number + 8
        parts.append(f'<path d="M{WIDTH - RIGHT + 10} {below}h26" {style}{dashes}/>')
        parts.append(f'<text x="{WIDTH - RIGHT + 42}" y="{below + 4}">{escape(curve.label)}</text>')
    middle = (LEFT + WIDTH - RIGHT) // 2
    parts.append(
        f'<text x="{middle}" y="{HEIGHT - 8}" text-anchor="middle">{escape(x_label)}</text>'
    )
    turned = f'transform="translate(14 {(TOP + HEIGHT - BOTTOM) // 2}) rotate(-90)"'
    parts.append(f'<text {turned} text-anchor="middle">{escape(y_label)}</text></svg>')
    return "".join(parts)


def _scaled(value: float, log: bool) -> float:
    return math.log10(max(value, 1e-30)) if log else value


def _ticks(low: float, high: float) -> list[float]:
    """About five round numbers."""
    raw = (high - low) / 5
    power = 10 ** math.floor(math.log10(raw))
    step = next(power * m for m in (1, 2, 5, 10) if power * m >= raw)
    first = math.ceil(low / step - 1e-9)
    return [n * step for n in range(first, math.floor(high / step + 1e-9) + 1)]


def _log_ticks(low: float, high: float) -> list[float]:
    """Powers of ten, with 2 and 5 between where those are few; plain ones within an octave."""
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    for multiples in ((1,), (1, 2, 5)):
        ticks = [m * 10.0**n for n in decades for m in multiples if low <= m * 10.0**n <= high]
        if len(ticks) >= 3:
            return ticks[:: -(-len(ticks) // 8)]
    return _ticks(low, high)
