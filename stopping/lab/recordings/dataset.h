// Reads and writes data sets: HDF5 files of recordings, a group a viewpoint, a group a block in it.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "stopping/lab/recordings/recording.h"

namespace lull {

// The recordings of one viewpoint.
struct ViewpointRecording {
    std::string name;
    int blockCount = 0;  // in the whole image
    int cap = 0;         // spp at which recordings end at the latest
    int passSpp = 0;     // samples per pixel and pass; 0: records come at any spp
    // Origin of the recordings: scene, its hash, resolution, sampler, ...
    std::map<std::string, std::string> provenance;
    std::map<int, BlockRecording> blocks;   // by row-major number; others are absent
    std::map<int, std::string> blockNotes;  // cost of each recording
};

// Reads all viewpoints of a file. Blocks may lack optional channels, each by itself. Throws
// std::runtime_error beginning with the file's name.
std::vector<ViewpointRecording> ReadDataset(const std::string& path);

// Returns the bytes of a data set file. Statistics are rounded to 12 significant bits, entropies
// and attributes to 19, which compresses them to half their size.
std::vector<std::byte> EncodeDataset(std::span<const ViewpointRecording> viewpoints);

// Adds the blocks of a viewpoint, replacing existing ones; a new viewpoint if there was none of
// that name. Throws std::runtime_error with the difference if there is one that was recorded in
// another way (provenance, cap, passes, number of blocks).
void AddToDataset(const ViewpointRecording& added, std::vector<ViewpointRecording>* viewpoints);

}  // namespace lull
