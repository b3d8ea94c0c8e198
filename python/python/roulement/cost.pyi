from os import PathLike

from .scene import Scene

def cost(scene: Scene, output: str | PathLike[str], name: str = "scene", threads: int | None = None) -> list[dict[str, str]]: ...
