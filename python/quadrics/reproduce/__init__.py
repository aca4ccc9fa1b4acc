"""The paper's experiments, one file a table or figure; each makes a section of one page."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

from quadrics.reproduce.data import Data
from quadrics.reproduce.section import Section


def experiment(name: str) -> Callable[[Data], Section]:
    """Give what makes the section of that name."""
    make: Callable[[Data], Section] = import_module(f"quadrics.reproduce.{name}").make
    return make
