"""gridshell.json: the gridshell written and read back to an equal object."""

import json
import math
from dataclasses import MISSING, fields, is_dataclass, replace
from functools import cache, partial
from typing import Any, Literal, get_args, get_origin, get_type_hints

import numpy as np

from aag_cad.errors import FileError
from aag_cad.files import json_object
from aag_cad.geometry.framed import FramedCurve
from aag_cad.parts.kinds import KINDS, kind_of
from aag_cad.parts.marks import turned_mark
from aag_cad.parts.model import SCHEMA_VERSION, Gridshell, Part, Shell
from aag_cad.parts.twins import renamed
from aag_cad.units import Floats

_hints = cache(get_type_hints)


def _plain(value: Any) -> Any:
    """Return lists, dicts, numbers and texts for a model value; what is ``more`` in it names its kind."""
    if isinstance(value, FramedCurve):
        return {name: getattr(value, name).tolist() for name in ("stations", "points", "normals")}
    if is_dataclass(value):
        plain = {f.name: _plain(getattr(value, f.name)) for f in fields(value)}
        if isinstance(value, Shell | Gridshell) and (more := plain.pop("more")):
            plain["more"] = [{"kind": kind_of(part).name, **each} for part, each in zip(value.more, more, strict=True)]
        return plain
    if isinstance(value, tuple):
        return [_plain(item) for item in value]
    return value


def _numbers(data: Any, path: str) -> Floats:
    flat = data
    while isinstance(flat, list) and any(isinstance(item, list) for item in flat):
        flat = [number for item in flat for number in (item if isinstance(item, list) else [item])]
    if not isinstance(flat, list) or any(type(number) not in (int, float) for number in flat):
        raise FileError(f"{path}: expected lists of numbers")
    try:
        array = np.array(data, dtype=np.float64)
    except ValueError as error:
        raise FileError(f"{path}: rows of different lengths") from error
    if not np.all(np.isfinite(array)):
        raise FileError(f"{path}: every number must be finite")
    return array


def _curve(data: Any, path: str) -> FramedCurve:
    if not isinstance(data, dict) or set(data) != {"stations", "points", "normals"}:
        raise FileError(f"{path}: not a curve of stations, points and normals")
    arrays = {name: _numbers(data[name], f"{path}.{name}") for name in ("stations", "points", "normals")}
    count = arrays["stations"].size
    if arrays["stations"].shape != (count,) or any(arrays[k].shape != (count, 3) for k in ("points", "normals")):
        raise FileError(f"{path}: {count} stations need as many points and normals of three numbers each")
    return FramedCurve(**arrays)


def _part(data: Any, path: str) -> Any:
    """Return a part that names its kind."""
    name = data.get("kind") if isinstance(data, dict) else None
    kind = next((row.part for row in KINDS.values() if row.name == name), None)
    if kind is None:
        raise FileError(f"{path}: kind {name!r} is none of {', '.join(row.name for row in KINDS.values())}")
    return value_of(kind, {key: data[key] for key in data if key != "kind"}, path)


def value_of(kind: Any, data: Any, path: str) -> Any:
    """Return the value of a type from plain data, as JSON gives it; FileError with the path of what does not fit.

    Types are dataclasses, tuples, literals, curves, texts, booleans and numbers.
    """
    if kind is FramedCurve:
        return _curve(data, path)
    if kind is Part:
        return _part(data, path)
    if is_dataclass(kind) and isinstance(kind, type):
        if not isinstance(data, dict):
            raise FileError(f"{path}: expected an object, found {type(data).__name__}")
        hints = {f.name: _hints(kind)[f.name] for f in fields(kind)}
        unknown = sorted(set(data) - set(hints))
        missing = sorted(f.name for f in fields(kind) if f.name not in data and f.default is MISSING)
        if unknown or missing:
            raise FileError(f"{path}: unknown keys {unknown}, missing keys {missing}")
        return kind(**{name: value_of(hints[name], data[name], f"{path}.{name}") for name in hints if name in data})
    origin, args = get_origin(kind), get_args(kind)
    if origin is tuple:
        if not isinstance(data, list):
            raise FileError(f"{path}: expected a list, found {type(data).__name__}")
        kinds = [args[0]] * len(data) if args[1:] == (Ellipsis,) else list(args)
        if len(kinds) != len(data):
            raise FileError(f"{path}: expected {len(kinds)} values, found {len(data)}")
        return tuple(value_of(k, item, f"{path}[{i}]") for i, (k, item) in enumerate(zip(kinds, data, strict=True)))
    if origin is Literal:
        if data not in args:
            raise FileError(f"{path}: {data!r} is none of {', '.join(map(repr, args))}")
        return data
    if kind is float and type(data) in (int, float):
        if not math.isfinite(data):
            raise FileError(f"{path}: {data!r} is not finite")
        return float(data)
    if type(data) is not kind:
        raise FileError(f"{path}: expected {kind.__name__}, found {data!r}")
    return data


def gridshell_json(gridshell: Gridshell) -> str:
    """Return the gridshell as JSON text, mm, every number with all its digits."""
    return json.dumps(_plain(gridshell), separators=(",", ":")) + "\n"


def _refuse_false_twins(shells: tuple[Shell, ...]) -> None:
    """Refuse a shell that says it is a twin and is none: what is planned for its first shell would be wrong for it."""
    for place, shell in enumerate(shells):
        first = next((i for i, other in enumerate(shells[:place]) if other.mark == shell.twin_of), None)
        if first is None and not shell.twin_of:
            continue
        where, remedy = f"gridshell.shells[{place}].twin_of", "leave twin_of out"
        if first is None or shells[first].twin_of:
            raise FileError(f"{where}: {shell.twin_of!r} is no shell before it that is none's twin; {remedy}")
        own = renamed(shells[first], partial(turned_mark, places=place - first, count=len(shells)))
        if own != replace(shell, twin_of="", placement=own.placement):
            raise FileError(f"{where}: {shell.mark} differs from {shell.twin_of} in its own coordinates; {remedy}")


def read_gridshell(text: str) -> Gridshell:
    """Return the gridshell in a JSON text; FileError with the path in the file where it does not fit."""
    data = json_object(text, "gridshell.json")
    version = data.get("schema_version")
    if version != SCHEMA_VERSION:
        raise FileError(
            f"gridshell.json: schema_version {version!r}, this program reads {SCHEMA_VERSION}; build the design again"
        )
    gridshell: Gridshell = value_of(Gridshell, data, "gridshell")
    _refuse_false_twins(gridshell.shells)
    return gridshell
