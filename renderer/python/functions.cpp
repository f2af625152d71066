// The functions of the extension: svd_entropy(), attributes26() and denoise().
#include <lull/lull.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "renderer/python/arrays.h"

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

// Pixels; less at the right and at the bottom is no block of its own.
constexpr int kLeastRest = 40;

constexpr const char* kColourName = "a or b";

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;

Floats ToFloats(const py::array& array, const std::string& name, int channels, py::ssize_t height,
                py::ssize_t width) {
    CheckShape(array, name, height, width, channels);
    if (array.dtype().kind() != 'f')
        throw py::value_error(name + " has the type " + TypeOf(array) +
                              "; linear floats are needed");
    const py::array wanted = array.ndim() == 2 ? array : FirstChannels(array, channels);
    if (name == kColourName)
        WarnOfColours(wanted, name);
    else if (channels == 3)
        WarnOfValues(wanted, name);  // depths may be infinite
    return Floats(wanted);
}

class Halves {
  public:
    Halves(const py::array& a, const py::array& b, const char* name, int channels,
           py::ssize_t height, py::ssize_t width)
        : a(ToFloats(a, name, channels, height, width)),
          b(ToFloats(b, name, channels, height, width)) {}

    static std::optional<Halves> Read(const py::object& given, const char* name, int channels,
                                      py::ssize_t height, py::ssize_t width) {
        if (given.is_none()) return {};
        if (py::isinstance<py::array>(given)) {
            const auto image = given.cast<py::array>();
            return Halves(image, image, name, channels, height, width);
        }
        if (!py::isinstance<py::sequence>(given) || py::len(given) != 2)
            throw py::value_error(std::string(name) + " must be an array, or a pair of arrays");
        const auto pair = given.cast<py::sequence>();
        return Halves(pair[0].cast<py::array>(), pair[1].cast<py::array>(), name, channels, height,
                      width);
    }

    lull_halves View() const { return {a.data(), b.data(), 0, 0, 0}; }

  private:
    Floats a, b;
};

lull_halves ViewOf(const std::optional<Halves>& halves) {
    return halves ? halves->View() : lull_halves{};
}

std::vector<int> CutsOf(int length, int side) {
    std::vector<int> cuts;
    for (int at = 0; at == 0 || at + kLeastRest <= length; at += side) cuts.push_back(at);
    cuts.push_back(length);
    return cuts;
}

struct Denoised {
    py::array_t<float> picture, error;
    int columns = 0;
    std::vector<lull_block_error> blocks;

    py::array_t<double> Of(double lull_block_error::*field) const {
        return ValuesOf<double>(blocks, columns, field);
    }
    std::vector<std::tuple<int, int, int, int>> Rects() const {
        std::vector<std::tuple<int, int, int, int>> rects;
        for (const lull_block_error& b : blocks) rects.emplace_back(b.x, b.y, b.width, b.height);
        return rects;
    }
};

Denoised Denoise(const py::array& a, const py::array& b, const py::object& albedo,
                 const py::object& normal, const py::object& depth, int block) {
    if (a.ndim() != 3) throw py::value_error("a has the shape " + ShapeOf(a) + ", not H x W x 3");
    if (block < kLeastRest)
        throw py::value_error("blocks of " + std::to_string(block) + " pixels; at least " +
                              std::to_string(kLeastRest) + " are needed");
    const py::ssize_t height = a.shape(0), width = a.shape(1);
    const Halves colour(a, b, kColourName, 3, height, width);
    const auto albedos = Halves::Read(albedo, "albedo", 3, height, width),
               normals = Halves::Read(normal, "normal", 3, height, width),
               depths = Halves::Read(depth, "depth", 1, height, width);
    const lull_noisy_image noisy = {int(width),      int(height),     colour.View(),
                                    ViewOf(albedos), ViewOf(normals), ViewOf(depths)};
    Denoised result{py::array_t<float>({height, width, py::ssize_t(3)}),
                    py::array_t<float>({height, width}),
                    0,
                    {}};
    const std::vector<int> xs = CutsOf(int(width), block), ys = CutsOf(int(height), block);
    result.columns = int(xs.size()) - 1;
    for (size_t v = 0; v + 1 < ys.size(); ++v)
        for (size_t u = 0; u + 1 < xs.size(); ++u)
            result.blocks.push_back({xs[u], ys[v], xs[u + 1] - xs[u], ys[v + 1] - ys[v], 0, 0});
    lull_denoised_image clean = {result.picture.mutable_data(), result.error.mutable_data(),
                                 result.blocks.data(), int(result.blocks.size())};
    lull_status status;
    {
        const py::gil_scoped_release others;
        status = lull_denoise(&noisy, &clean);
    }
    Check(status);
    return result;
}

