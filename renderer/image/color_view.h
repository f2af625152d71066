// Shows images through OpenColorIO.
#pragma once

#include <memory>
#include <string>

#include "renderer/formats/view_transform.h"

namespace lull {

// Returns a view of the configuration file `config`, empty: $OCIO, for its default display; the
// default view if `view` is empty. Throws Error, with the names of the views if there is no such.
std::shared_ptr<const ViewTransform> LoadView(const std::string& config, const std::string& view);

}  // namespace lull
