"""What an experiment shows: text, tables, plots and pictures, for a terminal and for a page."""

from __future__ import annotations

import base64
import io
from collections.abc import Sequence
from dataclasses import dataclass, field
from html import escape
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

#: Width of a picture on the page, in pixels.
PICTURE = 420
MOST_IN_A_ROW = 5


@dataclass(frozen=True)
class Table:
    """Rows of cells below headings."""

    headings: Sequence[str]
    rows: Sequence[Sequence[str]]

    def text(self) -> str:
        """Aligned for a terminal: the first column to the left, the others to the right."""
        every = [list(self.headings), *map(list, self.rows)]
        widths = [max(len(row[i]) for row in every) for i in range(len(self.headings))]
        lines = (
            "  ".join(
                cell.ljust(width) if i == 0 else cell.rjust(width)
                for i, (cell, width) in enumerate(zip(row, widths, strict=True))
            ).rstrip()
            for row in every
        )
        return "\n".join(lines)

    def html(self) -> str:
        """As a table of a page."""

        def row(cells: Sequence[str], tag: str) -> str:
            return "<tr>" + "".join(f"<{tag}>{escape(c)}</{tag}>" for c in cells) + "</tr>"

        return (
            f"<table>{row(self.headings, 'th')}{''.join(row(r, 'td') for r in self.rows)}</table>"
        )


@dataclass(frozen=True)
class Note:
    """A paragraph."""

    words: str

    def text(self) -> str:
        """As it is."""
        return self.words

    def html(self) -> str:
        """As a paragraph of a page."""
        return f"<p>{escape(self.words)}</p>"


@dataclass(frozen=True)
class Drawing:
    """An SVG, and what to say of it on a terminal."""

    svg: str
    caption: str

    def text(self) -> str:
        """Only what it is: a terminal has no pictures."""
        return f"[plot: {self.caption}]"

    def html(self) -> str:
        """As a figure of a page."""
        return f"<figure>{self.svg}<figcaption>{escape(self.caption)}</figcaption></figure>"


@dataclass(frozen=True, eq=False)
class Pictures:
    """Pixels (height, width, 3) side by side, each with a caption."""

    views: Sequence[tuple[str, NDArray[np.uint8]]]

    def text(self) -> str:
        """Only what they are."""
        return f"[pictures: {'; '.join(caption for caption, _ in self.views)}]"

    def html(self) -> str:
        """As a row of figures, the pictures inside the page."""
        count = len(self.views)
        # Rows of one length: six pictures are two rows of three, not five and one.
        columns = -(-count // -(-count // MOST_IN_A_ROW))
        style = f"grid-template-columns: repeat({columns}, minmax(0, 310px))"
        figures = "".join(_figure(*view) for view in self.views)
        return f'<div class=row style="{style}">{figures}</div>'


def _figure(caption: str, pixels: NDArray[np.uint8]) -> str:
    from PIL import Image

    image = Image.fromarray(pixels)
    image.thumbnail((PICTURE, PICTURE))
    content = io.BytesIO()
    image.save(content, format="PNG", optimize=True)
    code = base64.b64encode(content.getvalue()).decode()
    words = escape(caption)
    source = f"data:image/png;base64,{code}"
    return f'<figure><img alt="{words}" src="{source}"><figcaption>{words}</figcaption></figure>'


Block: TypeAlias = Table | Note | Drawing | Pictures


@dataclass(frozen=True)
class Section:
    """One table or figure of the paper."""

    title: str
    blocks: list[Block] = field(default_factory=list)

    def text(self) -> str:
        """For a terminal."""
        body = "\n".join(block.text() for block in self.blocks)
        return f"{self.title}\n{'=' * len(self.title)}\n{body}\n"

    def html(self) -> str:
        """For a page."""
        blocks = "\n".join(block.html() for block in self.blocks)
        return f"<section><h2>{escape(self.title)}</h2>\n{blocks}\n</section>"
