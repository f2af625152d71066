#include "renderer/python/arrays.h"

#include <lull/lull.h>
#include <pybind11/numpy.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace py = pybind11;

namespace lull {

namespace {

Picture WholePicture(const py::array& image) {
    if (image.ndim() != 3)
        throw py::value_error("image has " + std::to_string(image.ndim()) +
                              " dimensions; needed are 3: rows, columns, R G B");
    return Picture(image, {}, int(image.shape(1)), int(image.shape(0)));
}

py::tuple SvdEntropyOf(const py::array& image, int subBlocks, const py::object& type) {
    const Picture picture = WholePicture(image);
    // More than there are pixels are refused, and need no room.
    const int64_t pixels = int64_t(picture.view.width) * picture.view.height;
    std::vector<lull_entropy> entropies(size_t(std::clamp<int64_t>(subBlocks, 0, pixels)));
    Check(lull_svd_entropy(&picture.view, subBlocks, entropies.data()));
    const auto side = py::ssize_t(std::lround(std::sqrt(subBlocks)));
    const auto values = [&](double lull_entropy::*field) {
        py::array_t<double> array({side, side});
        for (size_t i = 0; i < entropies.size(); ++i) array.mutable_data()[i] = entropies[i].*field;
        return array;
    };
    return type(values(&lull_entropy::h), values(&lull_entropy::h1), values(&lull_entropy::h2));
}

py::array_t<double> Attributes26Of(const py::array& image) {
    const Picture picture = WholePicture(image);
    py::array_t<double> attributes(26);
    Check(lull_attributes26(&picture.view, attributes.mutable_data()));
    return attributes;
}

}  // namespace

void BindEntropies(py::module_& module) {
    using namespace py::literals;
    const py::object type = py::module_::import("collections")
                                .attr("namedtuple")("SvdEntropy", "h h1 h2", "module"_a = "lull");
    type.attr("__doc__") =
        "The SVD-entropies of the parts of a picture: arrays of their rows x columns, in [0, 1];\n"
        "h = h1 + h2, where h1 has the terms of the first quarter of the singular values.";
    module.attr("SvdEntropy") = type;
    module.def(
        "svd_entropy",
        [type](const py::array& image, int subBlocks) {
            return SvdEntropyOf(image, subBlocks, type);
        },
        "image"_a, "sub_blocks"_a = 100,
        "Computes the SVD-entropy of the lightness of a picture, or of a block of it.\n\n"
        "Args:\n"
        "    image: an array of height x width x 3, float32 (linear; 1 is white) or uint8 (sRGB).\n"
        "    sub_blocks: how many equal parts, a square number; 1: the picture as one matrix.\n\n"
        "Returns:\n"
        "    A SvdEntropy (h, h1, h2) of arrays of the rows and columns of parts.\n\n"
        "Raises:\n"
        "    ValueError: for another shape or type, or if sub_blocks is not a square number or "
        "the\n"
        "        picture has fewer pixels a side than its root.");
    module.def("attributes26", Attributes26Of, "image"_a,
               "Computes the 26 attributes that SVD-entropy is compared with.\n\n"
               "Args:\n"
               "    image: as for svd_entropy(), with 5 pixels a side or more.\n\n"
               "Returns:\n"
               "    An array: the means of |L - filtered L| for 13 filters, L being the lightness\n"
               "    from 0 to 100, then the standard deviations.\n\n"
               "Raises:\n"
               "    ValueError: for another shape or type.");
}

}  // namespace lull
