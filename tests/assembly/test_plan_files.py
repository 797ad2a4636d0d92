"""plan.json tells the whole plan by its schema and comes back equal; a damaged file is refused with the place."""

import json
import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import jsonschema
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from making import a_card, a_crew, a_step

from aag_cad.design import Design
from aag_cad.errors import AagError
from aag_cad.export.office.plan_files import gridshell_dossier
from aag_cad.findings import Finding
from aag_cad.language import LANGUAGES, printed, text
from aag_cad.parts.model import Gridshell, all_parts
from aag_cad.parts.quantities import mass
from aag_cad.planning import planned_source, read_source
from assembly.base.errors import PlanError
from assembly.base.phases import PHASES
from assembly.base.segments import Brace, Limits, PlankPiece
from assembly.base.steps import (
    Bracing,
    FastenersPut,
    Lashing,
    Plan,
    PropsAway,
    SplicePut,
    Station,
    Step,
    StepProp,
    WholeShell,
)
from assembly.booklet.plan_file import (
    Piece,
    PlanFile,
    TravellingSegment,
    gridshell_pieces,
    plan_file,
    plan_json,
    plan_schema,
    read_plan,
)
from assembly.booklet.step_words import step_words
from assembly.plan.planned import Planned, planned_of
from assembly.plan.schedule import schedule_of

LORRY = Limits(12000.0, 2400.0, 2600.0, 3000.0)

texts = st.text(max_size=12)
numbers = st.floats(allow_nan=False, allow_infinity=False)
vectors = st.tuples(numbers, numbers, numbers)
counts = st.integers(0, 99)


