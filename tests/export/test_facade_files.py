"""Flat patterns as DXF, read back, and the table of the cover."""

import csv
import re
from dataclasses import replace
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from ezdxf.document import Drawing

from aag_cad.design import Design
from aag_cad.export.workshop.facade_patterns import (
    FACADE_HEADER,
    StripPattern,
    edge_ordinates,
    strip_patterns,
    write_facade_table,
    write_flat_patterns,
)
from aag_cad.network.model import CurveNetwork
from aag_cad.parts.build import gridshell_from
from aag_cad.parts.facade import covered, placed_facade
from aag_cad.parts.model import Gridshell
from aag_cad.parts.quantities import mass


@pytest.fixture(scope="module")
def clad(design: Design, network: CurveNetwork) -> Gridshell:
    """One covered shell of the vault."""
    bare = design.model_copy(update={"facade": design.facade.model_copy(update={"cover": False})})
    gridshell = gridshell_from(bare, network)
    shell = covered(gridshell.shells[0], placed_facade(design, network, gridshell.shells[0]))
    return replace(gridshell, shells=(shell,))


@pytest.fixture(scope="module")
def patterns(clad: Gridshell) -> list[StripPattern]:
    return strip_patterns(clad)


@pytest.fixture(scope="module")
def folder(design: Design, clad: Gridshell, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("facade")
    write_flat_patterns(design, clad, path)
    write_facade_table(design, clad, path / "facade.csv")
    return path


@pytest.fixture(scope="module")
def peaked(folder: Path) -> Drawing:
    return ezdxf.readfile(folder / "P-07.dxf")


def texts(drawing: Drawing) -> list[str]:
    return [text.dxf.text for text in drawing.modelspace().query("TEXT")]


def test_there_is_a_sound_drawing_in_mm_for_each_flat_pattern(folder: Path, patterns: list[StripPattern]) -> None:
    assert sorted(path.stem for path in folder.glob("*.dxf")) == [f"P-{i:02d}" for i in range(1, 14)]
    for pattern in patterns:
        drawing = ezdxf.readfile(folder / f"{pattern.name}.dxf")
        assert not drawing.audit().errors
        assert drawing.header["$INSUNITS"] == 4


def test_the_outline_read_back_is_the_flat_pattern(folder: Path, patterns: list[StripPattern]) -> None:
    for pattern in patterns:
        drawing = ezdxf.readfile(folder / f"{pattern.name}.dxf")
        (outline,) = drawing.modelspace().query('LWPOLYLINE[layer=="OUTLINE"]')
        points = np.array([(x, y) for x, y, *_ in outline.get_points()])
        assert outline.closed
        assert points == pytest.approx(pattern.flat.outline, abs=1e-3)
        # No chord leaves the curved edge by 0.01 mm: s^2 / 8 R with the points' own spacing and curvature.
        for edge in (pattern.flat.left, pattern.flat.right):
            bends = np.linalg.norm(edge[:-2] - 2.0 * edge[1:-1] + edge[2:], axis=1) / 8.0
            assert bends.max() < 0.01


def test_the_check_bar_is_100_mm_long(peaked: Drawing) -> None:
    bar = max(
        peaked.modelspace().query('LINE[layer=="CHECK_BAR"]'), key=lambda line: abs(line.dxf.end[0] - line.dxf.start[0])
    )
    assert abs(bar.dxf.end[0] - bar.dxf.start[0]) == 100.0


def test_ordinates_in_the_table_are_those_of_the_edge(patterns: list[StripPattern], peaked: Drawing) -> None:
    pattern = next(pattern for pattern in patterns if pattern.name == "P-07")
    ordinates = edge_ordinates(pattern.flat.left)
    assert [station for station, _ in ordinates[:3]] == [0.0, 250.0, 500.0]
    assert (ordinates[0][1], ordinates[-1][1]) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert max(ordinate for _, ordinate in ordinates) == pytest.approx(pattern.flat.left_sagitta, abs=0.2)
    written = texts(peaked)
    assert {f"{ordinate + 0.0:.1f}" for _, ordinate in ordinates[1:-2]} <= set(written)
    assert {"edge on G-07", "edge on G-08"} <= set(written)


def test_a_drawing_names_its_strips_and_its_mirror_image(folder: Path, patterns: list[StripPattern]) -> None:
    assert [pattern.mirror for pattern in patterns] == [f"P-{i:02d}" if i != 7 else "" for i in range(13, 0, -1)]
    written = texts(ezdxf.readfile(folder / "P-02.dxf"))
    assert any(re.match(r"cut 1: P-02; mirror image of P-12", line) for line in written)


def test_equal_strips_of_all_shells_share_a_drawing(design: Design, clad: Gridshell, tmp_path: Path) -> None:
    shell = clad.shells[0]
    other = replace(shell, strips=tuple(replace(s, mark=s.mark.replace("S1", "S2")) for s in shell.strips))
    both = replace(clad, shells=(shell, other))
    write_flat_patterns(design, both, tmp_path)
    assert len(list(tmp_path.glob("*.dxf"))) == 13
    assert any(line.startswith("cut 2: S1-P-01, S2-P-01;") for line in texts(ezdxf.readfile(tmp_path / "P-01.dxf")))


def test_the_same_model_gives_the_same_bytes(design: Design, clad: Gridshell, folder: Path, tmp_path: Path) -> None:
    write_flat_patterns(design, clad, tmp_path)
    write_facade_table(design, clad, tmp_path / "facade.csv")
    files = sorted(path.name for path in folder.iterdir())
    assert all((folder / name).read_bytes() == (tmp_path / name).read_bytes() for name in files)


def test_the_table_lists_strips_and_bars(
    design: Design, clad: Gridshell, folder: Path, patterns: list[StripPattern]
) -> None:
    with (folder / "facade.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert tuple(rows[0]) == FACADE_HEADER
    by_kind = {kind: [row for row in rows if row["kind"] == kind] for kind in ("strip", "mullion", "clamping bar")}
    assert [len(listed) for listed in by_kind.values()] == [13, 14, 14]
    strip = by_kind["strip"][6]
    flat = patterns[6].flat
    assert float(strip["length_mm"]) == pytest.approx(flat.length, abs=0.05)
    assert float(strip["left_sagitta_mm"]) == pytest.approx(flat.left_sagitta, abs=0.05)
    assert float(strip["mass_kg"]) == pytest.approx(flat.area * 1e-6 * design.facade.sheet_mass, abs=1e-3)
    assert strip["stock_mm"] == "5500"
    bars = (*clad.shells[0].mullions, *clad.shells[0].clamps)
    total = sum(float(row["mass_kg"]) for row in by_kind["mullion"] + by_kind["clamping bar"])
    assert total == pytest.approx(sum(mass(bar, clad.timber) for bar in bars), abs=0.03)
