from os import PathLike

from .scene import Scene

def cost(scene: Scene | str | PathLike[str], output: str | PathLike[str], name: str = "scene", threads: int | None = None) -> list[dict[str, str]]: ...
