from collections.abc import Callable
from typing import Any

__all__ = [
    "RunError",
    "SceneError",
    "__version__",
    "check",
    "edited",
    "formatted",
    "run",
    "text_of_file",
    "tree",
    "types",
]

__version__: str

class SceneError(ValueError): ...
class RunError(RuntimeError): ...

def types() -> str: ...
def tree(text: str, name: str) -> Any: ...
def text_of_file(path: str) -> str: ...
def formatted(text: str, name: str) -> str: ...
def edited(text: str, new: str, name: str) -> str: ...
def check(text: str, name: str) -> list[dict[str, Any]]: ...
def run(
    text: str,
    path: str,
    settings: dict[str, Any],
    progress: Callable[[str, float | None, float | None], None] | None,
) -> dict[str, Any]: ...
