"""The IFC file of a shell that is cut for the journey: segments of its parts, and tasks by the one schedule."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import TypeAlias

import icalendar
import ifcopenshell
import ifcopenshell.util.element
import pytest
from ifctester import ids
from making import a_crew

from aag_cad.export.ifc.model import write_ifc
from aag_cad.export.ifc.schedule import PlannedWork
from aag_cad.export.office.plan_files import gridshell_dossier, write_plan_output
from aag_cad.parts.model import Gridshell, all_parts
from aag_cad.resources import template
from assembly.base.segments import Limits, Segmentation
from assembly.booklet.plan_file import read_plan
from assembly.plan.planned import planned_of

LORRY = Limits(12000.0, 2400.0, 2600.0, 3000.0)
# A Wednesday, so that the first week is a short one.
START = "2027-03-03"

# Title, begin and end of a step, by its number.
Times: TypeAlias = Mapping[int, tuple[str, datetime, datetime]]


@dataclass(frozen=True)
class Built:
    """What was written for one shell of the vault, and how it is cut."""

    gridshell: Gridshell
    segmentation: Segmentation
    folder: Path
    ifc: ifcopenshell.file


@pytest.fixture(scope="module")
def built(gridshell: Gridshell, tmp_path_factory: pytest.TempPathFactory) -> Built:
    one = replace(gridshell, shells=gridshell.shells[:1], blades=(), bolts=(), joints=())
    folder, crew = tmp_path_factory.mktemp("cut"), a_crew(4, start=START)
    planned = planned_of(one, crew, LORRY)
    for output in ("plan", "schedule"):
        write_plan_output(gridshell_dossier(planned, one, crew), output, folder)
    write_ifc(one, folder / "cut.ifc", PlannedWork(planned.plan, planned.schedule, crew, planned.segmentation))
    return Built(one, planned.segmentation, folder, ifcopenshell.open(str(folder / "cut.ifc")))


@pytest.fixture(scope="module")
def named(built: Built) -> dict[str, str]:
    """The segments that the file gives for each part."""
    parts = (each for each in built.ifc.by_type("IfcElement") if not each.is_a("IfcElementAssembly"))
    return {each.Name: ifcopenshell.util.element.get_pset(each, "AAG_Assembly", "Segment") for each in parts}


def test_every_part_names_the_segments_in_which_it_travels(built: Built, named: Mapping[str, str]) -> None:
    segments = built.segmentation.segments
    assert [segment.name for segment in segments] == ["S1.1", "S1.2", "S1.3"]
    assert set(named) == {part.mark for part in all_parts(built.gridshell)}
    for mark, name in named.items():
        homes = [s.name for s in segments if mark in s.parts or mark in {piece.plank for piece in s.pieces}]
        assert name == (" ".join(homes) or "S1"), mark


def test_a_plank_that_is_cut_names_both_its_segments(built: Built, named: Mapping[str, str]) -> None:
    cuts = [cut.plank for splice in built.segmentation.splices for cut in splice.cuts]
    assert cuts
    assert {mark for mark, name in named.items() if " " in name} == set(cuts)
    assert {named[mark] for mark in cuts} <= {"S1.1 S1.2", "S1.2 S1.3", "S1.1 S1.2 S1.3"}


def test_what_is_put_in_on_site_names_its_shell(built: Built, named: Mapping[str, str]) -> None:
    """Feet, cover, the fasteners that join segments, and what a splice takes the place of."""
    shell = built.gridshell.shells[0]
    on_site = {part.mark for parts in (shell.footings, shell.rods, shell.shoes) for part in parts}
    on_site |= {part.mark for parts in (shell.mullions, shell.strips, shell.clamps) for part in parts}
    joined = [joint for joint in shell.joints if joint.kind in ("cover", "foot", "footing")]
    on_site |= {mark for joint in joined for mark in joint.fasteners}
    on_site |= {joint.mark for joint in joined if joint.mark in joint.members} & set(named)
    on_site |= set(built.segmentation.site)
    on_site |= {mark for splice in built.segmentation.splices for mark in splice.left_out}
    assert {mark for mark, name in named.items() if name == "S1"} == on_site


def test_the_requirements_of_a_receiving_office_know_segments(built: Built) -> None:
    with template("ids/aag.ids").open("rb") as source:
        wanted = ids.from_string(source.read().decode("utf-8"))
    wanted.validate(built.ifc)
    (told,) = (each for each in wanted.specifications if each.name == "Every part knows its segment and step")
    assert told.status


def calendar_times(path: Path) -> Times:
    """Return the times of a calendar's events, whose titles begin with the number of their step."""
    found: dict[int, tuple[str, datetime, datetime]] = {}
    for event in icalendar.Calendar.from_ical(path.read_bytes()).walk("VEVENT"):
        number, _, title = str(event["SUMMARY"]).partition(" ")
        found[int(number)] = (title, event["DTSTART"].dt, event["DTEND"].dt)
    return found


def ifc_times(file: ifcopenshell.file) -> Times:
    """Return the scheduled times of a file's tasks by the numbers of their steps."""
    found: dict[int, tuple[str, datetime, datetime]] = {}
    for task in file.by_type("IfcTask"):
        number = ifcopenshell.util.element.get_pset(task, "AAG_Step", "StepNumber")
        begin, end = task.TaskTime.ScheduleStart, task.TaskTime.ScheduleFinish
        found[number] = (task.Name, datetime.fromisoformat(begin), datetime.fromisoformat(end))
    return found


def test_calendar_tasks_and_plan_tell_the_same_times(built: Built) -> None:
    calendar, tasks = calendar_times(built.folder / "schedule.ics"), ifc_times(built.ifc)
    assert tasks == calendar
    plan = read_plan((built.folder / "plan.json").read_text("utf-8"))
    told = {
        each.step.number: (each.words["en"].title, str(each.time.begins), str(each.time.ends)) for each in plan.steps
    }
    assert told == {n: (title, begin.isoformat(), end.isoformat()) for n, (title, begin, end) in tasks.items()}


def test_the_work_plan_lasts_from_the_first_morning_to_the_end_of_the_last_task(built: Built) -> None:
    times = ifc_times(built.ifc).values()
    assert min(begin for _, begin, _ in times) == datetime.fromisoformat(f"{START}T07:00:00")
    for control in (*built.ifc.by_type("IfcWorkPlan"), *built.ifc.by_type("IfcWorkSchedule")):
        assert control.StartTime == f"{START}T07:00:00"
        assert datetime.fromisoformat(control.FinishTime) == max(end for _, _, end in times)
