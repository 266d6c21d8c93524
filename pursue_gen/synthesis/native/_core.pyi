"""What the native engine (module.cpp) offers."""

from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

class LimitReached(Exception): ...

def solve(
    game: Dict[str, Any],
    seconds: float = 0.0,
    states: int = 0,
    memory_mib: int = 0,
    work: int = 0,
    wall: bool = False,
    progress: Optional[Callable[[int, int, float, int], None]] = None,
    small_budget: float = 5e5,
    soonest: bool = False,
) -> Dict[str, Any]: ...
def guess(
    game: Dict[str, Any],
    seconds: float = 0.0,
    states: int = 0,
    memory_mib: int = 0,
    work: int = 0,
    wall: bool = False,
    progress: Optional[Callable[[int, int, float, int], None]] = None,
    late: Sequence[int] = (),
) -> Dict[str, Any]: ...
def minimal(dim: int, matrix: Tuple[int, ...]) -> List[Tuple[int, int, int]]: ...
