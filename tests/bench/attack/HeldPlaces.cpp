#include "HeldPlaces.h"

namespace bench::attack {

namespace {

constexpr std::chrono::milliseconds kBetween{300};
constexpr int kNetwork = 6;

}  // namespace

ServerSetup HeldPlaces::setup() const {
  return {.arguments = {"--max-players", "10", "--max-per-address", std::to_string(kAllowed)},
          .password = {}};
}

void HeldPlaces::begin(const Target& target) {
  m_p_context = &target.context;
  m_port = target.server.port();
}

void HeldPlaces::update(Time now) {
  if (!m_guest) {
    if (now < m_next) return;
    m_next = now + kBetween;
    m_guest = std::make_unique<Guest>(*m_p_context, m_port, addressIn(kNetwork, 0), guestOptions(kName, ""));
  }
  m_guest->update(now);
  if (m_guest->state() == Guest::State::kJoining) return;
  ++(m_guest->state() == Guest::State::kPlaying ? m_joined : m_refused);
  m_guest.reset();
}

void HeldPlaces::end() {
  m_guest.reset();
}

void HeldPlaces::addFindings(Findings& findings) {
  findings.figures.emplace_back("joins", m_joined);
  findings.figures.emplace_back("joins_refused", m_refused);
}

}  // namespace bench::attack
