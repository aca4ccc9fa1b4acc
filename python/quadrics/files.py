"""From a path to a mesh: what may be read at all, and how much of it; parsing is the core's."""

from __future__ import annotations

import bz2
import gzip
import hashlib
import io
import lzma
import os
import stat
import time
import zlib
from collections.abc import Callable
from pathlib import Path

from quadrics import _core
from quadrics.errors import InputError, OutputError
from quadrics.mesh import Mesh, Source

#: How compressed files begin, and what opens them.
_PACKED: dict[bytes, Callable[[io.BytesIO], io.BufferedIOBase]] = {
    b"\x1f\x8b": lambda file: gzip.GzipFile(fileobj=file),
    b"BZh": bz2.BZ2File,
    b"\xfd7zXZ\x00": lzma.LZMAFile,
}
_PACKED_SUFFIXES = (".gz", ".bz2", ".xz")
#: Meshes shrink to a tenth or so; a file that grows beyond this is a bomb.
_MOST_GROWTH = 100
_ALWAYS_ALLOWED = 16 << 20
#: More than the core can index, in any format.
_LARGEST = 64 << 30


def load(path: Path) -> Mesh:
    """Read a mesh file; `quadrics.read` describes it."""
    started = time.perf_counter()
    packed = read_bytes(path)
    content = _unpack(path, packed)
    suffixes = [suffix for suffix in path.suffixes if suffix.lower() not in _PACKED_SUFFIXES]
    extension = suffixes[-1][1:] if suffixes else ""
    try:
        loaded = _core.read(extension, content, lambda name: _beside(path, name))
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    source = Source(
        path=str(path),
        sha256=hashlib.sha256(packed).hexdigest(),
        units=loaded["units"],
        repairs=tuple(loaded["repairs"]),
        read_s=time.perf_counter() - started,
    )
    return Mesh(
        loaded["positions"], loaded["faces"], loaded["parent"], loaded["face_count"], source
    )


def read_bytes(path: Path) -> bytes:
    """Read a regular file.

    Raises
    ------
    InputError
        If there is none, or it may not be read; the text says which.
    """
    try:
        about = path.stat()
        if stat.S_ISDIR(about.st_mode):
            raise InputError(f"{path}: is a folder; name a mesh file in it")
        # A pipe would be waited for, a device might never end.
        if not stat.S_ISREG(about.st_mode):
            raise InputError(f"{path}: is not a regular file; copy it to a file first")
        if about.st_size == 0:
            raise InputError(f"{path}: is empty; export the mesh again")
        if about.st_size > _LARGEST:
            raise InputError(f"{path}: {about.st_size >> 30} GiB are more than can be read")
        return path.read_bytes()
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except PermissionError:
        raise InputError(f"{path}: no permission to read it") from None
    except (OSError, ValueError) as error:  # ValueError: a NUL in the name.
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"{path}: cannot be read: {reason.lower()}") from None
    except MemoryError:
        raise InputError(f"{path}: does not fit into memory") from None


#: Endings of the names of files that can be written.
WRITABLE = (".ply", ".stl", ".obj", ".off")
PICTURES = (".png",)


def check_target(path: Path, *, overwrite: bool, endings: tuple[str, ...] = WRITABLE) -> None:
    """Refuse a file that cannot be written, before the work is done."""
    if path.suffix.lower() not in endings:
        raise OutputError(f"{path}: cannot be written: end its name in {', '.join(endings)}")
    if path.is_dir():
        raise OutputError(f"{path}: is a folder; name a file")
    if path.exists() and not overwrite:
        raise OutputError(f"{path}: is there already; add --overwrite, or choose another name")
    if not path.absolute().parent.is_dir():
        raise OutputError(f"{path}: there is no folder {path.parent}")


def save(mesh: Mesh, path: Path, *, overwrite: bool) -> None:
    """Write a mesh; the file appears whole, or not at all."""
    check_target(path, overwrite=overwrite)
    write_whole(path, _core.write(path.suffix[1:], mesh.vertices, mesh.faces))


def write_whole(path: Path, content: bytes) -> None:
    """Write a file beside `path`, then rename it: it appears whole, or not at all.

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    partial = path.with_name(f".{path.name}.{os.getpid()}.partial")
    try:
        try:
            partial.write_bytes(content)
            partial.replace(path)
        finally:
            partial.unlink(missing_ok=True)
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise OutputError(f"{path}: cannot be written: {reason}") from error


def _unpack(path: Path, content: bytes) -> bytes:
    for magic, opener in _PACKED.items():
        if content.startswith(magic):
            limit = _ALWAYS_ALLOWED + _MOST_GROWTH * len(content)
            try:
                with opener(io.BytesIO(content)) as stream:
                    unpacked = stream.read(limit + 1)
            except (OSError, EOFError, lzma.LZMAError, zlib.error) as error:
                raise InputError(f"{path}: cannot be unpacked: {error}") from None
            if len(unpacked) > limit:
                much = f"unpacks to more than {_MOST_GROWTH} times its size"
                raise InputError(f"{path}: {much}; unpack it yourself if you trust it")
            return unpacked
    return content


def _beside(path: Path, name: str) -> bytes | None:
    """Read a file that `path` refers to, from its own folder only."""
    try:
        folder = path.resolve().parent
        # Links are followed before the comparison: one may point out of the folder.
        wanted = (folder / name).resolve()
        if not wanted.is_relative_to(folder):
            return None
        return read_bytes(wanted)
    except (InputError, OSError, ValueError):
        return None
