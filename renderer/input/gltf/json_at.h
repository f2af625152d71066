// Checks JSON step by step; each check throws Error with the file and the JSON pointer.
#pragma once

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "renderer/base/error.h"
#include "renderer/base/math.h"
#include "renderer/files/file_io.h"
#include "renderer/input/gltf/document.h"

namespace lull {

// Beyond this no file of ours or anybody's goes, and all sums of two are still exact.
inline constexpr uint64_t kLargestJsonSize = uint64_t(1) << 48;

// Returns a place in a file by its JSON pointer; "": the whole.
inline FileLoc PlaceIn(const std::string& file, const std::string& path) {
    return {std::make_shared<const std::string>(file + ": " + (path.empty() ? "/" : path)), 0};
}

// A file's JSON while it is checked.
struct JsonChecked {
    nlohmann::json& root;
    const std::string& file;
    Warnings& warnings;
};

// A value and where it stands.
struct JsonAt {
    JsonChecked& json;
    nlohmann::json& value;
    std::string path;

    [[noreturn]] void Fail(const std::string& problem) const {
        throw Error(Loc().Prefix() + problem);
    }
    FileLoc Loc() const { return PlaceIn(json.file, path); }
    JsonAt Member(const std::string& name) const {
        return {json, value.at(name), path + "/" + name};
    }
    bool Has(const std::string& name) const { return value.contains(name); }

    void Object() const {
        if (!value.is_object()) Fail("has to be an object");
    }
    void String(const std::string& name) const {
        if (Has(name) && !value.at(name).is_string()) Member(name).Fail("has to be a string");
    }
    void Bool(const std::string& name) const {
        if (Has(name) && !value.at(name).is_boolean()) Member(name).Fail("has to be true or false");
    }
    // Returns a whole number that is not negative, which may be written as 4.0 or 4e0: it becomes
    // 4, as the library takes no other.
    std::optional<uint64_t> WholeItself() const {
        constexpr double kExact = 9007199254740992;
        if (value.is_number_float()) {
            const auto n = value.get<double>();
            if (!(n >= 0 && n <= kExact && n == std::floor(n))) return {};
            value = uint64_t(n);
        }
        if (!value.is_number_unsigned()) return {};
        return value.get<uint64_t>();
    }
    // Returns a whole number from `least` to `most`, `otherwise` where it is absent.
    uint64_t Whole(const std::string& name, uint64_t least, uint64_t most,
                   uint64_t otherwise) const {
        if (!Has(name)) return otherwise;
        const JsonAt member = Member(name);
        const std::optional<uint64_t> n = member.WholeItself();
        if (!n) member.Fail("has to be a whole number, not negative");
        if (*n < least || *n > most)
            member.Fail(fmt::format("is {}, but has to lie between {} and {}", *n, least, most));
        return *n;
    }
    void Required(const std::string& name) const {
        if (!Has(name)) Fail("lacks \"" + name + "\"");
    }
    void Number(const std::string& name) const {
        if (Has(name) && !value.at(name).is_number()) Member(name).Fail("has to be a number");
    }
    void NumberWithin(const std::string& name, double least, double most) const {
        Number(name);
        if (Has(name)) Member(name).Within(least, most);
    }
    void NumbersWithin(const std::string& name, size_t count, double least, double most) const {
        Numbers(name, count);
        ForEachAny(name, [&](const JsonAt& n) { n.Within(least, most); });
    }
    // Checks a value that is a number, but for rounding: who reads it clamps it.
    void Within(double least, double most) const {
        const auto n = value.get<double>();
        if (!InRange(n, least, most))
            Fail(fmt::format("is {:g}, but has to lie between {:g} and {:g}", n, least, most));
    }
    // Warn of numbers outside a range, which are clamped where they are used: 0 to 1, with the
    // product of a factor and its texture, and from 0 on.
    void Clamped(const std::string& name) const {
        WarnUnless(name, "number beyond 0 to 1, to which it is clamped",
                   [](double n) { return InRange(n, 0, 1).has_value(); });
    }
    void NotBelowZero(const std::string& name) const {
        WarnUnless(name, "negative number, which counts as 0",
                   [](double n) { return NotNegative(n).has_value(); });
    }
    void Numbers(const std::string& name, size_t count) const {
        if (!Has(name)) return;
        const JsonAt member = Member(name);
        if (!member.value.is_array() || member.value.size() != count)
            member.Fail(fmt::format("has to be an array of {} numbers", count));
        for (const nlohmann::json& n : member.value)
            if (!n.is_number()) member.Fail(fmt::format("has to be an array of {} numbers", count));
    }
    void OneOf(const std::string& name, std::initializer_list<const char*> names) const {
        String(name);
        if (!Has(name)) return;
        for (const char* n : names)
            if (value.at(name) == n) return;
        Member(name).Fail("is \"" + Printable(value.at(name).get<std::string>()) +
                          "\", which is not defined");
    }
    void OneOfNumbers(const std::string& name, std::initializer_list<uint64_t> numbers) const {
        if (!Has(name)) return;
        const uint64_t n = Whole(name, 0, kLargestJsonSize, 0);
        for (const uint64_t one : numbers)
            if (n == one) return;
        Member(name).Fail(fmt::format("is {}, which is not defined", n));
    }

