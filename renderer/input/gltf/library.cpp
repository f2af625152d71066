#include "renderer/input/gltf/library.h"

#include <fstream>

#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
