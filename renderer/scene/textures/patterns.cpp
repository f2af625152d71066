#include "renderer/scene/textures/patterns.h"

#include <fmt/core.h>

#include "stopping/base/input_file.h"

namespace lull {

template <typename T>
Made<T, Checkerboard<T>> MakeCheckerboard(const TextureInput& input) {
    const TextureEntity& entity = input.entity;
    const int dimension = entity.parameters.GetInt("dimension", 2);
    Checkerboard<T> board{Mapping3D{}, GetTexture<T>(input, "tex1", 1),
                          GetTexture<T>(input, "tex2", 0)};
    if (dimension != 2 && dimension != 3) {
        input.warnings.Substitute(
            entity.loc, fmt::format("{}-dimensional checkerboard is not supported", dimension),
            "1 stands in");
        return ConstantTexture<T>(1);
    }

    if (dimension == 2) {
        board.mapping = MakeMapping2D(input);
        const std::string mode = entity.parameters.GetString("aamode", "closedform");
        if (mode != "none" && mode != "closedform")
            input.warnings.Add(entity.loc, "unknown aamode of checkerboard ignored",
                               Printable(mode));
    } else {
        board.mapping = MakeMapping3D(input);
    }
    if (board.tex1.IsConstant() && board.tex2.IsConstant() &&
        AllEqual(board.tex1.constant, board.tex2.constant))
        return board.tex1;
    return board;
}

template Made<float, Checkerboard<float>> MakeCheckerboard(const TextureInput&);
template Made<Rgb, Checkerboard<Rgb>> MakeCheckerboard(const TextureInput&);

}  // namespace lull
