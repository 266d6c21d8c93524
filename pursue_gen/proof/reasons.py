"""Why a strategy fails, in words: the kind of failure first."""

BAD = "bad: the location that must be avoided is reached"
OTHER_NAMES = "other names: not all blocks name what the strategy speaks of, in the network's order"
NO_BLOCK = "no block: the strategy does not know this discrete state"
NOT_COVERED = "not covered: the strategy does not say what to do here"
BLOCKED = "time is blocked: an invariant ends, no command comes and its owner cannot move"
NO_END = "time is blocked: it cannot reach the end of a strict invariant"
WAITS_FOR_EVER = "waits for ever: no command comes and nothing obliges anyone to move"
NOT_ENABLED = "not enabled: the command's guard or an invariant does not hold here"
TOO_LATE = "may come too late: the command is no longer enabled when it takes effect here"
CONTRADICTION = "contradiction: the strategy says both to wait and to act here"
NOT_CONTROLLABLE = "not controllable: the command takes an edge of the environment"
NO_JOINT_MOVE = (
    "not a joint move: not exactly the sender and all who receive, the integers do not allow it, or it changes nothing"
)
FOR_EVER = "for ever: a play comes back to where it was and need not reach the goal"
NO_PROGRESS = "no progress: {} leads no nearer to the goal"
LIMIT = "limit: not decided within {} symbolic states"

IN_ORDER = (
    BAD,
    NO_BLOCK,
    NO_PROGRESS,
    NOT_COVERED,
    BLOCKED,
    NO_END,
    WAITS_FOR_EVER,
    NOT_ENABLED,
    TOO_LATE,
    CONTRADICTION,
    NOT_CONTROLLABLE,
    NO_JOINT_MOVE,
    FOR_EVER,
    LIMIT,
)
"""As delays.hpp numbers them."""
