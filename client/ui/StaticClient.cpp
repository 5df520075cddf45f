// Replacements for system files that the static dfclient may lack, or find in another version.
//
// A bare root file system has no locale, and glibc would load name service modules of the system, which
// belong to another glibc. The linker (--wrap) makes ncurses and dfclient call the functions below, which
// provide UTF-8 without a locale. Host names come only from /etc/hosts and DNS, both built into glibc.
#include <langinfo.h>
#include <nss.h>
#include <strings.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <cwchar>
#include <string>

#include "shared/values/Canvas.h"

// The linker requires these names.
// NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp)
extern "C" {
char* __real_setlocale(int category, const char* p_name);
char* __real_nl_langinfo(nl_item item);
size_t __real_wcrtomb(char* p_to, wchar_t ch, mbstate_t* p_state);
int __real_wcwidth(wchar_t ch);

char* __wrap_setlocale(int category, const char* p_name);
char* __wrap_nl_langinfo(nl_item item);
size_t __wrap_wcrtomb(char* p_to, wchar_t ch, mbstate_t* p_state);
int __wrap_wcwidth(wchar_t ch);
}

namespace {

/// True unless the environment selects the locale C or one with another encoding.
bool isUtf8() {
  static const bool s_utf8 = [] {
    const char* p_name = "";
    for (const char* p_variable : {"LC_ALL", "LC_CTYPE", "LANG"}) {
      const char* p_value = std::getenv(p_variable);
      if (p_value == nullptr || *p_value == '\0') continue;
      p_name = p_value;
      break;
    }
    if (std::strcmp(p_name, "C") == 0 || std::strcmp(p_name, "POSIX") == 0) return false;
    const char* p_coding = std::strchr(p_name, '.');
    if (p_coding == nullptr) return true;
    ++p_coding;
    return strncasecmp(p_coding, "utf-8", 5) == 0 || strncasecmp(p_coding, "utf8", 4) == 0;
  }();
  return s_utf8;
}

char g_locale[] = "C.UTF-8";
char g_coding[] = "UTF-8";

/// Makes glibc find host names only in files and by DNS. Initialised before any look-up.
[[maybe_unused]] const int g_names = __nss_configure_lookup("hosts", "files dns");

}  // namespace

char* __wrap_setlocale(int category, const char* p_name) {
  // In the locale C, ncurses would expect a terminal with single-byte characters.
  return isUtf8() ? g_locale : __real_setlocale(category, p_name);
}

char* __wrap_nl_langinfo(nl_item item) {
  return isUtf8() && item == CODESET ? g_coding : __real_nl_langinfo(item);
}

size_t __wrap_wcrtomb(char* p_to, wchar_t ch, mbstate_t* p_state) {
  if (!isUtf8()) return __real_wcrtomb(p_to, ch, p_state);
  if (p_to == nullptr) return 1;
  if (ch < 0 || ch > 0x10FFFF || (ch >= 0xD800 && ch < 0xE000)) {
    errno = EILSEQ;
    return static_cast<size_t>(-1);
  }
  if (ch == 0) {
    *p_to = '\0';
    return 1;
  }
  std::string text;
  df::appendUtf8(text, static_cast<char32_t>(ch));
  std::memcpy(p_to, text.data(), text.size());
  return text.size();
}

int __wrap_wcwidth(wchar_t ch) {
  if (!isUtf8()) return __real_wcwidth(ch);
  if (ch == 0) return 0;
  // Other characters on the screen have been checked to be drawable, and take one column.
  return ch < L' ' || (ch >= 0x7F && ch < 0xA0) ? -1 : 1;
}
// NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp)
