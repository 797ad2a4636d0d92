"""The reference vault, built once for all tests."""

import pytest

from aag_cad.design import Design, load_design


@pytest.fixture(scope="session")
def design() -> Design:
    """The shipped design of the reference vault."""
    return load_design("vault")
