// The texts of a study's page, which can be replaced: for other languages, tasks and laboratories.
#pragma once

#include <map>
#include <string>

namespace lull {

// Texts in Markdown by the keys of study_texts.md; and "own", which observers read and
// agree to first, if there is one.
using StudyTexts = std::map<std::string, std::string>;

// Returns the page's own texts, as a file that ReadStudyTexts() reads.
std::string DefaultStudyTexts();

// Reads a file: up to the first line "[key]", alone in its line, is the text "own"; the lines
// after such a line replace the text of that key, and others stay unchanged. Throws Error
// beginning with "path:line" for an unknown or repeated key, or a {name} that the page's own
// text does not have; and for a file that cannot be read, is empty or longer than anybody would
// read. Throws std::runtime_error for one that is not UTF-8 or has marks of its end amid the text.
StudyTexts ReadStudyTexts(const std::string& path);

// Returns all texts of a page, of which `own` replaces some.
StudyTexts AllStudyTexts(const StudyTexts& own);

}  // namespace lull
