// Functions that Microsoft's compiler has beyond the standard, for games that use them.
#pragma once

#if !defined(_MSC_VER)

#include <cerrno>
#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <ctime>

#if !defined(_countof)
#define _countof(array) (sizeof(array) / sizeof((array)[0]))
#endif

/// The type of Microsoft's error numbers.
using errno_t = int;

// Defined only if they are not macros already, because a game for several compilers may define these names.
#if !defined(sprintf_s)
/// Formats like std::snprintf().
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
/// Copies as much of `from` as fits with a 0 at the end. Returns 0, or ERANGE if `size` is 0.
inline int strcpy_s(char* text, std::size_t size, const char* from) {
  if (size == 0) return ERANGE;
  const std::size_t length = strnlen(from, size - 1);
  std::memcpy(text, from, length);
  text[length] = 0;
  return 0;
}
template <std::size_t size>
int strcpy_s(char (&text)[size], const char* from) {
  return strcpy_s(text, size, from);
}
#endif

#if !defined(strcat_s)
/// Appends as much of `more` as fits. Returns 0, or an error number if `text` has no 0 at its end.
inline int strcat_s(char* text, std::size_t size, const char* more) {
  const std::size_t length = strnlen(text, size);
  return strcpy_s(text + length, size - length, more);
}
template <std::size_t size>
int strcat_s(char (&text)[size], const char* more) {
  return strcat_s(text, size, more);
}
#endif

#if !defined(strncpy_s)
/// Copies at most `count` characters of `from`, and as much as fits with a 0 at the end.
inline int strncpy_s(char* text, std::size_t size, const char* from, std::size_t count) {
  return strcpy_s(text, size <= count ? size : count + 1, from);
}
template <std::size_t size>
int strncpy_s(char (&text)[size], const char* from, std::size_t count) {
  return strncpy_s(text, size, from, count);
}
#endif

#if !defined(fopen_s)
/// Opens a file. Returns 0; on failure sets `*p_file` to null and returns the error number.
inline int fopen_s(std::FILE** p_file, const char* name, const char* mode) {
  *p_file = std::fopen(name, mode);
  return *p_file != nullptr ? 0 : errno;
}
#endif

#if !defined(localtime_s)
/// Converts a time to local time. Returns 0, else the error number.
inline int localtime_s(std::tm* p_local, const std::time_t* p_time) {
  return localtime_r(p_time, p_local) != nullptr ? 0 : errno;
}
#endif

#endif
