// The memory of this process: how much it is, and giving it back.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace pursue {

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

// What is freed is kept for what comes next, up to some MiB, as federations grow and shrink all the time: to get pages from
// the system and to give them back took up to half of the time (two robots around a hub). Small blocks are joined when they
// are freed, not all at once at each larger one. To be called once.
inline void keep_what_is_freed() {
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TRIM_THRESHOLD, 64 << 20);
    mallopt(M_MXFAST, 0);
#endif
}

// At its end the system gets back what was freed meanwhile, if that is much: else it would count as in use when the next
// work begins.
class GivesBack {
  public:
    GivesBack() = default;
    ~GivesBack() {
#ifdef __GLIBC__
        constexpr std::size_t much = 16;
        if (memory_in_use() > before_ + much) malloc_trim(0);
#endif
    }
    GivesBack(const GivesBack&) = delete;
    GivesBack& operator=(const GivesBack&) = delete;

  private:
    const std::size_t before_ = memory_in_use();
};

}  // namespace pursue
