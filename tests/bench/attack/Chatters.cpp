#include "Chatters.h"

#include "ChatResume.h"

namespace bench::attack {

namespace {

constexpr std::chrono::milliseconds kBetweenLines{125};  // more than twice of what is allowed
constexpr int kNetwork = 5;

}  // namespace

void Chatters::begin(const Target& target) {
  m_p_context = &target.context;
  m_port = target.server.port();
  m_guests.resize(static_cast<std::size_t>(m_count));
}

void Chatters::update(Time now) {
  const bool talk = now >= m_next_line;
  if (talk) m_next_line = now + kBetweenLines;
  for (std::size_t i = 0; i < m_guests.size(); ++i) {
    std::unique_ptr<Guest>& guest = m_guests[i];
    if (guest && guest->isOver()) {
      ++m_ended;
      guest.reset();
    }
    if (!guest && talk) {
      guest = std::make_unique<Guest>(*m_p_context, m_port, addressIn(kNetwork, static_cast<int>(i)),
                                      guestOptions("talker", ""));
    }
    if (!guest) continue;
    guest->update(now);
    if (talk && guest->state() == Guest::State::kPlaying) guest->session()->sendChat(longLine());
  }
}

void Chatters::end() {
  m_guests.clear();
}

void Chatters::addFindings(Findings& findings) {
  findings.figures.emplace_back("chatters", m_count);
  findings.figures.emplace_back("chatters_ended", m_ended);
}

}  // namespace bench::attack
