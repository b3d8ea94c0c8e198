from os import PathLike
from typing import Any

from .scene import Scene

KEYS: tuple[str, ...]

def bearing(
    designation: str | None = None,
    *,
    candidate: int = 1,
    shelf: str | PathLike[str] | None = None,
    bore: float | str | None = None,
    outside: float | str | None = None,
    width: float | str | None = None,
    dynamic_load_rating: float | str | None = None,
    static_load_rating: float | str | None = None,
    contact_angle: float | str | None = None,
    clearance: str | None = None,
) -> Scene: ...
def candidates(
    designation: str | None = None,
    *,
    shelf: str | PathLike[str] | None = None,
    bore: float | str | None = None,
    outside: float | str | None = None,
    width: float | str | None = None,
    dynamic_load_rating: float | str | None = None,
    static_load_rating: float | str | None = None,
    contact_angle: float | str | None = None,
    clearance: str | None = None,
) -> list[dict[str, Any]]: ...
def names() -> list[str]: ...
