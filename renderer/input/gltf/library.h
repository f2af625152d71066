// Includes the library that reads glTF, always with the same settings: images stay as they are
// encoded, and files are read by functions of our own.
#pragma once

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
// Debian's libdraco exports a copy of this library, built otherwise: ours has another name.
#define tinygltf lull_tinygltf
#include <tiny_gltf.h>
