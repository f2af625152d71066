// Runs the program as a user would.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "tests/renderer/files/test_files.h"

namespace lull {

struct Outcome {
    int exitCode;  // 128 + the signal's number where one ended the program, as in a shell
    std::string out, err;
};

// Runs `command`, in which LULL stands for the program, with a shell in `directory`.
inline Outcome RunShell(const TemporaryDirectory& directory, std::string command) {
    for (size_t at = 0; (at = command.find("LULL", at)) != std::string::npos;)
        command.replace(at, 4, LULL_PROGRAM);
    const TemporaryDirectory logs;
    const std::string line = "cd '" + directory.path.string() + "' && (" + command + ") >'" +
                             logs.File("out") + "' 2>'" + logs.File("err") + "' </dev/null";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), logs.Bytes("out"),
            logs.Bytes("err")};
}

inline Outcome RunLull(const TemporaryDirectory& directory, const std::string& arguments) {
    return RunShell(directory, "LULL " + arguments);
}

// Expects that the program, run, reported no failure; returns its outcome.
inline Outcome ExpectSuccess(Outcome outcome) {
    EXPECT_EQ(outcome.exitCode, 0) << outcome.out << outcome.err;
    return outcome;
}
inline Outcome ExpectSuccess(const TemporaryDirectory& directory, const std::string& arguments) {
    return ExpectSuccess(RunLull(directory, arguments));
}

// A small scene that renders at once; `world` has its contents.
inline std::string SceneText(const std::string& world, const std::string& film = "") {
    return "LookAt 0 0 -3  0 0 0  0 1 0\n"
           "Camera \"perspective\" \"float fov\" [40]\n"
           "Film \"image\" \"integer xresolution\" [24] \"integer yresolution\" [16] " +
           film +
           "\n"
           "Sampler \"random\"\n"
           "WorldBegin\n"
           "LightSource \"infinite\" \"rgb L\" [1 1 1]\n" +
           world + "\nWorldEnd\n";
}

inline const char* const kSphere = "Shape \"sphere\"";

struct SceneDirectory : TemporaryDirectory {
    SceneDirectory() { Write("scene.pbrt", SceneText(kSphere)); }
};

// Returns the lines that begin as errors do.
inline int CountErrorLines(const std::string& err) {
    const std::string mark = "lull: error: ";
    int count = 0;
    for (size_t at = 0; (at = err.find(mark, at)) != std::string::npos; ++at)
        count += at == 0 || err[at - 1] == '\n';
    return count;
}

// Expects the exit code and one line of error that holds `parts`, and no change to any file;
// returns the outcome.
inline Outcome ExpectFailure(const TemporaryDirectory& directory, const std::string& arguments,
                             const std::vector<std::string>& parts, int exitCode = 1) {
    directory.Write("out.exr", "precious");
    const int filesBefore = directory.CountFiles();
    const Outcome outcome = RunLull(directory, arguments);
    EXPECT_EQ(outcome.exitCode, exitCode) << arguments << "\n" << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(CountErrorLines(outcome.err), 1) << outcome.err;
    EXPECT_EQ(outcome.err.back(), '\n');
    for (const std::string& part : parts) EXPECT_HAS(outcome.err, part);
    EXPECT_EQ(directory.Bytes("out.exr"), "precious");
    EXPECT_EQ(directory.CountFiles(), filesBefore);
    return outcome;
}

}  // namespace lull
