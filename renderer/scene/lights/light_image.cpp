#include "renderer/scene/lights/light_image.h"

#include "renderer/image/image_io.h"
#include "renderer/scene/textures/image_lookup.h"

namespace lull {

Rgb LightImage::Lookup(const Vec2f& st) const { return BilinearRgb(image, st, Wrap::Repeat); }

std::shared_ptr<const LightImage> ReadLightImage(const LightReader& in) {
    const std::string file = in.entity.parameters.GetString("mapname", "");
    if (file.empty()) return nullptr;
    auto made = std::make_shared<LightImage>();
    try {
        made->image = ReadImage(ResolvePath(in.description, file));
    } catch (const Error& error) {
        in.warnings.Substitute(in.entity.loc, error.what(), "white stands in");
        return nullptr;
    }
    Image& image = made->image;
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    std::visit(
        [&](auto& texels) {
            using T = std::decay_t<decltype(texels[0])>;
            for (T& texel : texels) {
                if (float(texel) >= 0 && std::isfinite(float(texel))) continue;
                texel = T();
                in.warnings.Add(in.entity.loc, "light map texel that is not finite or negative",
                                file);
            }
            for (int y = 0; y < image.height; ++y)
                for (int x = 0; x < image.width; ++x)
                    sum += TexelRgb(image, texels, x, y).template cast<double>();
        },
        image.texels);
    made->mean = (sum / (double(image.width) * image.height)).cast<float>();
    return made;
}

}  // namespace lull
