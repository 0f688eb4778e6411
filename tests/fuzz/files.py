"""Files to fuzz with: HDF5 files that are whole but not what is wanted, damaged HDF5 files.

`random`: as in texts.py.
"""

from __future__ import annotations

import io
import struct
from typing import Any

import h5py
import numpy as np
from texts import changed_bytes

NODES = 5
BINARY = [
    b"\0",
    b"\xff" * 4,
    b"\0" * 8,
    b"\xff" * 8,
    struct.pack("<q", 1 << 40),
    struct.pack("<i", 1 << 30),
    b"OHDR",
    b"TREE",
    b"\x89HDF\r\n\x1a\n",
]


def right_matrix() -> dict[str, np.ndarray]:
    """The datasets of a valid matrix body."""
    x = np.linspace(-0.01, 0.01, NODES)
    return {"x": x, "gap": 2.0 * x**2, "width": np.full(NODES, 0.005), "compliance": np.diag(np.linspace(1.0, 2.0, 2 * NODES))}


def matrix_bytes(**options: Any) -> bytes:
    """A valid file of a matrix body. `options`: of h5py.File."""
    memory = io.BytesIO()
    with h5py.File(memory, "w", **options) as file:
        for name, values in right_matrix().items():
            chunked = {"chunks": True, "compression": "gzip"} if options.get("libver") == "latest" else {}
            file.create_dataset(name, data=values, **chunked)
    return memory.getvalue()


def odd_hdf5(random: Any, right: dict[str, np.ndarray], groups: tuple[str, ...] = ()) -> bytes:
    """A whole HDF5 file with datasets like `right`, one to three of which are not what is wanted."""
    memory = io.BytesIO()
    odd = {random.choice(list(right)) for _ in range(random.randint(0, 3))}
    with h5py.File(memory, "w", libver=random.choice(("earliest", "latest"))) as file:
        for group in groups:
            file.create_group(group)
        for name, values in right.items():
            if name in odd:
                _put_odd(random, file, name, values)
            else:
                file[name] = values
        if random.randint(0, 5) == 0:
            _put_odd(random, file, random.choice(("stiffness", "extra", "gap2")), np.eye(NODES))
    return memory.getvalue()