def some(items: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    return st.lists(items, max_size=3).map(tuple)


lines = st.integers(1, 99).map("S1-G-{:02d}".format)
beams = st.builds("S1-{}-{:02d}".format, st.sampled_from(["A1", "A2"]), st.integers(1, 99))
joints = st.builds("S{}-{}-{:03d}".format, st.integers(1, 9), st.sampled_from("KN"), st.integers(1, 999))
bolts = st.builds("{}-{}1".format, joints, st.sampled_from("BW"))
figures = st.one_of(texts, st.integers(), numbers)
sentences = st.one_of(
    texts,
    st.builds(lambda shell: text("site.stand.shell", shell=shell), figures),
    st.builds(lambda a, b, line: text("site.splice.title", a=a, b=b, line=line), figures, figures, figures),
    st.builds(
        lambda segment, others: text("site.stand.first", segment=segment, others=others),
        st.builds(lambda shell: text("site.stand.shell", shell=shell), figures),
        some(texts),
    ),
)
braces = st.builds(Brace, st.sampled_from(["bar", "tie", "diagonal"]), joints, joints, numbers)
opened = st.sampled_from(["divide", "splice"])
extras = st.one_of(
    st.builds(
        SplicePut,
        work=st.sampled_from(["made", "divide", "splice", "unmade"]),
        member=beams,
        line=lines,
        joint=st.one_of(st.just(""), joints),
        shape=st.sampled_from(["block", "plate"]),
        stations=st.lists(st.builds(Station, texts, numbers), min_size=1, max_size=2).map(tuple),
        length=numbers,
        bolts=counts,
        diameter=numbers,
    ),
    st.builds(FastenersPut, opened, lines, some(bolts)),
    st.builds(Lashing, opened, lines, texts),
    st.builds(Bracing, opened, texts, braces),
    st.builds(PropsAway, some(joints)),
    st.builds(WholeShell, some(texts), some(lines), numbers),
)
words = st.fixed_dictionaries(dict.fromkeys(LANGUAGES, texts))
pieces = st.builds(Piece, words, numbers, numbers, some(texts))
segments = st.builds(
    TravellingSegment,
    name=texts,
    shell=texts,
    geodesics=some(texts),
    parts=some(texts),
    pieces=some(st.builds(PlankPiece, texts, numbers, numbers)),
    mass=numbers,
    centre=vectors,
    size=vectors,
    lifting=some(texts),
    props=some(texts),
    braces=some(braces),
)
findings = st.builds(
    Finding,
    code=texts,
    severity=st.sampled_from(["error", "warning", "note"]),
    mark=texts,
    what=sentences,
    found=numbers,
    allowed=numbers,
    unit=texts,
    remedy=sentences,
)


@st.composite
def steps(draw: st.DrawFn, number: int) -> Step:
    """Return a step that waits for some of those before it."""
    phase = draw(st.sampled_from(PHASES))
    before = draw(st.sets(st.integers(1, number - 1), max_size=3)) if number > 1 else set()
    return Step(
        number=number,
        id=f"{number} {draw(texts)}",
        phase=phase,
        title=draw(sentences),
        shell=draw(texts),
        marks=draw(some(texts)),
        assemblies=draw(some(texts)),
        segments=draw(some(texts)),
        crew=draw(st.integers(1, 4)),
        gear=draw(st.booleans()),
        predecessors=tuple(map(str, sorted(before))),
        card=a_card(phase),
        notes=draw(some(sentences)),
        held=draw(st.booleans()),
        props=draw(some(st.builds(StepProp, joints, texts))),
        extras=draw(some(extras)),
    )


@st.composite
def plans(draw: st.DrawFn) -> Plan:
    """Return a plan of any steps in an order in which they can be done."""
    listed = [draw(steps(number)) for number in range(1, draw(st.integers(0, 4)) + 1)]
    names = {str(step.number): step.id for step in listed}
    ordered = (replace(s, predecessors=tuple(names[before] for before in s.predecessors)) for s in listed)
    return Plan(draw(texts), tuple(ordered), draw(some(findings)))


@st.composite
def files(draw: st.DrawFn) -> tuple[Plan, PlanFile]:
    """Return a plan and its file, with pieces and segments of any kind, with and without a first day."""
    plan, start = draw(plans()), draw(st.sampled_from([None, "2027-03-01"]))
    schedule = schedule_of(plan, {step.id: draw(st.integers(0, 900)) for step in plan.steps}, 4)
    file = plan_file(plan, schedule, a_crew(4, start=start), draw(some(pieces)))
    return plan, replace(file, segments=draw(some(segments)))


@pytest.fixture(scope="module")
def validator() -> jsonschema.Draft202012Validator:
    """An independent reader of the schema, which is itself one by the rules of JSON Schema."""
    jsonschema.Draft202012Validator.check_schema(plan_schema())
    return jsonschema.Draft202012Validator(plan_schema())


def strictly(told: str) -> Any:
    """Return what a text of JSON holds; NaN and Infinity are no JSON."""

    def refused(constant: str) -> None:
        raise ValueError(f"{constant} is no JSON")

    return json.loads(told, parse_constant=refused)


@settings(suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(files())
def test_any_plan_comes_back_equal_and_keeps_the_schema(
    validator: jsonschema.Draft202012Validator, case: tuple[Plan, PlanFile]
) -> None:
    plan, file = case
    told = plan_json(file)
    assert read_plan(told) == file
    assert read_plan(told).plan == replace(plan, findings=())
    validator.validate(strictly(told))


SOURCES = ("up", "down", "cut", "cut down", "kagome", "impossible")


@pytest.fixture(scope="module")
def cut(gridshell: Gridshell, design: Design) -> tuple[Gridshell, Planned]:
    """One shell of the vault, cut for a lorry."""
    one = replace(gridshell, shells=gridshell.shells[:1], blades=(), bolts=(), joints=())
    return one, planned_of(one, design.crew, LORRY)


@pytest.fixture(scope="module")
def written(
    planned: Planned, cut: tuple[Gridshell, Planned], gridshell: Gridshell, design: Design
) -> dict[str, tuple[Plan, PlanFile]]:
    """The plans and files of the vault, of a shell cut for transport, and of weaves of other people."""
    found: dict[str, tuple[Plan, PlanFile]] = {}
    for name, whole, plans in (("up", gridshell, planned), ("cut", *cut)):
        found[name] = plans.plan, gridshell_dossier(plans, whole, design.crew).file
        told = (plans.down, plans.down_schedule, design.crew, gridshell_pieces(whole), plans.segmentation)
        found["down" if name == "up" else "cut down"] = plans.down, plan_file(*told)
    for name in ("kagome", "impossible"):
        dossier = planned_source(read_source(name))
        found[name] = dossier.plan, dossier.file
    return found


@pytest.fixture(scope="module", params=SOURCES)
def case(request: pytest.FixtureRequest, written: dict[str, tuple[Plan, PlanFile]]) -> tuple[Plan, PlanFile]:
    """One of these plans and its file."""
    return written[request.param]


def test_plans_of_vaults_and_weaves_come_back_equal(case: tuple[Plan, PlanFile]) -> None:
    plan, file = case
    assert read_plan(plan_json(file)) == file
    assert file.plan == replace(plan, findings=())
    assert [(found.code, found.severity, found.mark) for found in file.findings] == [
        (found.code, found.severity, found.mark) for found in plan.findings
    ]


def test_an_independent_validator_finds_no_fault(
    case: tuple[Plan, PlanFile], validator: jsonschema.Draft202012Validator
) -> None:
    data = strictly(plan_json(case[1]))
    assert [f"{error.json_path}: {error.message}" for error in validator.iter_errors(data)] == []


def nulls(data: Any, path: str = "") -> Iterator[str]:
    """Yield where nothing stands: the last key of each way to a null."""
    if isinstance(data, dict):
        for key, value in data.items():
            yield from nulls(value, key)
    elif isinstance(data, list):
        for value in data:
            yield from nulls(value, path)
    elif data is None:
        yield path


def test_every_number_is_finite(case: tuple[Plan, PlanFile]) -> None:
    """NaN and Infinity would be refused or stand as null; nothing but times by the clock may be missing."""
    assert set(nulls(strictly(plan_json(case[1])))) <= {"begins", "ends"}


def test_steps_parts_and_findings_are_told_in_every_language(case: tuple[Plan, PlanFile]) -> None:
    plan, data = case[0], strictly(plan_json(case[1]))
    for step, told in zip(plan.steps, data["steps"], strict=True):
        assert set(told["words"]) == set(LANGUAGES)
        assert len({told["words"][language]["title"] for language in LANGUAGES}) == len(LANGUAGES)
        for language in LANGUAGES:
            expected = step_words(step, language)
            assert told["words"][language] == {
                "phase": expected.phase, "title": expected.title, "tools": [*expected.tools],
                "instructions": [*expected.instructions], "hold": expected.hold, "extras": [*expected.extras],
            }  # fmt: skip
    assert all(set(piece["name"]) == set(LANGUAGES) for piece in data["pieces"])
    for finding, told in zip(plan.findings, data["findings"], strict=True):
        assert told["what"] == {language: printed(finding.what, language) for language in LANGUAGES}
        assert told["remedy"] == {language: printed(finding.remedy, language) for language in LANGUAGES}


def test_the_pieces_of_the_vault_are_all_its_parts_with_their_masses(
    written: dict[str, tuple[Plan, PlanFile]], gridshell: Gridshell
) -> None:
    found = {mark: piece.mass for piece in written["up"][1].pieces for mark in piece.marks}
    weighed = {part.mark: mass(part, gridshell.timber) for part in all_parts(gridshell)}
    # Pieces are alike whose masses are alike to 0.1 g.
    assert found == pytest.approx(weighed, abs=1e-4)
    names = {piece.name["en"]: piece.name["de"] for piece in written["up"][1].pieces}
    assert names["Bolt M8 x 65"] == "Sechskantbolzen M8 x 65"


def test_a_shell_that_is_cut_travels_in_its_segments(
    written: dict[str, tuple[Plan, PlanFile]], cut: tuple[Gridshell, Planned]
) -> None:
    _, planned = cut
    for name in ("cut", "cut down"):
        told = {segment.name: segment for segment in written[name][1].segments}
        assert list(told) == ["S1.1", "S1.2", "S1.3"]
        for segment in planned.segmentation.segments:
            found = told[segment.name]
            assert (found.mass, found.parts, found.pieces) == (segment.mass, segment.parts, segment.pieces)
            assert (found.lifting, found.props, found.braces) == (segment.lifting.studs, segment.props, segment.braces)


def _file() -> dict[str, Any]:
    step = a_step(1, "Hoist", "hoist", shell="S1", assemblies=("S1",), extras=(PropsAway(("S1-K-015",)),))
    plan = Plan("vault", (step,))
    data: dict[str, Any] = strictly(plan_json(plan_file(plan, schedule_of(plan, {"s1": 60}, 1), a_crew(1), ())))
    return data


def _step(**changes: Any) -> Callable[[dict[str, Any]], None]:
    return lambda data: data["steps"][0]["step"].update(changes)


DAMAGES: list[tuple[Callable[[dict[str, Any]], Any], str]] = [
    (lambda data: data.update(schema_version=99), "schema_version 99, allowed 3"),
    (lambda data: data.pop("schema_version"), "schema_version None, allowed 3"),
    (lambda data: data.pop("steps"), r"steps: Field required"),
    (lambda data: data.update(language="en"), r"language: Unexpected keyword argument, found 'en'"),
    (lambda data: data["steps"].append({}), r"steps\.1\.step: Field required"),
    (lambda data: data["steps"][0]["step"].pop("marks"), r"steps\.0\.step\.marks: Field required"),
    (_step(phase="lunch"), r"steps\.0\.step\.phase: Input should be 'prefabricate'.*, found 'lunch'"),
    (_step(crew="4"), r"steps\.0\.step\.crew: Input should be a valid integer, found '4'"),
    (_step(crew=True), r"steps\.0\.step\.crew: Input should be a valid integer, found True"),
    (_step(marks=[1]), r"steps\.0\.step\.marks\.0: Input should be a valid string, found 1"),
    (_step(held=None), r"steps\.0\.step\.held: Input should be a valid boolean, found None"),
    (_step(extras=[{"kind": "props away"}]), r"steps\.0\.step\.extras\.0\.props away\.joints: Field required"),
    (_step(extras=[{"joints": []}]), r"steps\.0\.step\.extras\.0: Unable to extract tag using discriminator 'kind'"),
    (_step(extras=[{"kind": "flag"}]), r"steps\.0\.step\.extras\.0: Input tag 'flag' .* 'splice', 'fasteners'"),
    (_step(hold="Stop."), r"steps\.0\.step\.hold: Unexpected keyword argument, found 'Stop\.'"),
    (lambda data: data["steps"][0]["words"].pop("de"), r"steps\.0\.words: Dictionary should have at least 2 items"),
    (lambda data: data["steps"][0]["words"].update(fr={}), r"steps\.0\.words\.fr\.\S*: Input should be 'en' or 'de'"),
]


@pytest.mark.parametrize(("damage", "place"), DAMAGES)
def test_a_damaged_file_is_refused_with_the_place_and_by_the_schema(
    damage: Callable[[dict[str, Any]], Any], place: str, validator: jsonschema.Draft202012Validator
) -> None:
    data = _file()
    validator.validate(data)
    damage(data)
    with pytest.raises(PlanError, match=place):
        read_plan(json.dumps(data))
    assert not validator.is_valid(data)


@pytest.mark.parametrize(("told", "place"), [("{", "not valid JSON"), ("[]", "schema_version None, allowed")])
def test_what_is_no_object_of_json_is_refused(told: str, place: str) -> None:
    with pytest.raises(PlanError, match=place):
        read_plan(told)


def test_numbers_that_are_none_are_refused() -> None:
    for number in (math.nan, math.inf):
        piece = {"name": dict.fromkeys(LANGUAGES, "stone"), "mass": number, "length": 1.0, "marks": []}
        with pytest.raises(PlanError, match=r"pieces\.0\.mass: Input should be a finite number"):
            read_plan(json.dumps(_file() | {"pieces": [piece]}))


def test_a_plan_error_is_an_error_of_the_toolkit_and_a_wrong_value() -> None:
    assert issubclass(PlanError, AagError)
    assert issubclass(PlanError, ValueError)
