"""A picture as SVG.

Source: https://www.w3.org/TR/SVG2/
"""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from gz_course.sim.show.rqt_graph.layered_layout import Point, layout
from gz_course.sim.show.rqt_graph.picture import BRIDGE, GZ_PROCESS, GZ_TOPIC, ROS_NODE, ROS_TOPIC, Box, Picture

_MARGIN = 20.0  # [px]
_LEGEND = 34.0  # [px]
_TITLE_CHARACTER = 7.3  # [px] the width of a character of 13 px, at most
_TYPE_CHARACTER = 5.8
_LOOKS = {  # fill, border, radius of the corners
    ROS_NODE: ("#dbe9ff", "#2f62b5", 16),
    ROS_TOPIC: ("#ffffff", "#7d8ba1", 3),
    BRIDGE: ("#ffe2b8", "#b56a00", 16),
    GZ_PROCESS: ("#d5f0dc", "#1f7a3d", 16),
    GZ_TOPIC: ("#f4fcf6", "#6ea582", 3),
}
_FAULT = "#c62828"
_STYLE = (
    "text{font-family:'DejaVu Sans',Verdana,sans-serif;text-anchor:middle;fill:#1c2430}"
    ".n{font-size:13px}.t{font-size:10px;fill:#5a6678}.f{font-size:10px;fill:#c62828}"
    "path{fill:none;stroke:#66738a;stroke-width:1.3}"
)


def svg(picture: Picture) -> str:
    """Return the whole SVG document."""
    lines = {key: _lines(box) for key, box in picture.boxes.items()}
    sizes = {key: _size(texts) for key, texts in lines.items()}
    placed = layout(sizes, picture.arrows)
    width = max(placed.width + 2 * _MARGIN, 640.0)
    height = placed.height + 2 * _MARGIN + _LEGEND
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}" '
        f'viewBox="0 0 {width:.0f} {height:.0f}">',
        f"<style>{_STYLE}</style>",
        '<defs><marker id="a" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" '
        'orient="auto-start-reverse"><path d="M0,0L8,4L0,8z" style="fill:#66738a;stroke:none"/></marker></defs>',
        f'<rect width="{width:.0f}" height="{height:.0f}" fill="#ffffff"/>',
        f'<g transform="translate({_MARGIN:.0f},{_MARGIN:.0f})">',
    ]
    for arrow in sorted(placed.ways):
        back = (arrow[1], arrow[0]) in placed.ways
        if back and arrow[0] > arrow[1]:
            continue  # one line with two heads
        start = ' marker-start="url(#a)"' if back else ""
        out.append(f'<path d="{_curve(placed.ways[arrow])}" marker-end="url(#a)"{start}/>')
    for key in sorted(picture.boxes):
        out += _box(picture.boxes[key], lines[key], placed.places[key], sizes[key])
    if not picture.boxes:
        out.append('<text class="n" x="300" y="10">no node and no topic is to be seen</text>')
    return "\n".join([*out, "</g>", *_legend(height), "</svg>", ""])


def _lines(box: Box) -> list[tuple[str, str]]:
    """Return the class and the text of each line in a box."""
    types = [] if len(box.types) != 1 else [("t", next(iter(box.types)))]
    return [("n", box.label), *types, *([("f", box.fault)] if box.fault else [])]


def _size(lines: Sequence[tuple[str, str]]) -> Point:
    widths = [len(text) * (_TITLE_CHARACTER if look == "n" else _TYPE_CHARACTER) for look, text in lines]
    return max(60.0, max(widths) + 24.0), 14.0 + 15.0 * len(lines)


def _box(box: Box, lines: Sequence[tuple[str, str]], place: Point, size: Point) -> list[str]:
    (x, y), (width, height) = place, size
    fill, border, radius = _LOOKS[box.kind]
    fault = f' stroke-dasharray="5 3" stroke="{_FAULT}"' if box.fault else f' stroke="{border}"'
    out = [
        f"<g><title>{escape(f'{box.kind} {box.label}')}</title>",
        f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}" rx="{radius}" fill="{fill}"{fault}/>',
    ]
    for number, (look, text) in enumerate(lines):
        out.append(f'<text class="{look}" x="{x + width / 2:.1f}" y="{y + 18 + 15 * number:.1f}">{escape(text)}</text>')
    return [*out, "</g>"]


def _curve(points: Sequence[Point]) -> str:
    (x, y), *rest = points
    path = f"M{x:.1f},{y:.1f}"
    for to_x, to_y in rest:
        middle = (x + to_x) / 2
        path += f"C{middle:.1f},{y:.1f} {middle:.1f},{to_y:.1f} {to_x:.1f},{to_y:.1f}"
        x, y = to_x, to_y
    return path


def _legend(height: float) -> list[str]:
    out = []
    x, y = _MARGIN, height - _LEGEND + 4
    for kind, (fill, border, radius) in _LOOKS.items():
        width = len(kind) * 6.4 + 22
        out.append(
            f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="20" rx="{min(radius, 9)}" fill="{fill}" '
            f'stroke="{border}"/><text class="t" x="{x + width / 2:.1f}" y="{y + 14:.1f}">{kind}</text>'
        )
        x += width + 12
    return out
