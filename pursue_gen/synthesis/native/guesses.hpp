// Which policies are tried, one after the other.
#pragma once

#include "forward.hpp"

namespace pursue {

inline Guess excursions(Trips trips) {
    Guess out;
    out.trips = trips;
    return out;
}

// One after the other.
inline const std::vector<Guess> GUESSES = {
    {Next::in_turn, true, Idle::stays, 1, false}, {Next::in_turn, true, Idle::stays, 1, true, true}, {Next::in_turn, true},
    {Next::in_turn, true, Idle::goes_home},       excursions(Trips::several),
    excursions(Trips::one),                       {Next::in_turn, true, Idle::goes_to_post},
    {Next::nearest, true, Idle::stays, 4, true, false, {}, 0, false, true},
    {Next::in_turn, false},                       {Next::in_turn, false, Idle::goes_home},
    {Next::soonest_due, true},                    {Next::soonest_due, true, Idle::goes_home},
    {Next::soonest_due, true, Idle::goes_to_post},
    {Next::nearest, false},                       {Next::nearest, false, Idle::goes_home},
    {Next::in_turn, true, Idle::stays, 4},        {Next::soonest_due, true, Idle::stays, 4},
    {Next::in_turn, true, Idle::stays, 1, false, false, {}, 0, false, false, Alternates::visits},
    {Next::in_turn, true, Idle::stays, 1, false, false, {}, 0, false, false, Alternates::long_limits},
    {Next::in_turn, true, Idle::prepares},        {Next::in_turn, true, Idle::prepares, 16},
};

// Likewise, where patrols wait until they are due, as late as is won.
inline std::vector<Guess> late_guesses(const std::vector<int>& patrols) {
    std::vector<Guess> out;
    for (const int reserve : {5, 10, 15, 20, 25, 30, 45, 60})
        for (Guess guess : GUESSES) {
            guess.patrols = patrols;
            guess.reserve = reserve;
            if (guess.next != Next::in_turn || !guess.shared_out || guess.zones > 1) continue;
            if (guess.trips != Trips::none) {
                out.push_back(guess);
                continue;
            }
            for (const bool sets_off : {false, true}) {
                guess.sets_off = sets_off;
                out.push_back(guess);
            }
            guess.visits_first = true;
            if (guess.idle == Idle::stays && guess.alternates == Alternates::nothing) out.push_back(guess);
        }
    return out;
}

inline const std::vector<Charging> CHARGINGS = {Charging::in_turn, Charging::until_called, Charging::when_idle};

inline constexpr std::size_t ZONES_OF_CALLS = 16;  // a charge that a call breaks off has each time gone on for another while
inline constexpr std::size_t FEW_FOLLOWED = 1000;  // states at clocks: what a policy is given first where robots may take turns

// Whether a policy is the same as another that is tried, or of no use.
template <class Z>
bool is_needless(const Forward<Z>& forward, const Guess& guess, const Duties& duties) {
    const Tasks& tasks = forward.tasks();
    if (!guess.shared_out && (forward.robots() < 2 || (guess.next == Next::in_turn && !tasks.has_choice()))) return true;
    if ((guess.needs_several() && !tasks.has_several()) || (guess.relieved && !tasks.has_guards())) return true;
    if (!forward.applies()) return true;
    if (guess.alternates == Alternates::long_limits && !forward.alternates()) return true;
    return guess.visits_first && guess.patrols.size() == duties.watching().size();  // nobody calls
}

// The first policy that wins, or none. `joints`, `duties`: of the game. `turns`: of those by which robots leave their homes
// in turns. Where these apply the others, by which robots may make way for ever, get little at first, and those that are cut
// off as much as they need then.
template <class Z>
std::unique_ptr<Forward<Z>> winning_guess(const Game& game, LimitMonitor& monitor, Joints& joints, Duties& duties,
                                          const std::vector<int>& late, bool turns) {
    const std::vector<int> charges = duties.has_batteries() ? std::vector<int>{0, 60, 100} : std::vector<int>{0};
    const bool trips = Forward<Z>(game, monitor, joints, duties, excursions(Trips::several)).applies();
    if (turns && !trips) return nullptr;
    std::set<int> lost;
    for (const std::size_t most : trips ? std::vector<std::size_t>{FEW_FOLLOWED, ALL} : std::vector<std::size_t>{ALL}) {
        int number = 0;
        for (const Charging charging : duties.chargers().none() ? std::vector<Charging>{Charging::in_turn} : CHARGINGS)
            for (Guess each : late.empty() ? GUESSES : late_guesses(late))
                for (const int charge : charges) {
                    if (lost.count(++number) || (turns && each.trips == Trips::none)) continue;
                    each.charge = charge;
                    each.charging = charging;
                    if (charging != Charging::in_turn) each.zones = ZONES_OF_CALLS;
                    auto forward = std::make_unique<Forward<Z>>(game, monitor, joints, duties, each);
                    const std::size_t limit = each.trips == Trips::none ? most : ALL;
                    if (!is_needless(*forward, each, duties) && forward->wins(limit)) return forward;
                    if (forward->followed() <= limit) lost.insert(number);
                }
    }
    return nullptr;
}

}  // namespace pursue
