// The work on federations, counted in zones, and the hooks by which whoever started long work looks after it.
#pragma once

#include <cstddef>
#include <cstdint>

namespace pursue {

// Of this thread. The hooks are called with `of`, and may throw to end the work.
struct Effort {
    std::uint64_t zones = 0;          // looked at so far: the same on every machine
    std::uint64_t due = 0;            // when so many zones have been looked at, `pause` is called; 0: never
    void (*pause)(void*) = nullptr;
    void (*look)(void*) = nullptr;    // called now and then, also while zones do not count
    std::uint64_t bounds = 0;         // of zones, met since `look` was called
    void* of = nullptr;
};

// Every loop meets it: where the module cannot be in the first TLS block of a thread, each use would be a call.
#ifdef __GLIBC__
__attribute__((tls_model("initial-exec")))
#endif
inline thread_local Effort effort;

// To be called by every loop over zones whose length is not known, with the zones that a round looks at.
inline void spend(std::size_t zones) {
    effort.zones += zones;
    if (effort.due && effort.zones >= effort.due) effort.pause(effort.of);
}

// While there is one, zones do not count. They are looked after as before.
class Uncounted {
  public:
    Uncounted() { effort.due = 0; }
    ~Uncounted() {
        effort.zones = zones_;
        effort.due = due_;
    }
    Uncounted(const Uncounted&) = delete;
    Uncounted& operator=(const Uncounted&) = delete;

  private:
    const std::uint64_t zones_ = effort.zones, due_ = effort.due;
};

// Called by whatever looks at zones, with the number of their bounds: a round over many or large zones takes long.
inline void attend(std::size_t bounds) {
    constexpr std::uint64_t often = 1 << 15;  // some tens of microseconds
    effort.bounds += bounds;
    if (effort.bounds < often) return;
    effort.bounds = 0;
    if (effort.look) effort.look(effort.of);
}

}  // namespace pursue
