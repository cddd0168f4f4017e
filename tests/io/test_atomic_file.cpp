#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <system_error>

#include "io/atomic_file.h"
#include "tests/io/example_result.h"

using namespace lucerna::io;

namespace {

std::size_t files_in(const ScratchFolder& folder) {
    const std::filesystem::directory_iterator files(folder.path());
    return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

// Runs `work` in a child process and returns how it ended, as wait() says it.
template <typename Work>
int in_child(Work work) {
    const pid_t child = ::fork();
    if (child == 0) {
        work();
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return status;
}

}  // namespace

TEST_CASE("A file appears under its name at the commit, and only then", "[unit]") {
    ScratchFolder folder;
    const auto path = folder / "report.json";
    write_file(path, "old");
    {
        AtomicFile file(path);
        file.write("new text", 8);
        CHECK(read_text(path) == "old");
        file.seek(0);
        file.write("N", 1);
        CHECK(file.position() == 1);
        file.commit();
    }
    CHECK(read_text(path) == "New text");
    CHECK(files_in(folder) == 1);
}

TEST_CASE("A file that is given up leaves nothing behind", "[unit]") {
    ScratchFolder folder;
    const auto path = folder / "image.exr";
    write_file(path, "old");
    { AtomicFile(path).write("half", 4); }
    CHECK(read_text(path) == "old");
    CHECK(files_in(folder) == 1);
}

TEST_CASE("A full disk is an error that names the file and keeps the old one", "[unit]") {
    ScratchFolder folder;
    const auto path = folder / "image.exr";
    write_file(path, "old");
    const int status = in_child([&] {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{4096, 4096};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        try {
            write_file(path, std::string(5000, 'x'));
        } catch (const std::system_error& error) {
            const bool named = std::string(error.what()).find("image.exr") != std::string::npos;
            ::_exit(named && error.code().value() == EFBIG ? 42 : 1);
        }
    });
    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 42);
    CHECK(read_text(path) == "old");
    CHECK(files_in(folder) == 1);
}

TEST_CASE("A failure that a library swallows is still known at the commit", "[unit]") {
    ScratchFolder folder;
    const auto path = folder / "image.exr";
    const int status = in_child([&] {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{4096, 4096};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        AtomicFile file(path);
        try {
            file.write(std::string(5000, 'x').data(), 5000);
        } catch (const std::system_error&) {
        }
        try {
            file.commit();
        } catch (const std::system_error&) {
            file.~AtomicFile();
            ::_exit(42);
        }
    });
    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 42);
    CHECK(files_in(folder) == 0);
}

TEST_CASE("A killed run leaves the old file under its name", "[unit]") {
    ScratchFolder folder;
    const auto path = folder / "image.exr";
    write_file(path, "old");
    const int status = in_child([&] {
        AtomicFile file(path);
        file.write("half", 4);
        ::raise(SIGKILL);
    });
    CHECK(WIFSIGNALED(status));
    CHECK(read_text(path) == "old");
}

TEST_CASE("A folder that does not exist is an error that names the file", "[unit]") {
    ScratchFolder folder;
    CHECK_THROWS_WITH(write_file(folder / "none/report.json", "x"),
                      Catch::Contains("none/report.json"));
}