    // Checks an index into one of the top-level arrays.
    void IndexItself(const std::string& array) const {
        const size_t size = json.root.contains(array) ? json.root.at(array).size() : 0;
        const std::optional<uint64_t> index = WholeItself();
        if (!index) Fail("has to be an index, a whole number");
        if (*index >= size)
            Fail(fmt::format("is {}, but there are only {} {}", *index, size, array));
    }
    void Index(const std::string& name, const std::string& array) const {
        if (Has(name)) Member(name).IndexItself(array);
    }
    void Indices(const std::string& name, const std::string& array) const {
        ForEachAny(name, [&](const JsonAt& index) { index.IndexItself(array); });
    }

    template <typename F>
    void ForEachAny(const std::string& name, const F& f) const {
        if (!Has(name)) return;
        const JsonAt member = Member(name);
        if (!member.value.is_array()) member.Fail("has to be an array");
        for (size_t i = 0; i < member.value.size(); ++i)
            f(JsonAt{json, member.value[i], fmt::format("{}/{}", member.path, i)});
    }
    template <typename F>
    void ForEach(const std::string& name, const F& f) const {
        ForEachAny(name, [&](const JsonAt& one) {
            one.Object();
            f(one);
        });
    }
    template <typename F>
    void ForEachValue(const std::string& name, const F& f) const {
        if (!Has(name)) return;
        const JsonAt member = Member(name);
        member.Object();
        for (const auto& [key, v] : member.value.items())
            f(JsonAt{json, v, member.path + "/" + Printable(key)});
    }
    bool HasExtension(const std::string& name) const {
        return Has("extensions") && Member("extensions").Has(name);
    }
    template <typename F>
    void Extension(const std::string& name, const F& f) const {
        if (!Has("extensions")) return;
        const JsonAt extensions = Member("extensions");
        extensions.Object();
        if (!extensions.Has(name)) return;
        const JsonAt extension = extensions.Member(name);
        extension.Object();
        f(extension);
    }
    // Calls f with the extras of the object for lull; warns of members that are not among `known`.
    template <typename F>
    void Extras(std::initializer_list<const char*> known, const F& f) const {
        if (!Has("extras") || !value.at("extras").contains("lull")) return;
        const JsonAt extras = Member("extras").Member("lull");
        extras.Object();
        for (const auto& [key, v] : extras.value.items())
            if (std::ranges::find(known, key) == known.end())
                json.warnings.Add(extras.Loc(), "unknown property of lull's own", Printable(key));
        f(extras);
    }
    void Extras(std::initializer_list<const char*> known) const {
        Extras(known, [](const JsonAt&) {});
    }

  private:
    template <typename IsFine>
    void WarnUnless(const std::string& name, const char* kind, const IsFine& isFine) const {
        if (!Has(name)) return;
        const JsonAt member = Member(name);
        const auto check = [&](const nlohmann::json& n) {
            if (!isFine(n.get<double>()))
                json.warnings.Add(member.Loc(), kind, fmt::format("{:g}", n.get<double>()));
        };
        if (!member.value.is_array()) return check(member.value);
        for (const nlohmann::json& n : member.value) check(n);
    }
};

}  // namespace lull
