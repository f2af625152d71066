// The AOVs that denoisers and compositors read ("arbitrary output variables").
#pragma once

#include <string>
#include <vector>

namespace lull {

// Which are wanted, and how.
struct AovSet {
    bool albedo = false, normal = false, depth = false, position = false, object = false,
         material = false, noise = false, alpha = false, cryptomatte = false;
    // Follow surfaces with only perfectly specular lobes to the next surface.
    bool throughSpecular = false;

    bool Any() const { return Hits() || noise || Mattes(); }
    // Return whether any is a property of first hits, and whether any is a coverage by them.
    bool Hits() const { return albedo || normal || depth || position || object || material; }
    bool Mattes() const { return alpha || cryptomatte; }
    bool operator==(const AovSet&) const = default;
};

// Names the AOVs: "albedo,normal,..." in the order above, without throughSpecular.
std::string NameOf(const AovSet&);
// Returns the same in words, with throughSpecular, for headers.
std::string TextOf(const AovSet&);

// Returns the names of all, with a separator between them.
std::string AllAovs(const char* separator);

// Reads such names, in any order. Throws Error naming the first unknown one.
AovSet ParseAovs(const std::vector<std::string>& names);

}  // namespace lull
