// What is installed works where it is put: the program, the library, the module, the manual.
#include <cmath>
#include <random>
#include <regex>
#include <set>

#include "renderer/image/image_io.h"
#include "tests/integration/run_lull.h"

namespace lull {
namespace {

// Runs a command in which TREE stands for the installed tree; expects that it succeeds.
std::string Do(const TemporaryDirectory& directory, std::string command) {
    const std::string prefix = directory.File("moved tree");
    for (size_t at = 0; (at = command.find("TREE", at)) != std::string::npos;)
        command.replace(at, 4, "'" + prefix + "'");
    return ExpectSuccess(RunShell(directory, command)).out;
}

// Installs into a temporary folder and moves that, so that nothing finds its parts by a path that
// was known when it was built. The environment names no models.
struct InstalledTree : TemporaryDirectory {
    InstalledTree() {
        unsetenv("LULL_MODELS");
        Do(*this, "'" LULL_CMAKE "' --install '" LULL_BUILD_DIR "' --prefix '" + File("tree") +
                      "' >/dev/null && mv tree TREE");
    }
    bool HasInstalled(const std::string& name) const {
        return std::filesystem::exists(path / "moved tree" / name);
    }
};

// Returns what bash offers in place of the last of these words.
std::string Complete(const InstalledTree& tree, const std::string& words, int last) {
    tree.Write("complete.sh",
               "set -e\n. 'moved tree/share/bash-completion/completions/lull'\nCOMP_WORDS=(" +
                   words + ")\nCOMP_CWORD=" + std::to_string(last) +
                   "\n_lull\necho \"${COMPREPLY[@]}\"\n");
    return Do(tree, "bash complete.sh");
}

// Returns the long options that a help text defines, each at the beginning of a line.
std::set<std::string> OptionsIn(const std::string& help) {
    std::set<std::string> options;
    const std::regex line("(?:^|\\n)  (-[^ ]*)"), option("--[a-z0-9-]+");
    for (std::sregex_iterator l(help.begin(), help.end(), line), end; l != end; ++l) {
        const std::string names = (*l)[1];
        for (std::sregex_iterator o(names.begin(), names.end(), option); o != end; ++o)
            options.insert(o->str());
    }
    return options;
}

const char* const kCommands[] = {"render",  "info",     "record",  "train", "evaluate",
                                 "denoise", "selftest", "compare", "study", "entropy"};

TEST(Install, RunsWhereItIsMoved) {
    const InstalledTree tree;
    EXPECT_EQ(Do(tree, "TREE/bin/lull --version"), "lull " LULL_VERSION "\n");
    tree.Write("scene.pbrt", SceneText(kSphere));
    // The rule reads its model before anything is rendered.
    Do(tree, "TREE/bin/lull render scene.pbrt --cap 20 --quiet -o out.exr");
    EXPECT_TRUE(tree.Has("out.png"));
    // The module of all formats but PNG and OpenEXR is found, and missed by name.
    tree.Write("a.pfm", "PF\n1 1\n-1.0\n" + std::string(12, '\0'));
    tree.Write("lit.pbrt", SceneText("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" "
                                     "\"a.pfm\"\nMaterial \"matte\" \"texture Kd\" \"t\"\n" +
                                     std::string(kSphere)));
    const std::string render = "TREE/bin/lull render lit.pbrt --spp 1 --quiet -o lit.exr";
    Do(tree, render);
    Do(tree, "rm \"$(find TREE -name formats.so)\"");
    Do(tree, "! " + render + " 2>err");
    const std::string err = tree.Bytes("err");
    EXPECT_TRUE(Contains(err, "lit.pbrt:") && Contains(err, "a.pfm") && Contains(err, "formats.so"))
        << err;
    Do(tree, "TREE/bin/lull render scene.pbrt --spp 1 --quiet -o out.exr");
    for (const char* file : {"include/lull/lull.h", "share/lull/models/entropy.h5",
                             "share/lull/models/paper.h5", "share/doc/lull/copyright"})
        EXPECT_TRUE(tree.HasInstalled(file)) << file;
}

TEST(Install, ManualAndCompletionNameEveryOption) {
    const InstalledTree tree;
    if (!tree.HasInstalled("share/man/man1/lull.1")) GTEST_SKIP() << "built without Python";
    const std::string page = tree.Bytes("moved tree/share/man/man1/lull.1");
    for (const std::string command : kCommands) {
        const std::string help = RunLull(tree, command + " --help-all").out;
        const std::set<std::string> options = OptionsIn(help);
        EXPECT_GE(options.size(), command == "info" || command == "selftest" ? 2u : 4u);
        const size_t begin = page.find(".SS lull " + command);
        ASSERT_NE(begin, std::string::npos);
        const std::string section = page.substr(begin, page.find("\n.SS ", begin + 1) - begin);
        std::string completed = " ";
        completed +=
            std::regex_replace(Complete(tree, "lull " + command + " -", 2), std::regex("\n"), " ");
        for (const std::string& option : options) {
            EXPECT_HAS(section, std::regex_replace(option, std::regex("-"), "\\-")) << option;
            EXPECT_HAS(completed, " " + option + " ") << command << " " << option;
        }
    }
}

TEST(Install, CompletionKnowsCommandsAndValues) {
    const InstalledTree tree;
    if (!tree.HasInstalled("share/bash-completion/completions/lull"))
        GTEST_SKIP() << "built without Python";
    EXPECT_EQ(Complete(tree, "lull ren", 1), "render\n");
    for (const char* command : kCommands)
        EXPECT_HAS(Complete(tree, "lull ''", 1), command) << command;
    EXPECT_EQ(Complete(tree, "lull render --sampler ''", 3), "random sobol sobol-halves\n");
    EXPECT_EQ(Complete(tree, "lull render --sampler so", 3), "sobol sobol-halves\n");
    EXPECT_EQ(Complete(tree, "lull render --aov al", 3), "albedo alpha\n");
    EXPECT_EQ(Complete(tree, "lull render --aov depth,no", 3), "depth,normal depth,noise\n");
    for (const char* option : {"render --stop", "compare --stop", "evaluate --stop"})
        EXPECT_EQ(Complete(tree, "lull " + std::string(option) + " ''", 3),
                  "learned entropy dammertz cycles: luxtile: lnoise denoised thresholds: fixed:\n")
            << option;
    EXPECT_EQ(Complete(tree, "lull render --stop th", 3), "thresholds:\n");
    EXPECT_EQ(Complete(tree, "lull render -o ''", 3), "\n");  // bash completes files
    EXPECT_EQ(Complete(tree, "lull render sc", 2), "\n");
}

// Writes pictures of ever less noise: a gradient, to which the mean of so many samples adds some.
// A pattern makes names of the number of the picture and its samples per pixel.
std::string WritePictures(const TemporaryDirectory& directory, int count, int step,
                          const char* pattern) {
    std::mt19937 generator(1);
    std::normal_distribution<float> gauss;
    std::vector<Rgb> sum(100 * 60, Rgb(0, 0, 0)), mean = sum;
    std::string names;
    for (int k = 1; k <= count; ++k) {
        for (size_t i = 0; i < sum.size(); ++i) {
            const float truth = 0.2f + 0.4f * float(i % 100) / 100;
            for (int c = 0; c < 3; ++c)
                sum[i][c] +=
                    truth * float(step) + 0.15f * std::sqrt(float(step)) * gauss(generator);
            mean[i] = sum[i] / float(k * step);
        }
        const std::string name = fmt::format(fmt::runtime(pattern), k, k * step);
        WritePng(directory.File(name), mean, 100, 60);
        names += " " + name;
    }
    return names;
}

TEST(Install, ExampleWatchesPicturesAgainstTheInstalledLibrary) {
    const InstalledTree tree;
    Do(tree, "'" LULL_CMAKE
             "' -S TREE/share/doc/lull/examples -B build -DCMAKE_PREFIX_PATH=TREE "
             "-DCMAKE_CXX_COMPILER='" LULL_CXX
             "' -DCMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON >&2 && "
             "'" LULL_CMAKE "' --build build >&2");
    WritePictures(tree, 30, 60, "tex_{1}.png");
    const std::string out = Do(tree, "build/watch_pngs tex_*.png");  // 120 is the first name
    EXPECT_TRUE(out.starts_with("tex_60.png: 60 spp, 1 of 1 blocks go on\ntex_120.png: 120 spp"))
        << out;
    EXPECT_TRUE(out.ends_with(", 0 of 1 blocks go on\n")) << out;
    EXPECT_GT(std::ranges::count(out, '\n'), 4) << out;

    // In the order of samples, not of names; eight pictures 40 spp apart make the first window.
    std::filesystem::create_directory(tree.File("room7"));
    WritePictures(tree, 20, 20, "room7/p_{1}.png");
    const std::string paper = Do(tree, "build/paper room7");
    EXPECT_TRUE(paper.starts_with("20 spp: 0 of 1 blocks are clean\n40 spp: ")) << paper;
    EXPECT_HAS(paper, "\n300 spp: 0 of 1 blocks are clean, P(noise) ");
    EXPECT_HAS(paper, "\nroom7;");
    EXPECT_TRUE(paper.ends_with(";\n")) << paper;
    std::filesystem::rename(tree.File("room7/p_20.png"), tree.File("room7/p.png"));
    const auto expect = [&](const std::string& command, int exitCode, const std::string& part) {
        const Outcome outcome = RunShell(tree, "build/" + command);
        EXPECT_EQ(outcome.exitCode, exitCode) << command;
        EXPECT_HAS(outcome.err, part);
    };
    expect("paper room7", 1, "p.png: has no number of samples");
    expect("watch_pngs tex_60.png tex_120.png tex_240.png", 0,
           "tex_240.png: images at 60, 120 and 240 spp lie too far");
    expect("watch_pngs tex_60.png nowhere_80.png", 1, "nowhere_80.png");
    WritePng(tree.File("small_20.png"), std::vector<Rgb>(20 * 20, Rgb(1, 1, 1)), 20, 20);
    expect("watch_pngs small_20.png", 1, "20x20");
}

TEST(Install, PkgConfigFindsTheLibrary) {
    const InstalledTree tree;
    if (RunShell(tree, "command -v pkg-config").exitCode != 0) GTEST_SKIP() << "no pkg-config";
    const std::string flags = "PKG_CONFIG_PATH=TREE/" LULL_LIBDIR "/pkgconfig pkg-config ";
    EXPECT_EQ(Do(tree, flags + "--modversion lull"), LULL_VERSION "\n");
    tree.Write("use.c",
               "#include <lull/lull.h>\n"
               "int main(void) { return lull_denoise(0, 0) == LULL_OK; }\n");
    Do(tree, "eval \"cc use.c -o use $(" + flags +
                 "--cflags --libs lull)\" && LD_LIBRARY_PATH=TREE/" LULL_LIBDIR " ./use");
}

// pip puts a wheel, made of what is built, into an environment of its own.
TEST(Install, WheelWorksWherePipPutsIt) {
    const TemporaryDirectory directory;
    const auto here = [&](const std::string& command) { return Do(directory, command); };
    if (std::string(LULL_PYTHON_DIR) == "none") GTEST_SKIP() << "built without Python";
    if (RunShell(directory, "'" LULL_PYTHON "' -m venv --system-site-packages env && "
                            "env/bin/python -m pip --version && env/bin/python -c 'import numpy'")
            .exitCode != 0)
        GTEST_SKIP() << "there is no venv, pip or numpy (python3-venv, python3-numpy)";
    here("'" LULL_CMAKE "' --install '" LULL_BUILD_DIR
         "' --component python --prefix tree >/dev/null");
    const std::string make = "'" LULL_PYTHON "' '" LULL_WHEEL "' tree '" LULL_PYTHON_DIR
                             "' " LULL_VERSION " 'x86-64-v3' ";
    EXPECT_HAS(here(make + "."), "lull_render-" LULL_VERSION "+x86.64.v3-cp3");
    here("mkdir again && " + make + "again && cmp *.whl again/*.whl");
    here("rm -r tree && env/bin/python -m pip install -q --no-index *.whl >&2");
    EXPECT_EQ(here("env/bin/lull --version"), "lull " LULL_VERSION "\n");
    directory.Write("scene.pbrt", SceneText(kSphere));
    directory.Write("use.py",
                    "import numpy, lull\n"
                    "stopper = lull.Stopper(50, 40)\n"
                    "print(stopper.observe(numpy.zeros((40, 50, 3), numpy.float32), 40))\n"
                    "print(lull.render('scene.pbrt', spp=2, progress=False).spp.max())\n"
                    "print(lull.denoise.__name__, lull.__file__)\n");
    const std::string out = here("env -u LULL_PROGRAM PATH=/usr/bin:/bin env/bin/python use.py");
    EXPECT_TRUE(out.starts_with("<lull.Answer: 0 of 1 blocks clean, at 40 to 40 spp>\n2\n")) << out;
    EXPECT_HAS(out, "/env/lib/python3");
    here("env/bin/python -m pip uninstall -q -y lull-render >&2 && test ! -e env/bin/lull");
}

// A package, made of what is built, unpacked and run: nothing of the system is changed.
TEST(Install, DebianPackageHoldsAllThatItNeeds) {
    const TemporaryDirectory directory;
    const auto here = [&](const std::string& command) { return Do(directory, command); };
    if (RunShell(directory, "command -v dpkg-deb && command -v dpkg-shlibdeps").exitCode != 0)
        GTEST_SKIP() << "there is no dpkg-shlibdeps (dpkg-dev)";
    here("'" LULL_CPACK "' -G DEB --config '" LULL_BUILD_DIR
         "/CPackConfig.cmake' -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip -B . >&2");
    const std::string fields = here("dpkg-deb -f lull_*.deb");
    EXPECT_HAS(fields, "Package: lull\n");
    EXPECT_HAS(fields, "Version: " LULL_VERSION);
    for (const char* library : {"libc6 ", "libembree", "libopenimageio", "libhdf5-", "libtbb12"})
        EXPECT_HAS(fields, library) << library << " in " << fields;
    EXPECT_FALSE(Contains(fields, "liblull")) << fields;

    here("dpkg-deb -x lull_*.deb 'moved tree' && test -r TREE/usr/share/doc/lull/copyright");
    EXPECT_EQ(here("TREE/usr/bin/lull --version"), "lull " LULL_VERSION "\n");
    directory.Write("scene.pbrt", SceneText(kSphere));
    here("TREE/usr/bin/lull render scene.pbrt --cap 20 --quiet -o out.exr");
    const std::string modules = "moved tree/usr/" LULL_PYTHON_DIR;
    if (std::filesystem::exists(directory.path / modules)) {
        EXPECT_HAS(fields, "python3-numpy");
        directory.Write("use.py",
                        "import sys, numpy, lull\n"
                        "stopper = lull.Stopper(50, 40, model='entropy')\n"
                        "answer = stopper.observe(numpy.zeros((40, 50, 3), numpy.float32), 40)\n"
                        "print(lull.__version__, answer.stop)\n");
        EXPECT_EQ(here("PYTHONPATH='" + modules + "' '" LULL_PYTHON "' use.py"),
                  LULL_VERSION " False\n");
    }
}

}  // namespace
}  // namespace lull
