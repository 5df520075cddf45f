// Which C++ the public headers are read as. The engine is C++20; games are what they are: the Makefile that
// comes with the published engine says -std=c++11. Compilers know inline variables and the like there, too,
// and only warn.
#pragma once

#if __cplusplus < 201703L && defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wc++17-extensions"
#endif
