"""How long gridshells take to write as IFC and GLB, and what a reader in JavaScript makes of the IFC file."""

import json
import re
import shutil
import subprocess
import time
from dataclasses import replace
from pathlib import Path

import ifcopenshell
import ifcopenshell.validate
import pytest
from making import work_of
from pytest_benchmark.fixture import BenchmarkFixture

from aag_cad.export.cad.gltf import write_glb
from aag_cad.export.ifc.model import write_ifc
from aag_cad.export.ifc.options import IFC_SCHEMAS, IfcOptions, IfcSchema
from aag_cad.parts.model import Gridshell, Shell, all_parts
from aag_cad.parts.quantities import gross_volume
from aag_cad.parts.store import gridshell_json, read_gridshell
from aag_cad.units import MM3_PER_M3

# Marks, volumes in m3 of all bodies; circles drawn with 180 chords, or fasteners are 5 % off.
_READER = """
import * as WebIfc from 'web-ifc'; import fs from 'fs';
const api = new WebIfc.IfcAPI(); await api.Init();
const model = api.OpenModel(new Uint8Array(fs.readFileSync(process.argv[2])), { CIRCLE_SEGMENTS: 180 });
const volumes = {};
api.StreamAllMeshes(model, (mesh) => {
  let sum = 0;
  for (let i = 0; i < mesh.geometries.size(); i++) {
    const shape = api.GetGeometry(model, mesh.geometries.get(i).geometryExpressID);
    const v = api.GetVertexArray(shape.GetVertexData(), shape.GetVertexDataSize());
    const f = api.GetIndexArray(shape.GetIndexData(), shape.GetIndexDataSize());
    const t = mesh.geometries.get(i).flatTransformation;
    const det = t[0] * (t[5] * t[10] - t[6] * t[9]) - t[4] * (t[1] * t[10] - t[2] * t[9])
      + t[8] * (t[1] * t[6] - t[2] * t[5]);
    for (let k = 0; k < f.length; k += 3) {
      const [a, b, c] = [f[k], f[k + 1], f[k + 2]].map((n) => [v[6 * n], v[6 * n + 1], v[6 * n + 2]]);
      sum += det * (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6;
    }
  }
  volumes[api.GetLine(model, mesh.expressID).Name.value] = sum;
});
fs.writeFileSync(process.argv[3], JSON.stringify(volumes));
"""


def of_shells(gridshell: Gridshell, count: int) -> Gridshell:
    """Return a gridshell of so many copies of the first shell, with marks of their own."""
    one = replace(gridshell, shells=gridshell.shells[:1], blades=(), bolts=(), joints=())
    text, shells = gridshell_json(one), list[Shell]()
    for number in range(1, count + 1):
        shells += read_gridshell(re.sub(r'"S1(?=["-])', f'"S{number}', text)).shells
    return replace(one, shells=tuple(shells))


def test_write_three_shells_with_every_bolt_as_ifc(
    benchmark: BenchmarkFixture, gridshell: Gridshell, tmp_path: Path
) -> None:
    benchmark(write_ifc, gridshell, tmp_path / "vault.ifc", work_of(gridshell, 6))
    assert 1e6 < (tmp_path / "vault.ifc").stat().st_size < 8e6


@pytest.mark.parametrize("count", [1, 3, 9])
def test_time_grows_with_the_number_of_shells(
    benchmark: BenchmarkFixture, gridshell: Gridshell, tmp_path: Path, count: int
) -> None:
    many = of_shells(gridshell, count)
    benchmark.pedantic(write_ifc, (many, tmp_path / "many.ifc"), rounds=1)
    written = ifcopenshell.open(str(tmp_path / "many.ifc"))
    shells = [e for e in written.by_type("IfcElementAssembly") if e.ObjectType == "Shell"]
    assert len(shells) == count


def test_ten_times_the_shells_take_at_most_twelve_times_as_long(gridshell: Gridshell, tmp_path: Path) -> None:
    seconds = []
    for count in (3, 30):
        many = of_shells(gridshell, count)
        start = time.perf_counter()
        write_ifc(many, tmp_path / f"{count}.ifc")
        seconds.append(time.perf_counter() - start)
    assert seconds[1] <= 12.0 * seconds[0]


@pytest.mark.parametrize("schema", IFC_SCHEMAS)
def test_the_whole_vault_keeps_all_rules_of_every_schema(
    gridshell: Gridshell, tmp_path: Path, schema: IfcSchema
) -> None:
    write_ifc(gridshell, tmp_path / "vault.ifc", work_of(gridshell, 6), IfcOptions(schema=schema))
    logger = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(ifcopenshell.open(str(tmp_path / "vault.ifc")), logger, express_rules=True)
    assert logger.statements == []


@pytest.mark.parametrize("schema", IFC_SCHEMAS)
def test_web_ifc_sees_every_part_with_its_volume(gridshell: Gridshell, tmp_path: Path, schema: IfcSchema) -> None:
    """1e-3, as with the other readers. Needs Node, and npm fetches web-ifc."""
    npm, node = shutil.which("npm"), shutil.which("node")
    assert npm, "npm is missing: install Node"
    assert node, "node is missing: install Node"
    write_ifc(gridshell, tmp_path / "vault.ifc", options=IfcOptions(schema=schema))
    subprocess.run([npm, "install", "--silent", "--prefix", str(tmp_path), "web-ifc"], check=True, timeout=300)
    (tmp_path / "reader.mjs").write_text(_READER)
    subprocess.run([node, "reader.mjs", "vault.ifc", "volumes.json"], check=True, cwd=tmp_path, timeout=300)
    volumes = json.loads((tmp_path / "volumes.json").read_text())
    parts = {part.mark: part for part in all_parts(gridshell)}
    assert set(volumes) == set(parts)
    for mark, volume in volumes.items():
        assert volume * MM3_PER_M3 == pytest.approx(gross_volume(parts[mark]), rel=1e-3), mark


def test_write_three_shells_with_every_bolt_as_glb(
    benchmark: BenchmarkFixture, gridshell: Gridshell, tmp_path: Path
) -> None:
    benchmark(write_glb, gridshell, tmp_path / "vault.glb")
    assert 1e5 < (tmp_path / "vault.glb").stat().st_size < 2e6
