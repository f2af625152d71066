// Expects parts of texts, such as messages.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace lull {

inline bool Contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace lull

// Shows both texts where the first does not contain the second.
#define EXPECT_HAS(text, part) EXPECT_PRED2(lull::Contains, text, part)
