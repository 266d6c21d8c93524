// How a long computation is ended: by whoever is asked a few times a second.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <utility>

#include "zones/native/effort.hpp"

namespace pursue::proof {

// Calls `poll` with the progress at the first tick, and then every 20 ms; it throws to end the work.
class Watch {
  public:
    using Poll = std::function<void(std::size_t states, std::size_t waiting)>;

    explicit Watch(Poll poll = [](std::size_t, std::size_t) {}) : poll_(std::move(poll)) {}

    // How far a search is: symbolic states that it reached, and those that wait to be explored.
    void reached(std::size_t states, std::size_t waiting) {
        states_ = states;
        waiting_ = waiting;
        tick();
    }

    // To be called in every loop whose length nothing bounds.
    void tick() {
        if (ticks_++ % 8) return;  // the clock is not for nothing
        const auto now = std::chrono::steady_clock::now();
        if (now < next_) return;
        poll_(states_, waiting_);
        next_ = std::chrono::steady_clock::now() + std::chrono::milliseconds(20);
    }

  private:
    Poll poll_;
    std::size_t states_ = 0, waiting_ = 0;
    unsigned ticks_ = 0;
    std::chrono::steady_clock::time_point next_{};
};

// While there is one, the watch ticks within the work on zones, too. One at a time per thread.
class Watched {
  public:
    explicit Watched(Watch& watch) {
        effort.look = [](void* of) { static_cast<Watch*>(of)->tick(); };
        effort.of = &watch;
    }
    ~Watched() { effort = Effort{}; }
    Watched(const Watched&) = delete;
    Watched& operator=(const Watched&) = delete;
};

}  // namespace pursue::proof
