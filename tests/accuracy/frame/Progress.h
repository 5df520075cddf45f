// A progress bar on stderr, shown only on a terminal.
#pragma once

#include <unistd.h>

#include <cstdio>
#include <string>

namespace lab {

class Progress {
 public:
  Progress() : m_shown(isatty(STDERR_FILENO) != 0) {}
  ~Progress() {
    if (m_shown) std::fputs("\r\033[K", stderr);
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Shows the part of the work that is done, 0 to 1, and a text that says what is in progress.
  void show(double part, const std::string& what) const {
    if (!m_shown) return;
    constexpr std::size_t kWidth = 30;
    const auto full = static_cast<std::size_t>(kWidth * part);
    const std::string bar = std::string(full, '#') + std::string(kWidth - full, '.');
    std::fprintf(stderr, "\r\033[K[%s] %3.0f %% %s", bar.c_str(), part * 100, what.c_str());
  }

 private:
  bool m_shown;
};

}  // namespace lab
