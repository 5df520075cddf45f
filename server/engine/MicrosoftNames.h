// What games made on Windows take from Microsoft's C library: the standard functions with the size of the
// buffer. What does not fit is cut off, where there a dialog would stop the game.
#pragma once

#if !defined(_MSC_VER)

#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <cstring>

// NOLINTBEGIN(cert-dcl50-cpp, readability-identifier-naming)

/// As snprintf().
__attribute__((format(printf, 3, 4))) inline int sprintf_s(char* to, std::size_t size, const char* format,
                                                           ...) {
  std::va_list values;
  va_start(values, format);
  const int length = std::vsnprintf(to, size, format, values);
  va_end(values);
  return length;
}

template <std::size_t size>
__attribute__((format(printf, 2, 3))) int sprintf_s(char (&to)[size], const char* format, ...) {
  std::va_list values;
  va_start(values, format);
  const int length = std::vsnprintf(to, size, format, values);
  va_end(values);
  return length;
}

/// Return 0.
inline int strcpy_s(char* to, std::size_t size, const char* from) {
  return sprintf_s(to, size, "%s", from) < 0 ? -1 : 0;
}

template <std::size_t size>
int strcpy_s(char (&to)[size], const char* from) {
  return strcpy_s(to, size, from);
}

/// Return 0.
inline int strcat_s(char* to, std::size_t size, const char* from) {
  const std::size_t length = strnlen(to, size);
  return strcpy_s(to + length, size - length, from);
}

template <std::size_t size>
int strcat_s(char (&to)[size], const char* from) {
  return strcat_s(to, size, from);
}

// NOLINTEND(cert-dcl50-cpp, readability-identifier-naming)

#endif
