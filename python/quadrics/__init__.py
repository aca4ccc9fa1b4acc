"""Recognises the surfaces that a scanned mechanical part was made of.

>>> import quadrics
>>> result = quadrics.segment("scan.stl")  # doctest: +SKIP
>>> for region in result.regions:  # doctest: +SKIP
...     print(region.id, region.surface)
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from quadrics import synth
    from quadrics.denoising import Deviation, denoise, deviation
    from quadrics.errors import InputError, OptionError, OutputError, QuadricsError
    from quadrics.evaluation import Evaluation, Match, evaluate
    from quadrics.mesh import Mesh, as_mesh, read
    from quadrics.options import Options
    from quadrics.result import Noise, Region, Relation, Repair, Result
    from quadrics.run import segment
    from quadrics.surfaces import (
        Cone,
        Cylinder,
        FreeForm,
        Plane,
        Quadric,
        Sphere,
        Surface,
        Torus,
    )

    __version__: str

# In reading order: the main job, what goes in, what comes out, what may go wrong.
_HOME = {
    "segment": "run",
    "evaluate": "evaluation",
    "Evaluation": "evaluation",
    "Match": "evaluation",
    "denoise": "denoising",
    "deviation": "denoising",
    "Deviation": "denoising",
    "Options": "options",
    "Mesh": "mesh",
    "as_mesh": "mesh",
    "read": "mesh",
    "Result": "result",
    "Region": "result",
    "Relation": "result",
    "Noise": "result",
    "Repair": "result",
    "Surface": "surfaces",
    "Plane": "surfaces",
    "Sphere": "surfaces",
    "Cylinder": "surfaces",
    "Cone": "surfaces",
    "Torus": "surfaces",
    "Quadric": "surfaces",
    "FreeForm": "surfaces",
    "QuadricsError": "errors",
    "InputError": "errors",
    "OutputError": "errors",
    "OptionError": "errors",
    "__version__": "_core",
}

__all__ = [
    "Cone",
    "Cylinder",
    "Deviation",
    "Evaluation",
    "FreeForm",
    "InputError",
    "Match",
    "Mesh",
    "Noise",
    "OptionError",
    "Options",
    "OutputError",
    "Plane",
    "Quadric",
    "QuadricsError",
    "Region",
    "Relation",
    "Repair",
    "Result",
    "Sphere",
    "Surface",
    "Torus",
    "__version__",
    "as_mesh",
    "denoise",
    "deviation",
    "evaluate",
    "read",
    "segment",
    "synth",
]


def __getattr__(name: str) -> Any:
    # On first use: `quadrics --help` must not wait for NumPy.
    if name == "synth":
        return import_module("quadrics.synth")
    if name not in _HOME:
        raise AttributeError(f"module 'quadrics' has no attribute '{name}'")
    value = getattr(import_module(f"quadrics.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_HOME})
