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

// The first policy that wins, or none. `joints`, `duties`: of the game.
template <class Z>
std::unique_ptr<Forward<Z>> winning_guess(const Game& game, LimitMonitor& monitor, Joints& joints, Duties& duties,
                                          const std::vector<int>& late) {
    const std::vector<int> charges = duties.has_batteries() ? std::vector<int>{0, 60, 100} : std::vector<int>{0};
    for (const Charging charging : duties.chargers().none() ? std::vector<Charging>{Charging::in_turn} : CHARGINGS)
        for (Guess each : late.empty() ? GUESSES : late_guesses(late))
            for (const int charge : charges) {
                each.charge = charge;
                each.charging = charging;
                if (charging != Charging::in_turn) each.zones = ZONES_OF_CALLS;
                auto forward = std::make_unique<Forward<Z>>(game, monitor, joints, duties, each);
                const bool alone = forward->robots() < 2 || (each.next == Next::in_turn && !forward->tasks().has_choice());
                if (!each.shared_out && alone) continue;  // the same as one that was tried
                if (each.needs_several() && !forward->tasks().has_several()) continue;  // likewise
                if (!forward->applies()) continue;
                if (each.relieved && !forward->tasks().has_guards()) continue;  // likewise
                if (each.alternates == Alternates::long_limits && !forward->alternates()) continue;
                if (each.visits_first && each.patrols.size() == duties.watching().size()) continue;  // nobody calls
                if (forward->wins()) return forward;
            }
    return nullptr;
}

}  // namespace pursue
