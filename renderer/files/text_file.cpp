#include "renderer/files/text_file.h"

#include <string>

#include "stopping/base/text_encoding.h"

namespace lull {

std::string_view WithoutByteOrderMark(std::string_view text, const FileLoc& loc) {
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    if (const std::string_view wide = WideEncoding(text); !wide.empty())
        throw Error(loc, "the text is " + std::string(wide) + "; save it as UTF-8");
    return text;
}

std::string_view CleanText(std::string_view text, const FileLoc& loc) {
    return WithoutEndMarks(WithoutByteOrderMark(text, loc));
}

}  // namespace lull
