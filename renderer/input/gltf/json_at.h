// Checks JSON step by step; each check throws Error with the file and the JSON pointer.
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "renderer/base/error.h"
#include "renderer/base/rounding.h"
#include "renderer/files/file_contents.h"

namespace lull {

// Beyond this no file of ours or anybody's goes, and all sums of two are still exact.
inline constexpr uint64_t kLargestJsonSize = uint64_t(1) << 48;

// A value and where it stands.
struct JsonAt {
    const nlohmann::json& root;
    const std::string& file;
    const nlohmann::json& value;
    std::string path;

    [[noreturn]] void Fail(const std::string& problem) const {
        throw Error(fmt::format("{}: {}: {}", file, path.empty() ? "/" : path, problem));
    }
    JsonAt Member(const std::string& name) const {
        return {root, file, value.at(name), path + "/" + name};
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
    // Returns a whole number from `least` to `most`, `otherwise` where it is absent.
    uint64_t Whole(const std::string& name, uint64_t least, uint64_t most,
                   uint64_t otherwise) const {
        if (!Has(name)) return otherwise;
        const JsonAt member = Member(name);
        if (!member.value.is_number_unsigned())
            member.Fail("has to be a whole number, not negative");
        const auto n = member.value.get<uint64_t>();
        if (n < least || n > most)
            member.Fail(fmt::format("is {}, but has to lie between {} and {}", n, least, most));
        return n;
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
        const size_t size = root.contains(array) ? root.at(array).size() : 0;
        if (!value.is_number_unsigned()) Fail("has to be an index, a whole number");
        if (value.get<uint64_t>() >= size)
            Fail(
                fmt::format("is {}, but there are only {} {}", value.get<uint64_t>(), size, array));
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
            f(JsonAt{root, file, member.value[i], fmt::format("{}/{}", member.path, i)});
    }
    template <typename F>
    void ForEach(const std::string& name, const F& f) const {
        ForEachAny(name, [&](const JsonAt& one) {
            one.Object();
            f(one);
        });
    }
    // Calls f with the values of an object.
    template <typename F>
    void ForEachValue(const std::string& name, const F& f) const {
        if (!Has(name)) return;
        const JsonAt member = Member(name);
        member.Object();
        for (const auto& [key, v] : member.value.items())
            f(JsonAt{root, file, v, member.path + "/" + Printable(key)});
    }
    // Calls f with an extension that the object has.
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
    // Calls f with the extras of the object for lull.
    template <typename F>
    void Extras(const F& f) const {
        if (!Has("extras") || !value.at("extras").contains("lull")) return;
        const JsonAt extras = Member("extras").Member("lull");
        extras.Object();
        f(extras);
    }
};

}  // namespace lull
