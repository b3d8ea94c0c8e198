from os import PathLike
from typing import Any, Iterable, Mapping, Sequence

import numpy as np
import pandas
from distributed import Client
from numpy.typing import NDArray

from .scene import Scene

PATIENCE: float

class Table:
    units: dict[str, str]
    def __init__(self, path: str | PathLike[str]) -> None: ...
    @property
    def names(self) -> list[str]: ...
    def __getitem__(self, name: str) -> NDArray[Any]: ...
    def __len__(self) -> int: ...
    def to_pandas(self) -> pandas.DataFrame: ...

def run(
    cases: str | PathLike[str] | Mapping[str, Any] | Iterable[Mapping[str, Any]],
    scene: Scene | str | PathLike[str] | None = None,
    output: str | PathLike[str] = "sweep",
    columns: str | Sequence[str] = (),
    workers: int | None = None,
    scheduler: str | Client | None = None,
    batch: int | None = None,
    progress: bool = False,
    growth: bool = False,
) -> Table: ...
def main(arguments: Sequence[str] | None = None) -> int: ...
