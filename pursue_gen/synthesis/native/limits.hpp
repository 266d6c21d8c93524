// Limits on time, memory, states and work, and reports of progress.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <functional>
#include <stdexcept>

#include "zones/native/effort.hpp"

namespace pursue {

struct Limit : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct Limits {
    double seconds = 0;                     // 0: none
    std::size_t states = 0;                 // discrete states, 0: none
    std::size_t memory = 0;                 // MiB of the whole process, 0: none
    std::uint64_t work = 0;                 // zones of `effort`, 0: none
    std::function<void()> poll = [] {};     // called now and then; may throw (Ctrl-C)
    // Called a few times a second, and before a limit is thrown: states, waiting, seconds, MiB. May throw.
    std::function<void(std::size_t, std::size_t, double, std::size_t)> progress;
};

// MiB of this process in memory; where the system does not report it, the most that it was so far.
inline std::size_t memory_in_use() {
    if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
        unsigned long pages = 0;
        const int read = std::fscanf(file, "%*u %lu", &pages);
        std::fclose(file);
        if (read == 1) return static_cast<std::size_t>(pages) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) >> 20;
    }
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
    return static_cast<std::size_t>(usage.ru_maxrss) >> 20;
#else
    return static_cast<std::size_t>(usage.ru_maxrss) >> 10;
#endif
}

// Checks the limits between steps and within long work on zones, and reports the progress. One at a time per thread.
class LimitMonitor {
  public:
    explicit LimitMonitor(const Limits& limits) : limits_(limits), start_(std::chrono::steady_clock::now()) {
        effort = {0, INTERVAL, [](void* self) { static_cast<LimitMonitor*>(self)->pause(); }, this};
    }
    ~LimitMonitor() { effort = {0, 0, nullptr, nullptr}; }
    LimitMonitor(const LimitMonitor&) = delete;
    LimitMonitor& operator=(const LimitMonitor&) = delete;

    double spent() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

    // Before one more state is taken in. Throws Limit.
    void admit(std::size_t states, std::size_t waiting) const {
        if (limits_.states && states >= limits_.states) stop("states", states, waiting);
    }

    // To be called often. Throws Limit, and what `poll` and `progress` throw.
    void check(std::size_t states, std::size_t waiting) {
        ++effort.zones;
        if (limits_.work && effort.zones > limits_.work) stop("work", states, waiting);
        states_ = states;
        waiting_ = waiting;
        const double now = spent();
        if (limits_.seconds > 0 && now > limits_.seconds) stop("seconds", states, waiting);
        if (now < next_check_) return;
        next_check_ = now + 0.02;  // reading the memory in use costs a system call or three
        limits_.poll();
        const std::size_t memory = memory_in_use();
        if (limits_.memory && memory > limits_.memory) stop("memory", states, waiting);
        if (now < next_report_) return;
        next_report_ = now + 0.2;
        if (limits_.progress) limits_.progress(states, waiting, now, memory);
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

    const Limits& limits_;
    std::chrono::steady_clock::time_point start_;
    std::size_t states_ = 0, waiting_ = 0;  // at the last step
    double next_check_ = 0, next_report_ = 0;  // seconds: of memory, and of the progress
};

}  // namespace pursue
