// The work on federations, counted in zones, and a hook by which whoever started long work looks after it.
#pragma once

#include <cstddef>
#include <cstdint>

namespace pursue {

struct Effort {
    std::uint64_t zones;   // looked at by this thread so far: the same on every machine
    std::uint64_t due;     // when so many zones have been looked at, `pause(of)` is called; 0: never
    void (*pause)(void*);  // may throw
    void* of;
};

inline thread_local Effort effort{0, 0, nullptr, nullptr};

// To be called by every loop over zones whose length is not known, with the zones that a round looks at.
inline void spend(std::size_t zones) {
    effort.zones += zones;
    if (effort.due && effort.zones >= effort.due) effort.pause(effort.of);
}

}  // namespace pursue
