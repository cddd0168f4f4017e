#include "tests/cli/run_program.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "tests/io/example_result.h"

namespace lucerna::cli {
namespace {

Outcome run(const std::vector<std::string>& arguments, bool interrupt) {
    const io::ScratchFolder folder;
    const auto out = folder / "out";
    const auto err = folder / "err";
    std::vector<char*> argv = {const_cast<char*>("lucerna")};
    for (const std::string& argument : arguments)
        argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);

    const pid_t child = ::fork();
    if (child == 0) {
        ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
        ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
        ::execv(LUCERNA_PROGRAM, argv.data());
        ::_exit(127);
    }
    int status = 0;
    if (interrupt) {
        while (io::read_text(err).empty() && ::waitpid(child, &status, WNOHANG) == 0)
            ::usleep(10'000);
        ::kill(child, SIGINT);
    }
    ::waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, io::read_text(out), io::read_text(err)};
}

}  // namespace

Outcome run_program(const std::vector<std::string>& arguments) {
    return run(arguments, false);
}

Outcome run_program_and_interrupt(const std::vector<std::string>& arguments) {
    return run(arguments, true);
}

}  // namespace lucerna::cli
