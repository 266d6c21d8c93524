"""Scenarios with state spaces that no solver explores soon: many agents that walk about on their own."""

from __future__ import annotations


def many_walkers(walkers: int = 7, pois: int = 8) -> str:
    """The text; each walker multiplies the states by more than its POIs.

    All of them matter: the visitor calls in company of the first, who chats with the second, and so on.
    """
    lines = [f'poi "p{k}"' for k in range(pois)]
    lines += [f"connect p{k} and p{(k + 1) % pois} distance {k % 3 + 2}" for k in range(pois)]
    lines += ['event "call" collaborative', 'event "fetch" location p1']
    lines += [f'event "chat{k}" collaborative' for k in range(walkers)]
    lines += ['agent "bot" controllable mobile 1 location p0 can_do fetch', 'agent "visitor" location p0 can_do call']
    for k in range(walkers):
        others = f"can_do chat{k} reacts_to chat{(k - 1) % walkers}" + (", call" if k == 0 else "")
        lines.append(f'agent "walker{k}" mobile {k % 2 + 1} location p{k % pois} {others}')
    return "\n".join([*lines, "objective: if call then fetch within 30"]) + "\n"
