"""The errors of the toolkit: one base, each kind also the built-in that it stands for."""


class AagError(Exception):
    """Base of every error that a user can mend; its text names the key or mark, the value, the range and the remedy."""


class DesignError(AagError, ValueError):
    """A design or an option that cannot be built: the text starts with the key's path or the option."""


class SurfaceError(AagError, ValueError):
    """A surface that carries no asymptotic curves where they are asked for (Gaussian curvature K >= 0)."""


class NetworkError(AagError, ValueError):
    """A web whose curves do not make a buildable network."""


class MarkError(AagError, ValueError):
    """A text that is not a mark of the grammar in ``aag_cad.parts.marks``."""


class SolidError(AagError, ArithmeticError):
    """A solid that came out invalid; the text names the mark."""


class FileError(AagError, OSError):
    """A file or folder that cannot be read or written."""
