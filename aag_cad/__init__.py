"""Design and fabrication of strained timber gridshells from asymptotic and geodesic planks."""

from importlib.metadata import version

__version__ = version("aag-toolkit")
