"""Random small games with conditions: both engines find the same, what is won is proven, and its missions end well.

In these missions the judge evaluates conditions directly, on places and states: a mission that is lost, or is not lost
where the condition is broken, is a problem.
"""

from __future__ import annotations

from typing import Optional, Tuple

from hypothesis import assume, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError, Severity
from pursue_gen.language import check, parse
from pursue_gen.language.conditions import (
    AllOf,
    AnyOf,
    At,
    AtMostOf,
    Condition,
    Doing,
    Holds,
    Not,
    OnWay,
    Who,
    condition_text,
)
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import Solution, solution
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tools.simulation.mission import simulate_mission
from pursue_gen.tools.simulation.outcome import GOAL, SAFE, Settings
from pursue_gen.tools.simulation.stage import stage_of
from pursue_gen.workspace import Options
from tests.conditions import ref
from tests.oracle import ENGINES

STORY = """\
poi "a"
poi "b"
connect a and b distance {distance}{way}
event "work" location b duration 2{work}
event "call"{call}
state "noisy": initially false, true_if call false_if work
agent "bot" controllable mobile 1 location {start} can_do work
agent "guest" mobile 2 location {guest} can_do call
{objective}
"""

WHO = st.sampled_from([Who(ref("bot")), Who(ref("guest")), Who(None), Who(None, robots=True)])
ATOMS: st.SearchStrategy[Condition] = (
    st.builds(At, WHO, st.sampled_from("ab").map(ref))
    | st.builds(OnWay, WHO)
    | st.builds(lambda who, either: OnWay(who, ref("b"), ref("a"), either), WHO, st.booleans())
    | st.builds(AtMostOf, st.integers(0, 1), st.just((At(Who(None), ref("a")),)))
    | st.builds(Doing, st.just(Who(ref("bot"))), st.just(ref("work")))
    | st.builds(Holds, st.just(ref("noisy")), st.booleans())
)
LITERALS = ATOMS | ATOMS.map(Not)
PAIRS = st.lists(LITERALS, min_size=2, max_size=2).map(tuple)
CONDITIONS = (LITERALS | PAIRS.map(AllOf) | PAIRS.map(AnyOf)).map(condition_text)


@st.composite
def games(draw: st.DrawFn) -> Tuple[str, Scenario]:
    """A scenario without errors, and its text."""

    def maybe() -> str:
        return f" only_if {draw(CONDITIONS)}" if draw(st.booleans()) else ""

    reach = draw(st.sampled_from(["", "reach_objective: do work", "reach_objective: do work after 6"]))
    forms = ["objective: avoid {}", "objective: always {}"] + ([""] if reach else [])
    safety = draw(st.sampled_from(forms)).format(draw(CONDITIONS))
    text = STORY.format(
        distance=draw(st.integers(1, 3)), way=maybe(), work=maybe(), call=maybe(), start=draw(st.sampled_from("ab")),
        guest=draw(st.sampled_from("ab")), objective="\n".join(part for part in (safety, reach) if part),
    )  # fmt: skip
    scenario = parse(text, "story.pur", "story")
    assume(all(finding.severity is not Severity.ERROR for finding in check(scenario)))
    return text, scenario


def outcome(scenario: Scenario, engine: str) -> Optional[Solution]:
    """The proven solution, None where the game is lost."""
    try:
        options = SolveOptions(engine=ENGINES[engine])
        return solution(translate(scenario), scenario_objective(scenario), DEFAULT, options)
    except PursueError as problem:
        assert problem.exit_status == 4, problem
        return None


@given(games())
@settings(max_examples=25)
def test_engines_agree_and_missions_keep_what_is_promised(drawn: Tuple[str, Scenario]) -> None:
    text, scenario = drawn
    won, again = outcome(scenario, "native"), outcome(scenario, "python")
    assert (won is None) == (again is None), text
    if won is None:
        return
    stage = stage_of(scenario, won, Options())
    for seed in range(3):
        ended = simulate_mission(stage, Settings("random", until=60.0), seed)
        assert ended.end in (GOAL, SAFE), (ended.reason, text)
