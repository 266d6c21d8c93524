"""What the native checker (module.cpp) offers."""

from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

class Tables:
    def __init__(self, network: Dict[str, Any], blocks: List[Any], constraints: List[Tuple[int, int, int]]) -> None: ...

class Loop:
    def __init__(self, tables: Tables, settings: Dict[str, Any]) -> None: ...
    def search(self, task: Dict[str, Any], poll: Callable[[int, int], None]) -> Dict[str, Any]: ...

def simplify(
    tables: Tables, factor: int, late: int, ranks: Optional[Sequence[int]], poll: Callable[[int, int], None]
) -> List[List[List[List[Tuple[int, int, int]]]]]: ...
