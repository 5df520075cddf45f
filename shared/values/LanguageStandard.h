// The C++ version in which games read the public headers. The engine is C++20, but the Makefile of the
// published engine compiles games with -std=c++11. Compilers accept inline variables and the like in C++11
// with a warning, which is disabled here.
#pragma once

#if __cplusplus < 201703L && defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wc++17-extensions"
#endif
