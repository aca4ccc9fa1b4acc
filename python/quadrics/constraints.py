"""What a user says about relations: a document that is read, checked, and handed to the core.

The document (schema: `quadrics/schema/constraints.json`) is a dictionary, or a JSON file of it:

    {"relations": [{"kind": "coaxial", "regions": [3, 7], "status": "forced"},
                   {"kind": "parallel", "regions": [1, 2], "status": "forbidden"}],
     "fix": [{"region": 7, "parameter": "radius", "value": 5.0},
             {"region": 3, "parameter": "axis", "value": [0, 0, 1]}],
     "gate": {"angle_deg": 0.5, "length": 0.1},
     "round": {"length": 0.1, "angle_deg": 1}}

Regions are those of a run with the same options and `constraints` on. A `segmentation.json` of such
a run is a document too: its accepted relations are forced, its refused ones forbidden.
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeAlias

from quadrics.errors import InputError, OptionError
from quadrics.files import read_bytes

#: What is asked of the relation that has that status; None for what follows from the others.
STATUS = {
    "forced": True,
    "accepted": True,
    "implied": None,
    "forbidden": False,
    "refused": False,
}
#: Demands as the core takes them.
Demands: TypeAlias = dict[str, Any]

_KEYS = ("relations", "fix", "gate", "round")


def as_constraints(source: object) -> dict[str, Any]:
    """Read and check a document.

    Parameters
    ----------
    source : dict or path
        The document, or a JSON file that holds it.

    Raises
    ------
    InputError
        If the file cannot be read or is no JSON.
    OptionError
        If it says something else than the schema allows.

    Examples
    --------
    >>> as_constraints({"fix": [{"region": 7, "parameter": "radius", "value": 5}]})
    {'fix': [{'region': 7, 'parameter': 'radius', 'value': 5}]}
    """
    where = "constraints"
    if isinstance(source, str | os.PathLike):
        path = Path(source)
        where = str(path)
        try:
            source = json.loads(read_bytes(path))
        except UnicodeDecodeError:
            raise InputError(f"{path}: is no JSON: not UTF-8") from None
        except json.JSONDecodeError as error:
            raise InputError(f"{path}: is no JSON: line {error.lineno}: {error.msg}") from None
    if not isinstance(source, Mapping):
        raise OptionError(f"{where} is {source!r}: give True, False, a dictionary or a JSON file")
    document = dict(source)
    if document.get("format") == "quadrics.segmentation":
        document = {"relations": document.get("relations", [])}
    if unknown := [key for key in document if key not in _KEYS]:
        raise OptionError(f"{where}: no entry {unknown[0]!r}: choose {', '.join(_KEYS)}")
    _core_form(document, where)
    return document


def for_core(constraints: object) -> bool | Demands:
    """Give what the core takes: True, False, or checked demands."""
    if isinstance(constraints, bool):
        return constraints
    return _core_form(as_constraints(constraints), "constraints")


def _core_form(document: Mapping[str, Any], where: str) -> Demands:
    relations = []
    for number, entry in enumerate(_entries(document, "relations", where)):
        at = f"{where}: relation {number}"
        kind, status = entry.get("kind"), entry.get("status", "forced")
        if not isinstance(kind, str):
            raise OptionError(f"{at}: kind is {kind!r}: it must be a name such as coaxial")
        if status not in STATUS:
            raise OptionError(f"{at}: status is {status!r}: choose {', '.join(STATUS)}")
        regions = _regions(entry.get("regions"), at)
        if (forced := STATUS[status]) is not None:
            relations.append((kind, regions, forced))
    fixed = []
    for number, entry in enumerate(_entries(document, "fix", where)):
        at = f"{where}: fix {number}"
        parameter, value = entry.get("parameter"), entry.get("value")
        if not isinstance(parameter, str):
            raise OptionError(f"{at}: parameter is {parameter!r}: it must be a name such as radius")
        values: list[Any] = list(value) if isinstance(value, list | tuple) else [value]
        if not all(_is_number(number) for number in values):
            raise OptionError(f"{at}: value is {value!r}: it must be a number, or three in a list")
        region = _regions([entry.get("region")], at)[0]
        fixed.append((region, parameter, [float(number) for number in values]))
    return {
        "relations": relations,
        "fix": fixed,
        "gate": _pair(document, "gate", where),
        "round": _pair(document, "round", where),
    }


def _entries(document: Mapping[str, Any], name: str, where: str) -> list[Mapping[str, Any]]:
    entries = document.get(name, [])
    if not isinstance(entries, list | tuple) or not all(isinstance(e, Mapping) for e in entries):
        raise OptionError(f"{where}: {name} is {entries!r:.40}: it must be a list of objects")
    return list(entries)


def _regions(value: Any, at: str) -> list[int]:
    """Whole numbers, or pairs of them, one after the other."""
    entries: list[Any] = list(value) if isinstance(value, list | tuple) else [None]
    flat: list[Any] = [
        n for entry in entries for n in (entry if isinstance(entry, list | tuple) else [entry])
    ]
    if not flat or not all(isinstance(n, int) and not isinstance(n, bool) and n >= 0 for n in flat):
        raise OptionError(f"{at}: regions are {value!r}: they must be whole numbers from 0")
    return flat


def _pair(document: Mapping[str, Any], name: str, where: str) -> tuple[float | None, float | None]:
    entry = document.get(name, {})
    known = ("length", "angle_deg")
    if not isinstance(entry, Mapping) or any(key not in known for key in entry):
        raise OptionError(f"{where}: {name} is {entry!r}: give {' and '.join(known)}")
    values = [entry.get(key) for key in known]
    for key, value in zip(known, values, strict=True):
        if value is not None and not (_is_number(value) and value > 0):
            raise OptionError(f"{where}: {name}: {key} is {value!r}: it must be above 0")
    return values[0], values[1]


def _is_number(value: Any) -> bool:
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return number and math.isfinite(value)
