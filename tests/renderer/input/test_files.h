// Gives input tests files of their own.
#pragma once

#include <string>
#include <string_view>

#include "renderer/input/pbrt_parser.h"
#include "tests/renderer/files/test_files.h"

namespace lull {

// Gives a test that parses scenes a directory of its own.
struct TestFolder : TemporaryDirectory {
    Description Parse(std::string_view text, Warnings* warnings = nullptr) const {
        Warnings ignored;
        Warnings& all = warnings ? *warnings : ignored;
        Description description = ParsePbrt(Write("scene.pbrt", text), all);
        all.ThrowErrors();
        return description;
    }

    // Parses the text between WorldBegin and WorldEnd, on line 1.
    Description ParseWorld(std::string_view text, Warnings* warnings = nullptr) const {
        return Parse("WorldBegin " + std::string(text) + "\nWorldEnd\n", warnings);
    }

    // Returns the message of the Error that `text` gives, without the folder's name; "" for none.
    std::string ErrorOf(std::string_view text) const {
        return MessageOf([&] { Parse(text); });
    }

    template <typename Function>
    std::string MessageOf(const Function& function) const {
        return WithoutPath(lull::ErrorOf(function));
    }
};

}  // namespace lull
