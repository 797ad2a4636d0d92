"""What every table of the design file is made of: numbers, texts, names."""

from typing import Annotated, TypeAlias

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

# Strict, because a key that reads "true" must not be built as one millimetre.
Number: TypeAlias = Annotated[float, Field(allow_inf_nan=False, strict=True)]
Positive: TypeAlias = Annotated[Number, Field(gt=0)]
NotNegative: TypeAlias = Annotated[Number, Field(ge=0)]
Count: TypeAlias = Annotated[int, Field(strict=True)]
Text: TypeAlias = Annotated[
    str, StringConstraints(strip_whitespace=True, min_length=1, max_length=80, pattern=r"^[^\x00-\x1f]+$")
]
Name: TypeAlias = Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9_-]*$", max_length=40)]


class DesignTable(BaseModel):
    """A table of the design file: extra keys are refused, values never change."""

    model_config = ConfigDict(extra="forbid", frozen=True)
