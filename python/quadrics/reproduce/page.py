"""One HTML page that needs no network: every picture is inside."""

from __future__ import annotations

from collections.abc import Sequence

from quadrics import _core
from quadrics.reproduce.section import Section

STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; color: #222; max-width: 1320px; margin: 2em auto;
  padding: 0 1.5em }
h1 { font-size: 1.6em } h2 { font-size: 1.2em; margin-top: 2.2em; border-top: 1px solid #ddd;
  padding-top: 1em }
table { display: block; overflow-x: auto; border-collapse: collapse; margin: 1em 0;
  font-variant-numeric: tabular-nums }
th, td { padding: .25em .8em; text-align: right; border-bottom: 1px solid #eee }
th { border-bottom: 1px solid #999; font-weight: 600 }
th:first-child, td:first-child { text-align: left }
.row { display: grid; gap: 10px }
figure { margin: 0 0 1em } figcaption { font-size: .85em; color: #555 }
img { max-width: 100%; border: 1px solid #eee }
p { max-width: 46em }
"""


def page(sections: Sequence[Section]) -> str:
    """Make the page."""
    body = "\n".join(section.html() for section in sections)
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        "<title>The paper's experiments</title>"
        f"<style>{STYLE}</style></head>\n<body><h1>Improved quadric surfaces recognition from "
        "scanned mechanical models: the paper's experiments</h1>\n"
        f"<p>Made by quadrics {_core.__version__}. Errors are eq. 1 in the unit cube.</p>\n"
        f"{body}\n</body></html>\n"
    )
