"""The legend of colours: what has which colour in every file and picture, as sRGB hexadecimal codes.

Things that touch differ in lightness by 15 of 100 at least, so that they are told apart in grey print too.
"""

from aag_cad.families import FAMILIES

LEGEND: dict[str, str] = {
    **{family: row.colour for family, row in FAMILIES.items()},
    "stud": "#dcc39a",
    "block": "#f3e9d2",
    "steel": "#808b96",
    "aluminium": "#3d5a6c",
    "sheet": "#cfe6f2",
    "concrete": "#b9b6ae",
}


def srgb(code: str) -> tuple[float, float, float]:
    """Return red, green and blue of a code, each 0 to 1, as screens, IFC, STEP and 3dm take them."""
    return int(code[1:3], 16) / 255.0, int(code[3:5], 16) / 255.0, int(code[5:7], 16) / 255.0


def linear(code: str) -> tuple[float, float, float]:
    """Return the intensities of red, green and blue of a code, each 0 to 1, as glTF takes them (IEC 61966-2-1)."""
    red, green, blue = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in srgb(code))
    return red, green, blue


def mixed(code: str, other: str, share: float) -> str:
    """Return a code with a share (0 to 1) of another one in it, by their sRGB numbers: tints and shades."""
    pairs = zip(srgb(code), srgb(other), strict=True)
    return "#" + "".join(f"{round(255.0 * ((1.0 - share) * a + share * b)):02x}" for a, b in pairs)
