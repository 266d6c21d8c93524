// What stands on PATH for a program that preloaded.py becomes: it hands its arguments, folder, variables and open files
// to the process that forks, passes signals on, and ends as the child does. In C++, as there are thousands of them in a
// run of all tests. FOLDER is its own, ADDRESS the other's socket, NAMESPACE the network in which that is.

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>
#include <vector>

extern char **environ;

namespace {

const int FORWARDED[] = {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2};
pid_t child = 0;

std::string linked(const char *path) {
    char text[4096];
    const ssize_t size = readlink(path, text, sizeof text);
    return std::string(text, size < 0 ? 0 : static_cast<std::size_t>(size));
}

// The program of that name on the rest of PATH.
[[noreturn]] void otherwise(const std::string &name, char **arguments) {
    std::string rest;
    const std::string path = std::string(getenv("PATH")) + ":";
    for (std::size_t at = 0, end; (end = path.find(':', at)) != std::string::npos; at = end + 1) {
        const std::string part = path.substr(at, end - at);
        if (part != FOLDER) rest += (rest.empty() ? "" : ":") + part;
    }
    setenv("PATH", rest.c_str(), 1);
    arguments[0] = const_cast<char *>(name.c_str());
    execvp(name.c_str(), arguments);
    std::perror(name.c_str());
    std::exit(127);
}

void forward(int number) { kill(child, number); }

// What the other process says next; nothing where it has ended.
std::string said(int link) {
    char text[64];
    ssize_t size;
    while ((size = recv(link, text, sizeof text, 0)) < 0 && errno == EINTR) {
    }
    return std::string(text, size < 0 ? 0 : static_cast<std::size_t>(size));
}

// Texts, each ended by a zero byte: how many arguments, these, the folder, the variables.
std::string asked(const std::string &script, int count, char **arguments) {
    char folder[4096];
    if (getcwd(folder, sizeof folder) == nullptr) std::exit(127);
    std::vector<std::string> texts;
    if (!script.empty()) texts.push_back(script);
    texts.insert(texts.end(), arguments + 1, arguments + count);
    texts.insert(texts.begin(), std::to_string(texts.size()));
    texts.emplace_back(folder);
    for (char **each = environ; *each != nullptr; ++each) texts.emplace_back(*each);
    std::string all;
    for (const std::string &text : texts) all.append(text.c_str(), text.size() + 1);
    return all;
}

void send(int link, std::string text) {
    const int room = 1 << 20, files[] = {0, 1, 2};
    setsockopt(link, SOL_SOCKET, SO_SNDBUF, &room, sizeof room);
    iovec part = {&text[0], text.size()};
    alignas(cmsghdr) char more[CMSG_SPACE(sizeof files)] = {};
    msghdr message = {};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = more;
    message.msg_controllen = sizeof more;
    cmsghdr *const head = CMSG_FIRSTHDR(&message);
    head->cmsg_level = SOL_SOCKET;
    head->cmsg_type = SCM_RIGHTS;
    head->cmsg_len = CMSG_LEN(sizeof files);
    std::memcpy(CMSG_DATA(head), files, sizeof files);
    if (sendmsg(link, &message, 0) < 0) {
        std::perror("sendmsg");
        std::exit(127);
    }
}

}  // namespace

int main(int count, char **arguments) {
    const std::string whole = linked("/proc/self/exe"), name = whole.substr(whole.rfind('/') + 1);
    struct stat found;
    const bool is_python = name == "python3";
    const bool is_file = count > 1 && stat(arguments[1], &found) == 0 && S_ISREG(found.st_mode);
    if (linked("/proc/self/ns/net") != NAMESPACE || (is_python && !is_file)) otherwise(name, arguments);
    sigset_t forwarded;
    sigemptyset(&forwarded);
    for (int number : FORWARDED) sigaddset(&forwarded, number);
    sigprocmask(SIG_BLOCK, &forwarded, nullptr);
    const int link = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
    sockaddr_un there = {};
    there.sun_family = AF_UNIX;
    std::strncpy(there.sun_path, ADDRESS, sizeof there.sun_path - 1);
    if (connect(link, reinterpret_cast<sockaddr *>(&there), sizeof there) != 0) {
        sigprocmask(SIG_UNBLOCK, &forwarded, nullptr);
        otherwise(name, arguments);
    }
    send(link, asked(is_python ? "" : linked((std::string(FOLDER "/../scripts/") + name).c_str()), count, arguments));
    const std::string number = said(link);
    child = static_cast<pid_t>(std::atoi(number.c_str()));
    if (child <= 0) return 127;
    if (FILE *const comm = std::fopen("/proc/self/comm", "w")) {
        std::fputs(number.c_str(), comm);
        std::fclose(comm);
    }
    kill(child, SIGCONT);
    struct sigaction passing = {};
    passing.sa_handler = forward;
    for (int each : FORWARDED) sigaction(each, &passing, nullptr);
    sigprocmask(SIG_UNBLOCK, &forwarded, nullptr);
    const std::string end = said(link);
    const int status = end.empty() ? -SIGKILL : std::atoi(end.c_str());
    if (status >= 0) return status;
    signal(-status, SIG_DFL);
    kill(getpid(), -status);
    return 128 - status;
}
