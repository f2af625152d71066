// The entry of libFuzzer, one program a target; LULL_FUZZ_TARGET is its name.
#include <cstddef>
#include <cstdint>

#include "tests/fuzz/fuzz_targets.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    static const lull::FuzzTarget run = [] {
        for (const lull::NamedFuzzTarget& target : lull::FuzzTargets())
            if (target.name == LULL_FUZZ_TARGET) return target.run;
        __builtin_trap();
    }();
    run({reinterpret_cast<const char*>(data), size});
    return 0;
}
