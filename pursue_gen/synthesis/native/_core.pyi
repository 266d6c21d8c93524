"""What the native engine (module.cpp) offers."""

from typing import Any, Callable, Dict, Optional

class LimitReached(Exception): ...

def solve(
    game: Dict[str, Any],
    seconds: float = 0.0,
    states: int = 0,
    memory_mib: int = 0,
    progress: Optional[Callable[[int, int, float, int], None]] = None,
    small_budget: float = 5e5,
    work: int = 0,
    soonest: bool = False,
    wall: bool = False,
) -> Dict[str, Any]: ...