std::string ReprOf(const Denoised& d) {
    const auto worst = std::ranges::max(d.blocks, {}, &lull_block_error::upper);
    return py::str(
               "<lull.Denoised of {} x {} pixels: visible difference {:.2g} in its worst "
               "block, hardly above {:.2g}>")
        .format(d.picture.shape(1), d.picture.shape(0), worst.estimate, worst.upper);
}

}  // namespace

void BindFunctions(py::module_& module) {
    using namespace py::literals;
    const py::object type = py::module_::import("collections")
                                .attr("namedtuple")("SvdEntropy", "h h1 h2", "module"_a = "lull");
    type.attr("__doc__") =
        "The SVD-entropies of the parts of an image: arrays of their rows x columns, in [0, 1];\n"
        "h = h1 + h2, where h1 has the terms of the first quarter of the singular values.";
    module.attr("SvdEntropy") = type;
    module.def(
        "svd_entropy",
        [type](const py::array& image, int subBlocks) {
            return SvdEntropyOf(image, subBlocks, type);
        },
        "image"_a, "sub_blocks"_a = 100,
        "Computes the SVD-entropy of the lightness of an image, or of a block of it.\n\n"
        "Args:\n"
        "    image: an array of height x width x 3, float32 (linear; 1 is white) or uint8 (sRGB).\n"
        "    sub_blocks: how many equal parts, a square number; 1: the image as one matrix.\n\n"
        "Returns:\n"
        "    A SvdEntropy (h, h1, h2) of arrays of the rows and columns of parts.\n\n"
        "Raises:\n"
        "    ValueError: for another shape or type, or if sub_blocks is not a square number or "
        "the\n"
        "        image has fewer pixels a side than its root.");
    module.def("attributes26", Attributes26Of, "image"_a,
               "Computes the 26 attributes that SVD-entropy is compared with.\n\n"
               "Args:\n"
               "    image: as for svd_entropy(), with 5 pixels a side or more.\n\n"
               "Returns:\n"
               "    An array: the means of |L - filtered L| for 13 filters, L being the lightness\n"
               "    from 0 to 100, then the standard deviations.\n\n"
               "Raises:\n"
               "    ValueError: for another shape or type.");

    py::class_<Denoised>(module, "Denoised", "A denoised image and its estimated error.")
        .def_readonly("image", &Denoised::picture, "H x W x 3, float32, linear.")
        .def_readonly("error", &Denoised::error,
                      "H x W: the estimated standard error of each pixel in L*.")
        .def_property_readonly("blocks", &Denoised::Rects,
                               "Rectangles of the blocks: (x, y, width, height), row by row.")
        .def_property_readonly(
            "estimate", [](const Denoised& d) { return d.Of(&lull_block_error::estimate); },
            "Visible difference of each block from the true image, an array of rows x columns; "
            "`lull render` stops below 3.1.")
        .def_property_readonly(
            "upper", [](const Denoised& d) { return d.Of(&lull_block_error::upper); },
            "Upper bound of the visible difference, exceeded in 10 of 100 blocks.")
        .def("__repr__", [](const Denoised& d) { return ReprOf(d); });

    module.def("denoise", &Denoise, "a"_a, "b"_a, py::kw_only(), "albedo"_a = py::none(),
               "normal"_a = py::none(), "depth"_a = py::none(), "block"_a = 200,
               "Denoises an image, given as two half buffers.\n\n"
               "Args:\n"
               "    a, b: means of independent samples, H x W x 3, linear; e.g. renders with other "
               "seeds.\n"
               "    albedo: of first hits, H x W x 3, 0 to 1: an array, or a pair for a and b.\n"
               "    normal: of first hits, H x W x 3, -1 to 1; likewise.\n"
               "    depth: of first hits, H x W, above 0; likewise.\n"
               "    block: side of the blocks of the error estimate, in pixels.\n\n"
               "Returns: a Denoised.\n"
               "Raises: ValueError for arrays of another shape, type or range, and for dependent a "
               "and b.");
}

}  // namespace lull
