"""The error of assembly planning."""

from aag_cad.errors import AagError


class PlanError(AagError, ValueError):
    """A gridshell that cannot be put together as it is drawn, or a text that is not an assembly plan."""
