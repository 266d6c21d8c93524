"""From a strategy to one sub-strategy per controller (what the thesis calls UP2SUBCO)."""

from pursue_gen.partition.split import (
    CENTRALIZED,
    DISTRIBUTED,
    GENERAL,
    SubStrategy,
    partition,
    unneeded,
    unneeded_words,
)

__all__ = ["CENTRALIZED", "DISTRIBUTED", "GENERAL", "SubStrategy", "partition", "unneeded", "unneeded_words"]
