"""What each of the six shapes gives of its parts: sizes, holes, volumes, mesh, and what the clash test asks."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Generic, Literal, TypeAlias, TypeVar

from aag_cad.geometry.framed import FramedCurve
from aag_cad.parts.triangles import Mesh
from aag_cad.units import Floats

ShapeName: TypeAlias = Literal["bar", "prism", "box", "threaded", "folded plate", "sheet"]
Form = TypeVar("Form")


@dataclass(frozen=True, eq=False)
class Shape(Generic[Form]):
    """One shape, as functions of a form: what a part is to this shape (``aag_cad.parts.kinds.Kind.form``).

    Lengths in mm, in product coordinates: those of the part's frame, or of its shell where it has none. ``sizes`` are
    (length, width, thickness); ``section`` is the area of the cross-section; ``volume`` is less the holes, which must
    not meet, ``gross_volume`` before drilling: without it, section x length. ``points`` (n, 3) lie on the surface;
    ``depths`` says how deep points (n, 3) lie inside, (n,), negative outside. ``lines`` are the curves that the form
    runs along, if any.
    """

    name: ShapeName
    sizes: Callable[[Form], tuple[float, float, float]]
    section: Callable[[Form], float]
    volume: Callable[[Form], float]
    mesh: Callable[[Form], Mesh]
    points: Callable[[Form], Floats]
    depths: Callable[[Form, Floats], Floats]
    holes: Callable[[Form], Sequence[Any]] = lambda _: ()
    lines: Callable[[Form], tuple[FramedCurve, ...]] = lambda _: ()
    gross_volume: Callable[[Form], float] | None = None
