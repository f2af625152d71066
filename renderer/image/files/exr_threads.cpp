#include "renderer/image/files/exr_threads.h"

#include <ImfThreading.h>

#include <thread>

namespace lull {

int UseExrThreads() {
    static const int threads = [] {
        Imf::setGlobalThreadCount(int(std::thread::hardware_concurrency()));
        return Imf::globalThreadCount();
    }();
    return threads;
}

}  // namespace lull