def _put_odd(random: Any, file: h5py.File, name: str, values: np.ndarray) -> None:
    """Something else than the dataset that is wanted."""
    kind = random.choice(
        (
            "missing",
            "type",
            "type",
            "rank",
            "shape",
            "shape",
            "huge",
            "value",
            "value",
            "value",
            "layout",
            "link",
            "group",
            "reference",
            "empty",
            "other",
        )
    )
    if kind == "type":
        types = (
            "i1",
            "u8",
            ">f8",
            "f2",
            "f4",
            "longdouble",
            "c16",
            "S8",
            "bool",
            "V3",
            [("a", "f8"), ("b", "i4")],
            (np.dtype("f8"), (3,)),
        )
        dtype = np.dtype(random.choice(types))
        file.create_dataset(name, values.shape, dtype)
    elif kind == "rank":
        file[name] = random.choice(
            (values.ravel()[0], values[None], values[..., None], values[None, None], np.float64(1), values.ravel())
        )
    elif kind == "shape":
        shape = tuple(random.choice((0, 1, 2, size - 1, size, size + 1, 2 * size, 300)) for size in values.shape)
        file[name] = np.resize(values, shape) if 0 not in shape else np.zeros(shape)
    elif kind == "huge":
        extent = random.choice((10**6, 2**31 - 1, 2**31, 2**31 + NODES, 2**32 + NODES, 2**40, 2**60))
        shape = (extent,) * values.ndim if extent**values.ndim < 2**63 else (extent,) + values.shape[1:]
        try:
            file.create_dataset(name, shape, "f8", chunks=(64,) * values.ndim)
        except (ValueError, OverflowError):  # what h5py itself does not make
            file.create_dataset(name, (10**6,) * values.ndim, "f8", chunks=(64,) * values.ndim)
    elif kind == "value":
        changed = np.array(values, dtype="f8")
        if changed.size:
            place = random.randrange(changed.size)
            changed.flat[place] = random.choice(
                (np.nan, np.inf, -np.inf, 0.0, -1.0, 1e308, -1e308, 5e-324, 1e-308, 1e20, changed.flat[0])
            )
        file[name] = changed
    elif kind == "layout" and values.ndim > 0 and values.size > 0:
        options = random.choice(
            (
                {"chunks": (1,) * values.ndim},
                {"compression": "gzip", "shuffle": True},
                {"fletcher32": True, "chunks": True},
                {"maxshape": (None,) * values.ndim},
                {"scaleoffset": 4},
                {"compression": "lzf"},
            )
        )
        file.create_dataset(name, data=values, **options)
    elif kind == "link":
        file[name] = random.choice(
            (
                h5py.ExternalLink("matrix.h5", "x"),
                h5py.ExternalLink("nowhere.h5", "/x"),
                h5py.SoftLink("/nowhere"),
                h5py.SoftLink("/" + name),
                h5py.ExternalLink("/dev/null", "x"),
            )
        )
    elif kind == "group":
        file.create_group(name)
    elif kind == "reference":
        file.create_dataset(name, data=np.array([file.ref] * values.size, dtype=h5py.ref_dtype).reshape(values.shape))
    elif kind == "empty":
        file.create_dataset(name, data=h5py.Empty("f8"))
    elif kind == "other":
        if random.randint(0, 1):
            file.create_dataset(name, data=np.full(values.shape, "text", dtype=object), dtype=h5py.string_dtype())
        else:
            file[name] = np.dtype("f8")  # a named type in place of a dataset


def odd_attributes(random: Any, data: bytes) -> bytes:
    """A result with attributes, datasets and groups taken out, or others in their place."""
    memory = io.BytesIO(data)
    with h5py.File(memory, "r+") as file:
        for _ in range(random.randint(1, 3)):
            if random.randint(0, 1):
                name = random.choice(list(file.attrs) or ["input"])
                if name in file.attrs:
                    del file.attrs[name]
                value = random.choice(
                    (
                        None,
                        "",
                        "x" * 70000,
                        3,
                        2.5,
                        np.arange(3),
                        np.bytes_(b"fixed"),
                        h5py.Empty("S1"),
                        ["a", "b"],
                        "&body /",
                        b"\xff\xfe",
                        "../x",
                    )
                )
                if value is not None:
                    try:
                        file.attrs[name] = value
                    except (OSError, RuntimeError):  # longer than HDF5 lets an attribute be
                        file.attrs[name] = "x" * 1000
            else:
                paths: list[str] = []
                file.visit(paths.append)
                path = random.choice(paths or ["/"])
                if path == "/":
                    continue
                item = file[path]
                values = item[()] if isinstance(item, h5py.Dataset) else None
                del file[path]
                if isinstance(values, np.ndarray) and values.dtype.kind == "f":
                    _put_odd(random, file, path, values)
    return memory.getvalue()


def damaged(random: Any, data: bytes) -> bytes:
    """A file with some bytes changed, mostly of the structure at its beginning and of what surrounds the raw data."""
    if random.randint(0, 1):
        return changed_bytes(random, data, BINARY)
    # Lengths stay: the addresses in the file then still lead somewhere.
    changed = bytearray(data)
    for _ in range(random.randint(1, 4)):
        at = random.randrange(min(len(changed), random.choice((100, 1000, 4000, len(changed)))))
        if random.randint(0, 1):
            changed[at] ^= 1 << random.randint(0, 7)
        else:
            changed[at] = random.choice((0, 1, 2, 4, 8, 0x10, 0x7F, 0x80, 0xFE, 0xFF))
    return bytes(changed)
