#include "PasswordCrowd.h"

namespace bench::attack {

namespace {

using namespace std::chrono_literals;

constexpr int kNetwork = 7;
constexpr auto kAfterBusy = 300ms;
constexpr auto kAfterWrong = 500ms;

}  // namespace

void PasswordCrowd::begin(const Target& target) {
  m_p_context = &target.context;
  m_port = target.server.port();
  for (int i = 0; i < kAddresses; ++i) m_guessers.push_back({.address = addressIn(kNetwork, i), .guest = {}});
}

void PasswordCrowd::update(Time now) {
  for (Guesser& guesser : m_guessers) {
    if (!guesser.guest) {
      if (now < guesser.next) continue;
      guesser.guest = std::make_unique<Guest>(*m_p_context, m_port, guesser.address,
                                              guestOptions("guesser", "a wrong one"));
    }
    guesser.guest->update(now);
    if (!guesser.guest->isOver()) continue;
    const bool busy = guesser.guest->state() == Guest::State::kRefusedForNow;
    m_busy += busy ? 1 : 0;
    m_wrong += guesser.guest->state() == Guest::State::kRefused ? 1 : 0;
    guesser.guest.reset();
    guesser.next = now + (busy ? kAfterBusy : kAfterWrong);
  }
}

void PasswordCrowd::end() {
  m_guessers.clear();
}

void PasswordCrowd::addFindings(Findings& findings) {
  findings.figures.emplace_back("guesses", m_wrong);
  findings.figures.emplace_back("busy", m_busy);
}

}  // namespace bench::attack
