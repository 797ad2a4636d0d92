"""summary.json: counts, figures, masses, findings, seconds and files of a build."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from aag_cad.audit import forming_stresses
from aag_cad.findings import Finding, finding_row
from aag_cad.language import Language
from aag_cad.mechanics.checks.supports import footing_checks
from aag_cad.model import Model
from aag_cad.network.extent import ShellExtent
from aag_cad.parts.blades import ridge_gaps
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import kind_of
from aag_cad.parts.model import Gridshell, all_parts, shell_parts
from aag_cad.parts.quantities import mass
from aag_cad.shop.purchases import Purchases, stock_summary
from aag_cad.shop.weights import PAPER_ROOF_KG_PER_M2, PAPER_ROOF_M2, roof_weight, shell_weights
from aag_cad.units import MM2_PER_M2, deg_per_m
from aag_cad.web.quality import WebQuality
from assembly.base.steps import Plan


def counts(gridshell: Gridshell) -> dict[str, int]:
    """Return how many parts of each kind there are, and of shells, beams and joints."""
    families = Counter(plank.family for plank in index_of(gridshell).planks.values())
    kinds = Counter(kind_of(part).name for part in all_parts(gridshell))
    return {
        "shells": len(gridshell.shells),
        "coupled beams": sum(len(shell.beams) for shell in gridshell.shells),
        **{f"planks {family}": families[family] for family in sorted(families)},
        **{f"{name}s": kinds[name] for name in sorted(kinds)},
        "joints": sum(len(shell.joints) for shell in gridshell.shells),
    }


def masses_per_shell(gridshell: Gridshell) -> dict[str, dict[str, float]]:
    """Return for each shell the mass in kg of each kind of part and of each material."""
    table = {}
    for shell in gridshell.shells:
        kilograms: Counter[str] = Counter()
        for part in shell_parts(shell):
            row, amount = kind_of(part), mass(part, gridshell.timber)
            kilograms[f"{row.name}s"] += amount  # type: ignore[assignment]
            kilograms[f"all {row.material}"] += amount  # type: ignore[assignment]
        table[shell.mark] = {name: round(float(kilograms[name]), 2) for name in sorted(kilograms)}
    return table


def figures(gridshell: Gridshell, web: WebQuality, extent: ShellExtent) -> dict[str, float]:
    """Return the figures that the paper states or that a designer looks for first."""
    stresses = forming_stresses(gridshell)
    timber = gridshell.timber
    return {
        "plan_area_m2": extent.plan_area * len(gridshell.shells) / MM2_PER_M2,
        "roof_area_m2": extent.roof_area * len(gridshell.shells) / MM2_PER_M2,
        "crown_height_mm": extent.crown_height,
        "entry_height_mm": extent.entry_height,
        "smallest_bending_radius_mm": min(extent.smallest_radius.values()),
        "largest_twist_deg_per_m": deg_per_m(max(extent.largest_twist.values())),
        "smallest_angle_aa_deg": web.angle_aa_deg.min,
        "largest_angle_aa_deg": web.angle_aa_deg.max,
        "smallest_angle_ag_deg": web.angle_ag_deg.min,
        "largest_angle_ag_deg": web.angle_ag_deg.max,
        "longest_plank_mm": max(plank.blank.length for plank in index_of(gridshell).planks.values()),
        "bending_utilisation": max(s.combined for s in stresses) / timber.bending_strength,
        "torsion_utilisation": max(s.torsion for s in stresses) / timber.shear_strength,
        "largest_unrolled_bow_mm": max(s.bow for s in stresses),
        "largest_edgewise_stress_n_per_mm2": max(s.edgewise for s in stresses),
        **_ridge_figures(gridshell),
    }


def _ridge_figures(gridshell: Gridshell) -> dict[str, float]:
    gaps = ridge_gaps(gridshell)
    return {} if gaps is None else {"smallest_ridge_gap_mm": gaps[0], "largest_ridge_gap_mm": gaps[1]}


def weights_of(gridshell: Gridshell, roof_m2: float) -> dict[str, Any]:
    """Return the weights of a shell by group and of the roof by area, beside those of the paper's vault."""
    return {
        "shell": [
            {"group": w.group, "kg": round(w.kg, 1), "paper_kg": w.paper_kg, "why": w.why}
            for w in shell_weights(gridshell)
        ],
        "roof_kg_per_m2": round(roof_weight(gridshell, roof_m2), 2),
        "paper_roof_kg_per_m2": PAPER_ROOF_KG_PER_M2,
        "why": f"the surfaces measure {roof_m2:.1f} m2 where the paper counts {PAPER_ROOF_M2:.0f} m2 of roof",
    }


def summary_of(
    model: Model,
    findings: Sequence[Finding],
    plan: Plan,
    purchases: Purchases,
    sizes: Mapping[str, int],
    seconds: Mapping[str, float],
    language: Language = "en",
) -> dict[str, Any]:
    """Return the summary as plain data; only ``seconds`` differs from one build of a design to the next.

    Findings of plans are said in ``language``.
    """
    gridshell, extent = model.gridshell, model.extent
    return {
        "design": gridshell.name,
        "title": gridshell.title,
        "counts": counts(gridshell),
        "figures": figures(gridshell, model.quality, extent),
        "web": asdict(model.quality),
        "mass_per_shell_kg": masses_per_shell(gridshell),
        "weights": weights_of(gridshell, extent.roof_area * len(gridshell.shells) / MM2_PER_M2),
        "supports": [asdict(check) for check in footing_checks(model.design, gridshell)][:1],
        "stock": stock_summary(purchases),
        "plan_steps": len(plan.steps),
        "findings": [finding_row(finding, language) for finding in findings],
        "files": dict(sizes),
        "seconds": {stage: round(value, 3) for stage, value in seconds.items()},
    }
