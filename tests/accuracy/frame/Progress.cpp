#include "Progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace lab {

namespace {

constexpr int kBarWidth = 30;

}  // namespace

Progress::Progress(int total) : m_total(std::max(total, 1)), m_shown(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (m_shown) std::fputs("\r\033[K", stderr);
}

void Progress::next(const std::string& what) {
  if (m_shown) {
    const int full = kBarWidth * m_done / m_total;
    const std::string bar = std::string(static_cast<std::size_t>(full), '#') +
                            std::string(static_cast<std::size_t>(kBarWidth - full), '.');
    std::fprintf(stderr, "\r\033[K[%s] %d/%d %s", bar.c_str(), m_done, m_total, what.c_str());
  }
  ++m_done;
}

}  // namespace lab
