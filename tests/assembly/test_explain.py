"""Why a part comes when it does: every reason given is true of the plan and of the model."""

import re

import networkx as nx
import pytest

from aag_cad.language import Language, printed
from aag_cad.parts.model import Gridshell
from assembly.base.errors import PlanError
from assembly.booklet.step_words import step_title
from assembly.graph.gridshell_graph import assembly_graph
from assembly.plan.explain import explanation, step_of_parts
from assembly.plan.planned import Planned


@pytest.fixture(scope="module")
def graph(gridshell: Gridshell) -> "nx.MultiGraph[str]":
    return assembly_graph(gridshell)


def _told(planned: Planned, graph: "nx.MultiGraph[str]", mark: str, language: Language = "en") -> str:
    lines = explanation(graph, planned.plan, mark, planned.schedule, planned.locking)
    return "\n".join(printed(line, language) for line in lines)


def test_a_geodesic_comes_after_the_beams_under_it_and_before_those_over_it(
    planned: Planned, graph: "nx.MultiGraph[str]"
) -> None:
    earlier, later = _told(planned, graph, "S1-G-05").split("It cannot come later:")
    assert re.search(r"under it lies A1-\d\d", earlier)
    assert re.search(r"over it lies A2-\d\d", later)
    assert "A2-" not in earlier
    assert "fixed as number" in later
    assert "fastened by K-" in later


def test_every_step_named_as_earlier_has_a_lower_number(planned: Planned, graph: "nx.MultiGraph[str]") -> None:
    at = step_of_parts(planned.plan, graph)
    for mark in ("S1-A2-03", "S2-N-031", "S3-E-01", "S1-K-012-W1", "R12-03", "S2-P-04", "S1-F-05"):
        own = at.get(mark) or at[f"{mark}-L"]
        text = _told(planned, graph, mark)
        earlier, _, later = text.partition("It cannot come later:")
        _, _, earlier = earlier.partition("It cannot come earlier:")
        assert all(int(n) < own.number for n in re.findall(r"step (\d+)", earlier))
        assert all(int(n) > own.number for n in re.findall(r"step (\d+)", later))
        assert f"Step {own.number} ({step_title(own, 'en')})" in text


def test_a_plank_of_a_beam_is_made_before_it_is_laid(planned: Planned, graph: "nx.MultiGraph[str]") -> None:
    text = _told(planned, graph, "S1-A1-07-L")
    assert "It belongs to coupled beam S1-A1-07." in text
    assert text.index("Make beams") < text.index("Lay beams")


def test_a_mark_that_does_not_exist_is_refused_with_marks_that_do(
    planned: Planned, graph: "nx.MultiGraph[str]"
) -> None:
    with pytest.raises(PlanError, match=r"--explain S1-G-5: no part .* S1-G-05"):
        _told(planned, graph, "S1-G-5")


def test_the_explanation_prints_in_german(planned: Planned, graph: "nx.MultiGraph[str]") -> None:
    text = _told(planned, graph, "S1-G-05", "de")
    assert "Früher geht nicht:" in text
    assert "5,08 Hz" in text
    assert "step" not in text
