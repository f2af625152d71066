// Ends a program that was built for a level of x86-64 on a processor that lacks it, before any
// other code of it runs. This file alone is compiled for any processor.
#include <cstdio>
#include <cstdlib>

namespace {

[[gnu::constructor(101)]] void CheckProcessor() {
    __builtin_cpu_init();
    if (__builtin_cpu_supports(LULL_ARCH)) return;
    std::fputs("error: this build of lull needs an " LULL_ARCH
               " processor (Intel of 2013, AMD of 2015 or later); build it from its sources here\n",
               stderr);
    std::_Exit(1);
}

}  // namespace
