// Functions that Microsoft's compiler has beside those of the standard, and that games made with it use.
#pragma once

#if !defined(_MSC_VER)

#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <cstring>

#if !defined(_countof)
#define _countof(array) (sizeof(array) / sizeof((array)[0]))
#endif

// A game that knows other compilers has macros of these names.
#if !defined(sprintf_s)
/// As std::snprintf().
__attribute__((format(printf, 3, 4))) inline int sprintf_s(char* text, std::size_t size, const char* format,
                                                           ...) {
  std::va_list arguments;
  va_start(arguments, format);
  const int length = std::vsnprintf(text, size, format, arguments);
  va_end(arguments);
  return length;
}
template <std::size_t size>
__attribute__((format(printf, 2, 3))) int sprintf_s(char (&text)[size], const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  const int length = std::vsnprintf(text, size, format, arguments);
  va_end(arguments);
  return length;
}
#endif

#if !defined(strcpy_s)
/// Copies what fits, with a 0 at the end. Return 0.
inline int strcpy_s(char* text, std::size_t size, const char* from) {
  std::snprintf(text, size, "%s", from);
  return 0;
}
template <std::size_t size>
int strcpy_s(char (&text)[size], const char* from) {
  return strcpy_s(text, size, from);
}
#endif

#endif
