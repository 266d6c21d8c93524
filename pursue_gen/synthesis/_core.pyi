"""What the native engine (core/module.cpp) offers."""

from typing import Any, Dict

INF: int

class LimitReached(Exception): ...

def solve(game: Dict[str, Any], seconds: float = 0.0, states: int = 0) -> Dict[str, Any]: ...
