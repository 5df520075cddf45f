#include "host/world/OutputRelay.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace naiad {

OutputRelay::~OutputRelay() {
  if (m_pipe >= 0) ::close(m_pipe);
}

void OutputRelay::update(Clock::time_point now) {
  char piece[16 << 10];
  for (std::size_t done = 0; done < kMaxRead && m_pipe >= 0;) {
    const ssize_t got = ::read(m_pipe, piece, sizeof piece);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return;
    takePiece({piece, static_cast<std::size_t>(got)}, now);
    done += static_cast<std::size_t>(got);
  }
}

void OutputRelay::finish(Clock::time_point now) {
  update(now);
  if (!m_text.empty()) endLine(now);
  reportDropped();
}

void OutputRelay::takePiece(std::string_view piece, Clock::time_point now) {
  while (!piece.empty()) {
    const std::size_t end = std::min(piece.find('\n'), piece.size());
    m_text += piece.substr(0, end).substr(0, kMaxLine - std::min(m_text.size(), kMaxLine));
    if (end == piece.size()) return;
    endLine(now);
    piece.remove_prefix(end + 1);
  }
}

void OutputRelay::endLine(Clock::time_point now) {
  const std::string line = std::exchange(m_text, {});
  if (!m_bucket.takeToken(kRate, now)) {
    ++m_dropped;
    return;
  }
  reportDropped();
  if (m_line) m_line(line);
}

void OutputRelay::reportDropped() {
  const std::uint64_t dropped = std::exchange(m_dropped, 0);
  if (dropped > 0 && m_line) m_line(std::to_string(dropped) + " lines were too many and are left out");
}

}  // namespace naiad
