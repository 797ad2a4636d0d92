"""The Gantt chart, read back from its SVG."""

import re
from dataclasses import replace
from xml.etree import ElementTree

import pytest
from making import a_step

from aag_cad.design_making import Minutes
from aag_cad.parts.model import Gridshell
from assembly.base.phases import PHASES, Phase
from assembly.base.steps import Plan
from assembly.booklet.gantt import HEIGHT, WIDTH, gantt_svg
from assembly.plan.assembly_plan import plan_of
from assembly.plan.disassembly import disassembly_of
from assembly.plan.durations import step_minutes
from assembly.plan.schedule import Schedule, schedule_of

SVG = "{http://www.w3.org/2000/svg}"


def scheduled(plan: Plan, gridshell: Gridshell) -> Schedule:
    return schedule_of(plan, step_minutes(plan, gridshell, Minutes.model_validate({})), 4)


@pytest.fixture(scope="module", params=[plan_of, disassembly_of])
def sheet(request: pytest.FixtureRequest, gridshell: Gridshell) -> tuple[Plan, Schedule, ElementTree.Element]:
    plan = request.param(gridshell, 4, 25.0)
    schedule = scheduled(plan, gridshell)
    return plan, schedule, ElementTree.fromstring(gantt_svg(plan, schedule, "Chart <1>"))


def test_the_sheet_is_a4_across(sheet: tuple[Plan, Schedule, ElementTree.Element]) -> None:
    assert (sheet[2].get("width"), sheet[2].get("height")) == ("297mm", "210mm")


def test_every_step_is_numbered_once_and_every_shell_has_its_lane(
    sheet: tuple[Plan, Schedule, ElementTree.Element],
) -> None:
    plan, _, root = sheet
    words = [node.text for node in root.iter(f"{SVG}text") if node.get("font-size") in ("26", "21")]
    numbers = [word for word in words if word and word.isdigit() and int(word) > 4]
    assert sorted(map(int, numbers)) == list(range(5, len(plan.steps) + 1))
    assert {"S1", "S2", "S3", "Site", "Chart <1>"} <= {node.text for node in root.iter(f"{SVG}text")}


def test_nothing_leaves_the_sheet(sheet: tuple[Plan, Schedule, ElementTree.Element]) -> None:
    for node in sheet[2].iter(f"{SVG}rect"):
        if node.get("x") is not None:
            x, y, wide, high = (float(node.get(key, "nan")) for key in ("x", "y", "width", "height"))
            assert 0.0 <= x <= x + wide <= WIDTH
            assert 0.0 <= y <= y + high <= HEIGHT


def test_the_chart_is_black_white_and_grey(sheet: tuple[Plan, Schedule, ElementTree.Element]) -> None:
    colours = {str(node.get(key, "none")) for node in sheet[2].iter() for key in ("fill", "stroke")}
    plain = {colour for colour in colours if colour != "none" and not colour.startswith("url(#gantt-")}
    assert all(re.fullmatch(r"#(.)\1\1|#(..)\2\2", colour) for colour in plain)
    drawn = {node.get("id") for node in sheet[2].iter(f"{SVG}pattern")}
    assert {colour[5:-1] for colour in colours if colour.startswith("url")} <= drawn


def test_the_bars_are_as_long_as_the_steps() -> None:
    steps = (a_step(1, phase="hoist", shell="S1"), a_step(2, phase="hoist", shell="S1", predecessors=("s1",)))
    plan = Plan("two", steps)
    root = ElementTree.fromstring(gantt_svg(plan, schedule_of(plan, {"s1": 120, "s2": 240}, 2), "Two"))
    bars = [group[0] for group in root.iter(f"{SVG}g") if group.get("fill") == "#000" and len(group) == 1]
    wide = [float(bar.get("width", "0")) for bar in bars if bar.tag == f"{SVG}rect" and float(bar.get("x", "0")) > 200]
    assert wide[:2] == pytest.approx([2680.0 / 480 * 120, 2680.0 / 480 * 240], abs=0.1)


def test_every_phase_has_one_look_on_the_chart() -> None:
    def bar(phase: Phase) -> Plan:
        return Plan("one", (a_step(1, phase=phase, shell="S1"),))

    legends = set()
    for phase in PHASES:
        root = ElementTree.fromstring(gantt_svg(bar(phase), schedule_of(bar(phase), {"s1": 60}, 1), "One"))
        told = [node.text for node in root.iter(f"{SVG}text")]
        assert told[-1] == "no slack (critical)"
        legends.add(told[-2])
    assert len(legends) == 13


def test_the_same_schedule_gives_the_same_chart(gridshell: Gridshell) -> None:
    plan = plan_of(gridshell, 4, 25.0)
    charts = {gantt_svg(plan, scheduled(plan, gridshell), "A") for _ in range(2)}
    assert len(charts) == 1


def test_a_plan_without_steps_is_an_empty_sheet(gridshell: Gridshell) -> None:
    empty = replace(plan_of(gridshell, 4, 25.0), steps=())
    sheet = ElementTree.fromstring(gantt_svg(empty, schedule_of(empty, {}, 4), "Nothing"))
    words = "".join(sheet.itertext())
    assert "Nothing" in words
    assert not any(shell.mark in words for shell in gridshell.shells)
