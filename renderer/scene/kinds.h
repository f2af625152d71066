// Tables of kinds: their names in scene files, and the functions that read them.
#pragma once

#include <string>

namespace lull {

// An entry of a table. `Make` is a type of function, the same for all of the table.
template <typename Make>
struct Kind {
    const char* name;  // as in scene files
    Make* make;
};

// Returns the entry of that name; null if there is none.
template <typename Make, size_t N>
const Kind<Make>* FindKind(const Kind<Make> (&kinds)[N], const std::string& name) {
    for (const Kind<Make>& kind : kinds)
        if (name == kind.name) return &kind;
    return nullptr;
}

// Lists the names of a table of at least two, for messages: "a, b and c".
template <typename Make, size_t N>
std::string NamesOf(const Kind<Make> (&kinds)[N]) {
    std::string names = kinds[0].name;
    for (size_t i = 1; i < N; ++i)
        names += (i + 1 < N ? ", " : " and ") + std::string(kinds[i].name);
    return names;
}

}  // namespace lull
