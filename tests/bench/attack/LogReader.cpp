#include "LogReader.h"

namespace bench::attack {

namespace {

constexpr std::chrono::milliseconds kBetween{200};
constexpr int kNetwork = 8;

}  // namespace

void LogReader::begin(const Target& target) {
  m_p_context = &target.context;
  m_port = target.server.port();
  m_fault == Fault::kStalls ? target.server.stallLog() : target.server.closeLog();
}

// Players who join and leave: a line each time.
void LogReader::update(Time now) {
  if (m_guest) {
    m_guest->update(now);
    if (m_guest->state() == Guest::State::kPlaying) m_guest->session()->leave();
    if (m_guest->isOver()) m_guest.reset();
  } else if (now >= m_next) {
    m_next = now + kBetween;
    m_guest =
        std::make_unique<Guest>(*m_p_context, m_port, addressIn(kNetwork, 0), guestOptions("noise", ""));
  }
}

void LogReader::end() {
  m_guest.reset();
}

}  // namespace bench::attack
