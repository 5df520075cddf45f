#include "Progress.h"

#include <unistd.h>

#include <cstdio>

namespace lab {

namespace {

constexpr int kBarWidth = 30;

}  // namespace

Progress::Progress() : m_shown(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (m_shown) std::fputs("\r\033[K", stderr);
}

void Progress::show(double part, const std::string& what) {
  if (!m_shown) return;
  const int full = static_cast<int>(kBarWidth * part);
  const std::string bar = std::string(static_cast<std::size_t>(full), '#') +
                          std::string(static_cast<std::size_t>(kBarWidth - full), '.');
  std::fprintf(stderr, "\r\033[K[%s] %3.0f %% %s", bar.c_str(), part * 100, what.c_str());
}

}  // namespace lab
