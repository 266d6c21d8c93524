// Limits on time, memory, states and work, and reports of progress.
#pragma once

#include <chrono>
#include <ctime>
#include <functional>
#include <stdexcept>

#include "zones/native/effort.hpp"
#include "zones/native/memory.hpp"

namespace pursue {

struct Limit : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct Limits {
    double seconds = 0;                     // of processor time, 0: none
    bool wall = false;                      // the seconds are the clock's, whatever else the machine does
    std::size_t states = 0;                 // discrete states, 0: none
    std::size_t memory = 0;                 // MiB of the whole process, 0: none
    std::uint64_t work = 0;                 // zones of `effort`, 0: none
    std::function<void()> poll = [] {};     // called now and then; may throw (Ctrl-C)
    // Called a few times a second, and before a limit is thrown: states, waiting, seconds, MiB. May throw.
    std::function<void(std::size_t, std::size_t, double, std::size_t)> progress;
};

// Seconds of a monotonic clock.
inline double clock_time() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Seconds that all threads of this process have worked.
inline double processor_time() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

// Checks the limits between steps and within long work on zones, and reports the progress. One at a time per thread.
class LimitMonitor {
  public:
    explicit LimitMonitor(const Limits& limits) : limits_(limits), start_(now()) {
        effort = Effort{};
        effort.due = INTERVAL;
        effort.pause = [](void* self) { static_cast<LimitMonitor*>(self)->pause(); };
        effort.look = [](void* self) { static_cast<LimitMonitor*>(self)->look(); };
        effort.of = this;
    }
    ~LimitMonitor() { effort = Effort{}; }
    LimitMonitor(const LimitMonitor&) = delete;
    LimitMonitor& operator=(const LimitMonitor&) = delete;

    double spent() const { return now() - start_; }

    // Before one more state is taken in. Throws Limit.
    void admit(std::size_t states, std::size_t waiting) const {
        if (limits_.states && states >= limits_.states) stop("states", states, waiting);
    }

    // To be called often: counts a unit of work. Throws Limit, and what `poll` and `progress` throw.
    void check(std::size_t states, std::size_t waiting) {
        ++effort.zones;
        if (limits_.work && effort.zones > limits_.work) stop("work", states, waiting);
        states_ = states;
        waiting_ = waiting;
        look();
    }

    // The same where no work counts.
    void look() {
        if (looks_++ % 8) return;  // the clock is not for nothing
        const double moment = clock_time();
        if (moment < next_look_) return;
        next_look_ = moment + 0.02;  // what comes now costs some system calls
        limits_.poll();
        const double seconds = spent();
        if (limits_.seconds > 0 && seconds > limits_.seconds) stop("seconds", states_, waiting_);
        const std::size_t memory = memory_in_use();
        if (limits_.memory && memory > limits_.memory) stop("memory", states_, waiting_);
        if (moment < next_report_) return;
        next_report_ = moment + 0.2;
        if (limits_.progress) limits_.progress(states_, waiting_, seconds, memory);
    }

  private:
    static constexpr std::uint64_t INTERVAL = 256;  // zones, some microseconds each

    void pause() {
        effort.due = effort.zones + INTERVAL;
        check(states_, waiting_);
    }

    [[noreturn]] void stop(const char* which, std::size_t states, std::size_t waiting) const {
        if (limits_.progress) limits_.progress(states, waiting, spent(), memory_in_use());
        throw Limit(which);
    }

    double now() const { return limits_.wall ? clock_time() : processor_time(); }

    const Limits& limits_;
    double start_;
    std::size_t states_ = 0, waiting_ = 0;    // at the last step
    unsigned looks_ = 0;
    double next_look_ = 0, next_report_ = 0;  // on the monotonic clock
};

}  // namespace pursue
