"""A design worked out: what every output starts from."""

from dataclasses import dataclass

from aag_cad.design import Design
from aag_cad.network.extent import ShellExtent
from aag_cad.network.model import CurveNetwork
from aag_cad.parts.model import Gridshell
from aag_cad.web.quality import WebQuality
from aag_cad.web.web import Web


@dataclass(frozen=True)
class Model:
    """A design worked out: its web and the quality of that, its curves and how far they reach, and the gridshell."""

    design: Design
    web: Web
    quality: WebQuality
    network: CurveNetwork
    extent: ShellExtent
    gridshell: Gridshell
