"""STEP text from a document of the CAD kernel: the same document gives the same bytes."""

import io
import re
from collections.abc import Iterator
from contextlib import contextmanager

from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
from OCP.gp import gp_Ax3, gp_Dir, gp_Pnt, gp_Trsf
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.Interface import Interface_Static
from OCP.Message import Message, Message_Gravity
from OCP.STEPCAFControl import STEPCAFControl_Controller, STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_StepModelType
from OCP.TCollection import TCollection_ExtendedString, TCollection_HAsciiString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label
from OCP.TDocStd import TDocStd_Document
from OCP.TopLoc import TopLoc_Location
from OCP.XCAFDoc import XCAFDoc_ShapeTool

from aag_cad import __version__
from aag_cad.errors import SolidError
from aag_cad.parts.forms import Frame

_MAKER = "AAG toolkit"
# A file must not change when nothing but the day has changed.
_NO_CLOCK = "2000-01-01T00:00:00"
_TEXT_SETTINGS = {"write.step.schema": "AP242DIS", "write.step.unit": "MM"}
_NUMBER_SETTINGS = {"write.step.assembly": 1, "write.surfacecurve.mode": 0, "write.step.nonmanifold": 0}
_TEXT = r"('(?:[^']|'')*')"
_OCCURRENCE = re.compile(
    rf"NEXT_ASSEMBLY_USAGE_OCCURRENCE\(\s*'\d+'\s*,\s*{_TEXT}\s*,\s*{_TEXT}\s*,\s*(#\d+)\s*,\s*(#\d+)\s*,\s*\$\s*\)"
)
_FIRST_STYLE = re.compile(r"^#\d+ = MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION\(", re.MULTILINE)
_RECORD = re.compile(r"#(\d+) = (.*?);\s*$", re.MULTILINE | re.DOTALL)
_NOT_ASCII = re.compile(r"[^\x00-\x7f]+")
_REFERENCE = re.compile(r"#(\d+)")


def named(label: TDF_Label, name: str) -> None:
    """Give a label its name."""
    TDataStd_Name.Set_s(label, TCollection_ExtendedString(name, True))


def placement(frame: Frame | None) -> TopLoc_Location:
    """Return the place of a frame, a new one each time.

    The kernel finds the name of an occurrence by product and place: the plain identity, which all share, would leave
    one mark for the planks of three shells.
    """
    move = gp_Trsf()
    if frame is not None:
        move.SetTransformation(gp_Ax3(gp_Pnt(*frame.origin), gp_Dir(*frame.z), gp_Dir(*frame.x)), gp_Ax3())
    return TopLoc_Location(move)


@contextmanager
def kernel_settings() -> Iterator[None]:
    """Set what the kernel keeps for the whole process, silence it, and put everything back afterwards."""
    STEPCAFControl_Controller.Init_s()
    texts = {name: Interface_Static.CVal_s(name) for name in _TEXT_SETTINGS}
    numbers = {name: Interface_Static.IVal_s(name) for name in _NUMBER_SETTINGS}
    naming = XCAFDoc_ShapeTool.AutoNaming_s()
    printers = [(printer, printer.GetTraceLevel()) for printer in Message.DefaultMessenger_s().Printers()]
    try:
        for printer, _level in printers:
            printer.SetTraceLevel(Message_Gravity.Message_Fail)
        for name, text in _TEXT_SETTINGS.items():
            Interface_Static.SetCVal_s(name, text)
        for name, number in _NUMBER_SETTINGS.items():
            Interface_Static.SetIVal_s(name, number)
        XCAFDoc_ShapeTool.SetAutoNaming_s(False)
        yield
    finally:
        for name, text in texts.items():
            Interface_Static.SetCVal_s(name, text)
        for name, number in numbers.items():
            Interface_Static.SetIVal_s(name, number)
        XCAFDoc_ShapeTool.SetAutoNaming_s(naming)
        for printer, level in printers:
            printer.SetTraceLevel(level)


def step_bytes(document: TDocStd_Document, name: str, description: str) -> bytes:
    """Return a document as the bytes of a STEP file that depend on the document alone; call it inside the settings.

    SolidError if the kernel cannot write it.
    """
    writer = STEPCAFControl_Writer()
    writer.SetNameMode(True)
    writer.SetColorMode(True)
    writer.SetLayerMode(False)
    writer.SetPropsMode(False)
    if not writer.Transfer(document, STEPControl_StepModelType.STEPControl_AsIs):
        raise SolidError(f"{name}: the kernel cannot turn the solids into STEP; check each of them on its own")
    _fill_header(writer, name, description)
    stream = io.BytesIO()
    if writer.WriteStream(stream) != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise SolidError(f"{name}: the kernel stopped while it wrote the STEP text; free some memory and write again")
    return _NOT_ASCII.sub(_directive, _neutral(stream.getvalue().decode("utf-8"))).encode("ascii")


def _fill_header(writer: STEPCAFControl_Writer, name: str, description: str) -> None:
    made = APIHeaderSection_MakeHeader(writer.ChangeWriter().Model())
    made.SetName(TCollection_HAsciiString(f"{name}.step"))
    made.SetTimeStamp(TCollection_HAsciiString(_NO_CLOCK))
    made.SetAuthorValue(1, TCollection_HAsciiString(_MAKER))
    made.SetOrganizationValue(1, TCollection_HAsciiString(_MAKER))
    made.SetOriginatingSystem(TCollection_HAsciiString(f"{_MAKER} {__version__}"))
    made.SetAuthorisation(TCollection_HAsciiString("none"))
    made.SetDescriptionValue(1, TCollection_HAsciiString(description))


def _neutral(text: str) -> str:
    """Return the STEP text without what depends on the process, not on the model.

    The kernel counts occurrences through the life of the process: the mark takes the place of that number. It lists the
    styles, which end the file, in the order of memory addresses: they are sorted by what they colour.
    """
    text = _OCCURRENCE.sub(r"NEXT_ASSEMBLY_USAGE_OCCURRENCE(\1,\1,\2,\3,\4,$)", text)
    first = _FIRST_STYLE.search(text)
    if first is None:
        return text
    end = text.index("ENDSEC;", first.start())
    return text[: first.start()] + _sorted_styles(text[first.start() : end]) + text[end:]


def _sorted_styles(block: str) -> str:
    """Return the records of a block, renumbered in the order of the older records that their roots point at."""
    records = {
        int(number): "".join(line.strip() for line in body.splitlines()) for number, body in _RECORD.findall(block)
    }
    lowest = min(records)
    links = {number: [int(link) for link in _REFERENCE.findall(body)] for number, body in records.items()}
    roots = set(records).difference(*links.values())
    order: dict[int, int] = {}

    def visit(number: int) -> None:
        if number >= lowest and number not in order:
            order[number] = lowest + len(order)
            for link in links[number]:
                visit(link)

    for root in sorted(roots, key=lambda number: min(links[number])):
        visit(root)
    return "".join(
        f"#{new} = {_REFERENCE.sub(lambda link: f'#{order.get(int(link[1]), link[1])}', records[old])};\n"
        for old, new in order.items()
    )


def _directive(found: re.Match[str]) -> str:
    """Return characters beyond ASCII as ISO 10303-21 spells them; the kernel writes them as UTF-8."""
    codes = [ord(character) for character in found[0]]
    if max(codes) > 0xFFFF:
        return "\\X4\\" + "".join(f"{code:08X}" for code in codes) + "\\X0\\"
    return "\\X2\\" + "".join(f"{code:04X}" for code in codes) + "\\X0\\"
